//! Openings: rectangles through which light comes into rooms.

use super::form_factor::Convex;
use crate::illumination::light::LightShape;
use crate::numeric::ray::Ray;
use glam::DVec3;

/// A parallelogram through which light goes both ways.
#[derive(Clone, Copy, Debug)]
pub(super) struct Opening {
    corner: DVec3,
    across: DVec3,
    up: DVec3,
    /// Unit length.
    pub(super) normal: DVec3,
    pub(super) area: f64,
}

/// Patches of the reveal of an opening are no wider than it and no farther from it than so many times as much.
const REVEAL: f64 = 8.0;
/// The finest elements of a reveal, as a part of the shorter side of the opening.
const FINEST: f64 = 1.0 / 8.0;
/// How much wider than the opening a patch may be by rounding.
const ROUNDING: f64 = 1e-6;

impl Opening {
    fn of(shape: &LightShape) -> Option<Opening> {
        let LightShape::Rectangle { corner, across, up } = *shape else { return None };
        let cross = across.cross(up);
        Some(Opening { corner, across, up, normal: cross.try_normalize()?, area: cross.length() })
    }

    /// A point of it.
    ///
    /// - `uniform`: a point of the unit square.
    pub(super) fn point(&self, [u, v]: [f64; 2]) -> DVec3 {
        self.corner + self.across * u + self.up * v
    }

    pub(super) fn corner(&self) -> DVec3 {
        self.corner
    }

    pub(super) fn polygon(&self) -> Convex {
        Convex::new(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|uniform| self.point(uniform)))
    }

    /// The middles of its parts, if each side is divided into so many.
    pub(super) fn grid(&self, side: u32) -> impl Iterator<Item = DVec3> {
        let middle = move |i: u32| (f64::from(i) + 0.5) / f64::from(side);
        (0..side * side).map(move |i| self.point([middle(i % side), middle(i / side)]))
    }

    /// Whether a triangle is part of its reveal: the sides of the hole in the wall.
    fn has_in_reveal(&self, corners: [DVec3; 3]) -> bool {
        let side = self.shorter_side();
        let middle = self.corner + 0.5 * (self.across + self.up);
        let [a, b, c] = corners;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let width = (b - a).cross(c - a).length() / longest;
        let reach = REVEAL * side + 0.5 * self.across.length().max(self.up.length());
        width <= side * (1.0 + ROUNDING) && corners.iter().any(|corner| corner.distance(middle) <= reach)
    }

    fn shorter_side(&self) -> f64 {
        self.across.length().min(self.up.length())
    }

    /// Whether a ray crosses it before a parameter.
    fn is_crossed(&self, ray: &Ray, t_max: f64) -> bool {
        let height = (self.corner - ray.origin).dot(self.normal);
        let t = height / ray.direction.dot(self.normal);
        if !(t > 0.0 && t < t_max) {
            return false;
        }
        let offset = ray.origin + ray.direction * t - self.corner;
        // Coordinates along the sides, by the sides' duals.
        let cross = self.across.cross(self.up);
        let square = cross.length_squared();
        let u = offset.cross(self.up).dot(cross) / square;
        let v = self.across.cross(offset).dot(cross) / square;
        (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)
    }
}

/// The openings of a scene.
pub(super) struct Openings(pub(super) Vec<Opening>);

impl Openings {
    pub(super) fn new(rectangles: &[LightShape]) -> Openings {
        Openings(rectangles.iter().filter_map(Opening::of).collect())
    }

    /// The length of the finest elements that a triangle needs: short in a reveal, where light changes within the width
    /// of the opening; elsewhere infinite.
    pub(super) fn finest_of(&self, corners: [DVec3; 3]) -> f64 {
        let of_reveals = self.0.iter().filter(|opening| opening.has_in_reveal(corners));
        of_reveals.map(|opening| FINEST * opening.shorter_side()).fold(f64::INFINITY, f64::min)
    }

    /// Whether a ray crosses one before a parameter.
    pub(super) fn are_crossed(&self, ray: &Ray, t_max: f64) -> bool {
        self.0.iter().any(|opening| opening.is_crossed(ray, t_max))
    }

    /// How many are crossed beside one.
    pub(super) fn others_crossed(&self, number: usize, ray: &Ray, t_max: f64) -> usize {
        let is_crossed = |(other, opening): &(usize, &Opening)| *other != number && opening.is_crossed(ray, t_max);
        self.0.iter().enumerate().filter(is_crossed).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_cross_a_slanted_opening_within_its_sides_and_before_their_ends_only() {
        let (across, up) = (DVec3::new(2.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0));
        let openings = Openings::new(&[LightShape::Rectangle { corner: DVec3::ZERO, across, up }]);
        let opening = openings.0[0];
        for (uniform, is_within) in [([0.1, 0.9], true), ([0.9, 0.1], true), ([1.1, 0.5], false), ([0.5, -0.1], false)]
        {
            for offset in [DVec3::new(0.3, -0.2, 1.0), DVec3::new(-2.0, 1.0, -0.5)] {
                let ray = Ray { origin: opening.point(uniform) + offset, direction: -offset };
                assert_eq!(openings.are_crossed(&ray, 1.5), is_within, "{uniform:?} {offset}");
                assert!(!openings.are_crossed(&ray, 0.9), "{uniform:?} {offset}");
                assert_eq!(openings.others_crossed(0, &ray, 1.5), 0);
            }
        }
        let along = Ray { origin: DVec3::new(-1.0, 0.5, 0.0), direction: DVec3::X };
        assert!(!openings.are_crossed(&along, f64::INFINITY));
    }
}
