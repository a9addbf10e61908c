//! Connected parts of all surfaces that nothing crosses, and what lies on both sides of each.

use super::arrangement::Arrangement;
use super::facets::Facet;
use super::operand::Operands;
use super::union_find::UnionFind;
use super::winding::winding;
use crate::numeric::implicit::{Definition, Point};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// What becomes of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It is no border of the result.
    Dropped,
    /// It is, with the result behind it.
    Kept,
    /// It is, with the result in front of it.
    Turned,
}

/// The parts of the surfaces.
pub struct Parts {
    nodes: UnionFind,
    vertices: usize,
    fates: FxHashMap<u32, Fate>,
    /// Number of parts.
    pub count: u64,
    /// Rays that were sent.
    pub rays: u64,
}

/// Something of a part where it can be classified.
struct Sample {
    root: u32,
    /// A vertex that nothing else touches, or a facet.
    vertex: Option<u32>,
    facet: Option<u32>,
}

impl Parts {
    /// Finds the parts and decides what becomes of each.
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
                nodes.join(triangle[0] + first, triangle[1] + first);
                nodes.join(triangle[1] + first, triangle[2] + first);
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
        let fates: Vec<(Fate, u64)> =
            samples.par_iter().map(|sample| fate(operands, arrangement, facets, sample, &inside)).collect();
        let rays = fates.iter().map(|(_, rays)| rays).sum();
        let fates = fates.into_iter().map(|(fate, _)| fate);
        let count = samples.len() as u64;
        let fates = samples.iter().zip(fates).map(|(sample, fate)| (sample.root, fate)).collect();
        Parts { nodes, vertices, fates, count, rays }
    }

    /// What becomes of an undivided triangle with this vertex.
    pub fn of_vertex(&self, vertex: u32) -> Fate {
        self.fates.get(&self.nodes.root(vertex)).copied().unwrap_or(Fate::Dropped)
    }

    /// What becomes of a facet.
    pub fn of_facet(&self, facet: usize) -> Fate {
        self.of_vertex((self.vertices + facet) as u32)
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
    let mut sides: Vec<(u64, u32)> = Vec::with_capacity(3 * facets.len());
    for (facet, index) in facets.iter().zip(first..) {
        for k in 0..3 {
            let (a, b) = (facet.corners[k], facet.corners[(k + 1) % 3]);
            sides.push((u64::from(a.min(b)) << 32 | u64::from(a.max(b)), index));
        }
    }
    sides.par_sort_unstable();
    for group in sides.chunk_by(|a, b| a.0 == b.0) {
        if let [one, two] = group
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
            samples.push(Sample { root, vertex: None, facet: None });
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
        for (triangle, _) in mesh.triangles.iter().zip(whole).filter(|(_, whole)| **whole) {
            let root = nodes.find(triangle[0] + first);
            if root != last {
                let sample = place(&mut samples, root);
                samples[sample].vertex.get_or_insert(triangle[0] + first);
                last = root;
            }
        }
    }
    samples
}

/// How often each operand goes along the part of a sample less how often against it; the sample's facet has no other
/// sides.
fn steps(operands: &Operands, arrangement: &Arrangement, facets: &[Facet], sample: &Sample) -> Vec<i32> {
    let mut steps = vec![0; operands.meshes().len()];
    match (sample.vertex, sample.facet) {
        (Some(vertex), _) => steps[operands.of_vertex(vertex) as usize] = 1,
        (None, Some(facet)) => {
            for covering in facets[facet as usize].cover() {
                let operand = operands.of_triangle(arrangement.triangles[covering.face as usize]);
                steps[operand as usize] += if covering.is_along { 1 } else { -1 };
            }
        }
        (None, None) => {}
    }
    steps
}

/// Asks by rays which operands a part lies in; those that it is part of itself are left out.
fn ask(operands: &Operands, arrangement: &Arrangement, facets: &[Facet], sample: &Sample) -> (Vec<bool>, u64) {
    let point = match (sample.vertex, sample.facet) {
        (Some(vertex), _) => Point::new(Definition::Given(operands.vertex(vertex))),
        (None, Some(facet)) => Point::middle(facets[facet as usize].corners.map(|p| &arrangement.points[p as usize])),
        (None, None) => return (vec![false; operands.meshes().len()], 0),
    };
    let mut rays = 0;
    let steps = steps(operands, arrangement, facets, sample);
    let is_in = |(step, operand): (i32, u32)| step == 0 && winding(operands, operand, &point, &mut rays) > 0;
    (steps.into_iter().zip(0..).map(is_in).collect(), rays)
}

/// What becomes of the part of a sample.
fn fate(
    operands: &Operands,
    arrangement: &Arrangement,
    facets: &[Facet],
    sample: &Sample,
    inside: impl Fn(&[bool]) -> bool,
) -> (Fate, u64) {
    let (state, rays) = ask(operands, arrangement, facets, sample);
    let steps = steps(operands, arrangement, facets, sample);
    let side = |is_in: fn(i32) -> bool| -> Vec<bool> {
        steps.iter().zip(&state).map(|(&step, &state)| if step == 0 { state } else { is_in(step) }).collect()
    };
    let fate = match (inside(&side(|step| step > 0)), inside(&side(|step| step < 0))) {
        (true, false) => Fate::Kept,
        (false, true) => Fate::Turned,
        _ => Fate::Dropped,
    };
    (fate, rays)
}
