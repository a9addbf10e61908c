//! A mirror that reflects a fraction of light.

use super::context::{BsdfSample, ShadingContext};
use super::lobe::{Flags, Lobe};
use super::prepared_textures::PreparedPaint;
use crate::color::Channels;

/// Reflects a fraction of light in one direction.
#[derive(Clone, Debug)]
pub(super) struct MirrorLobe(pub(super) PreparedPaint);

impl Lobe for MirrorLobe {
    fn flags(&self) -> Flags {
        Flags::DELTA | Flags::BLACK.when(self.0.is_black())
    }

    #[inline]
    fn strength(&self, context: &ShadingContext) -> f64 {
        self.0.of(context).max()
    }

    fn specular_samples(&self, context: &ShadingContext) -> [Option<BsdfSample>; 2] {
        [Some(BsdfSample::specular(context.mirror_direction(), self.0.of(context))), None]
    }

    fn glossy_albedo(&self, context: &ShadingContext) -> Channels {
        self.0.of(context)
    }
}

/// Mirrors for the contract of all lobes.
#[cfg(test)]
pub(super) fn tried() -> Vec<MirrorLobe> {
    vec![MirrorLobe(PreparedPaint::Plain(crate::color::WavelengthSets::bands().constant(0.6)))]
}
