//! Surfaces that emit: rectangles, discs and spheres.

use super::LightError;
use super::spherical_rectangle::SphericalRectangle;
use crate::numeric::ray::Ray;
use crate::numeric::sampling::{cap, disk_across, sphere};
use glam::{DVec3, Vec3Swizzles};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Below this solid angle, sr, a rectangle is sampled by its area: sums of its angles have too few digits.
const SMALL: f64 = 1e-6;
/// A point is in a plane if it is no farther from it, in parts of the largest coordinates.
const IN_PLANE: f64 = 1e-14;

/// A surface that emits light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightShape {
    /// A rectangle, or a parallelogram, that emits on the side where its sides turn counter-clockwise.
    Rectangle {
        /// A corner.
        corner: DVec3,
        /// From the corner along one side.
        across: DVec3,
        /// From the corner along another side.
        up: DVec3,
    },
    /// A disc that emits on the side of its normal.
    Disc {
        /// Its middle.
        center: DVec3,
        /// Its normal, any length but 0.
        normal: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// A sphere that emits outwards.
    Sphere {
        /// Its middle.
        center: DVec3,
        /// Its radius.
        radius: f64,
    },
}

/// A point of a light shape, sampled for a point that it lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ShapeSample {
    /// From the lit point towards it, unit length.
    pub(super) towards: DVec3,
    /// From the lit point to it.
    pub(super) distance: f64,
    /// The pdf of the direction, 1/sr.
    pub(super) pdf: f64,
}

impl LightShape {
    /// Words for what it is.
    pub fn words(&self) -> &'static str {
        match self {
            LightShape::Rectangle { .. } => "a rectangular light",
            LightShape::Disc { .. } => "a disc light",
            LightShape::Sphere { .. } => "a spherical light",
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`LightError`], if one is not finite, or if it has no area.
    pub fn check(&self) -> Result<(), LightError> {
        let area = self.area();
        let finite = match *self {
            LightShape::Rectangle { corner, across, up } => corner.is_finite() && across.is_finite() && up.is_finite(),
            LightShape::Disc { center, normal, radius } => {
                if normal.try_normalize().is_none() {
                    return Err(LightError::NoLength { what: "its normal", value: normal });
                }
                center.is_finite() && radius > 0.0
            }
            LightShape::Sphere { center, radius } => center.is_finite() && radius > 0.0,
        };
        match area {
            _ if !finite || !area.is_finite() => Err(LightError::Patch("not finite, or its radius not above 0")),
            0.0 => Err(LightError::Patch("flat: it has no area")),
            _ => Ok(()),
        }
    }

    /// Its area.
    pub fn area(&self) -> f64 {
        match *self {
            LightShape::Rectangle { across, up, .. } => across.cross(up).length(),
            LightShape::Disc { radius, .. } => PI * radius * radius,
            LightShape::Sphere { radius, .. } => 4.0 * PI * radius * radius,
        }
    }

    /// The corners of a box around it.
    pub fn bounds(&self) -> [DVec3; 2] {
        match *self {
            LightShape::Rectangle { corner, across, up } => {
                let corners = [corner, corner + across, corner + up, corner + across + up];
                corners.into_iter().fold([corner; 2], |[low, high], p| [low.min(p), high.max(p)])
            }
            LightShape::Disc { center, radius, .. } | LightShape::Sphere { center, radius } => {
                [center - DVec3::splat(radius), center + DVec3::splat(radius)]
            }
        }
    }

