//! Corners of elements: those that lie at the same place of a smooth surface are one.

use super::hierarchy::Hierarchy;

use super::node::{NONE, key};
use crate::scene::Prepared;
use glam::DVec3;
use std::collections::HashMap;
use std::ops::{Add, Mul};

/// Elements share a corner if the cosine between their normals is greater: of flat objects, and of curved ones.
const FLAT: f64 = 0.985;
const CURVED: f64 = 0.5;
/// How far corners look out from the place where they are, as a part of the way to the middles of their elements: on an
/// edge may lie another surface.
const INWARDS: f64 = 1e-3;
/// The sine of an angle below which elements are flat.
const HOLLOW: f64 = 1e-4;

/// A corner that elements share.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementCorner {
    /// One of the elements.
    pub(super) leaf: u32,
    /// Sums over the elements: of their middles and of their normals, and how many there are.
    middles: DVec3,
    normals: DVec3,
    count: f64,
    at: DVec3,
}

impl ElementCorner {
    /// A point from where it sees what its elements see, and its unit normal.
    pub(super) fn view(&self) -> [DVec3; 2] {
        let normal = self.normals.normalize_or_zero();
        let offset = self.middles / self.count - self.at;
        // The middles about a tip are within the body.
        let offset = offset - normal * offset.dot(normal).min(0.0);
        [self.at + offset * INWARDS, normal]
    }

    /// Whether its elements rise from it, so that they see each other there.
    pub(super) fn is_hollow(&self) -> bool {
        let offset = self.middles / self.count - self.at;
        offset.dot(self.normals) > HOLLOW * offset.length() * self.normals.length()
    }
}

/// The corners of leaves.
#[derive(Default)]
pub(super) struct ElementCorners {
    at: HashMap<[u64; 3], Vec<(DVec3, u32)>>,
    /// All corners, each once.
    pub(super) all: Vec<ElementCorner>,
    /// The corners of each leaf.
    pub(super) of: Vec<[u32; 3]>,
    /// For each leaf, a corner in its middle that is of it alone, or [`NONE`].
    middle: Vec<u32>,
    /// For each leaf, how alike normals must be.
    like: Vec<f64>,
}

impl ElementCorners {
    /// - `curved`: leaves over which light is not linear, in ascending order: corners tell too little of their means.
    pub(super) fn new(prepared: &Prepared, hierarchy: &Hierarchy, leaves: &[u32], curved: &[u32]) -> ElementCorners {
        let mut corners = ElementCorners::default();
        for leaf in leaves {
            let node = &hierarchy.nodes[*leaf as usize];
            if node.is_face_cluster() {
                let corner = corners.put_alone(hierarchy.central(*leaf), *leaf);
                corners.of.push([corner; 3]);
                corners.like.push(f64::INFINITY);
                corners.middle.push(NONE);
                continue;
            }
            let triangle = hierarchy.patches[node.patch as usize].triangle;
            let like = if prepared.corner_normals(triangle).is_some() { CURVED } else { FLAT };
            let mut numbers = [NONE; 3];
            for (number, at) in numbers.iter_mut().zip(node.corners) {
                *number = corners.put(at, node.normal, like, *leaf);
                let corner = &mut corners.all[*number as usize];
                corner.middles += node.middle;
                corner.normals += node.normal;
                corner.count += 1.0;
            }
            corners.of.push(numbers);
            corners.like.push(like);
            let middle = match curved.binary_search(leaf) {
                Ok(_) => corners.put_alone([node.middle, node.normal], *leaf),
                Err(_) => NONE,
            };
            corners.middle.push(middle);
        }
        corners
    }

    /// Adds a corner that is of one leaf alone, which looks out from where it is, along a unit normal.
    fn put_alone(&mut self, [at, normal]: [DVec3; 2], leaf: u32) -> u32 {
        self.all.push(ElementCorner { leaf, middles: at, normals: normal, count: 1.0, at });
        self.all.len() as u32 - 1
    }

    /// All corners of a leaf, that in its middle, too.
    ///
    /// - `leaf`: its number.
    pub(super) fn of_leaf(&self, leaf: usize) -> impl Iterator<Item = u32> + use<> {
        let middle = Some(self.middle[leaf]).filter(|corner| *corner != NONE);
        self.of[leaf].into_iter().chain(middle)
    }

    /// The mean over a leaf of what is known at its corners: of what is linear, or if there is a corner in its middle, of
    /// what is quadratic.
    ///
    /// - `leaf`: its number. `value`: of a corner, told its number.
    pub(super) fn mean<T: Add<Output = T> + Mul<f64, Output = T>>(&self, leaf: usize, value: impl Fn(u32) -> T) -> T {
        let [a, b, c] = self.of[leaf].map(&value);
        let linear = (a + b + c) * (1.0 / 3.0);
        match self.middle[leaf] {
            NONE => linear,
            middle => linear * 0.25 + value(middle) * 0.75,
        }
    }

    /// A corner at a place, with a normal that is like another.
    pub(super) fn find(&self, point: DVec3, normal: DVec3, like: f64) -> Option<u32> {
        let there = self.at.get(&key(point))?;
        there.iter().find(|(other, _)| other.dot(normal) > like).map(|(_, number)| *number)
    }

    fn put(&mut self, at: DVec3, normal: DVec3, like: f64, leaf: u32) -> u32 {
        self.find(at, normal, like).unwrap_or_else(|| {
            let number = self.all.len() as u32;
            self.at.entry(key(at)).or_default().push((normal, number));
            self.all.push(ElementCorner { leaf, middles: DVec3::ZERO, normals: DVec3::ZERO, count: 0.0, at });
            number
        })
    }

    /// For each corner, the most of what its leaves have.
    ///
    /// - `of_leaves`: what each has.
    pub(super) fn most_of(&self, of_leaves: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut most = vec![0.0f64; self.all.len()];
        for (leaf, value) in of_leaves.enumerate() {
            self.of_leaf(leaf).for_each(|corner| most[corner as usize] = most[corner as usize].max(value));
        }
        most
    }

    /// Corners that lie on edges of larger elements, each with the ends of the edge or of a half of it in the middle of
    /// which it is, and the length of that; the longest first, since those within depend on them.
    pub(super) fn hanging(&self, hierarchy: &Hierarchy, leaves: &[u32]) -> Vec<(f64, [u32; 3])> {
        let mut edges: Vec<(f64, [u32; 3])> = Vec::new();
        for ((leaf, numbers), like) in leaves.iter().zip(&self.of).zip(&self.like) {
            let node = &hierarchy.nodes[*leaf as usize];
            for i in if node.is_cluster() { 0..0 } else { 0..3 } {
                let j = (i + 1) % 3;
                let ends = [(node.corners[i], numbers[i]), (node.corners[j], numbers[j])];
                self.hang(ends, node.normal, *like, &mut edges);
            }
        }
        edges.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        edges
    }

    /// Corners in the middle of an edge, and in the middle of its halves.
    fn hang(
        &self,
        [(from, a), (to, b)]: [(DVec3, u32); 2],
        normal: DVec3,
        like: f64,
        edges: &mut Vec<(f64, [u32; 3])>,
    ) {
        let middle = 0.5 * (from + to);
        let Some(number) = self.find(middle, normal, like) else { return };
        if middle == from || middle == to || number == a || number == b {
            return;
        }
        edges.push((from.distance(to), [number, a, b]));
        self.hang([(from, a), (middle, number)], normal, like, edges);
        self.hang([(middle, number), (to, b)], normal, like, edges);
    }
}
