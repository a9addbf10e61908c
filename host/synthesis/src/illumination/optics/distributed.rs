//! A fraction of light, distributed by a D of the family or by a table; Phong's highlight is one of them.

use super::context::{BsdfSample, ShadingContext};
use super::lobe::{Flags, Lobe};
use super::prepared_textures::PreparedPaint;
use crate::color::Channels;
use crate::illumination::distribution::{Distribution, NormalisedPhong};
use glam::DVec3;
use std::sync::Arc;

/// Reflects a fraction of light as a distribution has it.
#[derive(Clone, Debug)]
pub(super) struct DistributedLobe<D> {
    pub(super) fraction: PreparedPaint,
    pub(super) distribution: D,
}

/// Whatever holds the distribution of a lobe.
pub(super) trait HasDistribution {
    /// The distribution.
    fn distribution(&self) -> &dyn Distribution;
}

impl HasDistribution for NormalisedPhong {
    #[inline]
    fn distribution(&self) -> &dyn Distribution {
        self
    }
}

impl HasDistribution for Arc<dyn Distribution> {
    #[inline]
    fn distribution(&self) -> &dyn Distribution {
        self.as_ref()
    }
}

impl<D: HasDistribution> Lobe for DistributedLobe<D> {
    fn flags(&self) -> Flags {
        let pdf = self.distribution.distribution().pdf(DVec3::Z, DVec3::Z);
        Flags::of_pdf(pdf) | Flags::BLACK.when(self.fraction.is_black())
    }

    #[inline]
    fn value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        if context.is_behind(light) {
            return Channels::ZERO;
        }
        let view = context.view;
        self.fraction.of(context) * (self.distribution.distribution().density(light, view) / view.z)
    }

    #[inline]
    fn pdf(&self, context: &ShadingContext, light: DVec3) -> f64 {
        if context.is_behind(light) { 0.0 } else { self.distribution.distribution().pdf(context.view, light) }
    }

    fn sample(&self, context: &ShadingContext, _: f64, point: [f64; 2]) -> Option<BsdfSample> {
        self.distribution.distribution().sample(context.view, point).map(BsdfSample::unweighted)
    }

    #[inline]
    fn strength(&self, context: &ShadingContext) -> f64 {
        self.fraction.of(context).max()
    }
}
