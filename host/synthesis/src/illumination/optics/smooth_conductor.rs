//! A polished metal.

use super::context::{BsdfSample, ShadingContext};
use super::lobe::{Flags, Lobe};
use crate::color::{Channels, LANES};
use crate::illumination::fresnel::Conductor;
use std::sync::Arc;

/// Reflects Fresnel's part of light in one direction.
#[derive(Clone, Debug)]
pub(super) struct SmoothConductor {
    /// For each wavelength set, lane by lane.
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

    fn strength(&self, _: &ShadingContext) -> f64 {
        1.0
    }

    fn specular_samples(&self, context: &ShadingContext) -> [Option<BsdfSample>; 2] {
        [Some(BsdfSample::specular(context.mirror_direction(), self.glossy_albedo(context))), None]
    }

    fn glossy_albedo(&self, context: &ShadingContext) -> Channels {
        reflectance(&self.conductors[context.wavelength_set.min(self.conductors.len() - 1)], context.view.z)
    }
}
