//! The nearest point of any surface, by Newton's method.

use glam::{DVec2, DVec3};

use super::Surface;

/// Steps at most; near a surface three or four are enough.
const MAX_STEPS: usize = 32;
/// Steps this small, as a part of the domain, need not come nearer, where distances do not differ by their digits any
/// more: they need only become shorter.
const SMALL_STEP: f64 = 1e-6;
/// Parts of a step that are tried in turn until one comes nearer.
const SCALES: [f64; 6] = [1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125];
/// The damping, as a part of the trace of the normal equations, where a derivative vanishes.
const DAMPING: f64 = 1e-9;

/// The parameters of the point of `surface` that is nearest to `point`, by damped Gauss-Newton steps from `guess`.
///
/// A local minimum of the distance; converges quadratically for points on the surface, and by as many digits a step as
/// the point is nearer than the radii of curvature for others.
pub fn nearest_from<S: Surface + ?Sized>(surface: &S, point: DVec3, guess: DVec2) -> DVec2 {
    let [low, high] = surface.domain();
    let mut uv = guess.clamp(low, high);
    let mut offset = point - surface.point(uv);
    let mut shortest = f64::INFINITY;
    for _ in 0..MAX_STEPS {
        let step = gauss_newton_step(surface.derivatives(uv), offset, uv, [low, high]);
        let length = (step / (high - low)).abs().max_element();
        let mut trial = (uv + step).clamp(low, high);
        if length > SMALL_STEP {
            let nearer = |trial: DVec2| (point - surface.point(trial)).length_squared() < offset.length_squared();
            let Some(scale) = SCALES.iter().find(|scale| nearer((uv + step * **scale).clamp(low, high))) else { break };
            trial = (uv + step * *scale).clamp(low, high);
        } else if length >= 0.5 * shortest || length == 0.0 {
            break;
        } else {
            shortest = length;
        }
        (uv, offset) = (trial, point - surface.point(trial));
    }
    uv
}

/// The step that would make `offset` perpendicular to both derivatives of a plane; parameters that would leave the
/// domain are held.
fn gauss_newton_step([du, dv]: [DVec3; 2], offset: DVec3, uv: DVec2, [low, high]: [DVec2; 2]) -> DVec2 {
    let (mut uu, mut vv, mut shared) = (du.dot(du), dv.dot(dv), du.dot(dv));
    let mut slope = DVec2::new(du.dot(offset), dv.dot(offset));
    let leaves = |uv: f64, low: f64, high: f64, slope: f64| (uv <= low && slope < 0.0) || (uv >= high && slope > 0.0);
    if leaves(uv.x, low.x, high.x, slope.x) {
        (slope.x, shared) = (0.0, 0.0);
    }
    if leaves(uv.y, low.y, high.y, slope.y) {
        (slope.y, shared) = (0.0, 0.0);
    }
    let damping = (uu + vv) * DAMPING;
    uu += damping;
    vv += damping;
    let determinant = uu * vv - shared * shared;
    if determinant > 0.0 {
        DVec2::new(vv * slope.x - shared * slope.y, uu * slope.y - shared * slope.x) / determinant
    } else {
        DVec2::ZERO
    }
}
