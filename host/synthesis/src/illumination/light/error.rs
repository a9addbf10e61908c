//! What can be wrong with a light.

use crate::illumination::material::MaterialError;
use glam::DVec3;

/// A reason for which a light is none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LightError {
    /// A place or a length that is not finite.
    #[error("{what} {value} is not finite")]
    NotFinite {
        /// The quantity.
        what: &'static str,
        /// Its value.
        value: DVec3,
    },
    /// A direction without length.
    #[error("{what} {value} has no length")]
    NoLength {
        /// The quantity.
        what: &'static str,
        /// Its value.
        value: DVec3,
    },
    /// A strength that is negative or not finite.
    #[error("{what} {least} to {most} is negative or not finite")]
    Strength {
        /// The quantity.
        what: &'static str,
        /// Its least value.
        least: f64,
        /// Its greatest value.
        most: f64,
    },
    /// Angles of a cone that is none.
    #[error("a cone of {inner} to {outer} degrees: they must rise and lie within 0 to 180")]
    Cone {
        /// The angle where the light begins to fall.
        inner: f64,
        /// The angle where it ends.
        outer: f64,
    },
    /// A surface that is flat or too large.
    #[error("its surface is {0}")]
    Patch(&'static str),
    /// A material that is none.
    #[error("its material: {0}")]
    Material(#[source] MaterialError),
}

/// Refuses a place that is not finite.
pub(super) fn place(at: DVec3) -> Result<(), LightError> {
    if at.is_finite() { Ok(()) } else { Err(LightError::NotFinite { what: "its place", value: at }) }
}

/// Refuses a direction without length.
pub(super) fn directed(what: &'static str, value: DVec3) -> Result<(), LightError> {
    if value.try_normalize().is_some() { Ok(()) } else { Err(LightError::NoLength { what, value }) }
}
