//! Parallel light from infinitely far away.

use super::emitter::Emitter;
use super::light_sample::{EmissionSample, LightOrigin, LightPoint, LightSample};
use crate::color::{Channels, SpectralTable};
use glam::DVec3;
use std::f64::consts::PI;

/// Parallel light.
#[derive(Clone, Debug)]
pub(super) struct DirectionalLight {
    /// Towards the light, unit length.
    pub(super) towards: DVec3,
    /// Irradiance of a surface that faces it, W/m².
    pub(super) strength: SpectralTable,
}

impl Emitter for DirectionalLight {
    fn sample_incident(&self, _: DVec3, _: Option<DVec3>, _: [f64; 2], wavelength_set: usize) -> Option<LightSample> {
        let irradiance = self.strength.of(wavelength_set);
        Some(LightSample { towards: self.towards, distance: f64::INFINITY, irradiance, pdf: None })
    }

    fn points(&self, _: u32) -> Vec<LightPoint> {
        vec![LightPoint::towards(self.towards)]
    }

    fn origin(&self) -> LightOrigin {
        LightOrigin::Towards(self.towards)
    }

    fn sample_emission(&self, _: [f64; 2], wavelength_set: usize) -> Option<EmissionSample> {
        Some(EmissionSample::Parallel { direction: -self.towards, irradiance: self.strength.of(wavelength_set) })
    }

    fn intensity(&self, _: Option<DVec3>, _: DVec3, wavelength_set: usize) -> Channels {
        self.strength.of(wavelength_set)
    }

    fn power(&self, radius: f64, wavelength_set: usize) -> Channels {
        let disc = PI * radius * radius;
        self.strength.of(wavelength_set) * disc
    }
}
