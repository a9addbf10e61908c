//! Ridged multifractal: octaves folded at 0, each weighted by the one before.

use super::super::form::Form;
use super::super::octaves::MEAN_ABSOLUTE;
use super::kind::{Fractal, FractalKind, FractalRow};

pub(super) const ROW: FractalRow = FractalRow {
    kind: FractalKind::Ridged,
    name: "ridged",
    summary: "Mountains with sharp ridges, rough near them and smooth below.",
    parameters: &["offset", "feedback"],
    offset: 1.0,
};

/// Each octave is (offset - |noise|)^2 times a weight, the octave before it times `feedback`, between 0 and 1.
///
/// Where an octave is left out its absolute value is replaced by the mean of that.
///
/// # Source
/// Musgrave in Ebert et al. 2003, Texturing and Modeling, chapter 16, RidgedMultifractal.
pub(super) fn heights<F: Form>(fractal: &Fractal, place: &F::Place, footprint: f64) -> F {
    let (offset, feedback) = (fractal.parameters.offset, fractal.parameters.feedback);
    let mut height = F::constant(place, 0.0);
    let mut signal = height;
    fractal.each_octave(place, footprint, |octave, amplitude, noise: F, left| {
        let level = F::constant(place, offset - (1.0 - left) * MEAN_ABSOLUTE);
        let ridge = level + noise.abs().scaled(-left);
        let squared = ridge * ridge;
        signal = if octave == 0 { squared } else { squared * signal.scaled(feedback).at_least(0.0).at_most(1.0) };
        height = height + signal.scaled(amplitude);
    });
    height.scaled(fractal.parameters.height)
}
