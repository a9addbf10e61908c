//! Pairs of triangles of a surface that overlap, and what of them is still known when the surface was changed.

use super::overlap::{NamedTriangle, overlap};
use crate::mesh::{Mesh, bits};
use crate::octree::TriangleBvh;
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The corners of a triangle, whichever is the first and whichever way it turns.
type Corners = [[u64; 3]; 3];

/// The triangles of a surface, and which pairs of them overlap.
pub struct Overlaps {
    numbers: FxHashMap<Corners, u32>,
    pairs: FxHashSet<[u32; 2]>,
}

impl Overlaps {
    /// - `pairs`: all pairs of triangles of the mesh that overlap, the lower first.
    pub fn new(mesh: &Mesh, pairs: &[[u32; 2]]) -> Overlaps {
        let numbers = (0..mesh.triangles.len()).map(|triangle| (corners(mesh, triangle), triangle as u32));
        Overlaps { numbers: numbers.collect(), pairs: pairs.iter().copied().collect() }
    }

    /// Pairs of triangles of another mesh, the lower first, that overlap. Of two triangles that the surface has too, it
    /// is known, since it depends on the places of the corners only.
    ///
    /// Cost: what [`overlapping`] costs for triangles that the surface has not; in proportion to pairs near each other
    /// for the others.
    pub fn overlapping(&self, mesh: &Mesh) -> Vec<[u32; 2]> {
        let number = |triangle| self.numbers.get(&corners(mesh, triangle)).copied();
        let numbers: Vec<Option<u32>> = (0..mesh.triangles.len()).map(number).collect();
        TriangleBvh::new(&mesh.vertices, &mesh.triangles).pairs_within(|a, b| {
            match [numbers[a as usize], numbers[b as usize]] {
                [Some(one), Some(two)] if one != two => self.pairs.contains(&[one.min(two), one.max(two)]),
                _ => do_overlap(mesh, a, b),
            }
        })
    }
}

fn corners(mesh: &Mesh, triangle: usize) -> Corners {
    let mut corners = mesh.corners(triangle).map(bits);
    corners.sort_unstable();
    corners
}

fn do_overlap(mesh: &Mesh, one: u32, two: u32) -> bool {
    let tile = |triangle: u32| NamedTriangle {
        names: mesh.triangles[triangle as usize],
        corners: mesh.corners(triangle as usize),
    };
    overlap(&tile(one).with_plane(), &tile(two), || tile(two).with_plane())
}

/// Pairs of triangles of a mesh, the lower first, that have more in common than corners and the edges between.
pub fn overlapping(mesh: &Mesh) -> Vec<[u32; 2]> {
    overlapping_up_to(mesh, &TriangleBvh::new(&mesh.vertices, &mesh.triangles), usize::MAX)
}

/// Pairs of triangles of a mesh as [`overlapping`] gives them; if there are more than `most`, a few more of them than
/// that.
///
/// - `sorted`: the triangles by location.
pub fn overlapping_up_to(mesh: &Mesh, sorted: &TriangleBvh, most: usize) -> Vec<[u32; 2]> {
    let count = AtomicUsize::new(0);
    let is_enough = || count.load(Ordering::Relaxed) > most;
    sorted.pairs_within_until(is_enough, |a, b| {
        let overlap = do_overlap(mesh, a, b);
        if overlap {
            count.fetch_add(1, Ordering::Relaxed);
        }
        overlap
    })
}
