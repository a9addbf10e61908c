//! Whether rounded points made a surface cross itself, or may have turned a part of it inside out.

use super::operand::Operands;
use super::overlap::{NamedTriangle, PlaneTriangle, nearly_overlap};
use super::parts::FaceClassification;
use crate::mesh::Mesh;
use crate::octree::TriangleBvh;
use rayon::prelude::*;

/// The whole triangles of a result: those of the operands that are in it uncut.
pub struct WholeTriangles {
    /// The classification of each triangle, counted over all operands; those that did not stay whole are discarded.
    pub classifications: Vec<FaceClassification>,
    /// By vertex, counted over all operands, its number in the result.
    pub of_vertex: Vec<u32>,
}

impl WholeTriangles {
    /// Whether a triangle, counted over all operands, is in the result as it is.
    #[inline]
    pub fn contains(&self, triangle: u32) -> bool {
        self.classifications[triangle as usize] != FaceClassification::Discarded
    }
}

/// The new triangles of a result: those that the operation made.
pub struct NewTriangles {
    /// The first of them.
    pub first: usize,
    /// Vertices before this one are corners of triangles that stayed whole.
    pub first_vertex: u32,
    /// For each vertex from that on, whether it may go, since none of its triangles stayed whole.
    pub is_free: Vec<bool>,
    /// The whole triangles, which come before the first new one.
    pub whole: Option<WholeTriangles>,
}

impl NewTriangles {
    /// The number of a vertex that may go, among those from the first on; `None` for another.
    pub fn number(&self, vertex: u32) -> Option<usize> {
        let number = vertex.checked_sub(self.first_vertex)? as usize;
        self.is_free[number].then_some(number)
    }
}

/// Whether new triangles of a result have no area or hardly any, overlap each other or whole triangles,
/// or are folded onto a neighbour.
///
/// - `first`: the first new triangle of the result.
/// - `is_moved`: whether rounding moved a vertex of the result.
pub fn crosses(operands: &Operands, result: &Mesh, first: usize, is_moved: &[bool], whole: &WholeTriangles) -> bool {
    if !is_moved.contains(&true) {
        return false;
    }
    // What was not moved is where it was when all was exact.
    let has_moved = |triangle: &[u32; 3]| triangle.iter().any(|&vertex| is_moved[vertex as usize]);
    let (moved, still): (Vec<[u32; 3]>, Vec<[u32; 3]>) = result.triangles[first..].iter().partition(|t| has_moved(t));
    let tile = |names: [u32; 3]| NamedTriangle { names, corners: names.map(|vertex| result.vertices[vertex as usize]) };
    let tiles = moved.par_iter().with_min_len(1024).map(|&triangle| tile(triangle).with_plane());
    let tiles: Vec<PlaneTriangle> = tiles.collect();
    if tiles.par_iter().with_min_len(1024).any(|tile| tile.is_thin() || tile.is_flat()) {
        return true;
    }
    let of_moved = |triangle: u32| &tiles[triangle as usize];
    let is_overlap = |a: u32, two: NamedTriangle| nearly_overlap(of_moved(a), &two, || two.with_plane());
    let sorted = TriangleBvh::new(&result.vertices, &moved);
    let is_own = |a: u32, b: u32| nearly_overlap(of_moved(a), of_moved(b).triangle(), || of_moved(b));
    if !sorted.pairs_within(is_own).is_empty() {
        return true;
    }
    let unmoved = TriangleBvh::new(&result.vertices, &still);
    if !sorted.pairs_if(&unmoved.all(), |a, b| is_overlap(a, tile(still[b as usize]))).is_empty() {
        return true;
    }
    (0..operands.meshes().len() as u32).any(|operand| {
        let mesh = operands.meshes()[operand as usize];
        let [first_vertex, first] = [operands.first_vertex(operand), operands.first_triangle(operand)];
        let of_kept = |triangle: u32| NamedTriangle {
            names: mesh.triangles[triangle as usize].map(|vertex| whole.of_vertex[(first_vertex + vertex) as usize]),
            corners: mesh.corners(triangle as usize),
        };
        let is_kept = |triangle: u32| whole.contains(first + triangle);
        let sorted_operand = operands.sorted(operand);
        // To find all whole triangles pays only where more than a few are asked for.
        let is_large = mesh.triangles.len() > 64 * moved.len();
        let near = if is_large { sorted_operand.all() } else { sorted_operand.part(is_kept) };
        !sorted.pairs_if(&near, |a, b| is_kept(b) && is_overlap(a, of_kept(b))).is_empty()
    })
}
