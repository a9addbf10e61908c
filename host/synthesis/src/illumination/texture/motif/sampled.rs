//! What all patterns share: the footprint, stray lines, waves in the mean.

use super::super::{TextureError, TextureFootprint};
use glam::DVec3;

/// A footprint in the coordinates of a pattern.
pub(super) struct Sampled<'a> {
    pub(super) footprint: &'a TextureFootprint,
    /// Its middle.
    pub(super) at: DVec3,
    /// The sides of the parallelogram about it.
    pub(super) sides: [DVec3; 2],
    /// The longer of them.
    pub(super) width: f64,
    /// Whether the pattern goes through the body.
    pub(super) is_solid: bool,
}

/// Refuses lines that stray by a negative amount.
pub(super) fn check_turbulence(value: f64) -> Result<(), TextureError> {
    match value.is_finite() && value >= 0.0 {
        true => Ok(()),
        false => Err(TextureError::Number { what: "turbulence", value, range: "0 or more" }),
    }
}

/// Amplitude of a wave of period 1 in the mean over a width; 0 beyond one period.
pub(super) fn sinc(width: f64) -> f64 {
    let x = std::f64::consts::PI * width;
    if width >= 1.0 {
        0.0
    } else if x < 1e-6 {
        1.0
    } else {
        x.sin() / x
    }
}
