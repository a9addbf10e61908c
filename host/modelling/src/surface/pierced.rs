//! Where a line goes through a surface, near a guess.

use glam::{DVec2, DVec3};

use super::Surface;

/// Steps at most; from a triangle of the surface three are usual.
const MAX_STEPS: usize = 12;
/// A step that is this part of the reach is the last: the next would be its square.
const LAST: f64 = 1e-6;
/// Sine of the angle of the derivatives below which they span no plane, as at a pole.
const SPANNING: f64 = 1e-10;
/// Sine of the angle of the derivatives below which they do not tell a normal of at least twelve digits.
const CLEAR: f64 = 1e-3;

/// Where a line goes through a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PiercingPoint {
    /// The parameters, within the domain.
    pub uv: DVec2,
    /// The outward unit normal.
    pub normal: DVec3,
    /// How far along the line, in lengths of its direction; may be negative.
    pub t: f64,
}

/// A line through a point near a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PiercingLine {
    /// The point.
    pub from: DVec3,
    /// Any length but 0.
    pub direction: DVec3,
    /// Whether it comes from the inside of the surface: its direction is on the side of the normal.
    pub outward: bool,
}

/// Where a line goes through `surface`, near the parameters `guess`. Beyond a border the tangent plane at the border
/// goes on.
///
/// None where the steps do not converge within `reach`, model units, of the point of the line, neither from the guess
/// nor from half the reach further out: where the line passes by the surface or grazes it.
///
/// # Source
/// Newton's method, as for patches in Toth 1985, "On ray tracing parametric surfaces": each step meets the tangent
/// plane. Ours: that borders hold, and that poles and seams are left by way of the nearest point.
pub fn pierced<S: Surface + ?Sized>(
    surface: &S,
    line: &PiercingLine,
    guess: DVec2,
    reach: f64,
) -> Option<PiercingPoint> {
    let [low, high] = surface.domain();
    let guess = guess.clamp(low, high);
    newton(surface, line, guess, reach).or_else(|| {
        // Close to an outline, steps from within may find the other end of a chord.
        let way = if line.outward { 0.5 } else { -0.5 } * reach / line.direction.length();
        newton(surface, line, surface.nearest(line.from + line.direction * way, guess), reach)
    })
}

fn newton<S: Surface + ?Sized>(surface: &S, line: &PiercingLine, mut uv: DVec2, reach: f64) -> Option<PiercingPoint> {
    let PiercingLine { from, direction, outward } = *line;
    let domain = surface.domain();
    for _ in 0..MAX_STEPS {
        let [point, du, dv] = surface.point_and_derivatives(uv);
        let across = du.cross(dv);
        let spans = across.length_squared() > SPANNING * SPANNING * du.length_squared() * dv.length_squared();
        let plane = if spans { across } else { surface.normal(uv) };
        let t = (point - from).dot(plane) / direction.dot(plane);
        // Not so for what is no number, either.
        let is_near = (t * direction).length() <= reach;
        if !is_near {
            return None;
        }
        let at = from + direction * t;
        let offset = at - point;
        let next = if spans { clamped_step([du, dv], across, offset, uv, domain) } else { surface.nearest(at, uv) };
        let step = du * (next.x - uv.x) + dv * (next.y - uv.y);
        let is_last = step.length() <= LAST * reach;
        uv = next;
        if is_last && offset.length() > LAST * reach {
            // At a border, or before a seam or pole beyond which the surface goes on.
            let other = surface.nearest(at, uv);
            if surface.point(other).distance(at) < 0.5 * offset.length() {
                uv = other;
                continue;
            }
        }
        if is_last {
            let normal = normal_at(surface, uv);
            let is_met = offset.length() <= reach && (normal.dot(direction) > 0.0) == outward;
            return is_met.then_some(PiercingPoint { uv, normal, t });
        }
    }
    None
}

/// The normal, from the derivatives where they tell it.
fn normal_at<S: Surface + ?Sized>(surface: &S, uv: DVec2) -> DVec3 {
    let [_, du, dv] = surface.point_and_derivatives(uv);
    let across = du.cross(dv);
    let is_clear = across.length_squared() > CLEAR * CLEAR * du.length_squared() * dv.length_squared();
    // A side that is nearly a point has derivatives of few digits.
    let is_clear = is_clear && du.length_squared().min(dv.length_squared()) > CLEAR * CLEAR * across.length();
    if is_clear { across.normalize() } else { surface.normal(uv) }
}

