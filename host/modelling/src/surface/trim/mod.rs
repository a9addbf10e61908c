//! Surfaces that are trimmed by curves in their parameters.

mod edges;
mod region;

pub use region::{tessellate_adaptively, tessellate_trimmed};

use glam::{DVec2, DVec3};

use super::{Surface, TessellationError};
use crate::curve::{Basis, BezierCurve, Curve, SplineCurve, SplineError};

/// Halvings of a piece of a curve until it is taken for a point: far below the digits of a number.
const MAX_HALVINGS: usize = 64;
/// The gap, as a part of the size of the domain, that may remain between the edges of a loop.
const CLOSED: f64 = 1e-9;

/// A fault that keeps a surface from being trimmed, or its rest from being tessellated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TrimError {
    /// A loop without edges.
    #[error("loop {loop_index} has no edges")]
    Empty {
        /// The loop.
        loop_index: usize,
    },
    /// A loop that does not close.
    #[error("loop {loop_index} does not close: edge {edge} ends {gap} away from where the next begins")]
    Open {
        /// The loop.
        loop_index: usize,
        /// The edge.
        edge: usize,
        /// The distance in the parameters.
        gap: f64,
    },
    /// An edge that leaves the domain of its surface.
    #[error("edge {edge} of loop {loop_index} leaves the domain of the surface at ({}, {})", at.x, at.y)]
    Outside {
        /// The loop.
        loop_index: usize,
        /// The edge.
        edge: usize,
        /// A point outside, (u, v).
        at: DVec2,
    },
    /// Loops that cross or touch along a piece.
    #[error("face {face}: the loops cross near ({}, {})", at.x, at.y)]
    Crossing {
        /// The surface, by its place in the list.
        face: usize,
        /// Where, (u, v).
        at: DVec2,
    },
    /// A rest that cannot be tessellated as asked.
    #[error(transparent)]
    Tessellation(#[from] TessellationError),
    /// A side of the domain that cannot be made a curve.
    #[error(transparent)]
    Spline(#[from] SplineError),
}

/// A piece of the outline of a trimmed surface.
#[derive(Clone, Debug, PartialEq)]
pub struct TrimEdge {
    /// The curve in the parameters: x is u, y is v, z is 0.
    pub curve: SplineCurve,
    /// A number that edges of several surfaces have in common if they are the same curve in space, at equal fractions
    /// of their parameters (from either end). Edges that agree to the bit are found to be the same without it.
    pub shared: Option<usize>,
}

/// A surface of which only a part is there: the points that an odd number of closed loops surround.
///
/// So an outer loop, holes in it, and islands in the holes need no direction and no order.
#[derive(Clone, Debug)]
pub struct TrimmedSurface<S> {
    surface: S,
    loops: Vec<Vec<TrimEdge>>,
}

impl<S: Surface> TrimmedSurface<S> {
    /// The part of `surface` inside `loops`, each a row of edges that follow one another.
    ///
    /// # Errors
    /// [`TrimError`] if a loop is empty, does not close, or leaves the domain.
    pub fn new(surface: S, loops: Vec<Vec<TrimEdge>>) -> Result<TrimmedSurface<S>, TrimError> {
        let [low, high] = surface.domain();
        for (loop_index, edges) in loops.iter().enumerate() {
            if edges.is_empty() {
                return Err(TrimError::Empty { loop_index });
            }
            for (edge, current) in edges.iter().enumerate() {
                let outside = |at: &DVec2| at.clamp(low, high).distance(*at) > CLOSED * (high - low).max_element();
                if let Some(at) = (0..=64).map(|k| current.uv(f64::from(k) / 64.0)).find(outside) {
                    return Err(TrimError::Outside { loop_index, edge, at });
                }
                let gap = current.uv(1.0).distance(edges[(edge + 1) % edges.len()].uv(0.0));
                if gap > CLOSED * (high - low).max_element() {
                    return Err(TrimError::Open { loop_index, edge, gap });
                }
            }
        }
        Ok(TrimmedSurface { surface, loops })
    }

    /// All of `surface` except what `holes` surround.
    ///
    /// # Errors
    /// [`TrimError`] if a hole is empty, does not close, or leaves the domain; the outline of the domain is loop 0.
    pub fn with_holes(surface: S, holes: Vec<Vec<TrimEdge>>) -> Result<TrimmedSurface<S>, TrimError> {
        let [low, high] = surface.domain();
        let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
        let mut outline = Vec::new();
        for k in 0..4 {
            let ends = [corners[k].extend(0.0), corners[(k + 1) % 4].extend(0.0)];
            outline.push(TrimEdge { curve: SplineCurve::new(Basis::bezier(1)?, &ends, &[])?, shared: None });
        }
        TrimmedSurface::new(surface, [vec![outline], holes].concat())
    }

    /// The whole surface.
    pub fn surface(&self) -> &S {
        &self.surface
    }

    /// The loops.
    pub fn loops(&self) -> &[Vec<TrimEdge>] {
        &self.loops
    }

    /// Whether the point at `uv` is there, by the curves themselves; points on a curve may count either way.
    pub fn contains(&self, uv: DVec2) -> bool {
        let pieces = self.loops.iter().flatten().flat_map(|edge| edge.curve.pieces());
        pieces.filter(|piece| crosses(piece, uv)).count() % 2 == 1
    }
}

impl TrimEdge {
    /// The parameters at a fraction of the curve.
    fn uv(&self, fraction: f64) -> DVec2 {
        let [low, high] = self.curve.domain();
        self.curve.point(super::between(low, high, fraction)).truncate()
    }
}

/// Whether a piece crosses the ray from `uv` along u an odd number of times.
///
/// A piece lies in the hull of its control points: where that does not decide, its halves are asked.
fn crosses(piece: &BezierCurve, uv: DVec2) -> bool {
    let mut is_odd = false;
    let mut stack = vec![(piece.clone(), 0)];
    while let Some((piece, halvings)) = stack.pop() {
        let points = || piece.control().iter().map(|control| control.point);
        let is_above = |point: DVec3| point.y > uv.y;
        let above = points().filter(|point| is_above(*point)).count();
        if above == 0 || above == points().count() || points().all(|point| point.x < uv.x) {
            continue;
        }
        if points().all(|point| point.x > uv.x) || halvings == MAX_HALVINGS {
            is_odd ^= is_above(piece.control()[0].point) != is_above(piece.control()[piece.degree()].point);
            continue;
        }
        stack.extend(piece.subdivided(0.5).map(|half| (half, halvings + 1)));
    }
    is_odd
}

#[cfg(test)]
mod tests;
