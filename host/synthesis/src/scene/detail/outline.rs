//! Outlines: a few boxes around what was made, by which rays tell that they pass it by.

use crate::numeric::bounds::Bounds;
use crate::octree::RayInterval;
use glam::{DVec3, UVec3};

/// Boxes of an outline, a power of 2.
const BOXES: usize = 16;
/// Their corners are kept in so many steps along each axis.
const STEPS: f64 = 255.0;
/// They are larger than what they hold by this part of the diagonal of all: far more than rounding changes.
const MARGIN: f64 = 1e-6;

/// A few boxes that hold something, in few bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DetailOutline {
    /// The least corner of all.
    low: DVec3,
    /// A step along each axis.
    step: DVec3,
    /// The least and the greatest corner of each in steps; those after the last one are equal to it.
    boxes: [[[u8; 3]; 2]; BOXES],
    /// Whether there is nothing.
    is_empty: bool,
}

impl DetailOutline {
    /// One around boxes.
    pub(super) fn around(boxes: &mut [Bounds]) -> DetailOutline {
        let all = boxes.iter().fold(Bounds::EMPTY, |all, one| all.union(*one));
        let margin = all.diagonal() * MARGIN;
        let (low, step) = (all.min - margin, (all.size() + 2.0 * margin) / STEPS);
        let mut outline = DetailOutline { low, step, boxes: [[[0; 3]; 2]; BOXES], is_empty: boxes.is_empty() };
        outline.divide(boxes, margin, 0, BOXES);
        outline
    }

    /// Fills so many places from `first` on, a power of 2, with boxes around those boxes.
    fn divide(&mut self, boxes: &mut [Bounds], margin: f64, first: usize, count: usize) {
        if count == 1 || boxes.len() <= 1 {
            let around = boxes.iter().fold(Bounds::EMPTY, |all, one| all.union(*one));
            // Rounded outwards; what is not finite becomes as large as can be.
            let steps = |at: DVec3, round: fn(f64) -> f64| {
                ((at - self.low) / self.step).to_array().map(|at| round(at).clamp(0.0, STEPS) as u8)
            };
            let corners = [steps(around.min - margin, f64::floor), steps(around.max + margin, f64::ceil)];
            self.boxes[first..first + count].fill(corners);
            return;
        }
        let middle = |one: &Bounds| one.min + one.max;
        let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let [low, high] =
            boxes.iter().map(middle).fold(none, |[low, high], middle| [low.min(middle), high.max(middle)]);
        let axis = (high - low).max_position();
        let half = boxes.len() / 2;
        boxes.select_nth_unstable_by(half, |a, b| middle(a)[axis].total_cmp(&middle(b)[axis]));
        let (below, above) = boxes.split_at_mut(half);
        self.divide(below, margin, first, count / 2);
        self.divide(above, margin, first + count / 2, count / 2);
    }

    /// Whether a ray comes to one of the boxes.
    pub(super) fn is_met(&self, along: &RayInterval<'_>) -> bool {
        let corner = |steps: [u8; 3]| self.low + self.step * UVec3::from(steps.map(u32::from)).as_dvec3();
        let meets = |[low, high]: &[[u8; 3]; 2]| {
            let bounds = Bounds { min: corner(*low), max: corner(*high) };
            along.ray.within(&bounds, along.between).is_some()
        };
        !self.is_empty && self.boxes.iter().any(meets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::ray::Ray;
    use crate::numeric::sampling::{RandomStream, sphere};

    #[test]
    fn each_ray_that_meets_a_box_meets_the_outline_and_most_others_do_not() {
        let mut random = RandomStream::new(3, 5);
        // Small boxes along two edges of a cube.
        let mut boxes: Vec<Bounds> = (0..200)
            .map(|n| {
                let along = random.uniform();
                let min = if n % 2 == 0 { DVec3::new(along, 0.0, 0.0) } else { DVec3::new(1.0, along, 1.0) };
                Bounds { min, max: min + 0.02 }
            })
            .collect();
        let all = boxes.iter().fold(Bounds::EMPTY, |all, one| all.union(*one));
        let outline = DetailOutline::around(&mut boxes);
        let (mut met, mut near) = (0, 0);
        for _ in 0..20_000 {
            let from = DVec3::from_array([(); 3].map(|()| 3.0 * random.uniform() - 1.0));
            let ray = Ray { origin: from, direction: sphere(random.point()) };
            let along = RayInterval { ray: &ray, between: [0.0, f64::INFINITY] };
            let is_hit = boxes.iter().any(|one| ray.within(one, along.between).is_some());
            assert!(!is_hit || outline.is_met(&along));
            met += usize::from(outline.is_met(&along));
            near += usize::from(ray.within(&all, along.between).is_some());
        }
        assert!(met > 30 && met * 4 < near, "{met} of {near}");
        let nothing = RayInterval { ray: &Ray { origin: DVec3::ZERO, direction: DVec3::X }, between: [0.0, 9.0] };
        assert!(!DetailOutline::around(&mut []).is_met(&nothing));
    }
}
