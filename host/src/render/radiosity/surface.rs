//! The solution at every point of every surface: irradiance at the corners of elements, linear between them.
//!
//! Corners that elements share have one value. Where a corner lies in the middle of an edge of a larger element, it has
//! the value of that edge: there are no cracks.

use super::elements::Elements;
use super::hierarchy::{Hierarchy, NONE};
use crate::color::Channels;
use crate::scene::Prepared;
use glam::DVec3;
use std::collections::HashMap;

/// Elements share a corner if the cosine between their normals is greater: of flat objects, and of curved ones.
const FLAT: f64 = 0.985;
const CURVED: f64 = 0.5;

/// Which part of the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// All of it.
    All,
    /// Only what other surfaces reflect.
    Indirect,
}

/// Irradiance over all surfaces.
#[derive(Clone, Debug, Default)]
pub(super) struct SurfaceLight {
    hierarchy: Hierarchy,
    /// The patch of each side of each triangle, outer and inner; [`NONE`] where no light comes.
    patch_of: Vec<[u32; 2]>,
    /// Of each node that is a leaf, its corners among the values; [`NONE`] where no light comes.
    corners: Vec<[u32; 3]>,
    /// Irradiance by lights, and by other elements.
    values: Vec<[Channels; 2]>,
}

/// A side of a triangle, or a part of it, with the parts of which it consists.
#[derive(Clone, Debug, PartialEq)]
pub struct Division {
    /// Its corners, counter-clockwise about the side; of the outer side of a triangle as the scene orders them, of the inner
    /// one the first, the third and the second.
    pub corners: [DVec3; 3],
    /// None for an element; else the four that the middles of its edges make, at the corners and in the middle, or, if it
    /// is cut, what lines left.
    pub parts: Vec<Division>,
    /// Whether it is cut.
    pub is_cut: bool,
}

impl Division {
    /// How many elements there are in it.
    pub fn leaves(&self) -> usize {
        if self.parts.is_empty() { 1 } else { self.parts.iter().map(Division::leaves).sum() }
    }
}

/// Corners by their place.
#[derive(Default)]
struct Corners {
    at: HashMap<[u64; 3], Vec<(DVec3, u32)>>,
    /// Sums and weights.
    sums: Vec<([Channels; 2], f64)>,
}

fn key(point: DVec3) -> [u64; 3] {
    // Adding 0 turns -0 into 0.
    point.to_array().map(|x| (x + 0.0).to_bits())
}

impl Corners {
    fn find(&self, point: DVec3, normal: DVec3, like: f64) -> Option<u32> {
        let there = self.at.get(&key(point))?;
        there.iter().find(|(other, _)| other.dot(normal) > like).map(|(_, number)| *number)
    }

    fn put(&mut self, point: DVec3, normal: DVec3, like: f64) -> u32 {
        self.find(point, normal, like).unwrap_or_else(|| {
            let number = self.sums.len() as u32;
            self.at.entry(key(point)).or_default().push((normal, number));
            self.sums.push(([Channels::ZERO; 2], 0.0));
            number
        })
    }
}

impl SurfaceLight {
    /// No light anywhere.
    pub(super) fn dark(prepared: &Prepared) -> SurfaceLight {
        SurfaceLight { patch_of: vec![[NONE; 2]; prepared.triangles.len()], ..SurfaceLight::default() }
    }

