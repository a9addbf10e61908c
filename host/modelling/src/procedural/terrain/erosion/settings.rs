//! The numbers of erosion, and the table that tells their names, ranges and usual values.

use super::super::error::TerrainError;
use super::super::parameters::in_range;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Most steps of a kind.
const MOST_STEPS: f64 = 1e6;

/// What is beyond the edge of a grid for water that runs over it.
///
/// Slides never cross the edge, and for rivers it is always the base level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ErosionEdge {
    /// A wall: water and what it carries stay.
    #[default]
    Closed,
    /// Dry ground as high as the cell at the edge: water runs off, and nothing comes back.
    Open,
}

/// The numbers by which a terrain is eroded.
///
/// Running water is computed with the spacing of the grid as the unit of length and one step as the unit of time, so
/// that the same numbers give the same shapes on terrain of any size. Rivers are computed in the units of the terrain
/// and in a unit of time of one's own, as the equation dh/dt = U - K A^m S^n is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErosionSettings {
    /// Steps of running water, rounded to a whole number.
    pub water_steps: f64,
    /// Rain on a cell, spacings per step.
    pub rain: f64,
    /// Part of the water that evaporates in a step.
    pub evaporation: f64,
    /// Drag of the bed on the water: u^2 times it over the depth is what slows it down.
    pub drag: f64,
    /// Load that a stream with a power of 1 carries, spacings.
    pub capacity: f64,
    /// Part of what a stream could carry more that it takes up in a step.
    pub detachment: f64,
    /// Part of what a stream carries too much that it drops in a step.
    pub settling: f64,
    /// Steps of slides, rounded to a whole number.
    pub slide_steps: f64,
    /// Angle of repose, degrees.
    pub repose_angle: f64,
    /// How fast slopes that are too steep slide, as a part of the fastest that never overshoots.
    pub slide_rate: f64,
    /// Most steps of rivers, rounded to a whole number.
    pub river_steps: f64,
    /// Length of a step of rivers, units of time.
    pub river_interval: f64,
    /// Erodibility K, length^(1 - 2m) over time: one over time for m = 0.5.
    pub erodibility: f64,
    /// Exponent m of the drainage area.
    pub area_exponent: f64,
    /// Exponent n of the slope.
    pub slope_exponent: f64,
    /// How much chance decides which of the ways down a river takes: 0 for the steepest of eight, which follows the
    /// grain of the grid.
    pub wander: f64,
    /// Uplift U, length over time.
    pub uplift: f64,
    /// Diffusivity of hillslopes, length^2 over time.
    pub diffusivity: f64,
    /// Rivers end when the largest change of a step is below this part of the relief. Where divides still move, that
    /// change is about U times the interval: a landscape is steady to a tolerance only with intervals that are short
    /// enough for it.
    pub tolerance: f64,
    /// What is beyond the edge for running water.
    pub edge: ErosionEdge,
    /// By what the rain on each cell is multiplied, row by row along x, 0 and more; 1 everywhere if not given.
    #[serde(skip)]
    pub rain_map: Option<Arc<[f64]>>,
    /// By what the uplift of each cell is multiplied, row by row along x; 1 everywhere if not given.
    #[serde(skip)]
    pub uplift_map: Option<Arc<[f64]>>,
}

/// A number of erosion.
#[derive(Clone, Copy)]
pub struct ErosionParameter {
    /// Its name in scripts.
    pub name: &'static str,
    /// What it does, and its unit.
    pub summary: &'static str,
    /// The least and the greatest that it may be.
    pub range: [f64; 2],
    /// What it is if nothing is said.
    pub default: f64,
    /// Reads it.
    pub get: fn(&ErosionSettings) -> f64,
    /// Gives the place where it is kept.
    pub place: fn(&mut ErosionSettings) -> &mut f64,
}

/// A row of the table.
macro_rules! row {
    ($name:ident, $range:expr, $default:expr, $summary:expr) => {
        ErosionParameter {
            name: stringify!($name),
            summary: $summary,
            range: $range,
            default: $default,
            get: |settings| settings.$name,
            place: |settings| &mut settings.$name,
        }
    };
}

