//! Kinds of fractals, and what all of them are made of: octaves with their amplitudes.

use super::super::error::TerrainError;
use super::super::form::Form;
use super::super::octave_sum::OctaveSum;
use super::super::octaves::{LANES, MOST_OCTAVES, Octaves, remaining};
use super::super::parameters::FractalParameters;
use serde::{Deserialize, Serialize};

/// A kind of fractal terrain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FractalKind {
    /// Fractional Brownian motion: a sum of octaves.
    Fbm,
    /// Octaves whose amplitude grows with the height so far: plains and rugged tops.
    Heterogeneous,
    /// Octaves weighted by the product of those before them: smooth valleys at every height.
    Hybrid,
    /// Octaves folded at 0 to sharp ridges, each weighted by the one before.
    Ridged,
}

/// What is known of a kind of fractal terrain.
#[derive(Clone, Copy, Debug)]
pub struct FractalRow {
    /// The kind.
    pub kind: FractalKind,
    /// Its name in scripts.
    pub name: &'static str,
    /// What it looks like, a sentence.
    pub summary: &'static str,
    /// Those numbers of [`FractalParameters`] that it takes beside octaves, lacunarity, H, scale, height and seed.
    pub parameters: &'static [&'static str],
    /// The usual offset.
    pub offset: f64,
}

/// A fractal with its lattices.
#[derive(Clone, Debug)]
pub(in super::super) struct Fractal {
    pub(super) kind: FractalKind,
    pub(super) parameters: FractalParameters,
    pub(super) sum: OctaveSum,
}

impl Fractal {
    /// Checks the numbers and makes the lattices.
    ///
    /// # Errors
    /// [`TerrainError`] for a number out of range, or an octave too fine for `reach`, the largest coordinate.
    pub(in super::super) fn new(
        kind: FractalKind,
        parameters: FractalParameters,
        reach: f64,
    ) -> Result<Fractal, TerrainError> {
        parameters.check()?;
        let FractalParameters { lacunarity, hurst, scale, height, .. } = parameters;
        let count = parameters.octaves.round() as u32;
        let octaves = Octaves::new(count, scale, lacunarity, parameters.seed.round() as u64, reach)?;
        // Multifractals are built at height 1: what they are made of is not proportional to it.
        let mut amplitude = if kind == FractalKind::Fbm { height } else { 1.0 };
        // By products: powers differ from one machine to the next.
        let gain = power_of(lacunarity, -hurst);
        let mut amplitudes = [0.0; MOST_OCTAVES];
        for entry in &mut amplitudes[..octaves.count()] {
            *entry = amplitude;
            amplitude *= gain;
        }
        Ok(Fractal { kind, parameters, sum: OctaveSum::new(octaves, amplitudes) })
    }

    /// Lattice points of the first octave in a unit of length.
    pub(in super::super) fn coarsest(&self) -> f64 {
        self.sum.octaves.frequencies[0]
    }

    /// Lattice points of the finest octave in a unit of length.
    pub(in super::super) fn finest(&self) -> f64 {
        self.sum.octaves.frequencies[self.sum.octaves.count() - 1]
    }

    /// Calls for each octave, with its amplitude, its noise and how much is left of that; noise of which nothing is
    /// left is given as 0.
    pub(super) fn each_octave<F: Form>(
        &self,
        place: &F::Place,
        footprint: f64,
        mut call: impl FnMut(usize, f64, F, f64),
    ) {
        let octaves = &self.sum.octaves;
        let mut noise = [F::constant(place, 0.0); LANES];
        for octave in 0..octaves.count() {
            let left = if footprint > 0.0 { remaining(footprint * octaves.frequencies[octave]) } else { 1.0 };
            let lane = octave % LANES;
            if lane == 0 && left > 0.0 {
                noise = F::noise(octaves, octave, place);
            }
            let of_octave = if left > 0.0 { noise[lane] } else { F::constant(place, 0.0) };
            call(octave, self.sum.amplitudes[octave], of_octave, left);
        }
    }
}

/// A power by square roots and products alone, which are the same on every machine.
///
/// - `base`: above 0. `exponent`: rounded to 2^-30.
fn power_of(base: f64, exponent: f64) -> f64 {
    const BITS: u32 = 30;
    let mut bits = (exponent.abs() * f64::from(1_u32 << BITS)).round() as u64;
    let mut power = 1.0;
    let mut whole = base;
    let mut after = bits >> BITS;
    while after > 0 {
        power *= if after & 1 == 1 { whole } else { 1.0 };
        whole *= whole;
        after >>= 1;
    }
    let mut root = base;
    for _ in 0..BITS {
        root = root.sqrt();
        bits <<= 1;
        power *= if bits >> BITS & 1 == 1 { root } else { 1.0 };
    }
    if exponent < 0.0 { 1.0 / power } else { power }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_those_of_the_standard_library() {
        for base in [1.25, 2.0, 2.17, 8.0] {
            for exponent in [0.0, 0.25, 0.8, 1.0, 1.37, 3.99, -1.0, -0.3] {
                let (found, expected) = (power_of(base, exponent), f64::powf(base, exponent));
                assert!((found / expected - 1.0).abs() < 1e-8, "{base}^{exponent}: {found} {expected}");
            }
        }
        assert_eq!([power_of(2.0, -1.0), power_of(4.0, 0.5)], [0.5, 2.0]);
    }
}
