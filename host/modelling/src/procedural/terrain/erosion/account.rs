//! The account of an erosion: what there was, what came, what left, and what is there.

use rayon::prelude::*;

/// Cells whose sum is one part of a sum over all of them.
const PART: usize = 4096;

/// Volumes of material and of water before and after an erosion, units of length cubed.
///
/// Material is counted from the height 0, ground below it is negative. What is suspended in water has settled in the
/// end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErosionAccount {
    /// Material before.
    pub material_before: f64,
    /// Material after.
    pub material_after: f64,
    /// Material that left over the edge: with running water, with rivers, by hillslopes.
    pub material_left: f64,
    /// Material that uplift brought.
    pub material_uplifted: f64,
    /// Water that rained.
    pub rain: f64,
    /// Water that evaporated.
    pub evaporated: f64,
    /// Water that left over the edge.
    pub water_left: f64,
    /// Water that is there at the end.
    pub water_after: f64,
    /// Absolute values of all heights times the area of a cell.
    pub(super) magnitude: f64,
}

impl ErosionAccount {
    /// Material that is missing or too much, as a part of all that there was or moved over the edge.
    ///
    /// (before + uplifted - left - after) / (sum over cells of |h| + uplifted + left)
    pub fn material_error(&self) -> f64 {
        let off = (self.material_before + self.material_uplifted) - (self.material_left + self.material_after);
        part_of(off, self.magnitude + self.material_uplifted.abs() + self.material_left.abs())
    }

    /// Water that is missing or too much, as a part of the rain.
    ///
    /// (rain - evaporated - left - after) / rain
    pub fn water_error(&self) -> f64 {
        part_of(self.rain - (self.evaporated + self.water_left + self.water_after), self.rain)
    }
}

fn part_of(off: f64, all: f64) -> f64 {
    if off == 0.0 { 0.0 } else { off.abs() / all }
}

/// The sum of a function of numbers, in an order that does not depend on threads.
pub(super) fn sum_of(values: &[f64], of: fn(f64) -> f64) -> f64 {
    let parts: Vec<f64> =
        values.par_chunks(PART).map(|part| part.iter().map(|value| of(*value)).sum::<f64>()).collect();
    parts.iter().sum()
}

/// The least and the greatest of numbers.
pub(super) fn range_of(values: &[f64]) -> [f64; 2] {
    let of = |[low, high]: [f64; 2], value: &f64| [low.min(*value), high.max(*value)];
    let nothing = [f64::INFINITY, f64::NEG_INFINITY];
    let parts: Vec<[f64; 2]> = values.par_chunks(PART).map(|part| part.iter().fold(nothing, of)).collect();
    parts.iter().fold(nothing, |all, part| [all[0].min(part[0]), all[1].max(part[1])])
}
