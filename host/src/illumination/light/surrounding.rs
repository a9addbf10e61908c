//! A sky as a light.

use super::Sky;
use super::beam::{LightSample, LightHit, LightPoint, LightOrigin, EmissionSample};
use super::emitter::Emitter;
use crate::color::{Channels, SpectralTable};
use crate::numeric::ray::Ray;
use glam::DVec3;
use std::f64::consts::PI;

/// A sky, or a disc in it.
#[derive(Clone, Debug)]
pub(super) struct EnvironmentLight {
    pub(super) sky: Box<Sky>,
    /// What its map is multiplied with, as light.
    pub(super) strength: SpectralTable,
}

impl Emitter for EnvironmentLight {
    fn sample_incident(&self, point: DVec3, normal: Option<DVec3>, uniform: [f64; 2], comb: usize) -> Option<LightSample> {
        let (towards, density) = self.sky.sample(point, normal, uniform)?;
        let irradiance = self.sky.radiance(towards, comb) * density.recip();
        Some(LightSample { towards, distance: f64::INFINITY, irradiance, density: Some(density) })
    }

    fn points(&self, _: u32) -> Vec<LightPoint> {
        self.sky.disc().map(LightPoint::towards).into_iter().collect()
    }

    fn origin(&self) -> LightOrigin {
        LightOrigin::Everywhere
    }

    fn sample_emission(&self, uniform: [f64; 2], comb: usize) -> Option<EmissionSample> {
        let (towards, density) = self.sky.sample_emission(uniform)?;
        let irradiance = self.sky.radiance(towards, comb) * density.recip();
        Some(EmissionSample::Parallel { direction: -towards, irradiance })
    }

    fn intensity(&self, _: Option<DVec3>, _: DVec3, comb: usize) -> Channels {
        self.strength.of(comb)
    }

    fn power(&self, radius: f64, comb: usize) -> Channels {
        let disc = PI * radius * radius;
        self.sky.total(comb) * disc
    }

    fn is_delta(&self) -> bool {
        false
    }

    fn emits_photons(&self) -> bool {
        !self.sky.is_even()
    }

    fn is_infinite(&self) -> bool {
        true
    }

    fn is_sky(&self) -> bool {
        self.sky.disc().is_none()
    }

    fn sky_radiance(&self, ray: &Ray, normal: Option<DVec3>, comb: usize) -> Option<LightHit> {
        let Ray { origin, direction: towards } = *ray;
        if self.sky.is_beside(towards) {
            return None;
        }
        let (radiance, density) = (self.sky.radiance(towards, comb), self.sky.pdf(origin, towards, normal));
        Some(LightHit { t: f64::INFINITY, radiance, density })
    }
}
