//! Connected parts of all surfaces that nothing crosses, and what lies on both sides of each.

use super::arrangement::Arrangement;
use super::facets::Facet;
use super::half_edges::{HalfEdges, of_triangles};
use super::operand::Operands;
use super::winding::winding;
use crate::numeric::implicit::{ImplicitPoint, PointDefinition, turn};
use crate::solid::union_find::UnionFind;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// The classification of a facet or part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceClassification {
    /// It is no border of the result.
    Discarded,
    /// It is, with the result behind it.
    Kept,
    /// It is, with the result in front of it.
    Reversed,
}

/// The parts of the surfaces.
pub struct Parts {
    nodes: UnionFind,
    vertices: usize,
    classifications: FxHashMap<u32, FaceClassification>,
    /// Number of parts.
    pub count: u64,
    /// Rays that were sent.
    pub rays: u64,
    /// An improper winding number beside the surface of an operand, negative if there is such a one, and where it is.
    pub improper_winding: Option<(i32, DVec3)>,
}

/// Something of a part where it can be classified.
struct Sample {
    root: u32,
    /// A triangle that nothing else touches, or a facet.
    triangle: Option<u32>,
    facet: Option<u32>,
}

impl Sample {
    /// A point of the part, rounded.
    fn position(&self, operands: &Operands, arrangement: &Arrangement, facets: &[Facet]) -> DVec3 {
        let corners = match (self.triangle, self.facet) {
            (Some(triangle), _) => operands.corners(triangle).1,
            (None, Some(facet)) => facets[facet as usize].corners.map(|p| arrangement.points[p as usize].near()),
            (None, None) => [DVec3::ZERO; 3],
        };
        (corners[0] + corners[1] + corners[2]) / 3.0
    }
}

impl Parts {
    /// Finds the parts and classifies each.
    ///
    /// - `is_whole`: whether a triangle, counted over all operands, may matter and did not become facets.
    /// - `inside`: whether a point belongs to the result, by whether it is in each operand.
    pub fn new(
        operands: &Operands,
        arrangement: &Arrangement,
        facets: &[Facet],
        is_whole: &[bool],
        inside: impl Fn(&[bool]) -> bool + Sync,
    ) -> Parts {
        let vertices = operands.vertex_count();
        let mut nodes = UnionFind::new(vertices + facets.len());
        for (operand, mesh) in operands.meshes().iter().enumerate() {
            let first = operands.first_vertex(operand as u32);
            let whole = &is_whole[operands.first_triangle(operand as u32) as usize..];
            for (triangle, _) in mesh.triangles.iter().zip(whole).filter(|(_, whole)| **whole) {
                nodes.join_three(triangle.map(|vertex| vertex + first));
            }
        }
        let free = |point: u32| {
            let is_free = !arrangement.on_other[point as usize];
            arrangement.vertices[point as usize].filter(|_| is_free)
        };
        for (index, facet) in facets.iter().enumerate() {
            for vertex in facet.corners.into_iter().filter_map(free) {
                nodes.join((vertices + index) as u32, vertex);
            }
        }
        join_neighbours(&mut nodes, operands, arrangement, facets);
        let samples = samples(operands, &mut nodes, facets, is_whole);
        let classified: Vec<(FaceClassification, i32, u64)> = samples
            .par_iter()
            .map(|sample| {
                let mut rays = 0;
                let windings = windings(operands, arrangement, facets, sample, &mut rays);
                let odd = windings.as_flattened().iter().copied().filter(|winding| !(0..=1).contains(winding)).min();
                (classify(&windings, &inside), odd.unwrap_or(0), rays)
            })
            .collect();
        let rays = classified.iter().map(|(.., rays)| rays).sum();
        let count = samples.len() as u64;
        let all_odd = samples.iter().zip(&classified).filter(|(_, (_, odd, _))| *odd != 0);
        let odd = all_odd.min_by_key(|(_, (_, odd, _))| *odd > 0);
        let odd = odd.map(|(sample, (_, odd, _))| (*odd, sample.position(operands, arrangement, facets)));
        let classifications = samples
            .iter()
            .zip(&classified)
            .map(|(sample, (classification, ..))| (sample.root, *classification))
            .collect();
        Parts { nodes, vertices, classifications, count, rays, improper_winding: odd }
    }

    /// Whether all are borders of the result, with the result behind them.
    pub fn keep_everything(&self) -> bool {
        self.classifications.values().all(|classification| *classification == FaceClassification::Kept)
    }

    /// The classification of each triangle, counted over all operands; those that are not whole are discarded.
    pub fn of_triangles(&self, operands: &Operands, is_whole: &[bool]) -> Vec<FaceClassification> {
        let mut classifications = vec![FaceClassification::Discarded; is_whole.len()];
        for (operand, mesh) in (0..).zip(operands.meshes()) {
            let [first_vertex, first] = [operands.first_vertex(operand), operands.first_triangle(operand)];
            // Neighbours in the list are mostly of one part.
            let mut last = (u32::MAX, FaceClassification::Discarded);
            let own = first as usize..first as usize + mesh.triangles.len();
            let slots = classifications[own.clone()].iter_mut().zip(&is_whole[own]);
            for (triangle, (classification, _)) in mesh.triangles.iter().zip(slots).filter(|(_, (_, whole))| **whole) {
                let root = self.nodes.root(triangle[0] + first_vertex);
                if root != last.0 {
                    last = (root, self.of_root(root));
                }
                *classification = last.1;
            }
        }
        classifications
    }

