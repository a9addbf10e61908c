//! Lambert's lobe: equal radiance everywhere.

use super::context::{BsdfSample, ShadingContext};
use super::lobe::{Flags, Lobe};
use super::prepared_textures::PreparedPaint;
use crate::color::Channels;
use crate::numeric::sampling::cosine_hemisphere;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Reflects a fraction of light alike to everywhere.
#[derive(Clone, Debug)]
pub(super) struct DiffuseLobe(pub(super) PreparedPaint);

/// A direction of light in proportion to its cosine.
pub(super) fn cosine_sample(point: [f64; 2]) -> Option<BsdfSample> {
    Some(cosine_hemisphere(point, DVec3::Z)).filter(|light| light.z > 0.0).map(BsdfSample::unweighted)
}

/// The pdf of [`cosine_sample`], 1/sr.
#[inline]
pub(super) fn cosine_pdf(context: &ShadingContext, light: DVec3) -> f64 {
    if context.is_behind(light) { 0.0 } else { light.z * FRAC_1_PI }
}

impl Lobe for DiffuseLobe {
    fn flags(&self) -> Flags {
        Flags::BROAD | Flags::DIFFUSE | Flags::EVEN | Flags::BLACK.when(self.0.is_black())
    }

    #[inline]
    fn value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        if context.is_behind(light) { Channels::ZERO } else { self.0.of(context) * FRAC_1_PI }
    }

    #[inline]
    fn pdf(&self, context: &ShadingContext, light: DVec3) -> f64 {
        cosine_pdf(context, light)
    }

    fn sample(&self, _: &ShadingContext, _: f64, point: [f64; 2]) -> Option<BsdfSample> {
        cosine_sample(point)
    }

    #[inline]
    fn strength(&self, context: &ShadingContext) -> f64 {
        self.0.of(context).max()
    }

    fn diffuse_albedo(&self, context: &ShadingContext) -> Channels {
        self.0.of(context)
    }
}
