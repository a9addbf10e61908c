//! Rays on the surface of a terrain: through its cells in the order in which they come to them.

use super::super::field::normal_of;
use super::super::march::TerrainHit;
use super::block::{Block, HALF};
use super::ground::SIDE;
use super::patch::first_negative;
use super::surface::TerrainSurface;
use crate::numeric::ray::Ray;
use glam::{DVec2, DVec3};

/// Rounding of the height of a ray above the surface, as a part of all coordinates and heights.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl TerrainSurface {
    /// The first crossing of a ray with the surface, from above or from below.
    ///
    /// Crossings are changes of side: a ray that only touches the surface, to rounding, has none there, and one that begins
    /// on it leaves it without a hit.
    ///
    /// - `interval`: the least and the greatest t.
    pub fn intersect(&self, ray: &Ray, interval: [f64; 2]) -> Option<TerrainHit> {
        if !(ray.origin.is_finite() && ray.direction.is_finite() && ray.direction != DVec3::ZERO) {
            return None;
        }
        let [from, to] = ray.within(&self.bounds(), interval)?;
        let hit = {
            let root = self.root.read().unwrap_or_else(|poisoned| poisoned.into_inner());
            let direction = DVec2::new(ray.direction.x, ray.direction.z);
            let mut walk = Walk {
                surface: self,
                ray,
                origin: DVec2::new(ray.origin.x, ray.origin.z),
                direction,
                reciprocal: direction.recip(),
                side: 0.0,
                hit: None,
            };
            walk.cells(&root, [0, 0], SIDE, [from, to]);
            walk.hit
        };
        self.keep_to_limit();
        hit
    }
}

/// A ray on its way.
struct Walk<'w> {
    surface: &'w TerrainSurface,
    ray: &'w Ray,
    /// Along the ground.
    origin: DVec2,
    direction: DVec2,
    reciprocal: DVec2,
    /// 1 above the surface, -1 below it; 0 while it is not known.
    side: f64,
    hit: Option<TerrainHit>,
}

impl Walk<'_> {
    /// Looks for the first crossing in a square of cells of a block; tells whether there is one.
    ///
    /// - `first`: its first cell. `count`: cells along its side, a power of 2. `part`: the t in which the ray is there.
    fn cells(&mut self, block: &Block, first: [usize; 2], count: usize, [mut from, to]: [f64; 2]) -> bool {
        let half = count / 2;
        let middle = block.corner_of(first.map(|axis| axis + half));
        // When it comes to the other half along an axis, and in which half it is.
        let mut next = [f64::INFINITY; 2];
        let mut halves = [0; 2];
        for axis in 0..2 {
            let rate = self.direction[axis];
            if rate == 0.0 {
                halves[axis] = usize::from(self.origin[axis] >= middle[axis]);
                continue;
            }
            let at = (middle[axis] - self.origin[axis]) * self.reciprocal[axis];
            let is_before = at > from;
            halves[axis] = usize::from((rate > 0.0) != is_before);
            next[axis] = if is_before { at } else { f64::INFINITY };
        }
        loop {
            let end = next[0].min(next[1]).min(to);
            let cell = [first[0] + halves[0] * half, first[1] + halves[1] * half];
            let found = if half == 1 {
                self.cell(block, cell, [from, end])
            } else {
                self.cells(block, cell, half, [from, end])
            };
            if found || end >= to {
                return found;
            }
            from = end;
            for axis in 0..2 {
                if next[axis] == end {
                    halves[axis] = 1 - halves[axis];
                    next[axis] = f64::INFINITY;
                }
            }
        }
    }

    /// Looks for the first crossing in a cell.
    #[inline]
    fn cell(&mut self, block: &Block, cell: [usize; 2], part: [f64; 2]) -> bool {
        let [begin, end] = part.map(|t| self.ray.origin.y + self.ray.direction.y * t);
        let [low, high] = block.bounds(cell);
        if begin.min(end) > high || begin.max(end) < low {
            let side = if begin > high { 1.0 } else { -1.0 };
            // Rounding between two cells may hide a crossing from both.
            let crosses = self.side * side < 0.0;
            self.side = side;
            return crosses && self.hits(block, cell, part[0]);
        }
        if block.is_final(cell) {
            return self.patch(block, cell, part, [begin, end]);
        }
        let finer = self.surface.quarter(block, cell);
        let found = self.cells(finer, cell.map(|axis| axis % HALF * 2), 2, part);
        if !found {
            block.narrow(cell, finer);
        }
        found
    }

    /// Looks for the first crossing in a cell that is not divided.
    fn patch(&mut self, block: &Block, cell: [usize; 2], [from, to]: [f64; 2], [begin, end]: [f64; 2]) -> bool {
        let corner = block.corner_of(cell);
        let patch = block.patch(cell);
        let place = |t: f64| (self.origin + self.direction * t - corner) / block.spacing;
        let ground = patch.along(place(from), place(to));
        let above = |k: usize| begin + (end - begin) * (0.25 * k as f64) - ground[k];
        let mut points = [above(0), above(1), above(2), above(3), above(4)];
        if self.side == 0.0 {
            // It leaves the surface on which it begins without a hit.
            let [low, high] = patch.range();
            let size = self.ray.origin.y.abs() + begin.abs() + end.abs() + low.abs() + high.abs();
            let far = (self.origin.abs() + corner.abs()).element_sum() / block.spacing * (high - low);
            let Some(clear) = points.iter().position(|point| point.abs() > ROUNDING * (size + far)) else {
                return false;
            };
            self.side = points[clear].signum();
            points[..clear].fill(0.0);
        }
        let found = first_negative(points.map(|point| point * self.side));
        found.is_some_and(|part| self.hits(block, cell, from + (to - from) * part))
    }

    /// Notes a hit in a cell.
    fn hits(&mut self, block: &Block, cell: [usize; 2], t: f64) -> bool {
        let place = (self.origin + self.direction * t - block.corner_of(cell)) / block.spacing;
        let (_, slope) = block.patch(cell).height_and_slope(place);
        self.hit = Some(TerrainHit { t, point: self.ray.at(t), normal: normal_of(slope / block.spacing) });
        true
    }
}
