//! The nearest point of any surface, by Newton's method.

use glam::{DVec2, DVec3};

use super::Surface;

/// Steps at most; near a surface three or four are enough.
const MAX_STEPS: usize = 32;
/// A step this small, as a part of the domain, is the last: what remains after it is of the order of its square.
const SMALL_STEP: f64 = 1e-7;
/// Halvings of a step that does not come nearer.
const MAX_HALVINGS: usize = 6;
/// The damping, as a part of the trace of the normal equations, where a derivative vanishes.
const DAMPING: f64 = 1e-9;

/// The parameters of the point of `surface` that is nearest to `point`, by damped Gauss-Newton steps from `guess`.
///
/// A local minimum of the distance; converges quadratically for points on the surface and fast for points that are
/// near in comparison with its radii of curvature.
pub fn nearest_from<S: Surface + ?Sized>(surface: &S, point: DVec3, guess: DVec2) -> DVec2 {
    let [low, high] = surface.domain();
    let mut uv = guess.clamp(low, high);
    let mut offset = point - surface.point(uv);
    for _ in 0..MAX_STEPS {
        let step = gauss_newton_step(surface.derivatives(uv), offset, uv, [low, high]);
        let is_last = (step / (high - low)).abs().max_element() <= SMALL_STEP;
        let mut scale = 1.0;
        let mut better = None;
        for _ in 0..if is_last { 1 } else { MAX_HALVINGS } {
            let trial = (uv + step * scale).clamp(low, high);
            let trial_offset = point - surface.point(trial);
            if trial_offset.length_squared() < offset.length_squared() {
                better = Some((trial, trial_offset));
                break;
            }
            scale *= 0.5;
        }
        let Some((trial, trial_offset)) = better else { break };
        (uv, offset) = (trial, trial_offset);
        if is_last {
            break;
        }
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
