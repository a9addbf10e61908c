//! Planes through three points, for many tests on which side of them points lie.

use super::implicit::side;
use glam::DVec3;

/// A plane through three given points, with its normal as far as roundings let it be known.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// The points.
    pub corners: [DVec3; 3],
    /// Twice the area vector of the triangle between them, rounded.
    pub normal: DVec3,
    /// The rounding scale of each coordinate of the normal: the sum of the sizes of the two products whose difference
    /// it is.
    sizes: DVec3,
    /// The axis that it is square to, if roundings leave no doubt of its normal.
    level: Option<usize>,
}

impl Plane {
    /// The plane through three points. Where they are on one line, all points lie on it.
    pub fn through([a, b, c]: [DVec3; 3]) -> Plane {
        let (d, e) = (b - a, c - a);
        let (plus, minus) = (DVec3::new(d.y * e.z, d.z * e.x, d.x * e.y), DVec3::new(d.z * e.y, d.x * e.z, d.y * e.x));
        let (normal, sizes) = (plus - minus, plus.abs() + minus.abs());
        let is_level = |&axis: &usize| {
            d[axis] == 0.0 && e[axis] == 0.0 && normal[axis].abs() > sizes[axis] * (4.0 * f64::EPSILON) + 1e-300
        };
        Plane { corners: [a, b, c], normal, sizes, level: (0..3).find(is_level) }
    }

    /// On which side a point lies, as [`side`] tells; `None` where roundings leave a doubt.
    #[inline]
    pub fn rounded_side(&self, point: DVec3) -> Option<f64> {
        let offset = point - self.corners[0];
        if let Some(axis) = self.level {
            // The sign of a difference is never wrong.
            let sign = if offset[axis] == 0.0 { 0.0 } else { offset[axis].signum() };
            return Some(-sign * self.normal[axis].signum());
        }
        let height = self.normal.dot(offset);
        let size = offset.abs();
        // Each product has the roundings of four differences and two products; the sums have five.
        let doubt = self.sizes.dot(size) * (8.0 * f64::EPSILON) + (size.element_sum() + 1.0) * 1e-300;
        let is_clear = height.abs() > doubt;
        is_clear.then(|| -height.signum())
    }

    /// Direction in which the points turn, seen along an axis with the other two in cyclic order: 1.0
    /// counter-clockwise, -1.0 clockwise, 0.0 where roundings leave a doubt.
    #[inline]
    pub fn facing(&self, axis: usize) -> f64 {
        let is_clear = self.normal[axis].abs() > self.sizes[axis] * (4.0 * f64::EPSILON) + 1e-300;
        if is_clear { self.normal[axis].signum() } else { 0.0 }
    }

    /// On which side a point lies, exactly, as [`side`] tells.
    pub fn side(&self, point: DVec3) -> f64 {
        let [a, b, c] = self.corners;
        self.rounded_side(point).unwrap_or_else(|| side(a, b, c, point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn sides_are_those_of_the_exact_determinant() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
        let mut clear = 0;
        for scale in [1.0, 1e-160, 1e160, 1e-50, 1e7] {
            for _ in 0..2000 {
                let mut point = |size: f64| DVec3::from([0; 3].map(|_| random.random_range(-1.0..1.0))) * size;
                let corners = [0; 3].map(|_| point(scale));
                let plane = Plane::through(corners);
                let [a, b, c] = corners;
                let on = a + (b - a) * 0.3 + (c - a) * 0.6;
                let near = on + point(scale * 1e-15);
                for p in [point(scale), on, near, a, (b + c) * 0.5, point(1.0)] {
                    clear += u32::from(plane.rounded_side(p).is_some());
                    // Determinants of the scale of 1e-480 are nothing in floating point.
                    if scale > 1e-100 && scale < 1e100 {
                        assert_eq!(plane.side(p), side(a, b, c, p), "{corners:?} {p}");
                    } else if plane.rounded_side(p).is_some() {
                        let [a, b, c, p] = [a, b, c, p].map(|p| p / scale);
                        assert!(!p.is_finite() || plane.rounded_side(p * scale) == Some(side(a, b, c, p)));
                    }
                }
            }
        }
        assert!(clear > 12_000, "{clear}");
        let level = Plane::through([DVec3::new(0.1, 0.3, 0.7), DVec3::new(0.2, 0.3, 0.1), DVec3::new(0.9, 0.3, 0.2)]);
        for point in [0.3, 0.1 + 0.2, 0.29].map(|y| DVec3::new(0.4, y, 7.0)) {
            let [a, b, c] = level.corners;
            assert_eq!(level.rounded_side(point), Some(side(a, b, c, point)));
        }
        let flat = Plane::through([DVec3::ZERO, DVec3::ONE, DVec3::splat(3.0)]);
        assert_eq!([flat.rounded_side(DVec3::X), flat.rounded_side(DVec3::splat(f64::MAX))], [None, None]);
    }
}
