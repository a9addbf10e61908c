//! Veins of a second paint in the first.

use super::super::{TextureError, positive};
use super::sampled::{Sampled, check_turbulence, sinc};
use crate::numeric::noise::octaves;
use std::f64::consts::TAU;

/// Refuses veins that stray by a negative amount, or are too narrow.
pub(super) fn check(turbulence: f64, sharpness: f64) -> Result<(), TextureError> {
    positive("sharpness", sharpness)?;
    if sharpness > 1000.0 {
        return Err(TextureError::Number { what: "sharpness", value: sharpness, range: "at most 1000" });
    }
    check_turbulence(turbulence)
}

/// The part of the second paint over a footprint.
pub(super) fn second(sampled: &Sampled<'_>, turbulence: f64, sharpness: f64) -> f64 {
    let x = sampled.at.x + turbulence * octaves(sampled.at, 6, sampled.width);
    let wave = (0.5 + 0.5 * (TAU * x).sin()).powf(sharpness);
    let mean = mean(sharpness);
    // Narrow veins have higher frequencies.
    mean + (wave - mean) * sinc(sampled.width * sharpness.sqrt())
}

/// The mean of ((1 + sin x)/2)^s: Γ(s + 1/2) / (√π Γ(s + 1)).
pub(super) fn mean(s: f64) -> f64 {
    (libm::lgamma(s + 0.5) - libm::lgamma(s + 1.0)).exp() / std::f64::consts::PI.sqrt()
}
