//! Whether rounded points made a surface cross itself.

use super::contact::overlap;
use super::operand::Operands;
use crate::mesh::Mesh;
use crate::octree::Sorted;
use rayon::prelude::*;

/// Whether triangles of a result that were made anew overlap each other or triangles that stayed whole.
///
/// - `first`: the first triangle of the result that was made anew.
/// - `is_kept`: whether a triangle of an operand stayed whole and is in the result.
pub fn crosses(operands: &Operands, result: &Mesh, first: usize, is_kept: impl Fn(u32, u32) -> bool + Sync) -> bool {
    let made = &result.triangles[first..];
    let sorted = Sorted::new(&result.vertices, made);
    let corners = |triangle: u32| result.corners(first + triangle as usize);
    if !sorted.pairs_within(corners, |a, b| overlap(corners(a), corners(b))).is_empty() {
        return true;
    }
    (0..operands.meshes().len() as u32).any(|operand| {
        let of_operand = |triangle: u32| operands.meshes()[operand as usize].corners(triangle as usize);
        let pairs = sorted.pairs(corners, operands.sorted(operand), of_operand);
        let is_overlap = |&[a, b]: &[u32; 2]| is_kept(operand, b) && overlap(corners(a), of_operand(b));
        pairs.par_iter().with_min_len(1024).any(is_overlap)
    })
}
