//! A polished metal.

use super::lobe::{Flags, Lobe};
use super::sighting::{BsdfSample, ShadingContext};
use crate::color::{Channels, LANES};
use crate::illumination::fresnel::Conductor;
use glam::DVec3;
use std::sync::Arc;

/// Reflects Fresnel's part of light in one direction.
#[derive(Clone, Debug)]
pub(super) struct SmoothConductor {
    /// For each set of wavelengths, lane by lane.
    pub(super) conductors: Arc<Vec<[Conductor; LANES]>>,
}

/// Fresnel's term of a metal, lane by lane.
pub(super) fn reflectance(metal: &[Conductor; LANES], cosine: f64) -> Channels {
    Channels(metal.map(|conductor| conductor.reflectance(cosine).mean()))
}

impl Lobe for SmoothConductor {
    fn flags(&self) -> Flags {
        Flags::DELTA
    }

    fn value(&self, _: &ShadingContext, _: DVec3) -> Channels {
        Channels::ZERO
    }

    fn density(&self, _: &ShadingContext, _: DVec3) -> f64 {
        0.0
    }

    fn sample(&self, sighting: &ShadingContext, _: f64, _: [f64; 2]) -> Option<BsdfSample> {
        self.mirrored(sighting)[0]
    }

    fn strength(&self, _: &ShadingContext) -> f64 {
        1.0
    }

    fn mirrored(&self, sighting: &ShadingContext) -> [Option<BsdfSample>; 2] {
        [Some(BsdfSample::single(sighting.mirrored(), self.shown(sighting))), None]
    }

    fn shown(&self, sighting: &ShadingContext) -> Channels {
        reflectance(&self.conductors[sighting.comb.min(self.conductors.len() - 1)], sighting.view.z)
    }
}
