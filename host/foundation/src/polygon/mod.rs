//! Planar polygons with any number of holes, divided into the fewest triangles.
//!
//! A polygon is a set of contours: closed runs of corners, in either direction. What lies inside of an odd number of
//! contours is inside of the polygon; so holes, islands in holes and several separate outlines need no mark. Contours
//! may touch each other, and themselves, in points; they may neither cross nor overlap. All decisions come from exact
//! signs, so that nearly degenerate polygons are as good as others.

mod chain;
mod delaunay;
mod error;
mod outline;
mod space;
mod status;
mod sweep;

pub use error::{PolygonEdge, PolygonError};
pub use space::triangulate_in_space;

use std::collections::HashSet;

use glam::DVec2;

use outline::Outline;

/// What a triangulation is to be good at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TriangulationKind {
    /// Made in the shortest time; triangles may be long and thin.
    #[default]
    Any,
    /// Constrained Delaunay: the smallest angle is as large as it can be without new points.
    Delaunay,
}

/// Triangles that cover a polygon without overlap.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Triangulation {
    /// Corners of each triangle, counter-clockwise: indices into the corners of all contours, one contour after the
    /// other. Corners at the same point bear the lowest index among them.
    pub triangles: Vec<[u32; 3]>,
    /// How many corners no triangle needs: repetitions of the corner before, and corners where the contour goes
    /// straight on.
    pub dropped: usize,
}

impl Triangulation {
    /// The edges around the polygon, with its inside on their left; contours that touch an edge divide it.
    pub fn border(&self) -> Vec<[u32; 2]> {
        let sides = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        let all: HashSet<[u32; 2]> = self.triangles.iter().flat_map(sides).collect();
        let edges = self.triangles.iter().flat_map(sides);
        edges.filter(|[a, b]| !all.contains(&[*b, *a])).collect()
    }
}

/// Divides a polygon into triangles.
///
/// n corners, without those that are dropped, and h holes give n + 2 h - 2 triangles, the fewest possible, if contours
/// do not touch. Each point where a hole touches the rest saves two of them; a corner that touches the middle of an edge
/// divides that edge, which counts as one corner more. No point is added. Takes time n log n.
///
/// - `contours`: corners of each, any unit, in either direction; the last is followed by the first. Nothing for no
///   contours. Coordinates below 2^-367 of the greatest are rounded to 2^-420 of it.
///
/// # Errors
/// A corner that is not finite, a contour without area, or edges that cross or overlap, with their places.
pub fn triangulate<C: AsRef<[DVec2]>>(contours: &[C], kind: TriangulationKind) -> Result<Triangulation, PolygonError> {
    let outline = Outline::of(contours)?;
    let mut triangles = sweep::triangles(&outline)?;
    if kind == TriangulationKind::Delaunay {
        delaunay::flip(&outline.corners, &mut triangles);
    }
    Ok(Triangulation { triangles, dropped: outline.dropped() })
}

#[cfg(test)]
mod tests;
