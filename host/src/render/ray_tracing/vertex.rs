//! An element that a ray met, as light and further rays are asked for there.

use super::sampler::PathSampler;
use crate::color::Channels;
use crate::illumination::distribution::ShadingFrame;
use crate::illumination::optics::{LobeSelection, ShadingContext};
use crate::render::world::{Media, SurfaceInteraction};

/// An element that a ray met, with the frame in which its optics has directions.
pub(super) struct PathVertex<'a> {
    pub(super) interaction: &'a SurfaceInteraction<'a>,
    /// What a ray is in that goes through it.
    pub(super) media_behind: Media,
    pub(super) frame: ShadingFrame,
    pub(super) context: ShadingContext<'a>,
    /// The choices of the sample.
    pub(super) sampler: PathSampler,
    /// The number of the path segment that met it.
    pub(super) segment: u32,
    /// Among which lobes a direction is drawn: not among those of mirrors, if all of these are followed beside it.
    pub(super) selection: LobeSelection,
    /// The greatest value with which it may reflect a lamp, 1/sr.
    pub(super) clamp_value: f64,
    /// Whether lamps that were followed count nothing.
    pub(super) is_in_photon_map: bool,
    /// How much of the radiance along the path segment comes to the eye, where wavelengths part: in the one lane that
    /// is left.
    pub(super) lane_throughput: Channels,
}

/// How much a light counts that a path segment of a density meets: the rest is what its own samples bring.
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
