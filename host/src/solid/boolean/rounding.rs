//! Whether rounded points made a surface cross itself.

use super::contact::overlap;
use super::operand::Operands;
use crate::mesh::Mesh;
use crate::numeric::implicit::projection;
use crate::octree::Sorted;
use rayon::prelude::*;

/// Whether triangles of a result that were made anew have no area, overlap each other or triangles that stayed whole.
///
/// - `first`: the first triangle of the result that was made anew.
/// - `is_moved`: whether rounding moved a vertex of the result.
/// - `is_kept`: whether a triangle of an operand stayed whole and is in the result.
pub fn crosses(
    operands: &Operands,
    result: &Mesh,
    first: usize,
    is_moved: &[bool],
    is_kept: impl Fn(u32, u32) -> bool + Sync,
) -> bool {
    // What was not moved is where it was when all was exact.
    let has_moved = |triangle: &&[u32; 3]| triangle.iter().any(|&vertex| is_moved[vertex as usize]);
    let made = &result.triangles[first..];
    let (moved, still): (Vec<&[u32; 3]>, Vec<&[u32; 3]>) = made.iter().partition(has_moved);
    let [moved, still] = [moved, still].map(|list| list.into_iter().copied().collect::<Vec<_>>());
    let corners = |[a, b, c]: [u32; 3]| [a, b, c].map(|vertex| result.vertices[vertex as usize]);
    let is_flat = |triangle: &[u32; 3]| projection(corners(*triangle)).is_none();
    if moved.par_iter().any(is_flat) {
        return true;
    }
    let of_moved = |triangle: u32| corners(moved[triangle as usize]);
    let sorted = Sorted::new(&result.vertices, &moved);
    if !sorted.pairs_within(|a, b| overlap(of_moved(a), of_moved(b))).is_empty() {
        return true;
    }
    let pairs = sorted.pairs(&Sorted::new(&result.vertices, &still));
    if pairs.into_par_iter().with_min_len(1024).any(|[a, b]| overlap(of_moved(a), corners(still[b as usize]))) {
        return true;
    }
    (0..operands.meshes().len() as u32).any(|operand| {
        let of_operand = |triangle: u32| operands.meshes()[operand as usize].corners(triangle as usize);
        let pairs = sorted.pairs(operands.sorted(operand));
        let is_overlap = |&[a, b]: &[u32; 2]| is_kept(operand, b) && overlap(of_moved(a), of_operand(b));
        pairs.par_iter().with_min_len(1024).any(is_overlap)
    })
}
