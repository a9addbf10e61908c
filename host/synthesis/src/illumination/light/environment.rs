//! A sky as a light.

use super::Sky;
use super::emitter::Emitter;
use super::light_sample::{EmissionSample, LightHit, LightOrigin, LightPoint, LightSample};
use crate::color::{Channels, SpectralTable};
use crate::numeric::ray::Ray;
use glam::DVec3;
use std::f64::consts::PI;

/// A sky, or a disc in it.
#[derive(Clone, Debug)]
pub(super) struct EnvironmentLight {
    pub(super) sky: Box<Sky>,
    /// Factor of its map, as light.
    pub(super) strength: SpectralTable,
}

impl Emitter for EnvironmentLight {
    fn sample_incident(
        &self,
        point: DVec3,
        normal: Option<DVec3>,
        uniform: [f64; 2],
        wavelength_set: usize,
    ) -> Option<LightSample> {
        let (towards, pdf) = self.sky.sample(point, normal, uniform)?;
        let irradiance = self.sky.radiance(towards, wavelength_set) * pdf.recip();
        Some(LightSample { towards, distance: f64::INFINITY, irradiance, pdf: Some(pdf) })
    }

    fn points(&self, _: u32) -> Vec<LightPoint> {
        self.sky.disc().map(LightPoint::towards).into_iter().collect()
    }

    fn origin(&self) -> LightOrigin {
        LightOrigin::Everywhere
    }

    fn sample_emission(&self, uniform: [f64; 2], wavelength_set: usize) -> Option<EmissionSample> {
        let (towards, pdf) = self.sky.sample_emission(uniform)?;
        let irradiance = self.sky.radiance(towards, wavelength_set) * pdf.recip();
        Some(EmissionSample::Parallel { direction: -towards, irradiance })
    }

    fn intensity(&self, _: Option<DVec3>, _: DVec3, wavelength_set: usize) -> Channels {
        self.strength.of(wavelength_set)
    }

    fn power(&self, radius: f64, wavelength_set: usize) -> Channels {
        let disc = PI * radius * radius;
        self.sky.total(wavelength_set) * disc
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

    fn sky_radiance(&self, ray: &Ray, normal: Option<DVec3>, wavelength_set: usize) -> Option<LightHit> {
        let Ray { origin, direction: towards } = *ray;
        if self.sky.is_beside(towards) {
            return None;
        }
        let (radiance, pdf) = (self.sky.radiance(towards, wavelength_set), self.sky.pdf(origin, towards, normal));
        Some(LightHit { t: f64::INFINITY, radiance, pdf })
    }
}
