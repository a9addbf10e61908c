//! Whether rounded points made a surface cross itself.

use super::operand::Operands;
use super::overlap::{Tile, overlap};
use crate::mesh::Mesh;
use crate::octree::Sorted;
use rayon::prelude::*;

/// Whether triangles of a result that were made anew have no area, overlap each other or triangles that stayed whole.
///
/// - `first`: the first triangle of the result that was made anew.
/// - `is_moved`: whether rounding moved a vertex of the result.
/// - `number`: of a vertex of the operands, counted through, in the result.
/// - `is_kept`: whether a triangle of an operand stayed whole and is in the result.
pub fn crosses(
    operands: &Operands,
    result: &Mesh,
    first: usize,
    is_moved: &[bool],
    number: impl Fn(u32) -> u32 + Sync,
    is_kept: impl Fn(u32, u32) -> bool + Sync,
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
    if !sorted.pairs_if(&Sorted::new(&result.vertices, &still), is_overlap).is_empty() {
        return true;
    }
    (0..operands.meshes().len() as u32).any(|operand| {
        let mesh = operands.meshes()[operand as usize];
        let first = operands.first_vertex(operand);
        let kept = |triangle: u32| {
            let corners = mesh.triangles[triangle as usize];
            let names = corners.map(|vertex| number(first + vertex));
            Tile::new(names, mesh.corners(triangle as usize))
        };
        let is_overlap = |a: u32, b: u32| is_kept(operand, b) && overlap(of_moved(a), &kept(b));
        !sorted.pairs_if(operands.sorted(operand), is_overlap).is_empty()
    })
}