    /// The classification of a facet.
    pub fn of_facet(&self, facet: usize) -> FaceClassification {
        self.of_root(self.nodes.root((self.vertices + facet) as u32))
    }

    fn of_root(&self, root: u32) -> FaceClassification {
        self.classifications.get(&root).copied().unwrap_or(FaceClassification::Discarded)
    }
}

/// Joins facets that are alone on the two sides of an edge, of the same operands: nothing else is there.
///
/// Operands differ where a face that cannot matter was left out.
fn join_neighbours(nodes: &mut UnionFind, operands: &Operands, arrangement: &Arrangement, facets: &[Facet]) {
    let first = operands.vertex_count() as u32;
    let operand = |face: u32| operands.of_triangle(arrangement.triangles[face as usize]);
    let are_alike = |one: u32, two: u32| {
        let cover = |index: u32| facets[(index - first) as usize].cover().map(|c| (operand(c.face), c.is_along));
        cover(one).eq(cover(two))
    };
    let sides = HalfEdges::new(arrangement.points.len(), of_triangles(facets.iter().map(|facet| facet.corners), first));
    for (_, beside) in sides.edges() {
        if let [one, two] = beside
            && are_alike(one.1, two.1)
        {
            nodes.join(one.1, two.1);
        }
    }
}

fn samples(operands: &Operands, nodes: &mut UnionFind, facets: &[Facet], is_whole: &[bool]) -> Vec<Sample> {
    let mut samples: Vec<Sample> = Vec::new();
    let mut known: FxHashMap<u32, usize> = FxHashMap::default();
    let mut place = |samples: &mut Vec<Sample>, root: u32| {
        *known.entry(root).or_insert_with(|| {
            samples.push(Sample { root, triangle: None, facet: None });
            samples.len() - 1
        })
    };
    let vertices = operands.vertex_count();
    for facet in 0..facets.len() {
        let root = nodes.find((vertices + facet) as u32);
        let sample = place(&mut samples, root);
        samples[sample].facet.get_or_insert(facet as u32);
    }
    for (operand, mesh) in operands.meshes().iter().enumerate() {
        let first = operands.first_vertex(operand as u32);
        let whole = &is_whole[operands.first_triangle(operand as u32) as usize..];
        let mut last = u32::MAX;
        let numbers = operands.first_triangle(operand as u32)..;
        for ((triangle, _), number) in mesh.triangles.iter().zip(whole).zip(numbers).filter(|((_, whole), _)| **whole) {
            let root = nodes.find(triangle[0] + first);
            if root != last {
                let sample = place(&mut samples, root);
                samples[sample].triangle.get_or_insert(number);
                last = root;
            }
        }
    }
    samples
}

/// The winding number of each operand behind a part and in front of it, as its sample tells.
///
/// A ray is spared for operands that bound themselves simply and that the part is of.
fn windings(
    operands: &Operands,
    arrangement: &Arrangement,
    facets: &[Facet],
    sample: &Sample,
    rays: &mut u64,
) -> Vec<[i32; 2]> {
    let mut steps = vec![0; operands.meshes().len()];
    let (point, corners) = match (sample.triangle, sample.facet) {
        (Some(triangle), _) => {
            steps[operands.of_triangle(triangle) as usize] = 1;
            let corners = operands.corners(triangle).1;
            (
                ImplicitPoint::middle(
                    corners.map(|corner| ImplicitPoint::new(PointDefinition::Given(corner))).each_ref(),
                ),
                corners,
            )
        }
        (None, Some(facet)) => {
            let facet = &facets[facet as usize];
            for covering in facet.cover() {
                let operand = operands.of_triangle(arrangement.triangles[covering.face as usize]);
                steps[operand as usize] += if covering.is_along { 1 } else { -1 };
            }
            let middle = ImplicitPoint::middle(facet.corners.map(|p| &arrangement.points[p as usize]));
            (middle, arrangement.faces[facet.face as usize].plane())
        }
        (None, None) => return vec![[0; 2]; steps.len()],
    };
    // The rays see what lies ahead of the surface: on which side of it that is, its first slope tells.
    let [a, b, c] = corners.map(|corner| ImplicitPoint::new(PointDefinition::Given(corner)));
    let is_front_ahead = (0..3).map(|axis| turn(axis, &a, &b, &c)).find(|slope| *slope != 0.0) > Some(0.0);
    let around = |(step, operand): (i32, u32)| match (operands.are_simple, step) {
        (true, 1) => [1, 0],
        (true, -1) => [0, 1],
        _ => {
            let ahead = winding(operands, operand, &point, rays);
            if is_front_ahead { [ahead + step, ahead] } else { [ahead, ahead - step] }
        }
    };
    steps.into_iter().zip(0..).map(around).collect()
}

/// The classification of a part by the winding numbers behind it and in front of it.
fn classify(windings: &[[i32; 2]], inside: impl Fn(&[bool]) -> bool) -> FaceClassification {
    let [behind, before] =
        [0, 1].map(|side| inside(&windings.iter().map(|winding| winding[side] > 0).collect::<Vec<_>>()));
    match (behind, before) {
        (true, false) => FaceClassification::Kept,
        (false, true) => FaceClassification::Reversed,
        _ => FaceClassification::Discarded,
    }
}
