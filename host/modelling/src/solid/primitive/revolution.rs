//! Solids of revolution of any closed profile.

use super::PrimitiveError;
use super::error::{count, points};
use super::round::turned;
use crate::curve::{Basis, SplineCurve, SplineError};
use crate::polygon::{PolygonError, TriangulationKind, triangulate};
use crate::solid::{Body, Face};
use crate::surface::{Profile, Surface, SurfaceOfRevolution};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Most points of a profile.
const MAX_POINTS: usize = 1 << 14;
/// Steps along a curved piece where it is compared with the others and with the axis.
const STEPS: usize = 24;
/// Greatest bulge: an arc that is all but a circle.
const MAX_BULGE: f64 = 1e3;

/// The solid of a closed profile that revolves once about the y axis.
///
/// - `profile`: points (r, y, bulge) in either direction, 3 or more; the last is followed by the first. The way to the
///   next point is straight if the bulge is 0, else an arc: the bulge is the tangent of a quarter of its angle,
///   positive if it turns left, 1 for half a circle.
pub fn revolution(profile: &[DVec3]) -> Result<Body, PrimitiveError> {
    count("points", profile.len(), 3, MAX_POINTS)?;
    points(profile.iter().copied())?;
    let mut pieces = Vec::new();
    let mut point_of = Vec::new();
    for (index, point) in profile.iter().enumerate() {
        let bulge = point.z;
        if bulge.abs() > MAX_BULGE {
            return Err(PrimitiveError::Measure { what: "bulge", value: bulge, range: "within -1000 to 1000" });
        }
        let next = profile[(index + 1) % profile.len()];
        if point.truncate() != next.truncate() {
            pieces.extend(arc(point.truncate(), next.truncate(), bulge)?);
            point_of.resize(pieces.len(), index);
        }
    }
    closed(pieces, &point_of)
}

/// The solid of a smooth profile that revolves once about the y axis: the cubic B-spline of control points (r, y),
/// which begins in the first and ends in the last, closed by straight pieces over the axis.
pub fn smooth_revolution(control: &[DVec2]) -> Result<Body, PrimitiveError> {
    count("points", control.len(), 2, MAX_POINTS)?;
    points(control.iter().map(|point| point.extend(0.0)))?;
    let ends = [control[0], control[control.len() - 1]];
    let on_axis = ends.map(|end| DVec2::new(0.0, end.y));
    let degree = 3.min(control.len() - 1);
    let all: Vec<DVec3> = control.iter().map(|point| point.extend(0.0)).collect();
    let curve = SplineCurve::new(Basis::clamped(degree, control.len())?, &all, &[])?;
    let mut pieces = Vec::new();
    for piece in curve.pieces() {
        let points: Vec<DVec3> = piece.control().iter().map(|control| control.point).collect();
        pieces.push(spline(&points, &[])?);
    }
    for (from, to) in [(ends[1], on_axis[1]), (on_axis[1], on_axis[0]), (on_axis[0], ends[0])] {
        if from != to {
            pieces.push(Profile::line(from, to));
        }
    }
    let point_of: Vec<usize> = (0..pieces.len()).map(|piece| piece.min(control.len() - 1)).collect();
    closed(pieces, &point_of)
}

/// A Bezier curve as a profile.
fn spline(points: &[DVec3], weights: &[f64]) -> Result<Profile, SplineError> {
    SplineCurve::new(Basis::bezier(points.len() - 1)?, points, weights).map(Profile::Spline)
}

