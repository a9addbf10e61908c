//! Solids of polygons that a curve carries along.

use super::PrimitiveError;
use super::error::{count, points};
use crate::curve::{Basis, SplineCurve};
use crate::polygon::{TriangulationKind, triangulate};
use crate::solid::{Body, Face};
use crate::surface::{Spine, Surface, Swept, TwistAndTaper};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Most points of a path, and most surfaces of a sweep.
const MAX_SURFACES: usize = 1 << 20;
/// Places on each span where the curvature is compared with the section.
const BEND_SAMPLES: usize = 16;

/// The curve of a path: the cubic B-spline of its points, which begins in the first and ends in the last, or the closed
/// one.
pub fn path(control: &[DVec3], is_closed: bool) -> Result<SplineCurve, PrimitiveError> {
    count("points of the path", control.len(), if is_closed { 4 } else { 2 }, MAX_SURFACES)?;
    points(control.iter().copied())?;
    let degree = 3.min(control.len() - 1);
    let basis = if is_closed { Basis::closed_uniform(3, control.len()) } else { Basis::clamped(degree, control.len()) };
    Ok(SplineCurve::new(basis?, control, &[])?)
}

/// The solid that a polygon makes along a curve. It stays square to the curve and does not turn about it, but as
/// `twist_and_taper` says. The curve goes through the origin of the polygon.
///
/// Contours may run either way; what lies in an odd number of them is inside. That parts of the curve far from each
/// other come too near is not checked.
///
/// # Errors
/// [`PrimitiveError`], with the place, if the curve bends tighter than the polygon is wide there, and if it has no
/// direction; if the polygon is none; if a closed curve is given a taper or a twist that does not come around.
pub fn sweep<C: AsRef<[DVec2]>>(
    contours: &[C],
    curve: SplineCurve,
    twist_and_taper: TwistAndTaper,
) -> Result<Body, PrimitiveError> {
    let TwistAndTaper { twist_turns: turns, scale } = twist_and_taper;
    let is_closed = curve.basis().is_closed();
    let refused = |what, value, range| Err(PrimitiveError::Measure { what, value, range });
    if !(0.0..=1e6).contains(&scale) {
        return refused("taper", scale, "0 to 1e6");
    }
    if is_closed && scale != 1.0 {
        return refused("taper", scale, "1, as a closed path needs");
    }
    if turns.is_nan() || turns.abs() > 1e4 || is_closed && turns != turns.round() {
        return refused("twist", turns * 360.0, "a number of degrees that comes around, if the path does");
    }
    let corners: Vec<DVec2> = contours.iter().flat_map(|contour| contour.as_ref()).copied().collect();
    points(corners.iter().map(|corner| corner.extend(0.0)))?;
    let base = triangulate(contours, TriangulationKind::Delaunay)?;
    let border = base.border();
    let breaks = curve.basis().breaks().to_vec();
    count("surfaces", border.len() * (breaks.len() - 1), 1, MAX_SURFACES)?;
    let spine = Arc::new(Spine::new(curve).ok_or(PrimitiveError::NoDirection)?);
    check_bend(&spine, &corners, twist_and_taper, &breaks)?;
    let mut curved: Vec<Arc<dyn Surface>> = Vec::new();
    for edge in border {
        let edge = edge.map(|corner| corners[corner as usize]);
        for part in breaks.windows(2) {
            curved.push(Arc::new(Swept::new(Arc::clone(&spine), twist_and_taper, edge, [part[0], part[1]])));
        }
    }
    let mut faces = Vec::new();
    let cap = |t: f64| corners.iter().map(|corner| spine.point_at(*corner, twist_and_taper, t)).collect::<Vec<_>>();
    if !is_closed {
        let turned = base.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        faces.push(Face::new(cap(breaks[0]), turned));
        if scale > 0.0 {
            faces.push(Face::new(cap(breaks[breaks.len() - 1]), base.triangles));
        }
    }
    Ok(Body::new(curved, faces))
}

/// # Errors
/// [`PrimitiveError::Bend`] at the first place where a corner of the section is at the center of the bend or beyond.
fn check_bend(
    spine: &Spine,
    corners: &[DVec2],
    twist_and_taper: TwistAndTaper,
    breaks: &[f64],
) -> Result<(), PrimitiveError> {
    let [low, high] = [breaks[0], breaks[breaks.len() - 1]];
    for part in breaks.windows(2) {
        for look in 0..=BEND_SAMPLES {
            let t = part[0] + (part[1] - part[0]) * look as f64 / BEND_SAMPLES as f64;
            let bend = spine.curvature_in_section(twist_and_taper, t);
            let scale = 1.0 + (twist_and_taper.scale - 1.0) * (t - low) / (high - low);
            let most = corners.iter().map(|corner| corner.dot(bend) * scale).fold(0.0, f64::max);
            if most >= 1.0 {
                let radius = 1.0 / bend.length();
                let at = spine.point_at(DVec2::ZERO, twist_and_taper, t);
                return Err(PrimitiveError::Bend { at, radius, reach: most * radius });
            }
        }
    }
    Ok(())
}
