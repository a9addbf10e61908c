//! The surface element at a hit: position, normals, and where rays may leave from.

use super::carrier::Carrier;
use crate::numeric::ray::{Hit, Ray};
use crate::scene::{Contents, SurfacePoint};
use glam::DVec3;

/// Rounding errors in units of the last place of the triangle's largest coordinate that a leaving ray keeps clear of.
///
/// A hit point in barycentric coordinates is off its plane by at most 5 of them (three products, two sums, and a
/// third weight that is itself rounded), and the intersection of the leaving ray with the same plane errs by about as
/// much again. The rest is safety: one part in 10^14 of the coordinate.
const CLEARANCE_ULPS: f64 = 32.0;

/// The surface element where a ray hits: position, normals, and origins of further rays.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct SurfaceElement {
    /// On the triangle, with the rounding errors of its coordinates, or on the exact surface behind it.
    pub(in crate::render) position: DVec3,
    /// Unit normal of the triangle, on the side of the viewer.
    pub(in crate::render) face: DVec3,
    /// Unit normal for shading, on the side of the viewer.
    pub(in crate::render) normal: DVec3,
    /// Unit normal of what rays leave on the side of the viewer: of the triangle, or of the exact surface before it.
    pub(in crate::render) horizon: DVec3,
    /// Whether the viewer is on the outer side of the triangle.
    pub(in crate::render) outside: bool,
    /// Origin of a ray that leaves on the side of the viewer: on the triangle, or on the exact surface before it.
    pub(in crate::render) leave: DVec3,
    /// Origin of a ray that goes through: always on the triangle.
    pub(in crate::render) through: DVec3,
    /// Origin of a ray towards a light: on the curved surface that the triangle stands for, if it bulges out.
    pub(in crate::render) leave_curved: DVec3,
    /// How far from the triangle rays begin that leave it or go through, scene units.
    pub(in crate::render) clearance: f64,
}

impl SurfaceElement {
    /// The element at `hit`; `curved` asks for interpolated normals. None for a triangle without area.
    pub(in crate::render) fn new(
        contents: &Contents,
        triangle: u32,
        ray: &Ray,
        hit: &Hit,
        curved: bool,
    ) -> Option<SurfaceElement> {
        let corners = contents.corners(triangle);
        let [a, b, c] = corners;
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
        let position = a * weights[0] + b * weights[1] + c * weights[2];
        let outside = (b - a).cross(c - a).try_normalize().or_else(|| scaled_normal(corners))?;
        let flat = SurfaceElement::smooth(position, outside, ray.direction, clearance(corners));
        let (face, side) = (flat.face, if flat.outside { 1.0 } else { -1.0 });
        let corner_normals = if curved { contents.corner_normals(triangle) } else { None };
        let Some(corner_normals) = corner_normals else { return Some(flat) };
        let normals = corner_normals.map(|n| {
            let n = n.as_dvec3() * side;
            if n == DVec3::ZERO { face } else { n }
        });
        let sum = normals[0] * weights[0] + normals[1] * weights[1] + normals[2] * weights[2];
        let Some(normal) = sum.try_normalize() else { return Some(flat) };
        let normal = towards_viewer(normal, -ray.direction);
        Some(SurfaceElement {
            normal,
            leave_curved: bulge(position, corners, normals, weights) + face * flat.clearance,
            ..flat
        })
    }

    /// The element of a surface whose normal is known, for shading too.
    ///
    /// - `outside`: its outer unit normal. `clearance`: how far from it rays begin that leave it, scene units.
    pub(super) fn smooth(position: DVec3, outside: DVec3, direction: DVec3, clearance: f64) -> SurfaceElement {
        let side = if outside.dot(direction) > 0.0 { -1.0 } else { 1.0 };
        let face = outside * side;
        let leave = position + face * clearance;
        SurfaceElement {
            position,
            face,
            normal: face,
            horizon: face,
            outside: side > 0.0,
            leave,
            through: position - face * clearance,
            leave_curved: leave,
            clearance,
        }
    }

    /// Moves it along the ray to the exact surface. Whether it did: not to where the ray is not yet, which begins
    /// `before` the triangle.
    ///
    /// A surface before the triangle is on a part of the ray that hits nothing: rays may leave from there, and whatever
    /// bulges as it does, does not occlude them. Behind the triangle they would begin below other triangles, and from
    /// there they continue from the triangle.
    ///
    /// - `before`: in lengths of the direction.
    pub(in crate::render) fn settle(&mut self, direction: DVec3, before: f64, on: &SurfacePoint) -> bool {
        if on.beyond <= -before {
            return false;
        }
        let way = direction * on.beyond;
        self.position += way;
        self.normal = on.normal;
        self.leave_curved = self.leave;
        if on.beyond < 0.0 {
            (self.leave, self.leave_curved) = (self.leave + way, self.leave + way);
            self.horizon = on.normal;
        }
        true
    }

