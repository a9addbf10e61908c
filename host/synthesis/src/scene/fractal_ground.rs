//! A rectangle of ground whose heights are a fractal.

use super::kept_grids::KeptGrids;
use crate::procedural::terrain::{FractalKind, FractalParameters, HeightFunction, MidpointDisplacement, TerrainError};
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// Octaves of the noise by which places are moved.
const WARP_OCTAVES: f64 = 3.0;
/// The noises by which places are moved differ from that of the heights, and from one another, by this in their seeds.
const WARP_SEEDS: [f64; 2] = [7919.0, 104_729.0];

/// Heights along the longer side that midpoint displacement makes at the most.
const MOST_HEIGHTS: f64 = 2048.0;

/// How the heights of ground are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GroundKind {
    /// By octaves of noise.
    Noise(FractalKind),
    /// By midpoint displacement, as many times as there are octaves.
    Midpoint,
}

/// The grids of midpoint displacement that were made last.
static KEPT: KeptGrids<FractalGround> = KeptGrids::new();

/// Ground around the origin whose height is a fractal of x and z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FractalGround {
    /// The kind of fractal.
    pub kind: GroundKind,
    /// Its numbers.
    pub parameters: FractalParameters,
    /// Sides of the rectangle along x and z, units of length, above 0.
    pub size: [f64; 2],
    /// How far the ground is drawn aside by another noise, units of length: ridges and valleys are bent; 0 for not at
    /// all.
    pub warp: f64,
}

impl FractalGround {
    /// The height as a function of x and z.
    ///
    /// # Errors
    /// [`TerrainError`] for numbers that midpoint displacement does not take.
    pub fn function(&self) -> Result<HeightFunction, TerrainError> {
        let heights = match self.kind {
            GroundKind::Noise(kind) => HeightFunction::fractal(kind, self.parameters),
            GroundKind::Midpoint => self.displaced()?,
        };
        if self.warp == 0.0 {
            return Ok(heights);
        }
        let [along_x, along_z] = WARP_SEEDS.map(|apart| {
            let seed = (self.parameters.seed + apart) % FractalParameters::MOST_SEED;
            let octaves = self.parameters.octaves.min(WARP_OCTAVES);
            let parameters = FractalParameters { octaves, seed, height: self.warp, ..self.parameters };
            HeightFunction::fractal(FractalKind::Fbm, parameters)
        });
        Ok(heights.warped(along_x, along_z))
    }

    /// The smooth surface through the heights that midpoint displacement gives.
    fn displaced(&self) -> Result<HeightFunction, TerrainError> {
        self.parameters.check()?;
        let FractalParameters { octaves, hurst, scale, height, seed, .. } = self.parameters;
        let longer = DVec2::from(self.size).max_element() + 2.0 * self.warp;
        let enough = libm::floor(libm::log2(MOST_HEIGHTS * scale / longer)).max(0.0);
        let level = (octaves.round() - 1.0).min(enough) as u32;
        let spacing = scale / (1_u64 << level) as f64;
        // A little more around it, which a warp may draw in.
        let half = (0.5 * DVec2::from(self.size) + self.warp) / spacing;
        let first = [half.x, half.y].map(|half| -half.ceil() as i64);
        let size = first.map(|first| 2 * first.unsigned_abs() as usize + 1);
        let displacement = MidpointDisplacement { hurst, scale, height: height.abs(), seed: seed as u64 };
        let key = FractalGround { warp: longer, ..self.clone() };
        Ok(HeightFunction::Grid(KEPT.get(key, || displacement.region(level, first, size))?))
    }

    /// Least and greatest x and z.
    pub fn region(&self) -> [DVec2; 2] {
        let half = 0.5 * DVec2::from(self.size);
        [-half, half]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::procedural::terrain::HeightField;

    fn displaced(octaves: f64, warp: f64) -> FractalGround {
        let parameters =
            FractalParameters { octaves, scale: 8.0, seed: 4.0, hurst: 0.8, ..FractalParameters::default() };
        FractalGround { kind: GroundKind::Midpoint, parameters, size: [20.0, 12.0], warp }
    }

    #[test]
    fn squares_are_divided_as_often_as_asked_and_keep_their_corners() {
        let height = |ground: &FractalGround, at: DVec2| {
            HeightField::new(&ground.function().expect("sound"), ground.region()).expect("sound").height(at, 0.0)
        };
        let corner = DVec2::new(8.0, 0.0);
        let [coarse, fine] = [displaced(3.0, 0.0), displaced(8.0, 0.0)];
        assert!((height(&coarse, corner) - height(&fine, corner)).abs() < 1e-12);
        let beside = DVec2::new(7.3, 0.6);
        assert!(height(&coarse, beside) != height(&fine, beside) && height(&displaced(8.0, 0.5), beside) != 0.0);
        assert!(displaced(32.0, 0.0).function().is_ok(), "no more than there is room for");
    }

    #[test]
    fn numbers_that_it_does_not_take_are_named() {
        let mut rough = displaced(4.0, 0.0);
        rough.parameters.hurst = 1.5;
        assert!(rough.function().unwrap_err().to_string().contains("hurst"));
    }
}
