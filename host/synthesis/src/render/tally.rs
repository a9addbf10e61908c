//! Samples of a pixel, and what they add up to.

use crate::color::srgb::LUMINANCE;
use crate::picture::Pixel;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Below this luminance errors count as if it was this, so that black pixels do not take all the samples.
const LEAST_LUMINANCE: f64 = 0.05;

/// So many samples of a pixel, one after the other, share a photon map; for those after them photons are traced anew.
pub(super) const SHARING: u32 = 8;

/// Light by the classes of its paths to the camera, as light path expressions (Heckbert 1990) tell them apart: each
/// path is in one class.
///
/// Scattering is broad where light is scattered about everywhere, as by Lambert's term (D), and narrow where it is
/// concentrated: by mirrors, glass and highlights (S and G).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathClass {
    /// Light of lamps and skies, straight or by narrow scattering alone.
    Emitted,
    /// Light by one broad scattering, straight from the lamp; narrow ones may follow.
    Direct,
    /// Light by narrow scattering first, and then one broad; narrow ones may follow.
    Caustic,
    /// Light by several broad ones, and ambient light.
    Indirect,
}

impl PathClass {
    /// All classes, in the order of their numbers.
    pub const ALL: [PathClass; 4] = [PathClass::Emitted, PathClass::Direct, PathClass::Caustic, PathClass::Indirect];

    /// The word for it in layers.
    pub fn word(self) -> &'static str {
        match self {
            PathClass::Emitted => "emission",
            PathClass::Direct => "direct",
            PathClass::Caustic => "caustic",
            PathClass::Indirect => "indirect",
        }
    }
}

/// Radiance of each class, linear sRGB.
pub type RadianceByClass = [DVec3; PathClass::ALL.len()];

/// The sums over the samples of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, bytemuck::Zeroable)]
pub struct Tally {
    /// Sum of radiance, linear sRGB.
    pub sum: DVec3,
    /// Sum of squared luminance.
    pub squares: f64,
    /// Samples.
    pub count: u32,
    /// Sum of the weights of those that hit an object.
    pub covered: f32,
    /// Sum of the distances of the elements that were seen first, scene units.
    pub distances: f64,
    /// Sum of their normals.
    pub normals: DVec3,
    /// How many samples saw an element first.
    pub elements: u32,
    /// Sum of the standard errors of luminance by what samples share.
    pub shared: f32,
    /// Luminance of the samples up to the last power of two before their number, if they came one by one.
    pub early: f64,
    /// Object and its material that the first of them saw.
    pub first_ids: [u32; 2],
}

/// One sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelSample {
    /// Radiance, linear sRGB, times its weight.
    pub radiance: DVec3,
    /// How much it counts in its pixel by the reconstruction filter; 1 on average.
    pub weight: f64,
    /// Whether it hit anything.
    pub covered: bool,
    /// The first element that it saw: distance, normal, object and material.
    pub first: Option<(f64, DVec3, [u32; 2])>,
    /// The albedo that it saw, straight or by mirrors and smooth interfaces, as
    /// [`broad_bands`](crate::color::WavelengthSets::broad_bands) bands; 0 unless a denoiser needs it.
    pub albedo: DVec3,
    /// The normals there, each times the throughput; 0 unless a denoiser needs them.
    pub normal: DVec3,
    /// Standard error of its luminance by what it shares with the samples before and after it: the photon map of all of
    /// them.
    pub shared: f64,
}

impl Default for PixelSample {
    fn default() -> PixelSample {
        let (radiance, albedo, normal) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        PixelSample { radiance, weight: 1.0, covered: false, first: None, albedo, normal, shared: 0.0 }
    }
}

impl Tally {
    /// Adds a sample; one that is not a number is taken for black.
    pub fn add(&mut self, sample: &PixelSample) {
        if self.count.is_power_of_two() {
            self.early = self.sum.dot(LUMINANCE);
        }
        self.add_alike(sample, 1);
    }

