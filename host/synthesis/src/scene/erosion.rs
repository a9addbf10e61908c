//! Ground that was eroded on a grid, with the finer octaves of its fractal on top.

use super::fractal_ground::FractalGround;
use super::kept_grids::KeptGrids;
use crate::procedural::terrain::{
    ErosionSettings, FractalKind, FractalParameters, HeightField, HeightFunction, HeightGrid, TerrainError, erode,
};
use glam::DVec2;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Fewest and most cells along the longer side.
pub(super) const CELLS: [u32; 2] = [8, 8192];
/// Lattice spacing of the coarsest octave that is added, spacings of the grid.
const DETAIL: f64 = 4.0;
/// How high it is, as a part of what the fractal has at that scale: erosion smooths.
const LEFT: f64 = 0.5;

/// How a terrain is eroded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Erosion {
    /// Cells of the grid along the longer side, 8 to 8192.
    pub cells: u32,
    /// The numbers.
    pub settings: ErosionSettings,
}

/// The eroded grids that were made last.
static KEPT: KeptGrids<(FractalGround, Erosion)> = KeptGrids::new();

impl Erosion {
    /// The height after erosion as a function of x and z.
    ///
    /// # Errors
    /// [`TerrainError`] for numbers out of range or too little memory.
    pub(super) fn heights(&self, of: &FractalGround) -> Result<HeightFunction, TerrainError> {
        let grid = self.grid(of)?;
        let spacing = grid.spacing();
        let FractalParameters { octaves, lacunarity, hurst, scale, height, seed, .. } = of.parameters;
        let finer = DETAIL * spacing / scale;
        let left = octaves + libm::log(finer) / libm::log(lacunarity);
        if left < 0.5 || finer > 1.0 {
            return Ok(HeightFunction::Grid(grid));
        }
        let detail = FractalParameters {
            octaves: left,
            scale: DETAIL * spacing,
            height: LEFT * height * libm::pow(finer, hurst),
            seed: (seed + 1.0) % FractalParameters::MOST_SEED,
            ..of.parameters
        };
        let detail = HeightFunction::fractal(FractalKind::Fbm, detail);
        Ok(HeightFunction::Sum(vec![HeightFunction::Grid(grid), detail]))
    }

    /// The heights on the grid: those that were made last are given again.
    fn grid(&self, of: &FractalGround) -> Result<Arc<HeightGrid>, TerrainError> {
        KEPT.get((of.clone(), self.clone()), || self.made(of))
    }

    fn made(&self, of: &FractalGround) -> Result<HeightGrid, TerrainError> {
        let cells = self.cells.clamp(CELLS[0], CELLS[1]);
        let sides = DVec2::from(of.size);
        let spacing = sides.max_element() / f64::from(cells);
        let [columns, rows] = (sides / spacing).to_array().map(|count| (count - 1e-9).ceil().max(1.0) as usize + 1);
        let corner = of.region()[0];
        let field = HeightField::new(&of.function()?, of.region())?;
        let height = |k: usize| {
            let at = corner + DVec2::new((k % columns) as f64, (k / columns) as f64) * spacing;
            field.height(at, spacing)
        };
        let before = HeightGrid::new([columns, rows], corner, spacing, (0..columns * rows).map(height).collect())?;
        Ok(erode(&before, &self.settings, &|| false)?.heights)
    }
}

#[cfg(test)]
mod tests {
    use super::super::fractal_ground::GroundKind;
    use super::*;

    fn nothing() -> ErosionSettings {
        ErosionSettings { water_steps: 0.0, slide_steps: 0.0, river_steps: 0.0, ..ErosionSettings::default() }
    }

    fn ground() -> FractalGround {
        let parameters =
            FractalParameters { octaves: 9.0, scale: 4.0, height: 1.5, seed: 2.0, ..FractalParameters::default() };
        FractalGround { kind: GroundKind::Noise(FractalKind::Fbm), parameters, size: [10.0, 6.0], warp: 0.0 }
    }

    #[test]
    fn what_nothing_erodes_is_the_fractal_at_the_grid() {
        let (ground, still) = (ground(), Erosion { cells: 64, settings: nothing() });
        let field = |function: &HeightFunction| HeightField::new(function, ground.region()).expect("sound");
        let (eroded, fractal) =
            (field(&still.heights(&ground).expect("sound")), field(&ground.function().expect("sound")));
        let spacing = 10.0 / 64.0;
        for k in 0..60 {
            let at = ground.region()[0] + DVec2::new(f64::from(k), f64::from(k % 30)) * spacing;
            // The octaves on top are a twentieth as high as the first one.
            assert!((eroded.height(at, 0.0) - fractal.height(at, spacing)).abs() < 0.1);
        }
    }

    #[test]
    fn erosion_is_made_once_and_carries_ground_away() {
        let settings = ErosionSettings { river_steps: 5.0, water_steps: 20.0, ..ErosionSettings::default() };
        let grid = |settings: &ErosionSettings| {
            Erosion { cells: 64, settings: settings.clone() }.grid(&ground()).expect("sound")
        };
        let one = grid(&settings);
        assert!(Arc::ptr_eq(&one, &grid(&settings)));
        let mean = |grid: &HeightGrid| grid.heights().iter().sum::<f64>() / grid.heights().len() as f64;
        assert!(mean(&one) < mean(&grid(&nothing())) - 0.01, "over the edge");
    }
}
