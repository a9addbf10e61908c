//! Errors of distributions.

use glam::DVec3;

/// A reason for which a distribution cannot be made or used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DistributionError {
    /// A roughness outside what is provided for.
    #[error("a roughness of {0}: it must lie between 1e-8 and 1000")]
    Roughness(f64),
    /// An exponent outside what is provided for.
    #[error("an exponent of {0}: it must lie between 0 and 1e17")]
    Exponent(f64),
    /// A value below zero.
    #[error(
        "{name} is {value} for light from {light} and a viewer at {view} (z is the normal): it must not be negative"
    )]
    Negative {
        /// The distribution.
        name: String,
        /// Its value, 1/sr.
        value: f64,
        /// Towards the light.
        light: DVec3,
        /// Towards the viewer.
        view: DVec3,
    },
    /// A value that is not a number, or infinite.
    #[error("{name} is not finite for light from {light} and a viewer at {view} (z is the normal)")]
    NotFinite {
        /// The distribution.
        name: String,
        /// Towards the light.
        light: DVec3,
        /// Towards the viewer.
        view: DVec3,
    },
    /// A table too small to hold a function, or too large to be kept.
    #[error("a table of {0} steps: from 4 to 96 are possible")]
    Resolution(usize),
    /// A table whose numbers contradict each other.
    #[error("the table of {name} contradicts itself: {problem}")]
    Table {
        /// The distribution.
        name: String,
        /// What is wrong.
        problem: &'static str,
    },
    /// A function that emits nothing cannot be normalised.
    #[error("{name} emits nothing for light from {light} (z is the normal): it cannot be normalised")]
    Nothing {
        /// The distribution.
        name: String,
        /// Towards the light.
        light: DVec3,
    },
}

/// The smallest roughness.
pub const LEAST_ROUGHNESS: f64 = 1e-8;
/// The greatest roughness.
pub const MOST_ROUGHNESS: f64 = 1e3;

/// A roughness that is provided for.
pub(in crate::illumination) fn checked_roughness(roughness: f64) -> Result<f64, DistributionError> {
    let possible = (LEAST_ROUGHNESS..=MOST_ROUGHNESS).contains(&roughness);
    if possible { Ok(roughness) } else { Err(DistributionError::Roughness(roughness)) }
}