    /// Polygons that stand for it, each counter-clockwise seen from where it emits to.
    ///
    /// - `sides`: of a round one, 3 and more.
    pub fn polygons(&self, sides: usize) -> Vec<Vec<DVec3>> {
        let turn = |k: usize| (TAU * (k % sides) as f64 / sides as f64).sin_cos();
        match *self {
            LightShape::Rectangle { corner, across, up } => {
                vec![vec![corner, corner + across, corner + across + up, corner + up]]
            }
            LightShape::Disc { center, radius, .. } => {
                let normal = self.normal().unwrap_or(DVec3::Y);
                let across = normal.any_orthonormal_vector();
                let up = normal.cross(across);
                let point = |k: usize| center + (across * turn(k).1 + up * turn(k).0) * radius;
                vec![(0..sides).map(point).collect()]
            }
            LightShape::Sphere { center, radius } => {
                let rows = sides.div_ceil(2);
                let point = |row: usize, k: usize| {
                    let (sin, cos) = (PI * row as f64 / rows as f64).sin_cos();
                    let (sin, cos) = if row == rows { (0.0, -1.0) } else { (sin, cos) };
                    center + DVec3::new(sin * turn(k).1, cos, -sin * turn(k).0) * radius
                };
                let cell = |row: usize, k: usize| {
                    let mut corners = vec![point(row, k), point(row + 1, k), point(row + 1, k + 1), point(row, k + 1)];
                    corners.dedup();
                    if corners.first() == corners.last() {
                        corners.pop();
                    }
                    corners
                };
                (0..rows).flat_map(|row| (0..sides).map(move |k| (row, k))).map(|(row, k)| cell(row, k)).collect()
            }
        }
    }

    /// The flat ones' normal.
    fn normal(&self) -> Option<DVec3> {
        match *self {
            LightShape::Rectangle { across, up, .. } => across.cross(up).try_normalize(),
            LightShape::Disc { normal, .. } => normal.try_normalize(),
            LightShape::Sphere { .. } => None,
        }
    }

    /// Whether a point is on the side of a rectangle on which this emits, and not in its plane, as far as coordinates
    /// tell; of other patches, always.
    pub(super) fn is_before(&self, point: DVec3) -> bool {
        match *self {
            LightShape::Rectangle { corner, across, up } => {
                // A point of the rectangle itself would see all of it on one side or the other, by chance.
                let largest = corner.abs().max_element() + point.abs().max_element();
                let normal = across.cross(up);
                (point - corner).dot(normal) > IN_PLANE * largest * normal.length()
            }
            LightShape::Disc { .. } | LightShape::Sphere { .. } => true,
        }
    }

    /// Samples a point that lights a point; none where it does not light it.
    ///
    /// A sphere and a rectangle are sampled evenly by solid angle, a disc by its area.
    pub(super) fn sample(&self, point: DVec3, uniform: [f64; 2]) -> Option<ShapeSample> {
        match *self {
            LightShape::Rectangle { corner, across, up } => {
                let normal = self.normal()?;
                if !self.is_before(point) {
                    return None;
                }
                if let Some(seen) = self.spherical_rectangle(point) {
                    let offset = seen.sample(uniform);
                    let distance = offset.length();
                    let pdf = seen.solid_angle().recip();
                    return (distance > 0.0).then(|| ShapeSample { towards: offset / distance, distance, pdf });
                }
                self.by_area(point, corner + across * uniform[0] + up * uniform[1], normal)
            }
            LightShape::Disc { center, radius, .. } => {
                let normal = self.normal()?;
                self.by_area(point, center + disk_across(normal, uniform) * radius, normal)
            }
            LightShape::Sphere { center, radius } => sample_sphere(center - point, radius, uniform),
        }
    }

    /// A point of it, sampled evenly by area, and its normal if it has one.
    ///
    /// - `middle`: its middle instead.
    pub(super) fn sample_area(&self, uniform: [f64; 2], middle: bool) -> (DVec3, Option<DVec3>) {
        let [u, v] = if middle { [0.5; 2] } else { uniform };
        match *self {
            LightShape::Rectangle { corner, across, up } => (corner + across * u + up * v, self.normal()),
            LightShape::Disc { center, radius, .. } => {
                let normal = self.normal();
                (center + disk_across(normal.unwrap_or(DVec3::Y), [u, v]) * radius, normal)
            }
            LightShape::Sphere { center, .. } if middle => (center, None),
            LightShape::Sphere { center, radius } => {
                // Seen from anywhere, as far from the middle in the mean square as the points of a disc.
                let radius = radius * 0.75f64.sqrt();
                (center + sphere([u, v]).xzy() * radius, None)
            }
        }
    }