/// The straight way or the arc between two points, in pieces of a quarter of a circle at most.
///
/// Arcs are rational, so that they begin and end in their points to the bit.
fn arc(from: DVec2, to: DVec2, bulge: f64) -> Result<Vec<Profile>, PrimitiveError> {
    if bulge == 0.0 {
        return Ok(vec![Profile::line(from, to)]);
    }
    let angle = 4.0 * bulge.atan();
    let out = -(to - from).perp();
    if angle.abs() > FRAC_PI_2 {
        // The middle of an arc is as far from the chord as the bulge says, in half chords.
        let middle = (from + to) * 0.5 + out * (0.5 * bulge);
        let half = (angle / 8.0).tan();
        return Ok([arc(from, middle, half)?, arc(middle, to, half)?].concat());
    }
    let corner = (from + to) * 0.5 + out * (0.5 * (angle * 0.5).tan());
    let weights = [1.0, (angle * 0.5).cos(), 1.0];
    Ok(vec![spline(&[from, corner, to].map(|point| point.extend(0.0)), &weights)?])
}

/// The body of a closed chain, in either direction. `point_of`: for each piece the point of the user where it begins.
fn closed(pieces: Vec<Profile>, point_of: &[usize]) -> Result<Body, PrimitiveError> {
    let mut outline = Vec::new();
    let mut piece_of = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        let steps = if matches!(piece, Profile::Line { .. }) { 1 } else { STEPS };
        for step in 0..steps {
            let point = piece.point(step as f64 / steps as f64);
            if point.x < 0.0 {
                return Err(PrimitiveError::ThroughAxis { index: point_of[index], at: point });
            }
            outline.push(point);
            piece_of.push(index);
        }
    }
    check_simple(&outline, |corner| point_of[piece_of[corner]])?;
    let doubled: f64 = (0..outline.len()).map(|k| outline[k].perp_dot(outline[(k + 1) % outline.len()])).sum();
    Ok(if doubled > 0.0 { turned(pieces) } else { turned(pieces.into_iter().rev().map(Profile::reversed)) })
}

/// # Errors
/// If the outline crosses or overlaps itself, or bounds nothing.
fn check_simple(outline: &[DVec2], point_of: impl Fn(usize) -> usize) -> Result<(), PrimitiveError> {
    match triangulate(&[outline], TriangulationKind::Any) {
        Ok(_) => Ok(()),
        Err(PolygonError::Crossing { first, second } | PolygonError::Overlap { first, second }) => {
            Err(PrimitiveError::Crossing { first: point_of(first.corner), second: point_of(second.corner) })
        }
        Err(error) => Err(error.into()),
    }
}

/// A polygon in the plane of x and y, x not below 0, that revolves about the y axis from the z axis on through `turn`
/// towards the x axis, in turns above 0 and up to 1.
///
/// Contours may run either way; what lies in an odd number of them is inside.
pub fn revolved_polygon<C: AsRef<[DVec2]>>(contours: &[C], turn: f64) -> Result<Body, PrimitiveError> {
    if !(turn > 0.0 && turn <= 1.0) {
        let value = turn * 360.0;
        return Err(PrimitiveError::Measure { what: "angle", value, range: "above 0 and at most 360 degrees" });
    }
    let corners: Vec<DVec2> = contours.iter().flat_map(|contour| contour.as_ref()).copied().collect();
    count("corners", corners.len(), 3, MAX_POINTS)?;
    points(corners.iter().map(|corner| corner.extend(0.0)))?;
    if let Some(index) = corners.iter().position(|corner| corner.x < 0.0) {
        return Err(PrimitiveError::ThroughAxis { index, at: corners[index] });
    }
    let base = triangulate(contours, TriangulationKind::Delaunay)?;
    let mut curved: Vec<Arc<dyn Surface>> = Vec::new();
    for edge in base.border() {
        let [from, to] = edge.map(|corner| corners[corner as usize]);
        let side = Profile::line(from, to);
        if !side.is_on_axis() {
            curved.push(Arc::new(SurfaceOfRevolution::part(side, [0.0, turn])));
        }
    }
    let mut faces = Vec::new();
    if turn < 1.0 {
        let at =
            |turns: f64| corners.iter().map(|corner| SurfaceOfRevolution::revolve(*corner, turns)).collect::<Vec<_>>();
        let turned = base.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        faces = vec![Face::new(at(0.0), base.triangles.clone()), Face::new(at(turn), turned)];
    }
    Ok(Body::new(curved, faces))
}
