//! What keeps edges of a solid from being rounded.

use glam::DVec3;

use crate::polygon::PolygonError;
use crate::solid::SolidError;
use crate::subdivision::SubdivisionError;

/// A fault that keeps edges from being rounded.
#[derive(Debug, thiserror::Error)]
pub enum RoundingError {
    /// A radius that is no length.
    #[error("radius {radius} is not a length above 0")]
    Radius {
        /// The radius.
        radius: f64,
    },
    /// There is nothing to round.
    #[error("the solid has no edges")]
    NoEdges,
    /// A face is curved.
    #[error("the edge from {from} to {to} is not between two flat faces")]
    Curved {
        /// Where the edge begins.
        from: DVec3,
        /// Where it ends.
        to: DVec3,
    },
    /// A face is too narrow.
    #[error(
        "radius {radius} is too large beside the edge from {from} to {to}: four times the setback must fit on a face"
    )]
    TooWide {
        /// Where the edge begins.
        from: DVec3,
        /// Where it ends.
        to: DVec3,
        /// The radius.
        radius: f64,
    },
    /// Only one of two edges is rounded where a face has a hollow corner.
    #[error("at {at} a face has a hollow or a straight corner; round both of its edges there, or none")]
    Hollow {
        /// The corner.
        at: DVec3,
    },
    /// Faces touch in a vertex.
    #[error("a face touches itself at {at}")]
    Touching {
        /// Where.
        at: DVec3,
    },
    /// An edge turns back.
    #[error("the edge from {from} to {to} turns by {degrees} degrees; the limit is 179")]
    Sharp {
        /// Where the edge begins.
        from: DVec3,
        /// Where it ends.
        to: DVec3,
        /// How far it turns.
        degrees: f64,
    },
    /// What is left of a face is no polygon.
    #[error("a face has no place for the rounding: {0}")]
    Polygon(#[from] PolygonError),
    /// The polyhedron cannot be subdivided.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// The result is no solid.
    #[error("the rounded surface bounds no solid: {0}")]
    Solid(#[from] SolidError),
}
