//! What can be wrong with the measures of a solid.

use crate::curve::SplineError;
use crate::polygon::PolygonError;
use crate::solid::SolidError;
use crate::surface::TessellationError;
use glam::{DVec2, DVec3};

/// A fault of the measures of a solid. Indices count from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PrimitiveError {
    /// A measure out of its range.
    #[error("{what} {value} is not {range}")]
    Measure {
        /// What it measures.
        what: &'static str,
        /// The number.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// Two measures that contradict each other.
    #[error("{what} {value} is not {than} {other}")]
    Contradiction {
        /// What the first measures.
        what: &'static str,
        /// The first.
        value: f64,
        /// How they must stand to each other.
        than: &'static str,
        /// The second.
        other: f64,
    },
    /// Too few or too many points.
    #[error("{found} {what} are not within {least} to {most}")]
    Count {
        /// Of what.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// The fewest.
        least: usize,
        /// The most.
        most: usize,
    },
    /// A point that is not finite or too far away.
    #[error("point {index} is {point}, its coordinates must be numbers within 1e90")]
    Point {
        /// The number of the point, from 0.
        index: usize,
        /// Where.
        point: DVec3,
    },
    /// A profile that goes through the axis.
    #[error("the profile goes through the axis at {at}, behind point {index}")]
    ThroughAxis {
        /// The last point of the profile before.
        index: usize,
        /// Where.
        at: DVec2,
    },
    /// A profile that crosses itself.
    #[error("the profile meets itself between points {first} and {} and between points {second} and {}", first + 1, second + 1)]
    Crossing {
        /// The first of the pieces that meet, by the index of its first point.
        first: usize,
        /// The second of the pieces that meet, by the index of its first point.
        second: usize,
    },
    /// A curve that bends tighter than what it carries is wide.
    #[error("the path bends with the radius {radius} at {at}, where the polygon reaches {reach} to the inside")]
    Bend {
        /// Where.
        at: DVec3,
        /// The radius of the bend.
        radius: f64,
        /// How far the polygon reaches towards the center of the bend.
        reach: f64,
    },
    /// A curve that stands still.
    #[error("the path has no direction somewhere: points coincide")]
    NoDirection,
    /// A polygon that bounds nothing.
    #[error(transparent)]
    Polygon(#[from] PolygonError),
    /// A curve that cannot be calculated with.
    #[error(transparent)]
    Spline(#[from] SplineError),
    /// A surface that cannot be approximated.
    #[error(transparent)]
    Tessellation(#[from] TessellationError),
    /// Surfaces that do not close.
    #[error(transparent)]
    Open(#[from] SolidError),
    /// A solid without an end.
    #[error("a half-space has no end: it must be combined with solids that have")]
    Endless,
}

/// Greatest measure, model units: products of several stay finite.
const GREATEST: f64 = 1e60;

/// # Errors
/// [`PrimitiveError::Measure`] unless `value` is a length above 0 that can be calculated with.
pub(super) fn length(what: &'static str, value: f64) -> Result<f64, PrimitiveError> {
    let range = if value > 0.0 { "within 1e-60 to 1e60" } else { "a length above 0" };
    let is_right = (1.0 / GREATEST..=GREATEST).contains(&value);
    if is_right { Ok(value) } else { Err(PrimitiveError::Measure { what, value, range }) }
}

/// # Errors
/// [`PrimitiveError::Measure`] unless `value` is 0 or a length.
pub(super) fn length_or_zero(what: &'static str, value: f64) -> Result<f64, PrimitiveError> {
    let range = "0 or a length";
    if value == 0.0 { Ok(0.0) } else { length(what, value).map_err(|_| PrimitiveError::Measure { what, value, range }) }
}

/// # Errors
/// [`PrimitiveError::Contradiction`] unless `value` is greater than `other`.
pub(super) fn above(what: &'static str, value: f64, than: &'static str, other: f64) -> Result<(), PrimitiveError> {
    if value > other { Ok(()) } else { Err(PrimitiveError::Contradiction { what, value, than, other }) }
}

/// # Errors
/// [`PrimitiveError::Count`] unless `found` is within limits.
pub(super) fn count(what: &'static str, found: usize, least: usize, most: usize) -> Result<(), PrimitiveError> {
    let is_right = (least..=most).contains(&found);
    if is_right { Ok(()) } else { Err(PrimitiveError::Count { what, found, least, most }) }
}

/// # Errors
/// [`PrimitiveError::Point`] with the first point that is not finite or too far away.
pub(super) fn points(all: impl IntoIterator<Item = DVec3>) -> Result<(), PrimitiveError> {
    let is_wrong = |p: &DVec3| !(p.is_finite() && p.abs().max_element() <= GREATEST);
    match all.into_iter().enumerate().find(|(_, point)| is_wrong(point)) {
        Some((index, point)) => Err(PrimitiveError::Point { index, point }),
        None => Ok(()),
    }
}
