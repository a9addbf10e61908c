//! A part of a principled material as a lobe.

use super::super::context::{BsdfSample, ShadingContext};
use super::super::lobe::{Flags, Lobe, NARROW};
use super::surface::{PrincipledPart, PrincipledSurface};
use crate::color::Channels;
use glam::DVec3;
use std::sync::Arc;

/// One of the parts of a surface, which share its tables.
#[derive(Clone, Debug)]
pub(in crate::illumination::optics) struct PrincipledLobe {
    pub(in crate::illumination::optics) part: PrincipledPart,
    pub(in crate::illumination::optics) surface: Arc<PrincipledSurface>,
}

impl PrincipledLobe {
    fn is_clear(&self) -> bool {
        self.part == PrincipledPart::Facets && self.surface.is_mirror(self.part) && self.surface.transmits()
    }
}

impl Lobe for PrincipledLobe {
    fn flags(&self) -> Flags {
        let PrincipledLobe { part, surface } = self;
        Flags::BROAD.when(surface.is_broad(*part, NARROW))
            | Flags::DIFFUSE.when(*part == PrincipledPart::Spread && !surface.transmits())
            | Flags::DELTA.when(surface.is_mirror(*part))
            | Flags::CLEAR.when(self.is_clear())
            | Flags::PANE.when(*part == PrincipledPart::Facets && surface.is_pane())
    }

    fn value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        self.surface.value(self.part, context, light)
    }

    fn pdf(&self, context: &ShadingContext, light: DVec3) -> f64 {
        self.surface.pdf(self.part, context, light)
    }

    fn sample(&self, context: &ShadingContext, choice: f64, point: [f64; 2]) -> Option<BsdfSample> {
        match self.surface.is_mirror(self.part) {
            true => self.surface.specular_sample(self.part, context, choice),
            false => self.surface.sample(self.part, context, choice, point).map(BsdfSample::unweighted),
        }
    }

    fn strength(&self, context: &ShadingContext) -> f64 {
        self.surface.strength(self.part, context)
    }

    fn specular_samples(&self, context: &ShadingContext) -> [Option<BsdfSample>; 2] {
        self.surface.specular_samples(self.part, context)
    }

    fn diffuse_albedo(&self, context: &ShadingContext) -> Channels {
        self.surface.diffuse_albedo(self.part, context)
    }

    fn glossy_albedo(&self, context: &ShadingContext) -> Channels {
        self.surface.glossy_albedo(self.part, context)
    }

    fn clear_transmittance(&self, context: &ShadingContext) -> Channels {
        if self.is_clear() { self.surface.straight_transmittance(context) } else { Channels::ZERO }
    }
}