    /// The area that is seen of it from straight before it and far away.
    pub(super) fn projected_area(&self) -> f64 {
        match *self {
            LightShape::Sphere { radius, .. } => PI * radius * radius,
            _ => self.area(),
        }
    }

    fn by_area(&self, point: DVec3, at: DVec3, normal: DVec3) -> Option<ShapeSample> {
        let offset = at - point;
        let distance = offset.length();
        let towards = offset / distance;
        let facing = -normal.dot(towards);
        let pdf = distance * distance / (facing * self.area());
        (distance > 0.0 && facing > 0.0 && pdf.is_finite()).then_some(ShapeSample { towards, distance, pdf })
    }

    /// The rectangle as a point sees it, unless it is too small or none.
    fn spherical_rectangle(&self, point: DVec3) -> Option<SphericalRectangle> {
        let LightShape::Rectangle { corner, across, up } = *self else { return None };
        let skew = across.dot(up).abs();
        if skew > 1e-12 * across.length() * up.length() {
            return None;
        }
        SphericalRectangle::new(corner - point, across, up).filter(|seen| seen.solid_angle() > SMALL)
    }

    /// The pdf of a direction by [`LightShape::sample`] in which the shape is hit at a distance, 1/sr.
    pub(super) fn pdf(&self, point: DVec3, towards: DVec3, distance: f64) -> f64 {
        match *self {
            LightShape::Sphere { center, radius } => cap(center - point, radius).map_or(0.0, |cap| (TAU * cap).recip()),
            _ => {
                let Some(normal) = self.normal() else { return 0.0 };
                if let Some(seen) = self.spherical_rectangle(point) {
                    return seen.solid_angle().recip();
                }
                let facing = -normal.dot(towards);
                if facing > 0.0 { distance * distance / (facing * self.area()) } else { 0.0 }
            }
        }
    }

    /// The hit of a ray, in lengths of the direction, and whether it is on the side that emits.
    pub(super) fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<(f64, bool)> {
        let Ray { origin, direction } = *ray;
        let within = |t: &f64| t_min < *t && *t < t_max;
        let plane = |at: DVec3, normal: DVec3| {
            let slope = direction.dot(normal);
            let t = (at - origin).dot(normal) / slope;
            Some((t, slope < 0.0)).filter(|(t, _)| within(t))
        };
        match *self {
            LightShape::Rectangle { corner, across, up } => {
                let normal = across.cross(up);
                let (t, front) = plane(corner, normal)?;
                let offset = origin + direction * t - corner;
                let square = normal.length_squared();
                let (a, b) = (offset.cross(up).dot(normal) / square, across.cross(offset).dot(normal) / square);
                ((0.0..=1.0).contains(&a) && (0.0..=1.0).contains(&b)).then_some((t, front))
            }
            LightShape::Disc { center, normal, radius } => {
                let (t, front) = plane(center, normal)?;
                ((origin + direction * t).distance_squared(center) <= radius * radius).then_some((t, front))
            }
            LightShape::Sphere { center, radius } => {
                // The nearest point of the line to the middle, and half the chord: no digit is lost far away.
                let square = direction.length_squared();
                let offset = center - origin;
                let middle = offset.dot(direction) / square;
                let height = (offset - direction * middle).length_squared();
                let chord = ((radius * radius - height) / square).sqrt();
                [middle - chord, middle + chord].into_iter().find(within).map(|t| (t, t < middle))
            }
        }
    }
}

fn sample_sphere(offset: DVec3, radius: f64, [x, y]: [f64; 2]) -> Option<ShapeSample> {
    let cap = cap(offset, radius)?;
    let far = offset.length();
    let axis = offset / far;
    let height = cap * x;
    let sine = (height * (2.0 - height)).max(0.0).sqrt();
    let (sin, cos) = (TAU * y).sin_cos();
    let (across, up) = axis.any_orthonormal_pair();
    let towards = ((across * cos + up * sin) * sine + axis * (1.0 - height)).normalize();
    let half_chord = (radius * radius - far * far * sine * sine).max(0.0).sqrt();
    Some(ShapeSample { towards, distance: far * (1.0 - height) - half_chord, pdf: (TAU * cap).recip() })
}
