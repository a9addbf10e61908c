//! A point that emits alike in all directions.

use super::emitter::Emitter;
use super::light_sample::{EmissionSample, LightOrigin, LightPoint, LightSample, from_point};
use crate::color::{Channels, SpectralTable};
use glam::DVec3;
use std::f64::consts::TAU;

/// A point light.
#[derive(Clone, Debug)]
pub(super) struct PointLight {
    pub(super) at: DVec3,
    /// Radiant intensity, W/sr.
    pub(super) strength: SpectralTable,
}

impl Emitter for PointLight {
    fn sample_incident(
        &self,
        point: DVec3,
        _: Option<DVec3>,
        _: [f64; 2],
        wavelength_set: usize,
    ) -> Option<LightSample> {
        from_point(self.at - point, self.strength.of(wavelength_set))
    }

    fn points(&self, _: u32) -> Vec<LightPoint> {
        vec![LightPoint::at(self.at)]
    }

    fn origin(&self) -> LightOrigin {
        LightOrigin::point(self.at)
    }

    fn sample_emission(&self, _: [f64; 2], _: usize) -> Option<EmissionSample> {
        Some(EmissionSample::Point { at: self.at, normal: None, area: 0.0 })
    }

    fn intensity(&self, _: Option<DVec3>, _: DVec3, wavelength_set: usize) -> Channels {
        self.strength.of(wavelength_set)
    }

    fn power(&self, _: f64, wavelength_set: usize) -> Channels {
        self.strength.of(wavelength_set) * (2.0 * TAU)
    }
}
