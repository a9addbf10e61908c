//! Squares or cubes of two paints in turn.

use super::sampled::Sampled;

/// The second paint covers one half.
pub(super) const MEAN: f64 = 0.5;

/// The part of the second paint over a footprint.
pub(super) fn second(sampled: &Sampled<'_>) -> f64 {
    let [a, b] = sampled.sides;
    let extent = a.abs() + b.abs();
    let axes = if sampled.is_solid { 3 } else { 2 };
    0.5 - 0.5 * (0..axes).map(|axis| square_wave(sampled.at[axis], extent[axis])).product::<f64>()
}

/// The mean over a width of a wave that is 1 from 0 to 1/2 and −1 from 1/2 to 1.
fn square_wave(at: f64, width: f64) -> f64 {
    let part = |x: f64| x - x.floor();
    if width < 1e-12 {
        return if part(at) < 0.5 { 1.0 } else { -1.0 };
    }
    // Its integral is a triangle wave; whole periods have none.
    let integral = |x: f64| {
        let part = part(x);
        if part < 0.5 { part } else { 1.0 - part }
    };
    let mean = (integral(at + 0.5 * width) - integral(at - 0.5 * width)) / width;
    if mean.is_finite() { mean.clamp(-1.0, 1.0) } else { 0.0 }
}
