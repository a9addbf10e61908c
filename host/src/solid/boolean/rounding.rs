//! Whether rounded points made a surface cross itself.

use super::operand::Operands;
use super::overlap::{Tile, overlap};
use crate::mesh::Mesh;
use crate::octree::Sorted;
use rayon::prelude::*;

/// What stayed whole.
pub struct Kept {
    /// For each triangle of the operands, counted through, whether it is in the result.
    pub is_kept: Vec<bool>,
    /// By vertex of the operands, counted through, its number in the result.
    pub of_vertex: Vec<u32>,
}

/// Whether triangles of a result that were made anew have no area, overlap each other or triangles that stayed whole.
///
/// - `first`: the first triangle of the result that was made anew.
/// - `is_moved`: whether rounding moved a vertex of the result.
pub fn crosses(
    operands: &Operands,
    result: &Mesh,
    first: usize,
    is_moved: &[bool],
    kept: &Kept,
) -> bool {
    // What was not moved is where it was when all was exact.
    let has_moved = |triangle: &[u32; 3]| triangle.iter().any(|&vertex| is_moved[vertex as usize]);
    let (moved, still): (Vec<[u32; 3]>, Vec<[u32; 3]>) = result.triangles[first..].iter().partition(|t| has_moved(t));
    let at = |vertex: u32| result.vertices[vertex as usize];
    let tile = |&triangle: &[u32; 3]| Tile::new(triangle, triangle.map(at));
    let tiles: Vec<Tile> = moved.par_iter().with_min_len(1024).map(tile).collect();
    if tiles.par_iter().with_min_len(1024).any(Tile::is_flat) {
        return true;
    }
    let of_moved = |triangle: u32| &tiles[triangle as usize];
    let sorted = Sorted::new(&result.vertices, &moved);
    if !sorted.pairs_within(|a, b| overlap(of_moved(a), of_moved(b))).is_empty() {
        return true;
    }
    let is_overlap = |a: u32, b: u32| overlap(of_moved(a), &tile(&still[b as usize]));
    if !sorted.pairs_if(&Sorted::new(&result.vertices, &still).all(), is_overlap).is_empty() {
        return true;
    }
    (0..operands.meshes().len() as u32).any(|operand| {
        let mesh = operands.meshes()[operand as usize];
        let [first_vertex, first] = [operands.first_vertex(operand), operands.first_triangle(operand)];
        let of_kept = |triangle: u32| {
            let corners = mesh.triangles[triangle as usize];
            let names = corners.map(|vertex| kept.of_vertex[(first_vertex + vertex) as usize]);
            Tile::new(names, mesh.corners(triangle as usize))
        };
        let near = operands.sorted(operand).part(|triangle| kept.is_kept[(first + triangle) as usize]);
        !sorted.pairs_if(&near, |a, b| overlap(of_moved(a), &of_kept(b))).is_empty()
    })
}
