//! What stands on a plane, in the way of light along it.

use crate::numeric::bounds::Bounds;
use glam::{DVec2, DVec3, Vec2};

/// Walls are longer by this part of the disc at both ends, so that rounding leaves no gap where two of them meet.
const OVERLAP: f64 = 1e-6;

/// A disc on a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flat {
    middle: DVec3,
    normal: DVec3,
    /// Of the plane, unit length.
    pub(super) axes: [DVec3; 2],
    radius: f64,
}

/// A segment that hides what is behind it from the middle of the disc, which has radius 1 here.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wall {
    /// The middle is on the left of the way from one to the other.
    ends: [Vec2; 2],
}

impl Flat {
    /// - `normal`: unit length. `radius`: scene units.
    pub(super) fn new(middle: DVec3, normal: DVec3, radius: f64) -> Flat {
        let (x, y) = normal.any_orthonormal_pair();
        Flat { middle, normal, axes: [x, y], radius }
    }

    /// What the disc reaches to.
    pub(super) fn bounds(&self) -> Bounds {
        let [x, y] = self.axes.map(|axis| axis * axis);
        let reach = (x + y).map(f64::sqrt) * self.radius;
        Bounds { min: self.middle - reach, max: self.middle + reach }
    }

    /// Where a triangle cuts the disc; none if it does not, or only touches it from below.
    pub(super) fn cut(&self, corners: [DVec3; 3]) -> Option<Wall> {
        let offsets = corners.map(|corner| corner - self.middle);
        let heights = offsets.map(|offset| offset.dot(self.normal));
        let is_above = heights.map(|height| height > 0.0);
        let mut ends = [DVec2::ZERO; 2];
        let mut found = 0;
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            if is_above[i] == is_above[j] {
                continue;
            }
            // From below, whichever triangle the edge belongs to.
            let (i, j) = if is_above[i] { (j, i) } else { (i, j) };
            let at = offsets[i].lerp(offsets[j], heights[i] / (heights[i] - heights[j]));
            ends[found] = DVec2::new(at.dot(self.axes[0]), at.dot(self.axes[1])) / self.radius;
            found += 1;
        }
        if found < 2 {
            return None;
        }
        let [a, b] = ends;
        let way = b - a;
        let nearest = a + way * (-a.dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        if nearest.length_squared() >= 1.0 {
            return None;
        }
        let over = way.normalize_or_zero() * OVERLAP;
        let ends = [a - over, b + over].map(|end| end.as_vec2());
        Some(Wall { ends: if a.perp_dot(b) < 0.0 { [ends[1], ends[0]] } else { ends } })
    }
}

impl Wall {
    /// Whether it stands between the middle and a place.
    #[inline]
    pub(super) fn hides(&self, place: Vec2) -> bool {
        let [a, b] = self.ends;
        a.perp_dot(place) >= 0.0 && place.perp_dot(b) >= 0.0 && (b - a).perp_dot(place - a) <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sampling::Stream;

    #[test]
    fn what_a_wall_hides_is_what_rays_along_the_plane_do_not_reach() {
        let mut stream = Stream::new(9, 1);
        let mut coordinate = move || 2.0 * stream.uniform() - 1.0;
        let mut hidden = 0;
        for _ in 0..20_000 {
            let mut vector = || DVec3::new(coordinate(), coordinate(), coordinate());
            let (middle, normal, corners) = (vector(), vector().normalize(), [vector(), vector(), vector()]);
            let flat = Flat::new(middle, normal, 0.8);
            let wall = flat.cut(corners);
            let at = DVec2::new(coordinate(), coordinate()) * 0.7;
            let end = middle + (flat.axes[0] * at.x + flat.axes[1] * at.y) * 0.8;
            // By signs of volumes: the ends are on both sides of the triangle, and the way goes through it.
            let volume = |a: DVec3, b: DVec3, c: DVec3, d: DVec3| (b - a).cross(c - a).dot(d - a);
            let [a, b, c] = corners;
            let (s, t) = (volume(a, b, c, middle), volume(a, b, c, end));
            let round = [(a, b), (b, c), (c, a)].map(|(p, q)| volume(middle, end, p, q));
            let clear = [s, t].iter().chain(&round).all(|v| v.abs() > 1e-4);
            let crosses = s * t < 0.0 && (round.iter().all(|v| *v > 0.0) || round.iter().all(|v| *v < 0.0));
            if clear {
                assert_eq!(wall.is_some_and(|wall| wall.hides(at.as_vec2())), crosses);
                hidden += u32::from(crosses);
            }
        }
        assert!(hidden > 100);
    }

    #[test]
    fn nothing_is_seen_between_two_walls_that_meet() {
        let flat = Flat::new(DVec3::new(3.0, -7.0, 1e-9), DVec3::Z, 2.0);
        let corner = |x: f64, z: f64| DVec3::new(3.0 + x, -6.0, z);
        // One face of a box, its diagonal from below to above.
        let walls = [
            [corner(-1.0, 0.0), corner(1.0, 0.0), corner(1.0, 2.0)],
            [corner(-1.0, 0.0), corner(1.0, 2.0), corner(-1.0, 2.0)],
        ];
        let walls: Vec<Wall> = walls.into_iter().filter_map(|corners| flat.cut(corners)).collect();
        assert_eq!(walls.len(), 2);
        for i in 0..10_000 {
            let x = (i as f32 / 5000.0 - 1.0) * 0.999;
            assert!(walls.iter().any(|wall| wall.hides(Vec2::new(0.5 * x, 0.55))), "{x}");
        }
    }

    #[test]
    fn what_touches_the_plane_from_below_or_is_far_is_no_wall() {
        let flat = Flat::new(DVec3::ZERO, DVec3::Z, 1.0);
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        assert!(flat.cut([at(-1.0, 0.5, 0.0), at(1.0, 0.5, 0.0), at(0.0, 0.5, -1.0)]).is_none());
        assert!(flat.cut([at(-1.0, 0.5, 0.0), at(1.0, 0.5, 0.0), at(0.0, 0.5, 1.0)]).is_some());
        assert!(flat.cut([at(-1.0, 1.5, 0.0), at(1.0, 1.5, 0.0), at(0.0, 1.5, 1.0)]).is_none());
        assert!(flat.cut([at(0.0, 0.5, 1.0); 3]).is_none());
    }
}
