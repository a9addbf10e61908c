//! Exact rational surfaces of revolution.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec3;

use super::SplineSurface;
use crate::curve::{Basis, ControlPoint, SplineCurve, SplineError};

/// The control points of the unit circle over [`circle_basis`]: corners of the square around it with weights of the
/// square root of one half, and the points between them where it touches.
const CIRCLE: [[f64; 2]; 8] =
    [[1.0, 1.0], [0.0, 1.0], [-1.0, 1.0], [-1.0, 0.0], [-1.0, -1.0], [0.0, -1.0], [1.0, -1.0], [1.0, 0.0]];

/// Four rational quadratic quarters, closed; parameters 0..=4.
fn circle_basis() -> Result<Basis, SplineError> {
    Basis::closed_b_spline(2, &[0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0])
}

fn circle_weight(k: usize) -> f64 {
    if k.is_multiple_of(2) { FRAC_1_SQRT_2 } else { 1.0 }
}

/// The surface that `profile`, a curve in the plane z = 0, makes when it revolves about the y axis.
///
/// u turns from the x axis towards -z, 0..=4 for a whole turn, in four exact rational quarters; v is the parameter of
/// the profile. The outside is on the right of a profile that is followed upwards at x > 0. A point of the profile on
/// the axis becomes a pole.
///
/// # Errors
/// [`SplineError`] if the profile lies out of the plane z = 0, with the control point as row 0.
pub fn revolved(profile: &SplineCurve) -> Result<SplineSurface, SplineError> {
    if let Some(column) = profile.control().iter().position(|control| control.point.z != 0.0) {
        return Err(SplineError::Point { row: 0, column, point: profile.control()[column].point });
    }
    let turned = |k: usize, control: &ControlPoint| {
        let ([x, z], DVec3 { x: radius, y, .. }) = (CIRCLE[k], control.point);
        let point = if radius == 0.0 { DVec3::Y * y } else { DVec3::new(radius * x, y, -radius * z) };
        ControlPoint { point, weight: control.weight * circle_weight(k) }
    };
    let rows = (0..8).flat_map(|k| profile.control().iter().map(move |control| turned(k, control)));
    let control = rows.collect();
    Ok(SplineSurface::of([circle_basis()?, profile.basis().clone()], control))
}

/// The sphere around the origin as a rational surface: u goes about the y axis, 0..=4, v runs from the lower pole to
/// the upper, 0..=2; outside out.
///
/// # Errors
/// [`SplineError`] if the radius is out of range.
pub fn rational_sphere(radius: f64) -> Result<SplineSurface, SplineError> {
    let points = [[0.0, -1.0], [1.0, -1.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let points = points.map(|[x, y]| DVec3::new(x, y, 0.0) * radius);
    let weights = [1.0, FRAC_1_SQRT_2, 1.0, FRAC_1_SQRT_2, 1.0];
    let basis = Basis::b_spline(2, &[0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0])?;
    revolved(&SplineCurve::new(basis, &points, &weights)?)
}

/// The torus around the y axis as a rational surface: a tube of radius `tube` around a circle of radius `ring`; u goes
/// about the axis and v around the tube from its outermost circle upwards, both 0..=4; outside out.
///
/// # Errors
/// [`SplineError`] if a radius is out of range.
pub fn rational_torus(ring: f64, tube: f64) -> Result<SplineSurface, SplineError> {
    let points = CIRCLE.map(|[x, y]| DVec3::new(ring + tube * x, tube * y, 0.0));
    let weights: Vec<f64> = (0..8).map(circle_weight).collect();
    revolved(&SplineCurve::new(circle_basis()?, &points, &weights)?)
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::super::{Direction, Surface, Tolerance, normal_curvature, tessellate};
    use super::*;

    fn samples(surface: &SplineSurface) -> Vec<DVec2> {
        let [low, high] = surface.domain();
        (0..41 * 41).map(|k| low + (high - low) * DVec2::new((k % 41) as f64, (k / 41) as f64) / 40.0).collect()
    }

    #[test]
    fn spheres_are_exact_with_normals_and_curvature() {
        for radius in [1.0, 1e-6, 3.7e6] {
            let sphere = rational_sphere(radius).unwrap();
            for uv in samples(&sphere) {
                let point = sphere.point(uv) / radius;
                assert!((point.length() - 1.0).abs() < 1e-15, "{uv}: {:e}", point.length() - 1.0);
                assert!((sphere.normal(uv) - point).length() < 1e-14, "{uv}: {} {point}", sphere.normal(uv));
                if let Some(curvature) =
                    normal_curvature(&sphere, uv, sphere.derivatives(uv)[0] + sphere.derivatives(uv)[1])
                {
                    assert!((curvature * radius + 1.0).abs() < 1e-12, "{uv}: {curvature}");
                }
            }
        }
    }

    #[test]
    fn tori_are_exact_with_normals() {
        for (ring, tube) in [(3.0, 1.0), (1.0, 0.01)] {
            let torus = rational_torus(ring, tube).unwrap();
            for uv in samples(&torus) {
                let point = torus.point(uv);
                let across = point.x.hypot(point.z);
                let off = (across - ring).hypot(point.y) - tube;
                assert!(off.abs() < 1e-15 * (ring + tube), "{uv}: {off:e}");
                let center = DVec3::new(point.x, 0.0, point.z) * (ring / across);
                assert!((torus.normal(uv) - (point - center) / tube).length() < 1e-12);
            }
        }
    }

    #[test]
    fn they_are_closed_without_cracks() {
        for chord in [0.2, 0.02, 0.002] {
            let mesh = tessellate(rational_sphere(1.0).unwrap().patches(), Tolerance::new(chord, 180.0)).unwrap();
            let report = mesh.edge_report();
            assert!(report.is_closed() && report.euler_characteristic() == 2, "{report:?}");
            let mesh = tessellate(rational_torus(2.0, 0.5).unwrap().patches(), Tolerance::new(chord, 180.0)).unwrap();
            let report = mesh.edge_report();
            assert!(report.is_closed() && report.euler_characteristic() == 0, "{report:?}");
            assert!(mesh.signed_volume() > 0.0);
        }
    }

    #[test]
    fn refined_spheres_are_still_exact() {
        let sphere = rational_sphere(1.0).unwrap();
        let finer = sphere.with_joint(Direction::U, 0.3).unwrap().with_joint(Direction::V, 1.9).unwrap();
        let higher = finer.elevated(Direction::U).unwrap().elevated(Direction::V).unwrap();
        assert_eq!(higher.basis(Direction::V).degree(), 3);
        let mut parts = higher.subdivided(Direction::U, 1.5).unwrap();
        assert_eq!(parts.len(), 1);
        parts = parts[0].subdivided(Direction::V, 0.7).unwrap();
        assert_eq!(parts.len(), 2);
        for surface in [vec![finer, higher], parts].concat() {
            for uv in samples(&surface) {
                assert!((surface.point(uv).length() - 1.0).abs() < 3e-15);
                assert!((surface.point(uv) - sphere.point(DVec2::new(uv.x.rem_euclid(4.0), uv.y))).length() < 1e-13);
            }
        }
    }

    #[test]
    fn profiles_out_of_the_plane_are_refused() {
        let profile = SplineCurve::new(Basis::bezier(1).unwrap(), &[DVec3::X, DVec3::ONE], &[]).unwrap();
        assert!(revolved(&profile).unwrap_err().to_string().starts_with("control point 1 of row 0"));
    }
}
