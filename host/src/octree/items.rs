//! What the index holds: triangles, and pieces of those that are large among small ones.

use rayon::prelude::*;

use super::build::Leaves;
use super::clip::Bounds;

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

/// Items, and which of them stands for each reference of a terminal node.
pub struct Items {
    /// All of them.
    pub items: Vec<Item>,
    /// For each entry of the leaves' triangles the number of its item.
    pub of_reference: Vec<u32>,
}

impl Items {
    /// Makes one item of each triangle in a leaf, or one of each of its references if that saves enough.
    ///
    /// - `whole`: box of a triangle in local coordinates.
    /// - `triangles`: number of triangles.
    pub fn new(leaves: &Leaves, triangles: usize, whole: impl Fn(u32) -> Bounds + Sync) -> Self {
        let mut pieces = vec![(0_u32, 0.0_f32); triangles];
        for (&triangle, bounds) in leaves.triangles.iter().zip(&leaves.bounds) {
            let (count, area) = &mut pieces[triangle as usize];
            *count += 1;
            *area += bounds.half_area();
        }
        let boxes: Vec<Bounds> = (0..triangles as u32).into_par_iter().with_min_len(4096).map(&whole).collect();
        let all = boxes.iter().fold(Bounds::EMPTY, |all, b| all.union(b)).half_area();
        let threshold = WORTHWHILE * all / triangles as f32;
        let split = |triangle: u32| {
            let (count, area) = pieces[triangle as usize];
            boxes[triangle as usize].half_area() - area > threshold * count as f32
        };
        let mut items = Vec::with_capacity(triangles);
        let mut single = vec![u32::MAX; triangles];
        let of_reference = leaves
            .triangles
            .iter()
            .zip(&leaves.bounds)
            .map(|(&triangle, &bounds)| {
                let pieces = split(triangle);
                let known = single[triangle as usize];
                if !pieces && known != u32::MAX {
                    return known;
                }
                let number = items.len() as u32;
                let bounds = if pieces { bounds } else { boxes[triangle as usize] };
                single[triangle as usize] = number;
                items.push(Item { bounds, triangle, number });
                number
            })
            .collect();
        Self { items, of_reference }
    }
}
