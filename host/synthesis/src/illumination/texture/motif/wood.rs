//! Rings of early and late wood about an axis.

use super::super::TextureError;
use super::sampled::{Sampled, check_turbulence, sinc};
use crate::numeric::noise::octaves;
use glam::DVec3;

/// The place in a ring of wood where the late wood ends and the next year begins.
const YEAR: f64 = 0.85;

/// Refuses rings that stray by a negative amount, and more fibres than all.
pub(super) fn check(turbulence: f64, grain: f64) -> Result<(), TextureError> {
    if !(0.0..=1.0).contains(&grain) {
        return Err(TextureError::Number { what: "grain", value: grain, range: "0 to 1" });
    }
    check_turbulence(turbulence)
}

/// The part of the second paint over a footprint.
pub(super) fn second(sampled: &Sampled<'_>, turbulence: f64, grain: f64) -> f64 {
    let (at, width) = (sampled.at, sampled.width);
    let stray = DVec3::new(1.0, 0.15, 1.0);
    let radius = DVec3::new(at.x, 0.0, at.z).length() + turbulence * octaves(at * 0.4 * stray, 3, 0.4 * width);
    let part = radius - radius.floor();
    let ring = if part < YEAR { (part / YEAR).powi(3) } else { (1.0 - part) / (1.0 - YEAR) };
    let mean = mean();
    let ring = mean + (ring - mean) * sinc(width * 2.0);
    let fibre = octaves(at * DVec3::new(24.0, 0.8, 24.0), 2, width * 24.0);
    (ring * (1.0 - grain) + grain * (mean + fibre)).clamp(0.0, 1.0)
}

/// The mean of a ring.
pub(super) fn mean() -> f64 {
    YEAR / 4.0 + (1.0 - YEAR) / 2.0
}
