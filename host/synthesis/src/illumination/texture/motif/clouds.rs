//! Clouds of a second paint in the first.

use super::super::TextureError;
use super::sampled::Sampled;
use crate::numeric::noise::octaves;

/// Most octaves of noise.
const MOST_OCTAVES: u32 = 16;

/// Noise is as often above its middle as below.
pub(super) const MEAN: f64 = 0.5;

/// Refuses too many frequencies, and none.
pub(super) fn check(count: u32) -> Result<(), TextureError> {
    match (1..=MOST_OCTAVES).contains(&count) {
        true => Ok(()),
        false => Err(TextureError::Number { what: "number of octaves", value: f64::from(count), range: "1 to 16" }),
    }
}

/// The part of the second paint over a footprint.
pub(super) fn second(sampled: &Sampled<'_>, count: u32) -> f64 {
    (0.5 + 0.5 * octaves(sampled.at, count, sampled.width)).clamp(0.0, 1.0)
}
