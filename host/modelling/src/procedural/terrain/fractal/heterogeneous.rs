//! Heterogeneous terrain: octaves whose amplitude grows with the height so far.

use super::super::form::Form;
use super::kind::{Fractal, FractalKind, FractalRow};

pub(super) const ROW: FractalRow = FractalRow {
    kind: FractalKind::Heterogeneous,
    name: "heterogeneous",
    summary: "Plains in the valleys, rugged tops: details grow with the height.",
    parameters: &["offset"],
    offset: 0.7,
};

/// The first octave is `offset` + noise; each later one adds (noise + offset) times amplitude times the height so far.
///
/// # Source
/// Musgrave in Ebert et al. 2003, Texturing and Modeling, chapter 16, Hetero_Terrain.
pub(super) fn heights<F: Form>(fractal: &Fractal, place: &F::Place, footprint: f64) -> F {
    let offset = F::constant(place, fractal.parameters.offset);
    let mut height = F::constant(place, 0.0);
    fractal.each_octave(place, footprint, |octave, amplitude, noise: F, left| {
        let raised = noise.scaled(left) + offset;
        height = if octave == 0 { raised } else { height + raised.scaled(amplitude) * height };
    });
    height.scaled(fractal.parameters.height)
}
