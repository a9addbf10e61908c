//! Lambert's lobe behind the surface: light from there comes through alike to everywhere.

use super::context::{BsdfSample, ShadingContext};
use super::diffuse::cosine_sample;
use super::lobe::{Flags, Lobe};
use super::prepared_textures::PreparedPaint;
use crate::color::Channels;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Lets a fraction of light through, alike to everywhere on the other side.
#[derive(Clone, Debug)]
pub(super) struct TranslucentLobe(pub(super) PreparedPaint);

/// Whether light comes from the side on which the viewer is not.
#[inline]
fn is_beyond(context: &ShadingContext, light: DVec3) -> bool {
    light.z < 0.0 && context.view.z > 0.0
}

impl Lobe for TranslucentLobe {
    fn flags(&self) -> Flags {
        Flags::BROAD | Flags::TRANSLUCENT | Flags::BLACK.when(self.0.is_black())
    }

    #[inline]
    fn value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        if is_beyond(context, light) { self.0.of(context) * FRAC_1_PI } else { Channels::ZERO }
    }

    #[inline]
    fn pdf(&self, context: &ShadingContext, light: DVec3) -> f64 {
        if is_beyond(context, light) { -light.z * FRAC_1_PI } else { 0.0 }
    }

    fn sample(&self, _: &ShadingContext, _: f64, point: [f64; 2]) -> Option<BsdfSample> {
        cosine_sample(point).map(|sample| BsdfSample { light: DVec3 { z: -sample.light.z, ..sample.light }, ..sample })
    }

    #[inline]
    fn diffuse_transmittance(&self, context: &ShadingContext) -> Channels {
        self.0.of(context)
    }

    #[inline]
    fn strength(&self, context: &ShadingContext) -> f64 {
        self.0.of(context).max()
    }
}
