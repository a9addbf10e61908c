//! What covers terrain: rock in strata, snow, plants, by height, slope and wetness.

use super::error::TerrainError;
use super::parameters::in_range;

/// Limits of what covers the ground, with smooth edges.
#[derive(Clone, Debug, PartialEq)]
pub struct TerrainCover {
    /// Height from which on snow lies, units of length.
    pub snow_line: f64,
    /// How far above and below that line snow comes and goes, units of length, above 0.
    pub snow_edge: f64,
    /// Slope from which on snow slides off, height over length; it is gone at twice that.
    pub snow_slope: f64,
    /// Height up to which plants grow, units of length.
    pub tree_line: f64,
    /// How far above and below that line plants become few, units of length, above 0.
    pub tree_edge: f64,
    /// Slope from which on plants find no hold; there are none at twice that.
    pub plant_slope: f64,
    /// Wetness, 0 to 1, at which plants grow half as densely as they can, above 0.
    pub half_wetness: f64,
    /// Layers of rock, lowest first: one after the other, again and again.
    pub strata: Vec<Stratum>,
    /// Height of the bottom of the first layer.
    pub strata_base: f64,
    /// How steeply the layers rise along x and z, height over length.
    pub strata_dip: [f64; 2],
    /// Part of a layer's thickness over which it goes over to the next one, 0 to 1.
    pub strata_edge: f64,
}

/// A layer of rock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stratum {
    /// Its thickness, units of length, above 0.
    pub thickness: f64,
    /// Number of its material.
    pub material: u32,
}

/// What covers a place: parts whose sum is 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CoverWeights {
    /// The part under snow.
    pub snow: f64,
    /// The part under plants, also their density as a part of the greatest.
    pub plants: f64,
    /// The bare part.
    pub rock: f64,
}

/// The layer of rock at a place: its material, the one it goes over to, and how much of that is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StratumMix {
    /// Material of the layer.
    pub material: u32,
    /// Material of the layer above.
    pub next: u32,
    /// The part of that, 0 to 1.
    pub part: f64,
}

impl TerrainCover {
    /// Checks every number.
    ///
    /// # Errors
    /// [`TerrainError::Parameter`] names the first that is out of range.
    pub fn check(&self) -> Result<(), TerrainError> {
        const MOST: f64 = 1e12;
        in_range("snow line", self.snow_line, [-MOST, MOST])?;
        in_range("snow edge", self.snow_edge, [f64::MIN_POSITIVE, MOST])?;
        in_range("snow slope", self.snow_slope, [f64::MIN_POSITIVE, MOST])?;
        in_range("tree line", self.tree_line, [-MOST, MOST])?;
        in_range("tree edge", self.tree_edge, [f64::MIN_POSITIVE, MOST])?;
        in_range("plant slope", self.plant_slope, [f64::MIN_POSITIVE, MOST])?;
        in_range("half wetness", self.half_wetness, [f64::MIN_POSITIVE, 1.0])?;
        in_range("strata base", self.strata_base, [-MOST, MOST])?;
        in_range("strata edge", self.strata_edge, [0.0, 1.0])?;
        for dip in self.strata_dip {
            in_range("strata dip", dip, [-MOST, MOST])?;
        }
        self.strata.iter().try_for_each(|layer| in_range("thickness", layer.thickness, [f64::MIN_POSITIVE, MOST]))
    }

    /// What covers a place.
    ///
    /// - `height`: y, units of length. `slope`: length of the gradient, height over length, 0 and more. `wetness`: 0
    ///   to 1.
    pub fn weights(&self, height: f64, slope: f64, wetness: f64) -> CoverWeights {
        let above = |line: f64, edge: f64| smooth((height - line) / (2.0 * edge) + 0.5);
        let held = |most: f64| 1.0 - smooth(slope / most - 1.0);
        let snow = above(self.snow_line, self.snow_edge) * held(self.snow_slope);
        // Saturation as of Michaelis and Menten, and 1 where it is as wet as can be.
        let wet = wetness.clamp(0.0, 1.0);
        let grown = wet * (1.0 + self.half_wetness) / (wet + self.half_wetness);
        let plants = (1.0 - above(self.tree_line, self.tree_edge)) * held(self.plant_slope) * grown * (1.0 - snow);
        CoverWeights { snow, plants, rock: 1.0 - snow - plants }
    }

    /// The layer of rock at a place; none where there are no layers.
    ///
    /// - `at`: x, y and z.
    pub fn stratum(&self, at: glam::DVec3) -> Option<StratumMix> {
        let all: f64 = self.strata.iter().map(|layer| layer.thickness).sum();
        let level = at.y - self.strata_base - self.strata_dip[0] * at.x - self.strata_dip[1] * at.z;
        let mut within = level.rem_euclid(all);
        let last = self.strata.len().checked_sub(1)?;
        let mut number = 0;
        while number < last && within >= self.strata[number].thickness {
            within -= self.strata[number].thickness;
            number += 1;
        }
        let layer = self.strata[number];
        let edge = self.strata_edge * layer.thickness;
        let left = layer.thickness - within;
        let part = if edge > 0.0 { smooth(1.0 - left / edge) } else { 0.0 };
        let next = self.strata[(number + 1) % self.strata.len()].material;
        Some(StratumMix { material: layer.material, next, part })
    }
}

/// From 0 to 1 as `t` goes from 0 to 1, with a continuous slope.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
