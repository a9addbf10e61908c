//! Reading surfaces that a grammar defines by numbers: leaves, petals.

use super::error::{GrammarError, GrammarProblem};
use super::scanner::Cursor;
use crate::polygon::{TriangulationKind, triangulate_in_space};
use crate::procedural::drawing::{PredefinedPart, PredefinedSurface};
use crate::surface::BezierPatch;
use glam::DVec3;

/// Most points of a surface.
const MOST_POINTS: usize = 1 << 14;

/// Reads what follows on the heading of a surface: `polygon` with three points or more, or `patch` with 16, again and
/// again. A point is `(x, y, z)`.
pub(super) fn surface(name: String, cursor: &mut Cursor) -> Result<PredefinedSurface, GrammarError> {
    let mut parts = Vec::new();
    loop {
        let before = cursor.clone();
        if cursor.take("polygon") {
            let corners = points(cursor)?;
            let filled = triangulate_in_space(&[&corners[..]], TriangulationKind::Delaunay);
            let triangles = filled.map_err(|error| before.fault(GrammarProblem::Polygon(error.to_string())))?.triangles;
            parts.push(PredefinedPart::Polygon { corners, triangles });
        } else if cursor.take("patch") {
            let points = points(cursor)?;
            let Ok(control) = <[DVec3; 16]>::try_from(points) else {
                return Err(before.expected("`patch` with 16 points"));
            };
            let row = |i: usize| std::array::from_fn(|j| control[4 * i + j]);
            parts.push(PredefinedPart::Patch(Box::new(BezierPatch::new(std::array::from_fn(row)))));
        } else if parts.is_empty() || !cursor.is_at_end() {
            return Err(cursor.expected("`polygon` or `patch`"));
        } else {
            return Ok(PredefinedSurface { name, parts });
        }
    }
}

fn points(cursor: &mut Cursor) -> Result<Vec<DVec3>, GrammarError> {
    let mut points = Vec::new();
    while cursor.take("(") {
        let mut point = [0.0; 3];
        for (axis, coordinate) in point.iter_mut().enumerate() {
            if axis > 0 {
                cursor.require(",")?;
            }
            let is_negative = cursor.take("-");
            let size = cursor.take_number()?.ok_or_else(|| cursor.expected("a coordinate"))?;
            *coordinate = if is_negative { -size } else { size };
        }
        cursor.require(")")?;
        points.push(DVec3::from_array(point));
        if points.len() > MOST_POINTS {
            return Err(cursor.fault(GrammarProblem::TooMany { what: "points of a surface", most: MOST_POINTS }));
        }
    }
    Ok(points)
}