    /// Takes it to where what it belongs to is.
    pub(in crate::render) fn carry(&mut self, carrier: &Carrier) {
        let height = carrier.height(self.face);
        for point in [&mut self.position, &mut self.leave, &mut self.through, &mut self.leave_curved] {
            *point = carrier.point(*point);
        }
        for normal in [&mut self.face, &mut self.normal, &mut self.horizon] {
            *normal = carrier.normal(*normal);
        }
        // There and back, points are rounded again.
        let distance = CLEARANCE_ULPS * f64::EPSILON * carrier.largest_at(self.position);
        let clearance = self.face * distance;
        self.leave += clearance;
        self.leave_curved += clearance;
        self.through -= clearance;
        self.clearance = self.clearance * height + distance;
    }

    /// Gives it another normal for shading.
    ///
    /// - `view`: towards the viewer. `tilted`: from a normal outwards to another.
    pub(in crate::render) fn tilt(&mut self, view: DVec3, tilted: impl FnOnce(DVec3) -> DVec3) {
        let side = if self.outside { 1.0 } else { -1.0 };
        self.normal = towards_viewer(tilted(self.normal * side) * side, view);
    }

    /// A direction that the shading normal sends to the wrong side, at the plane of the triangle or its surface.
    ///
    /// Where it just grazes the plane, both agree.
    ///
    /// - `above`: whether it should be on the side of the viewer.
    pub(in crate::render) fn righted(&self, direction: DVec3, above: bool) -> DVec3 {
        let plane = self.plane(above);
        let height = direction.dot(plane);
        if (height < 0.0) == above { direction - plane * (2.0 * height) } else { direction }
    }

    /// The normal of the plane that bounds the directions in which rays leave.
    pub(in crate::render) fn plane(&self, above: bool) -> DVec3 {
        if above { self.horizon } else { self.face }
    }
}

/// How far from a triangle rays begin that leave it or go through, scene units.
pub(in crate::render) fn clearance(corners: [DVec3; 3]) -> f64 {
    let largest = corners.iter().fold(0.0f64, |most, corner| most.max(corner.abs().max_element()));
    rounding_at(largest)
}

/// How far rays begin from a surface whose coordinates are not above one, scene units.
pub(super) fn rounding_at(largest: f64) -> f64 {
    (CLEARANCE_ULPS * f64::EPSILON * largest).max(f64::MIN_POSITIVE)
}

/// The normal of a triangle whose sides are too short to be multiplied.
fn scaled_normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let longest = (b - a).abs().max_element().max((c - a).abs().max_element());
    let scale = 1.0 / longest;
    (longest > 0.0 && scale.is_finite()).then(|| ((b - a) * scale).cross((c - a) * scale).try_normalize()).flatten()
}

/// Turns a normal that an interpolation has carried past the outline back to the viewer.
fn towards_viewer(normal: DVec3, view: DVec3) -> DVec3 {
    let cosine = normal.dot(view);
    if cosine >= 0.0 { normal } else { normal - view * (2.0 * cosine / view.length_squared()) }
}

/// The point of a smooth surface through the corners, over a point of the triangle.
///
/// P' = P + sum of w_i max(0, (V_i - P)·n_i) n_i: each corner's tangent plane lifts the point by its weight, so that
/// it lies above a triangle of an outward bulging surface and never below. A ray towards a light then does not
/// strike the neighbouring triangles of a surface that is convex in truth.
///
/// # Source
/// Hanika 2021, hacking the shadow terminator.
fn bulge(p: DVec3, corners: [DVec3; 3], normals: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    let lift = |i: usize| normals[i] * ((corners[i] - p).dot(normals[i]).max(0.0) * weights[i]);
    p + lift(0) + lift(1) + lift(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_of_an_inscribed_chord_is_lifted_towards_the_sphere() {
        let corners = [DVec3::X, DVec3::Y, DVec3::Z];
        let third = [1.0 / 3.0; 3];
        let p = DVec3::splat(1.0 / 3.0);
        let lifted = bulge(p, corners, corners, third);
        assert!(lifted.length() > p.length() && lifted.length() < 1.0);
        assert_eq!(bulge(DVec3::X, corners, corners, [1.0, 0.0, 0.0]), DVec3::X, "corners stay");
        let flat = [DVec3::splat(3f64.sqrt().recip()); 3];
        assert!((bulge(p, corners, flat, third) - p).length() < 1e-15, "plane faces stay");
    }

    #[test]
    fn a_reflected_ray_never_goes_below_the_triangle() {
        let face = DVec3::Y;
        for tilt in [-0.6f64, -0.2, 0.0, 0.2, 0.6] {
            let normal = DVec3::new(tilt.sin(), tilt.cos(), 0.0);
            let zero = DVec3::ZERO;
            let element = SurfaceElement {
                position: zero,
                face,
                normal,
                horizon: face,
                outside: true,
                leave: face,
                through: zero,
                leave_curved: face,
                clearance: 0.0,
            };
            for angle in [0.1f64, 0.5, 1.0, 1.5] {
                let direction = DVec3::new(angle.cos(), -angle.sin(), 0.0);
                let out = element.righted(direction - normal * (2.0 * direction.dot(normal)), true);
                assert!(out.y >= -1e-15 && (out.length() - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_normal_is_turned_to_the_viewer_and_keeps_its_length() {
        let view = DVec3::new(0.0, 0.0, 3.0);
        let turned = towards_viewer(DVec3::new(0.8, 0.0, -0.6), view);
        assert!((turned - DVec3::new(0.8, 0.0, 0.6)).length() < 1e-15);
    }
}