/// All numbers of erosion.
pub const EROSION_PARAMETERS: &[ErosionParameter] = &[
    row!(water_steps, [0.0, MOST_STEPS], 200.0, "steps of running water; 0 for none"),
    row!(rain, [0.0, 1e6], 3e-4, "depth of rain, spacings of the grid per step"),
    row!(evaporation, [0.0, 1.0], 0.005, "part of the water that evaporates in a step"),
    row!(drag, [1e-4, 1e4], 0.05, "drag of the bed: the larger, the slower and deeper the water"),
    row!(capacity, [0.0, 1e3], 20.0, "load that a stream with a power of 1 carries, spacings of the grid"),
    row!(detachment, [0.0, 1.0], 0.1, "part of the missing load that is taken up in a step"),
    row!(settling, [0.0, 1.0], 0.05, "part of the surplus load that is dropped in a step"),
    row!(slide_steps, [0.0, MOST_STEPS], 60.0, "steps of slides to the angle of repose; 0 for none"),
    row!(repose_angle, [0.0, 89.9], 36.0, "the steepest slope on which loose ground lies, degrees"),
    row!(slide_rate, [0.0, 1.0], 0.5, "how fast steeper slopes slide, as a part of the fastest that is stable"),
    row!(river_steps, [0.0, MOST_STEPS], 30.0, "most steps of rivers; 0 for none"),
    row!(river_interval, [1e-12, 1e12], 1.0, "length of a step of rivers, units of time"),
    row!(erodibility, [0.0, 1e9], 0.02, "K of dh/dt = U - K A^m S^n, length^(1 - 2m) over time; 0 for no rivers"),
    row!(area_exponent, [0.0, 2.0], 0.5, "exponent m of the drainage area"),
    row!(slope_exponent, [0.25, 4.0], 1.0, "exponent n of the slope"),
    row!(wander, [0.0, 1.0], 0.6, "how much chance decides where rivers flow: 0 for the steepest of eight ways"),
    row!(uplift, [0.0, 1e9], 0.0, "uplift U of all but the edge, length over time"),
    row!(diffusivity, [0.0, 1e12], 0.0, "diffusivity of hillslopes between rivers, length^2 over time"),
    row!(tolerance, [0.0, 1.0], 1e-4, "rivers end when no cell changes by more of the relief in a step"),
];

impl Default for ErosionSettings {
    fn default() -> ErosionSettings {
        let mut settings = ErosionSettings {
            water_steps: 0.0,
            rain: 0.0,
            evaporation: 0.0,
            drag: 0.0,
            capacity: 0.0,
            detachment: 0.0,
            settling: 0.0,
            slide_steps: 0.0,
            repose_angle: 0.0,
            slide_rate: 0.0,
            river_steps: 0.0,
            river_interval: 0.0,
            erodibility: 0.0,
            area_exponent: 0.0,
            slope_exponent: 0.0,
            wander: 0.0,
            uplift: 0.0,
            diffusivity: 0.0,
            tolerance: 0.0,
            edge: ErosionEdge::default(),
            rain_map: None,
            uplift_map: None,
        };
        for row in EROSION_PARAMETERS {
            *(row.place)(&mut settings) = row.default;
        }
        settings
    }
}

impl ErosionSettings {
    /// Sets one number by its name.
    ///
    /// # Errors
    /// [`TerrainError::UnknownParameter`], and [`TerrainError::Parameter`] if it is out of range.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), TerrainError> {
        let row = EROSION_PARAMETERS.iter().find(|row| row.name == name);
        let row = row.ok_or_else(|| TerrainError::UnknownParameter { name: name.into() })?;
        in_range(row.name, value, row.range)?;
        *(row.place)(self) = value;
        Ok(())
    }

    /// Whether there are rivers, uplift or hillslopes that change heights.
    pub(super) fn has_rivers(&self) -> bool {
        self.river_steps >= 0.5 && (self.erodibility > 0.0 || self.uplift > 0.0 || self.diffusivity > 0.0)
    }

    /// Checks every number, and the maps for a grid.
    ///
    /// - `size`: cells along x and z.
    ///
    /// # Errors
    /// [`TerrainError::Parameter`] names the first number that is out of range, [`TerrainError::GridSize`] says that a
    /// map has another number of cells, [`TerrainError::Cell`] where a map has no number that it may have.
    pub fn check(&self, size: [usize; 2]) -> Result<(), TerrainError> {
        EROSION_PARAMETERS.iter().try_for_each(|row| in_range(row.name, (row.get)(self), row.range))?;
        const MOST: f64 = 1e6;
        check_map(self.rain_map.as_deref(), "rain", size, [0.0, MOST])?;
        check_map(self.uplift_map.as_deref(), "uplift", size, [-MOST, MOST])
    }
}

/// Checks the numbers of cells.
///
/// # Errors
/// [`TerrainError::GridSize`] for another number of cells, [`TerrainError::Cell`] for a number out of range.
fn check_map(
    map: Option<&[f64]>,
    what: &'static str,
    [columns, rows]: [usize; 2],
    range: [f64; 2],
) -> Result<(), TerrainError> {
    let Some(map) = map else { return Ok(()) };
    if columns.checked_mul(rows) != Some(map.len()) {
        return Err(TerrainError::GridSize { columns, rows, heights: map.len() });
    }
    match map.iter().position(|value| !(range[0]..=range[1]).contains(value)) {
        Some(cell) => Err(TerrainError::Cell { what, column: cell % columns, row: cell / columns, value: map[cell] }),
        None => Ok(()),
    }
}
