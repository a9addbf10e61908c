//! A rectangle of ground whose heights are a fractal.

use crate::procedural::terrain::{FractalKind, FractalParameters, HeightFunction};
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// Octaves of the noise by which places are moved.
const WARP_OCTAVES: f64 = 3.0;
/// The noises by which places are moved differ from that of the heights, and from one another, by this in their seeds.
const WARP_SEEDS: [f64; 2] = [7919.0, 104_729.0];

/// Ground around the origin whose height is a fractal of x and z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FractalGround {
    /// The kind of fractal.
    pub kind: FractalKind,
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
    pub fn function(&self) -> HeightFunction {
        let heights = HeightFunction::fractal(self.kind, self.parameters);
        if self.warp == 0.0 {
            return heights;
        }
        let [along_x, along_z] = WARP_SEEDS.map(|apart| {
            let seed = (self.parameters.seed + apart) % FractalParameters::MOST_SEED;
            let octaves = self.parameters.octaves.min(WARP_OCTAVES);
            let parameters = FractalParameters { octaves, seed, height: self.warp, ..self.parameters };
            HeightFunction::fractal(FractalKind::Fbm, parameters)
        });
        heights.warped(along_x, along_z)
    }

    /// Least and greatest x and z.
    pub fn region(&self) -> [DVec2; 2] {
        let half = 0.5 * DVec2::from(self.size);
        [-half, half]
    }
}