    /// - `is_dark`: of each leaf, whether no light can come to it.
    pub(super) fn new(prepared: &Prepared, elements: Elements<'_>, leaves: &[u32], is_dark: &[bool]) -> SurfaceLight {
        let Elements { hierarchy, around, indirect, .. } = elements;
        let mut patch_of = vec![[NONE; 2]; prepared.triangles.len()];
        for (number, patch) in (0..).zip(&hierarchy.patches) {
            patch_of[patch.triangle as usize][usize::from(!patch.outside)] = number;
        }
        let mut corners = vec![[NONE; 3]; hierarchy.nodes.len()];
        let mut shared = Corners::default();
        let lit = || leaves.iter().zip(is_dark).filter(|(_, is_dark)| !**is_dark).map(|(leaf, _)| *leaf as usize);
        let like = |leaf: usize| {
            let triangle = hierarchy.patches[hierarchy.nodes[leaf].patch as usize].triangle;
            if prepared.corner_normals(triangle).is_some() { CURVED } else { FLAT }
        };
        for leaf in lit() {
            let node = &hierarchy.nodes[leaf];
            for ((place, corner), lit) in corners[leaf].iter_mut().zip(node.corners).zip(&around[leaf]) {
                *place = shared.put(corner, node.normal, like(leaf));
                // The nearer the middle of an element, the more it tells.
                let weight = corner.distance(node.middle).recip();
                let (sum, all) = &mut shared.sums[*place as usize];
                *all += weight;
                sum[0] += lit.direct * weight;
                sum[1] += indirect[leaf] * weight;
            }
        }
        let mean = |(sum, all): &([Channels; 2], f64)| sum.map(|part| part * all.recip());
        let mut values: Vec<[Channels; 2]> = shared.sums.iter().map(mean).collect();
        let mut edges: Vec<(f64, [u32; 3])> = Vec::new();
        for leaf in lit() {
            let node = &hierarchy.nodes[leaf];
            for i in 0..3 {
                let j = (i + 1) % 3;
                let ends = [(node.corners[i], corners[leaf][i]), (node.corners[j], corners[leaf][j])];
                hang(&shared, ends, node.normal, like(leaf), &mut edges);
            }
        }
        // Those of the largest edges first: on them depend those within.
        edges.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        for (_, [middle, from, to]) in edges {
            let (from, to) = (values[from as usize], values[to as usize]);
            values[middle as usize] = [0, 1].map(|part| (from[part] + to[part]) * 0.5);
        }
        SurfaceLight { hierarchy, patch_of, corners, values }
    }

    /// Irradiance at a place of a side of a triangle, W/m², in lanes that are means over all combs.
    ///
    /// - `weights`: of the corners, as the scene orders them.
    pub(super) fn at(&self, triangle: u32, outside: bool, weights: [f64; 3], part: Part) -> Channels {
        let patch = self.patch_of[triangle as usize][usize::from(!outside)];
        if patch == NONE {
            return Channels::ZERO;
        }
        let weights = self.hierarchy.patches[patch as usize].weights(weights);
        let (leaf, weights) = self.hierarchy.leaf_at(patch, weights);
        let corners = self.corners[leaf as usize];
        if corners[0] == NONE {
            return Channels::ZERO;
        }
        let of = |(corner, weight): (u32, f64)| {
            let [direct, indirect] = self.values[corner as usize];
            (if part == Part::All { direct + indirect } else { indirect }) * weight.max(0.0)
        };
        corners.into_iter().zip(weights).map(of).fold(Channels::ZERO, |a, b| a + b)
    }
}

impl SurfaceLight {
    /// How a side of a triangle is divided; none where no light comes.
    pub(super) fn division(&self, triangle: u32, outside: bool) -> Option<Division> {
        let patch = self.patch_of[triangle as usize][usize::from(!outside)];
        (patch != NONE).then(|| self.division_of(self.hierarchy.node_of[patch as usize] as usize))
    }

    fn division_of(&self, node: usize) -> Division {
        let node = &self.hierarchy.nodes[node];
        let parts = node.children().filter(|_| !node.is_dark).map(|child| self.division_of(child)).collect();
        Division { corners: node.corners, parts, is_cut: node.is_cut }
    }
}

/// Corners in the middle of an edge, and in the middle of its halves.
fn hang(
    shared: &Corners,
    [(from, a), (to, b)]: [(DVec3, u32); 2],
    normal: DVec3,
    like: f64,
    edges: &mut Vec<(f64, [u32; 3])>,
) {
    let middle = 0.5 * (from + to);
    let Some(number) = shared.find(middle, normal, like) else { return };
    if middle == from || middle == to || number == a || number == b {
        return;
    }
    edges.push((from.distance(to), [number, a, b]));
    hang(shared, [(from, a), (middle, number)], normal, like, edges);
    hang(shared, [(middle, number), (to, b)], normal, like, edges);
}
