//! Hybrid multifractal: octaves weighted by the product of those before them.

use super::super::form::Form;
use super::kind::{Fractal, FractalKind, FractalRow};

pub(super) const ROW: FractalRow = FractalRow {
    kind: FractalKind::Hybrid,
    name: "hybrid",
    summary: "Smooth valleys at every height below rough slopes.",
    parameters: &["offset"],
    offset: 0.7,
};

/// Each octave is (noise + offset) times amplitude; it is added times a weight, the product of the octaves before it
/// but not above 1.
///
/// # Source
/// Musgrave in Ebert et al. 2003, Texturing and Modeling, chapter 16, HybridMultifractal.
pub(super) fn heights<F: Form>(fractal: &Fractal, place: &F::Place, footprint: f64) -> F {
    let offset = F::constant(place, fractal.parameters.offset);
    let mut height = F::constant(place, 0.0);
    let mut weight = height;
    fractal.each_octave(place, footprint, |octave, amplitude, noise: F, left| {
        let signal = (noise.scaled(left) + offset).scaled(amplitude);
        if octave == 0 {
            (height, weight) = (signal, signal);
        } else {
            let limited = weight.at_most(1.0);
            height = height + limited * signal;
            weight = limited * signal;
        }
    });
    height.scaled(fractal.parameters.height)
}
