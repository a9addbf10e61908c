//! Lambert's lobe: equal radiance everywhere.

use super::lobe::{Flags, Lobe};
use super::shade::Shade;
use super::sighting::{Onward, Sighting};
use crate::color::Channels;
use crate::numeric::sampling::cosine_hemisphere;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Reflects a fraction of light alike to everywhere.
#[derive(Clone, Debug)]
pub(super) struct Diffuse(pub(super) Shade);

/// A direction of light in proportion to its cosine.
pub(super) fn cosine_sample(point: [f64; 2]) -> Option<Onward> {
    Some(cosine_hemisphere(point, DVec3::Z)).filter(|light| light.z > 0.0).map(Onward::spread)
}

/// The density of [`cosine_sample`], 1/sr.
#[inline]
pub(super) fn cosine_density(sighting: &Sighting, light: DVec3) -> f64 {
    if sighting.is_behind(light) { 0.0 } else { light.z * FRAC_1_PI }
}

impl Lobe for Diffuse {
    fn flags(&self) -> Flags {
        Flags::BROAD | Flags::DIFFUSE | Flags::EVEN | Flags::BLACK.when(self.0.is_black())
    }

    #[inline]
    fn value(&self, sighting: &Sighting, light: DVec3) -> Channels {
        if sighting.is_behind(light) { Channels::ZERO } else { self.0.of(sighting) * FRAC_1_PI }
    }

    #[inline]
    fn density(&self, sighting: &Sighting, light: DVec3) -> f64 {
        cosine_density(sighting, light)
    }

    fn sample(&self, _: &Sighting, _: f64, point: [f64; 2]) -> Option<Onward> {
        cosine_sample(point)
    }

    #[inline]
    fn strength(&self, sighting: &Sighting) -> f64 {
        self.0.of(sighting).max()
    }

    fn diffuse(&self, sighting: &Sighting) -> Channels {
        self.0.of(sighting)
    }
}
