//! What can be wrong with a polygon, and where.

use std::fmt;

/// A fault that keeps a polygon from having a triangulation.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PolygonError {
    /// A corner is not a point.
    #[error("contour {contour}: corner {corner} is not finite")]
    NotFinite {
        /// The contour, from 0.
        contour: usize,
        /// Its corner, from 0.
        corner: usize,
    },
    /// Fewer than three different corners in a row.
    #[error("contour {contour} has {corners} different corners; it needs three")]
    TooFewCorners {
        /// The contour, from 0.
        contour: usize,
        /// How many corners are left without repetitions.
        corners: usize,
    },
    /// All corners lie on one line.
    #[error("contour {contour} encloses no area")]
    NoArea {
        /// The contour, from 0.
        contour: usize,
    },
    /// Two edges cross, or a corner passes through an edge.
    #[error("{first} crosses {second}")]
    Crossing {
        /// The first of the two edges.
        first: PolygonEdge,
        /// The second of the two edges.
        second: PolygonEdge,
    },
    /// Two edges share more than a point.
    #[error("{first} overlaps {second}")]
    Overlap {
        /// The first of the two edges.
        first: PolygonEdge,
        /// The second of the two edges.
        second: PolygonEdge,
    },
    /// More corners than indices of 32 bits can tell apart.
    #[error("{corners} corners are too many")]
    TooManyCorners {
        /// How many.
        corners: usize,
    },
}

/// The edge of a contour from a corner to the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PolygonEdge {
    /// The contour, from 0.
    pub contour: usize,
    /// The corner where the edge begins, from 0. Corners in the middle of a straight run are passed over.
    pub corner: usize,
}

impl fmt::Display for PolygonEdge {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "the edge from corner {} of contour {}", self.corner, self.contour)
    }
}
