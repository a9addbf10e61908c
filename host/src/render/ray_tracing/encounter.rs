//! An element that a ray met, as light and further rays are asked for there.

use super::draws::PathSampler;
use crate::color::Channels;
use crate::illumination::distribution::ShadingFrame;
use crate::illumination::optics::{LobeSelection, ShadingContext};
use crate::render::world::{SurfaceInteraction, Media};

/// An element that a ray met, with the frame in which its optics has directions.
pub(super) struct PathVertex<'a> {
    pub(super) found: &'a SurfaceInteraction<'a>,
    /// What a ray is in that goes through it.
    pub(super) behind: Media,
    pub(super) frame: ShadingFrame,
    pub(super) sighting: ShadingContext<'a>,
    /// The choices of the sample.
    pub(super) draws: PathSampler,
    /// The number of the leg that met it.
    pub(super) leg: u32,
    /// Among which lobes a direction is drawn: not among those of mirrors, if all of these are followed beside it.
    pub(super) among: LobeSelection,
    /// The greatest value with which it may reflect a lamp, 1/sr.
    pub(super) highest: f64,
    /// Whether lamps that were followed count nothing.
    pub(super) is_known: bool,
    /// How much of the radiance along the leg comes to the eye, where wavelengths part: in the one lane that is left.
    pub(super) alone: Channels,
}

/// How much a light counts that a leg of a density meets: the rest is what its own samples bring.
///
/// # Source
/// Veach and Guibas 1995, the power heuristic.
pub(super) fn power_heuristic(leg: Option<f64>, light: f64) -> f64 {
    match leg {
        None => 1.0,
        Some(density) => {
            let ratio = light / density;
            if ratio.is_finite() { 1.0 / (1.0 + ratio * ratio) } else { 0.0 }
        }
    }
}
