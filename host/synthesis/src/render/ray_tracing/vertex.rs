//! A path vertex: a surface interaction as light and further segments are sampled there.

use super::sampler::PathSampler;
use crate::color::Channels;
use crate::illumination::distribution::ShadingFrame;
use crate::illumination::optics::{LobeSelection, ShadingContext};
use crate::render::world::{Media, SurfaceInteraction};

/// A surface interaction of a path, with the frame in which its BSDF has directions.
pub(super) struct PathVertex<'a> {
    pub(super) interaction: &'a SurfaceInteraction<'a>,
    /// The media behind it.
    pub(super) media_behind: Media,
    pub(super) frame: ShadingFrame,
    pub(super) context: ShadingContext<'a>,
    /// The random numbers of the sample.
    pub(super) sampler: PathSampler,
    /// The number of the path segment that hit it.
    pub(super) segment: u32,
    /// The lobes among which a direction is sampled: not those of mirrors, if all of these are traced beside it.
    pub(super) selection: LobeSelection,
    /// The greatest value with which it may reflect a lamp, 1/sr.
    pub(super) clamp_value: f64,
    /// Whether lamps that emit photons count nothing.
    pub(super) is_in_photon_map: bool,
    /// Throughput of the path segment, where wavelengths separate: in the one lane that is left.
    pub(super) lane_throughput: Channels,
}

/// Weight of a light that a path segment hits; the rest is brought by light sampling.
///
/// w = p² / (p² + q²)
///
/// - `bsdf_pdf`: p, of the direction by the BSDF, 1/sr; none where there was no choice.
/// - `light_pdf`: q, of the direction by sampling the light, 1/sr.
///
/// # Source
/// Veach and Guibas 1995, the power heuristic.
pub(super) fn power_heuristic(bsdf_pdf: Option<f64>, light_pdf: f64) -> f64 {
    match bsdf_pdf {
        None => 1.0,
        Some(pdf) => {
            let ratio = light_pdf / pdf;
            if ratio.is_finite() { 1.0 / (1.0 + ratio * ratio) } else { 0.0 }
        }
    }
}
