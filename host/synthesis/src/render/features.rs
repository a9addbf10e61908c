//! Features of a pixel for the denoiser, beside its tally: what its samples saw behind mirrors and glass, the variance
//! of that, and their first half.

use super::tally::{PixelSample, Tally};
use serde::{Deserialize, Serialize};

/// Sums over the samples of a pixel for a denoiser.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, bytemuck::Zeroable)]
pub struct PixelFeatures {
    /// Sum of the radiance of the samples up to the last power of two before their number, linear sRGB.
    pub early: [f32; 3],
    /// Sum of the squared radiance of all samples.
    pub squares: [f32; 3],
    /// Sum of the albedo that is seen, straight or by mirrors and smooth interfaces; a light counts as 1.
    pub albedo: [f32; 3],
    /// Sum of its squared length.
    pub albedo_squares: f32,
    /// Sum of the normals of what is seen there, each times the throughput.
    pub normal: [f32; 3],
    /// Sum of their squared lengths.
    pub normal_squares: f32,
    /// Sum of the squared distances of the elements that are seen first, squared scene units.
    pub distance_squares: f32,
}

/// Radiance beyond this counts as this in squares, so that these stay numbers.
const MOST: f32 = 1e16;

impl PixelFeatures {
    /// Adds a sample.
    ///
    /// - `before`: the pixel without it.
    pub fn add(&mut self, sample: &PixelSample, before: &Tally) {
        if before.count.is_power_of_two() {
            self.early = before.sum.as_vec3().to_array();
        }
        let radiance = if sample.radiance.is_finite() { sample.radiance.as_vec3() } else { glam::Vec3::ZERO };
        let (albedo, normal) = (sample.albedo.as_vec3(), sample.normal.as_vec3());
        for band in 0..3 {
            self.squares[band] += radiance[band].abs().min(MOST).powi(2);
            self.albedo[band] += albedo[band];
            self.normal[band] += normal[band];
        }
        self.albedo_squares += albedo.length_squared();
        self.normal_squares += normal.length_squared();
        self.distance_squares += sample.first.map_or(0.0, |(distance, ..)| (distance * distance) as f32);
    }
}
