//! Fractional Brownian motion: a sum of octaves of noise.

use super::super::form::Form;
use super::kind::{Fractal, FractalKind, FractalRow};

pub(super) const ROW: FractalRow = FractalRow {
    kind: FractalKind::Fbm,
    name: "fbm",
    summary: "Hills as rough everywhere: a sum of octaves of noise.",
    parameters: &[],
    offset: 0.0,
};

/// The sum over the octaves of amplitude times noise.
///
/// # Source
/// Mandelbrot and Van Ness 1968; Musgrave in Ebert et al. 2003, Texturing and Modeling, chapter 16, fBm.
pub(super) fn heights<F: Form>(fractal: &Fractal, place: &F::Place, footprint: f64) -> F {
    F::octave_sum(&fractal.sum, place, footprint)
}
