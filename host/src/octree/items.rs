//! What the index holds: triangles, and pieces of those that are large among small ones.

use super::build::{Division, Leaves};
use super::clip::Bounds;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// A triangle is held as pieces if each of them saves more than this share of a test of every triangle by every ray.
const WORTHWHILE: f32 = 4.0;

/// A triangle, or its piece in one terminal node.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    /// Box in local coordinates.
    pub bounds: Bounds,
    /// Index of the triangle.
    pub triangle: u32,
    /// Place among the items before the index sorts them.
    pub number: u32,
}

/// Makes one item of each triangle in a leaf, or one of each of its pieces in the leaves if that saves enough.
pub fn items(leaves: &Leaves, division: &Division<'_>) -> Vec<Item> {
    let triangles = division.triangles.len();
    let boxes: Vec<Bounds> = (0..triangles as u32)
        .into_par_iter()
        .with_min_len(4096)
        .map(|triangle| Bounds::of(&division.corners(triangle).map(|corner| corner.to_array())))
        .collect();
    let all = boxes.iter().fold(Bounds::EMPTY, |all, b| all.union(b)).half_area();
    let threshold = WORTHWHILE * all / triangles as f32;
    // Only a triangle with a box above the threshold can save so much; of the others no piece need be made.
    let is_large = |triangle: u32| boxes[triangle as usize].half_area() > threshold;
    let mut pieces: FxHashMap<u32, Vec<Bounds>> = FxHashMap::default();
    for (node, &cell) in leaves.codes.iter().enumerate() {
        for &triangle in leaves.of(node).iter().filter(|&&triangle| is_large(triangle)) {
            pieces.entry(triangle).or_default().extend(division.part(triangle, cell));
        }
    }
    pieces.retain(|&triangle, pieces| {
        let area: f32 = pieces.iter().map(Bounds::half_area).sum();
        boxes[triangle as usize].half_area() - area > threshold * pieces.len() as f32
    });
    let mut items: Vec<Item> = Vec::with_capacity(triangles);
    let mut is_made = vec![false; triangles];
    for &triangle in &leaves.triangles {
        if std::mem::replace(&mut is_made[triangle as usize], true) {
            continue;
        }
        let whole = [boxes[triangle as usize]];
        let bounds = pieces.get(&triangle).map_or(whole.as_slice(), Vec::as_slice);
        items.extend(bounds.iter().map(|&bounds| Item { bounds, triangle, number: 0 }));
    }
    items.iter_mut().zip(0..).for_each(|(item, number)| item.number = number);
    items
}
