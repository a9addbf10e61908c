//! Curvature of surfaces.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::Surface;

/// A surface that is differentiable twice within its domain.
pub trait Curved: Surface {
    /// The derivatives of the point by uu, uv and vv.
    fn second_derivatives(&self, uv: DVec2) -> [DVec3; 3];
}

impl<S: Curved + ?Sized> Curved for Arc<S> {
    fn second_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        (**self).second_derivatives(uv)
    }
}

/// The curvature of the section of `surface` by the plane of its normal and `direction`, a vector in the tangent plane;
/// 1 / model unit, positive where the surface bends to the outside.
///
/// `None` where the derivatives do not span the tangent plane.
pub fn normal_curvature<S: Curved + ?Sized>(surface: &S, uv: DVec2, direction: DVec3) -> Option<f64> {
    let [du, dv] = surface.derivatives(uv);
    let (a, b) = (du.length(), dv.length());
    let (along_u, along_v) = (du / a, dv / b);
    let (shared, span) = (along_u.dot(along_v), along_u.cross(along_v).length_squared());
    if !(a > 0.0 && b > 0.0 && span > 1e-12) {
        return None;
    }
    // `direction` as a combination of the derivatives.
    let direction = direction.normalize_or_zero();
    let (x, y) = (direction.dot(along_u), direction.dot(along_v));
    let (x, y) = ((x - shared * y) / span / a, (y - shared * x) / span / b);
    let normal = surface.normal(uv);
    let [uu, both, vv] = surface.second_derivatives(uv).map(|second| second.dot(normal));
    let curvature = uu * x * x + 2.0 * both * x * y + vv * y * y;
    curvature.is_finite().then_some(curvature)
}
