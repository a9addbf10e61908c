//! Critical points of the distance between two surfaces: where their tangent planes are parallel.

use glam::{DVec2, DVec3};

use super::newton::{NewtonSolver, beside};
use super::point::SheetCoordinates;

/// Steps at most.
const MOST_STEPS: usize = 30;
/// The step of differences, as a part of the reach: their errors are below 10^-7 of the curvature.
const DIFFERENCE: f64 = 1e-4;
/// A curvature this much smaller than the other is taken for 0: the surfaces touch along a curve.
const FLAT: f64 = 1e-5;
/// The tangential part of a normal, as a part of what a curvature makes of the reach, at which a point counts as found.
const LEVEL: f64 = 1e-7;

/// A point of the first surface from which the second is at an extreme distance, or a saddle of it.
#[derive(Clone, Copy, Debug)]
pub struct CriticalPoint {
    pub at: DVec3,
    pub coordinates: [SheetCoordinates; 2],
    pub normals: [DVec3; 2],
    /// The signed distance between the surfaces, along the normal of the second.
    pub gap: f64,
    /// Unit vectors in the tangent plane along which the distance bends most and least.
    pub directions: [DVec3; 2],
    /// Second derivatives of the distance along these directions, 1 / model unit; the greater magnitude first.
    pub curvatures: [f64; 2],
}

impl CriticalPoint {
    /// Whether the surfaces stay as near along the second direction, as far as curvatures tell.
    pub fn is_flat(&self) -> bool {
        self.curvatures[1].abs() <= FLAT * self.curvatures[0].abs()
    }
}

impl NewtonSolver<'_> {
    /// The critical point near `start`; none if there is none within `reach`.
    pub fn critical(&self, mut places: [SheetCoordinates; 2], start: DVec3, reach: f64) -> Option<CriticalPoint> {
        let mut at = start;
        let mut smallest = f64::INFINITY;
        let mut found = None;
        for _ in 0..MOST_STEPS {
            let current = self.step(&mut places, at, reach)?;
            let CriticalPoint { directions, curvatures, .. } = current.critical;
            let height = |k: usize| current.gradient.dot(directions[k]);
            let along = |k: usize| directions[k] * (-height(k) / curvatures[k]);
            let flat = current.critical.is_flat();
            let step = if curvatures[0] == 0.0 {
                DVec3::ZERO
            } else if flat {
                along(0)
            } else {
                along(0) + along(1)
            };
            if !step.is_finite() {
                return None;
            }
            let is_level = current.gradient.length() <= LEVEL * curvatures[0].abs() * reach;
            if step.length() >= 0.5 * smallest && is_level {
                break;
            }
            smallest = step.length();
            found = is_level.then_some(current.critical).or(found);
            if smallest == 0.0 {
                break;
            }
            at = current.critical.at + step.clamp_length_max(0.5 * reach);
            if at.distance(start) > 2.0 * reach {
                return None;
            }
        }
        found.filter(|critical| critical.at.distance(start) <= reach)
    }

    /// The gradient of the distance on the first surface at the foot point of a point, with what it would be to be
    /// critical.
    fn step(&self, places: &mut [SheetCoordinates; 2], at: DVec3, reach: f64) -> Option<CriticalStep> {
        let (one, foot) = self.foot(0, places[0], at, reach);
        let (two, gradient, gap, other) = self.gradient(places[1], foot.point, foot.normal, reach)?;
        *places = [one, two];
        let normal = foot.normal;
        let e = normal.any_orthonormal_vector();
        let frame = [e, normal.cross(e)];
        let h = DIFFERENCE * reach;
        let mut second = [DVec2::ZERO; 2];
        for (k, axis) in frame.into_iter().enumerate() {
            let moved = |by: f64| {
                let (_, foot) = self.foot(0, one, foot.point + axis * by, reach);
                let (_, gradient, ..) = self.gradient(two, foot.point, foot.normal, reach)?;
                Some(DVec2::new(gradient.dot(frame[0]), gradient.dot(frame[1])))
            };
            second[k] = (moved(h)? - moved(-h)?) / (2.0 * h);
        }
        let (vectors, curvatures) = principal(second[0].x, 0.5 * (second[0].y + second[1].x), second[1].y);
        let directions = vectors.map(|v| frame[0] * v.x + frame[1] * v.y);
        let normals = [normal, other];
        let critical = CriticalPoint { at: foot.point, coordinates: *places, normals, gap, directions, curvatures };
        Some(CriticalStep { critical, gradient })
    }

    /// Along the first surface: the place on the second, the gradient of the distance, the distance, the normal there.
    fn gradient(
        &self,
        place: SheetCoordinates,
        at: DVec3,
        normal: DVec3,
        reach: f64,
    ) -> Option<(SheetCoordinates, DVec3, f64, DVec3)> {
        let (place, foot) = self.foot(1, place, at, reach);
        // Where the second surface ends, its distance is another function.
        let is_on_both = beside(&foot, at) <= 1e-6 * reach && normal != DVec3::ZERO && foot.normal != DVec3::ZERO;
        let gradient = foot.normal - normal * foot.normal.dot(normal);
        is_on_both.then(|| (place, gradient, foot.normal.dot(at - foot.point), foot.normal))
    }
}

/// A point on the way to a critical one.
struct CriticalStep {
    critical: CriticalPoint,
    gradient: DVec3,
}

/// Eigenvectors and eigenvalues of a symmetric matrix, the greater magnitude first.
fn principal(a: f64, b: f64, d: f64) -> ([DVec2; 2], [f64; 2]) {
    let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
    let radius = half.hypot(b);
    // The better conditioned of two forms.
    let vector = if half >= 0.0 { DVec2::new(half + radius, b) } else { DVec2::new(b, radius - half) };
    let high = vector.normalize_or(DVec2::X);
    let (one, two) = (mean + radius, mean - radius);
    if one.abs() >= two.abs() { ([high, high.perp()], [one, two]) } else { ([high.perp(), high], [two, one]) }
}