    /// Adds several samples that are the same.
    #[inline]
    pub fn add_alike(&mut self, sample: &PixelSample, count: u32) {
        let radiance = if sample.radiance.is_finite() { sample.radiance } else { DVec3::ZERO };
        let times = f64::from(count);
        self.sum += radiance * times;
        self.squares += radiance.dot(LUMINANCE).powi(2) * times;
        self.count += count;
        self.covered += if sample.covered { (sample.weight * times) as f32 } else { 0.0 };
        if sample.shared.is_finite() {
            self.shared += (sample.shared * times) as f32;
        }
        if let Some((distance, normal, seen)) = sample.first {
            if self.elements == 0 {
                self.first_ids = seen;
            }
            self.distances += distance * times;
            self.normals += normal * times;
            self.elements += count;
        }
    }

    /// Mean radiance; black without samples.
    pub fn mean(&self) -> DVec3 {
        self.sum / f64::from(self.count.max(1))
    }

    /// The part of the pixel that objects cover, as the reconstruction filter counts it.
    pub fn coverage(&self) -> f64 {
        f64::from(self.covered) / f64::from(self.count.max(1))
    }

    /// The pixel so far; black and uncovered without samples.
    pub fn pixel(&self) -> Pixel {
        Pixel { radiance: self.mean().as_vec3().to_array(), coverage: self.coverage() as f32 }
    }

    /// Variance of the mean luminance, as if samples and photon paths were independent: evenly spread ones are better.
    /// What some of them share is added: a photon map is wrong by the same for all of these.
    pub fn variance(&self) -> f64 {
        if self.count < 2 {
            return f64::INFINITY;
        }
        let count = f64::from(self.count);
        let mean = self.sum.dot(LUMINANCE) / count;
        (self.squares / count - mean * mean).max(0.0) / (count - 1.0) + self.shared_variance()
    }

    /// Variance of the mean luminance by the difference of its halves, the first to the last power of two and the rest;
    /// none without two samples that came one by one.
    ///
    /// That samples are evenly spread is in it, and what they share as far as halves do not share it. Of a single pixel
    /// it tells little.
    pub(super) fn variance_of_halves(&self) -> Option<f64> {
        let early = 1u32 << self.count.checked_sub(1)?.checked_ilog2()?;
        let (early, count) = (f64::from(early), f64::from(self.count));
        let late = count - early;
        let difference = (self.sum.dot(LUMINANCE) - self.early) / late - self.early / early;
        let shared = if self.count <= SHARING { self.shared_variance() } else { 0.0 };
        Some(difference * difference * early * late / (count * count) + shared)
    }

    /// Variance of the mean luminance by what samples share.
    fn shared_variance(&self) -> f64 {
        let count = f64::from(self.count.max(1));
        (f64::from(self.shared) / count).powi(2) * f64::from(SHARING.min(self.count)) / count
    }

    /// Standard error of the mean luminance over the luminance.
    pub fn relative_error(&self) -> f64 {
        self.variance().sqrt() / self.mean().dot(LUMINANCE).abs().max(LEAST_LUMINANCE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(value: f64) -> PixelSample {
        PixelSample { radiance: DVec3::splat(value), covered: true, ..PixelSample::default() }
    }

    #[test]
    fn the_error_of_a_mean_is_that_of_its_samples() {
        let mut tally = Tally::default();
        [1.0, 3.0].iter().for_each(|value| tally.add(&sample(*value)));
        assert!((tally.mean() - DVec3::splat(2.0)).length() < 1e-12 && (tally.variance() - 1.0).abs() < 1e-12);
        assert!((tally.relative_error() - 0.5).abs() < 1e-12);
        tally.add(&PixelSample { radiance: DVec3::NAN, ..sample(0.0) });
        assert!(tally.mean().is_finite() && tally.count == 3);
        assert_eq!(Tally::default().variance(), f64::INFINITY);
    }
}