/// The parameters of the point of the tangent plane at `offset`, as far as the domain goes.
fn clamped_step([du, dv]: [DVec3; 2], across: DVec3, offset: DVec3, uv: DVec2, [low, high]: [DVec2; 2]) -> DVec2 {
    let square = across.length_squared();
    let step = DVec2::new(offset.cross(dv).dot(across), du.cross(offset).dot(across)) / square;
    let next = (uv + step).clamp(low, high);
    let rest = |derivative: DVec3, other: DVec3, way: f64| {
        (offset - other * way).dot(derivative) / derivative.length_squared()
    };
    if next.x != uv.x + step.x {
        let v = uv.y + rest(dv, du, next.x - uv.x);
        DVec2::new(next.x, v.clamp(low.y, high.y))
    } else if next.y != uv.y + step.y {
        let u = uv.x + rest(du, dv, next.y - uv.y);
        DVec2::new(u.clamp(low.x, high.x), next.y)
    } else {
        next
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BezierPatch, Profile, Sphere, SurfaceOfRevolution, TransformedSurface, teapot};
    use super::*;
    use glam::DAffine3;

    #[test]
    fn a_sphere_is_met_where_the_closed_form_says_also_across_seam_and_pole() {
        let sphere = Sphere::new(DVec3::new(0.1, 0.2, 0.3), 2.0);
        for k in 0..400 {
            let angle = f64::from(k) * 2.4;
            let at = DVec2::new(angle.cos(), angle.sin()) * (f64::from(k) / 400.0 * 1.8);
            for axis in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.5, 0.7, -0.6).normalize()] {
                let (right, up) = axis.any_orthonormal_pair();
                let height = (4.0 - at.length_squared()).sqrt();
                let expected = DVec3::new(0.1, 0.2, 0.3) + right * at.x + up * at.y + axis * height;
                let from = expected + axis * 0.13;
                let guess = sphere.nearest(from + right * 0.2 - up * 0.15, DVec2::new(0.5, 0.0));
                let line = PiercingLine { from, direction: axis * -3.0, outward: false };
                let found = pierced(&sphere, &line, guess, 1.0).expect("it meets the sphere");
                assert!((found.t - 0.13 / 3.0).abs() < 1e-12, "{k} {axis}: {}", found.t);
                assert!((found.normal - (expected - DVec3::new(0.1, 0.2, 0.3)) / 2.0).length() < 1e-12, "{k} {axis}");
            }
        }
    }

    #[test]
    fn lines_through_known_points_of_surfaces_find_them() {
        let torus = SurfaceOfRevolution::whole(Profile::Arc { center: DVec2::X * 2.0, radius: 0.7, turns: [0.0, 1.0] });
        let skewed = DAffine3::from_cols_array(&[1.0, 0.2, 0.0, -0.3, 0.8, 0.1, 0.0, 0.5, 1.3, 4.0, 5.0, 6.0]);
        let patch: BezierPatch = teapot()[9].clone();
        let surfaces: [Box<dyn Surface>; 3] =
            [Box::new(torus.clone()), Box::new(TransformedSurface::new(torus, skewed)), Box::new(patch)];
        for (member, surface) in surfaces.iter().enumerate() {
            let [low, high] = surface.domain();
            for k in 0..100 {
                let part = DVec2::new(f64::from(k % 10) + 0.7, f64::from(k / 10) + 0.6) / 10.9;
                let uv = low + (high - low) * part;
                let (point, normal) = (surface.point(uv), surface.normal(uv));
                let direction = normal * -1.0 + surface.derivatives(uv)[0].normalize() * 0.8;
                let guess = (uv + (high - low) * DVec2::new(0.02, -0.015)).clamp(low, high);
                let line = PiercingLine { from: point - direction * 0.02, direction, outward: false };
                let found = pierced(surface, &line, guess, 0.3).expect("near");
                assert!((found.t - 0.02).abs() < 1e-11, "{member} {k}: {}", found.t);
                assert!((found.normal - normal).length() < 1e-9, "{member} {k}");
            }
        }
    }

    #[test]
    fn beyond_a_border_the_tangent_plane_goes_on_and_beyond_reach_there_is_nothing() {
        let can = SurfaceOfRevolution::whole(Profile::line(DVec2::new(1.0, 0.0), DVec2::new(1.0, 2.0)));
        let guess = DVec2::new(0.25, 0.95);
        let line = |from: DVec3, direction: DVec3| PiercingLine { from, direction, outward: false };
        let beside = line(DVec3::new(1.2, 2.1, 0.0), DVec3::NEG_X);
        let found = pierced(&can, &beside, guess, 0.5).expect("beside it");
        assert!((found.t - 0.2).abs() < 1e-15 && found.uv.y == 1.0);
        assert!((found.normal - DVec3::X).length() < 1e-15);
        assert_eq!(pierced(&can, &beside, guess, 0.05), None, "out of reach");
        assert_eq!(pierced(&can, &PiercingLine { outward: true, ..beside }, guess, 0.5), None, "from outside");
        let along = DVec3::new(1.1, 1.0, 0.0);
        assert_eq!(pierced(&can, &line(along, DVec3::Y), guess, 0.5), None, "along the surface");
        assert_eq!(pierced(&can, &line(along, DVec3::ZERO), guess, 0.5), None, "no direction");
    }

    #[test]
    fn of_two_places_close_to_an_outline_the_one_on_the_asked_side_is_found() {
        let sphere = Sphere::new(DVec3::ZERO, 1.0);
        for k in 1..100 {
            let height = 1.0 - 0.002 * f64::from(k);
            let half = (1.0 - height * height).sqrt();
            // Begun below the outline, as by a coarse triangle.
            let guess = sphere.nearest(DVec3::new(0.1, height, 0.05), DVec2::splat(0.1));
            for outward in [false, true] {
                let from = DVec3::new(0.0, height, if outward { -0.1 } else { 0.1 });
                let found = pierced(&sphere, &PiercingLine { from, direction: DVec3::NEG_Z, outward }, guess, 1.2);
                let expected = if outward { from.z + half } else { from.z - half };
                assert!((found.expect("both are near").t - expected).abs() < 1e-9, "{k} {outward}: {found:?}");
            }
        }
    }
}
