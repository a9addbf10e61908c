//! The numbers of a fractal, and the table that tells their names, ranges and defaults.

use super::error::TerrainError;
use super::octaves::MOST_OCTAVES;
use serde::{Deserialize, Serialize};

/// The numbers of a fractal terrain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FractalParameters {
    /// Number of octaves, rounded to a whole number.
    pub octaves: f64,
    /// Frequency of an octave over that of the one before.
    pub lacunarity: f64,
    /// Exponent H: octave i has the amplitude `lacunarity^(-i H)`. The fractal dimension of the surface is 3 - H
    /// between 0 and 1.
    pub hurst: f64,
    /// What is added to the noise of each octave, in units of it; it raises plains of multifractals above valleys.
    pub offset: f64,
    /// How strongly an octave of a ridged multifractal weighs the next one.
    pub feedback: f64,
    /// Lattice spacing of the first octave, units of length.
    pub scale: f64,
    /// Amplitude of the first octave, units of length.
    pub height: f64,
    /// What makes this terrain another one, rounded to a whole number.
    pub seed: f64,
}

/// A number of a fractal terrain.
#[derive(Clone, Copy)]
pub struct FractalParameter {
    /// Its name in scripts.
    pub name: &'static str,
    /// What it does, in words that may follow its name.
    pub summary: &'static str,
    /// The least and the greatest that it may be.
    pub range: [f64; 2],
    /// What it is if nothing is said.
    pub default: f64,
    /// Reads it.
    pub get: fn(&FractalParameters) -> f64,
    /// Gives the place where it is kept.
    pub place: fn(&mut FractalParameters) -> &mut f64,
}

/// A row of the table.
macro_rules! row {
    ($name:ident, $range:expr, $default:expr, $summary:expr) => {
        FractalParameter {
            name: stringify!($name),
            summary: $summary,
            range: $range,
            default: $default,
            get: |parameters| parameters.$name,
            place: |parameters| &mut parameters.$name,
        }
    };
}

/// All numbers of a fractal terrain.
pub const FRACTAL_PARAMETERS: &[FractalParameter] = &[
    row!(octaves, [1.0, MOST_OCTAVES as f64], 12.0, "how many octaves of noise there are"),
    row!(lacunarity, [1.25, 8.0], 2.0, "frequency of an octave over that of the one before"),
    row!(hurst, [0.0, 4.0], 1.0, "octave i is lacunarity^(-i hurst) as high as the first: the lower, the rougher"),
    row!(offset, [-4.0, 4.0], 0.7, "added to the noise of each octave, for kinds other than fbm"),
    row!(feedback, [0.0, 8.0], 2.0, "how strongly an octave weighs the next one, of ridged ground"),
    row!(scale, [1e-9, 1e9], 1.0, "how far hills of the first octave are apart, units of length"),
    row!(height, [-1e9, 1e9], 1.0, "how far the first octave goes up and down, units of length"),
    row!(seed, [0.0, FractalParameters::MOST_SEED], 0.0, "another ground for each whole number"),
];

impl Default for FractalParameters {
    fn default() -> FractalParameters {
        let mut parameters = FractalParameters {
            octaves: 0.0,
            lacunarity: 0.0,
            hurst: 0.0,
            offset: 0.0,
            feedback: 0.0,
            scale: 0.0,
            height: 0.0,
            seed: 0.0,
        };
        for row in FRACTAL_PARAMETERS {
            *(row.place)(&mut parameters) = row.default;
        }
        parameters
    }
}

impl FractalParameters {
    /// The greatest seed: the largest whole number that is told from its neighbours.
    pub const MOST_SEED: f64 = 9_007_199_254_740_991.0;

    /// Sets one number by its name.
    ///
    /// # Errors
    /// [`TerrainError::UnknownParameter`], and [`TerrainError::Parameter`] if it is out of range.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), TerrainError> {
        let row = FRACTAL_PARAMETERS.iter().find(|row| row.name == name);
        let row = row.ok_or_else(|| TerrainError::UnknownParameter { name: name.into() })?;
        in_range(row.name, value, row.range)?;
        *(row.place)(self) = value;
        Ok(())
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`TerrainError::Parameter`] names the first that is out of range.
    pub fn check(&self) -> Result<(), TerrainError> {
        FRACTAL_PARAMETERS.iter().try_for_each(|row| in_range(row.name, (row.get)(self), row.range))
    }
}

/// Refuses a number that is out of a range or none.
///
/// # Errors
/// [`TerrainError::Parameter`].
pub(super) fn in_range(name: &'static str, value: f64, range: [f64; 2]) -> Result<(), TerrainError> {
    if (range[0]..=range[1]).contains(&value) { Ok(()) } else { Err(TerrainError::Parameter { name, value, range }) }
}
