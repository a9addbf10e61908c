//! Shared curves: the sides of surfaces that are one curve.

use std::collections::HashMap;

use glam::DVec2;

use super::{Surface, between};
use crate::mesh::bits;

/// The use of a curve as a side of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurveUse {
    /// The curve; sides of neighbours have the same.
    pub curve: usize,
    /// Whether the side runs against the direction in which its curve was found first.
    pub is_reversed: bool,
    /// Whether it is a single point.
    pub is_point: bool,
}

/// All shared curves: their number, where each was found first (surface and side), and the four sides of each surface.
pub(super) struct SharedCurves {
    pub first: Vec<(usize, usize)>,
    pub sides: Vec<[CurveUse; 4]>,
}

/// The parameters at `fraction` of side `side`: 0 is v lowest, 1 is v highest (u rises along both), 2 is u lowest, 3 is
/// u highest (v rises along both).
pub(super) fn along_side([low, high]: [DVec2; 2], side: usize, fraction: f64) -> DVec2 {
    match side {
        0 => DVec2::new(between(low.x, high.x, fraction), low.y),
        1 => DVec2::new(between(low.x, high.x, fraction), high.y),
        2 => DVec2::new(low.x, between(low.y, high.y, fraction)),
        _ => DVec2::new(high.x, between(low.y, high.y, fraction)),
    }
}

impl SharedCurves {
    /// Compares all sides by five points each, bit by bit.
    pub fn of<S: Surface>(surfaces: &[S]) -> SharedCurves {
        let mut borders = SharedCurves { first: Vec::new(), sides: Vec::with_capacity(surfaces.len()) };
        let mut curve_of: HashMap<[[u64; 3]; 5], usize> = HashMap::new();
        for (index, surface) in surfaces.iter().enumerate() {
            let domain = surface.domain();
            let sides = [0, 1, 2, 3].map(|side| {
                let fractions = [0.0, 0.25, 0.5, 0.75, 1.0];
                let key = fractions.map(|fraction| bits(surface.point(along_side(domain, side, fraction))));
                let mut turned = key;
                turned.reverse();
                let is_point = key.iter().all(|point| *point == key[0]);
                let known = |key| curve_of.get(key).copied().filter(|_| !is_point);
                if let Some(curve) = known(&key) {
                    return CurveUse { curve, is_reversed: false, is_point };
                }
                if let Some(curve) = known(&turned) {
                    return CurveUse { curve, is_reversed: true, is_point };
                }
                let curve = borders.first.len();
                borders.first.push((index, side));
                curve_of.insert(key, curve);
                CurveUse { curve, is_reversed: false, is_point }
            });
            borders.sides.push(sides);
        }
        borders
    }

    /// For each curve its strip: sides that face each other across a surface belong to the same strip, so that equal
    /// numbers of segments within strips make every surface a full grid.
    pub fn strips(&self) -> Vec<usize> {
        let mut parent: Vec<usize> = (0..self.first.len()).collect();
        for sides in &self.sides {
            for (a, b) in [(0, 1), (2, 3)] {
                let (a, b) = (root(&mut parent, sides[a].curve), root(&mut parent, sides[b].curve));
                parent[a.max(b)] = a.min(b);
            }
        }
        (0..parent.len()).map(|curve| root(&mut parent, curve)).collect()
    }
}

fn root(parent: &mut [usize], mut curve: usize) -> usize {
    while parent[curve] != curve {
        parent[curve] = parent[parent[curve]];
        curve = parent[curve];
    }
    curve
}
