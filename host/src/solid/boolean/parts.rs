//! Connected parts of all surfaces that nothing crosses, and what lies on both sides of each.

use super::arrangement::Arrangement;
use super::facets::Facet;
use super::operand::Operands;
use super::union_find::UnionFind;
use crate::numeric::bounds::Bounds;
use crate::numeric::implicit::{Definition, Point, side_of, turn};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;

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
    fates: HashMap<u32, Fate>,
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
    /// - `is_divided`: whether a triangle, counted over all operands, became facets.
    /// - `inside`: whether a point belongs to the result, by whether it is in each operand.
    pub fn new(
        operands: &Operands,
        arrangement: &Arrangement,
        facets: &[Facet],
        is_divided: &[bool],
        inside: impl Fn(&[bool]) -> bool + Sync,
    ) -> Parts {
        let vertices = operands.vertex_count();
        let mut nodes = UnionFind::new(vertices + facets.len());
        for (operand, mesh) in operands.meshes().iter().enumerate() {
            let first = operands.first_vertex(operand as u32);
            let divided = &is_divided[operands.first_triangle(operand as u32) as usize..];
            for (triangle, _) in mesh.triangles.iter().zip(divided).filter(|(_, divided)| !**divided) {
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
        join_neighbours(&mut nodes, vertices as u32, facets);
        let samples = samples(operands, &mut nodes, facets, is_divided);
        let fates: Vec<(Fate, u64)> = samples
            .par_iter()
            .map(|sample| {
                let mut rays = 0;
                (fate(operands, arrangement, facets, sample, &inside, &mut rays), rays)
            })
            .collect();
        let count = samples.len() as u64;
        let rays = fates.iter().map(|(_, rays)| rays).sum();
        let fates = samples.iter().zip(&fates).map(|(sample, (fate, _))| (sample.root, *fate)).collect();
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

/// Joins facets that are alone on the two sides of an edge.
fn join_neighbours(nodes: &mut UnionFind, first: u32, facets: &[Facet]) {
    let mut sides: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * facets.len());
    for (index, facet) in facets.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (facet.corners[k], facet.corners[(k + 1) % 3]);
            sides.push((a.min(b), a.max(b), first + index as u32));
        }
    }
    sides.par_sort_unstable();
    for group in sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        if let [one, two] = group {
            nodes.join(one.2, two.2);
        }
    }
}

fn samples(operands: &Operands, nodes: &mut UnionFind, facets: &[Facet], is_divided: &[bool]) -> Vec<Sample> {
    let mut samples: Vec<Sample> = Vec::new();
    let mut known: HashMap<u32, usize> = HashMap::new();
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
        let divided = &is_divided[operands.first_triangle(operand as u32) as usize..];
        let mut last = u32::MAX;
        for (triangle, _) in mesh.triangles.iter().zip(divided).filter(|(_, divided)| !**divided) {
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

/// What becomes of the part of a sample.
fn fate(
    operands: &Operands,
    arrangement: &Arrangement,
    facets: &[Facet],
    sample: &Sample,
    inside: impl Fn(&[bool]) -> bool,
    rays: &mut u64,
) -> Fate {
    let count = operands.meshes().len();
    // Winding numbers of all operands in front of the part and behind it.
    let mut front = vec![None; count];
    let mut behind = vec![None; count];
    let mut step = vec![0; count];
    let point = match (sample.vertex, sample.facet) {
        (Some(vertex), _) => {
            step[operands.of_vertex(vertex) as usize] = 1;
            Point::new(Definition::Given(operands.vertex(vertex)))
        }
        (None, Some(facet)) => {
            let facet = &facets[facet as usize];
            for covering in &facet.cover {
                let operand = operands.of_triangle(arrangement.triangles[covering.face as usize]);
                step[operand as usize] += if covering.is_along { 1 } else { -1 };
            }
            Point::middle(facet.corners.map(|p| &arrangement.points[p as usize]))
        }
        (None, None) => return Fate::Dropped,
    };
    for operand in 0..count {
        (behind[operand], front[operand]) = match step[operand] {
            0 => {
                let is_inside = winding(operands, operand as u32, &point, rays) > 0;
                (Some(is_inside), Some(is_inside))
            }
            along => (Some(along > 0), Some(along < 0)),
        };
    }
    let result = |side: Vec<Option<bool>>| inside(&side.into_iter().map(|s| s.unwrap_or(false)).collect::<Vec<_>>());
    match (result(behind), result(front)) {
        (true, false) => Fate::Kept,
        (false, true) => Fate::Turned,
        _ => Fate::Dropped,
    }
}

/// How often an operand winds around a point that is not on its surface.
///
/// Counts the triangles beside a ray along x. The ray is thought to be moved a little along y and much less along z, so
/// that it meets neither vertex nor edge.
fn winding(operands: &Operands, operand: u32, point: &Point, rays: &mut u64) -> i32 {
    let bounds = operands.sorted(operand).bounds();
    let near = point.bounds();
    if !bounds.touches(near) {
        return 0;
    }
    *rays += 1;
    let mesh = operands.meshes()[operand as usize];
    let beside = Bounds { min: near.min, max: near.max.with_x(f64::INFINITY) };
    let mut winding = 0;
    operands.sorted(operand).touching(beside, |triangle| {
        let corners = mesh.corners(triangle as usize);
        if Bounds::of(corners).touches(beside) {
            winding += passes(point, corners);
        }
    });
    winding
}

/// 1 if the ray along x leaves through the front of a triangle, -1 if through its back, 0 if not at all.
fn passes(point: &Point, corners: [DVec3; 3]) -> i32 {
    let [a, b, c] = corners.map(|corner| Point::new(Definition::Given(corner)));
    let facing = turn(0, &a, &b, &c);
    if facing == 0.0 {
        return 0;
    }
    for (from, to) in [(&a, &b), (&b, &c), (&c, &a)] {
        let mut turns = turn(0, point, from, to);
        if turns == 0.0 {
            // The derivatives of the turn by y and by z.
            let (p, q) = (from.near(), to.near());
            let by = [p.z - q.z, q.y - p.y];
            turns = if by[0] != 0.0 { by[0] } else { by[1] };
        }
        if turns * facing < 0.0 {
            return 0;
        }
    }
    let is_ahead = side_of(corners, point) * facing > 0.0;
    if is_ahead { facing as i32 } else { 0 }
}
