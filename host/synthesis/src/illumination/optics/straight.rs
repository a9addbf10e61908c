//! Transmission straight through, as if nothing was there.

use super::context::{BsdfSample, ShadingContext};
use super::lobe::{Flags, Lobe};
use super::prepared_textures::PreparedPaint;

/// Lets a fraction of light straight through.
#[derive(Clone, Debug)]
pub(super) struct StraightLobe(pub(super) PreparedPaint);

impl Lobe for StraightLobe {
    fn flags(&self) -> Flags {
        Flags::DELTA | Flags::STRAIGHT | Flags::BLACK.when(self.0.is_black())
    }

    #[inline]
    fn strength(&self, context: &ShadingContext) -> f64 {
        self.0.of(context).max()
    }

    fn specular_samples(&self, context: &ShadingContext) -> [Option<BsdfSample>; 2] {
        [Some(BsdfSample { is_straight: true, ..BsdfSample::specular(-context.view, self.0.of(context)) }), None]
    }
}
