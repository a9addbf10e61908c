//! Rays and where they hit.

use super::bounds::Bounds;
use glam::DVec3;

/// A half line; its points are `origin + t direction` for `t >= 0`.
///
/// The direction need not have unit length, but must be finite and not zero; `t` counts in its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point where the ray begins.
    pub origin: DVec3,
    /// The direction of the ray, of any length.
    pub direction: DVec3,
}

impl Ray {
    /// The point at parameter `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// The part of a range of `t` in which the ray is in a box; none if it is in it nowhere there, or without end.
    pub fn within(&self, bounds: &Bounds, [mut from, mut to]: [f64; 2]) -> Option<[f64; 2]> {
        for axis in 0..3 {
            let (low, high) = (bounds.min[axis] - self.origin[axis], bounds.max[axis] - self.origin[axis]);
            let rate = self.direction[axis];
            if rate == 0.0 {
                // A quotient would be no number on a side of the box.
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (one, other) = (low / rate, high / rate);
            (from, to) = (from.max(one.min(other)), to.min(one.max(other)));
        }
        (from <= to && from.is_finite() && to.is_finite()).then_some([from, to])
    }
}

/// A hit of a ray on a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Parameter along the ray.
    pub t: f64,
    /// Index of the triangle.
    pub triangle: u32,
    /// Barycentric weight of the second corner, 0..=1.
    pub u: f64,
    /// Barycentric weight of the third corner, 0..=1; the first has `1 - u - v`.
    pub v: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_is_in_a_box_between_its_sides() {
        let bounds = Bounds { min: DVec3::ZERO, max: DVec3::new(1.0, 2.0, 3.0) };
        let ray = |origin: [f64; 3], direction: [f64; 3]| Ray { origin: origin.into(), direction: direction.into() };
        let all = [0.0, f64::INFINITY];
        assert_eq!(ray([0.5, 1.0, -2.0], [0.0, 0.0, 2.0]).within(&bounds, all), Some([1.0, 2.5]));
        assert_eq!(ray([0.5, 1.0, 1.0], [0.0, -1.0, 0.0]).within(&bounds, [0.25, 0.5]), Some([0.25, 0.5]));
        assert_eq!(ray([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]).within(&bounds, all), Some([1.0, 4.0]));
        assert_eq!(ray([2.0, 1.0, 1.0], [0.0, 1.0, 0.0]).within(&bounds, all), None);
        assert_eq!(ray([2.0, 1.0, 1.0], [1.0, 0.0, 0.0]).within(&bounds, all), None);
        assert_eq!(ray([0.5, 1.0, 1.0], [0.0, 0.0, 0.0]).within(&bounds, all), None);
        assert_eq!(ray([0.5, 1.0, 1.0], [1.0, 0.0, 0.0]).within(&Bounds::EMPTY, all), None);
        assert_eq!(ray([f64::NAN, 1.0, 1.0], [1.0, 0.0, 0.0]).within(&bounds, [0.0, f64::INFINITY]), None);
    }
}
