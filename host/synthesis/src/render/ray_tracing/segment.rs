//! The segments of a path, and the scattering events before them.

use crate::color::Channels;
use crate::illumination::optics::{Bsdf, BsdfSample, ShadingContext};
use crate::render::PathClass;
use crate::render::world::{BoundedRay, Media};
use glam::DVec3;

/// Throughput above which both parts of a path are traced where it splits.
const LEAST_SPLIT: f64 = 1.0 / 64.0;
/// Most path segments of a sample that wait to be traced.
const MOST_WAITING: usize = 8;

/// A segment of a sample's path: one ray with its throughput, its pdf and the history of the path.
#[derive(Clone, Copy)]
pub(super) struct PathSegment {
    pub(super) bounded: BoundedRay,
    /// Throughput: the radiance that arrives at the camera for a radiance of 1 along it.
    pub(super) throughput: Channels,
    /// Part of the light of a lamp that counts if it hits one; below 1 where the lobe was cut off.
    pub(super) lamp_weight: f64,
    /// Where on its ray it begins, scene units: more than 0 behind what it went straight through.
    pub(super) begin: f64,
    /// How many path segments came before it.
    pub(super) depth: u32,
    /// Unlike that of all other path segments of the sample.
    pub(super) number: u32,
    /// The pdf of its direction, 1/sr; none where there was no choice.
    pub(super) pdf: Option<f64>,
    /// The normal of the element from which it starts.
    pub(super) normal: Option<DVec3>,
    pub(super) media: Media,
    /// The only lane that is left, after a dispersive interface separated the wavelengths.
    pub(super) lane: Option<usize>,
    /// Whether it only tests for lights: it is one beyond the depth for anything else.
    pub(super) for_lights: bool,
    /// The scattering events on the path from here to the camera.
    pub(super) history: PathHistory,
    /// The last scattering event.
    pub(super) last_scattering: LastScattering,
    /// Whether lights that emit photons count nothing on it: the photon map has theirs where a narrow lobe precedes a
    /// broad one.
    pub(super) is_in_photon_map: bool,
    /// Whether its hit gives features to a denoiser: it comes from the camera, by mirrors and smooth interfaces alone.
    pub(super) records_features: bool,
}

impl PathSegment {
    /// Whether the path is split where this segment ends: continues by one sample for each specular lobe and one of all
    /// others.
    ///
    /// - `waiting`: how many path segments wait to be traced.
    pub(super) fn is_split(&self, bsdf: &Bsdf, context: &ShadingContext<'_>, waiting: usize) -> bool {
        let is_worth = |sample: BsdfSample| (self.throughput * sample.weight).max() > LEAST_SPLIT;
        let samples = bsdf.specular_samples(context);
        let (count, all_worth) = samples.fold((0, true), |(count, all), sample| (count + 1, all && is_worth(sample)));
        let directions = count + usize::from(bsdf.continues_non_delta());
        directions <= 1 || waiting + directions <= MOST_WAITING && all_worth
    }
}

/// The scattering events on a path, in the order in which light takes them, by the classes of their lobes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PathHistory {
    /// No broad one.
    NoBroad,
    /// A broad one first, and none but narrow ones behind it.
    OneBroad,
    /// Narrow ones first, then a broad one, and none but narrow ones behind it: a light that is hit there makes a
    /// caustic.
    Caustic,
    /// Several broad ones.
    SeveralBroad,
}

impl PathHistory {
    /// The history with a scattering event before those that it has.
    pub(super) fn extended(self, is_broad: bool) -> PathHistory {
        match (self, is_broad) {
            (PathHistory::NoBroad, true) => PathHistory::OneBroad,
            (_, true) => PathHistory::SeveralBroad,
            (PathHistory::OneBroad, false) => PathHistory::Caustic,
            (history, false) => history,
        }
    }

    /// The class of light that leaves a lamp on such a path.
    pub(super) fn class(self) -> PathClass {
        match self {
            PathHistory::NoBroad => PathClass::Emitted,
            PathHistory::OneBroad => PathClass::Direct,
            PathHistory::Caustic => PathClass::Caustic,
            PathHistory::SeveralBroad => PathClass::Indirect,
        }
    }
}

/// The scattering events of a path segment since the last lobe that was not delta.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LastScattering {
    /// No other scattering: the last lobe was not delta.
    NonDelta,
    /// Scattering by polished interfaces only.
    ClearInterface,
    /// Other delta scattering.
    Other,
}
