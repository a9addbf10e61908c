//! A point that emits a cone of light, which fades towards its edge.

use super::emitter::Emitter;
use super::light_sample::{EmissionSample, LightOrigin, LightPoint, LightSample, from_point};
use crate::color::{Channels, SpectralTable};
use glam::DVec3;
use std::f64::consts::TAU;

/// A spot light.
#[derive(Clone, Debug)]
pub(super) struct SpotLight {
    pub(super) at: DVec3,
    /// The direction of the cone, unit length.
    pub(super) axis: DVec3,
    /// Cosine of the angle where the light begins to fall.
    pub(super) inner: f64,
    /// Cosine of the angle where there is none.
    pub(super) outer: f64,
    /// Radiant intensity on the axis, W/sr.
    pub(super) strength: SpectralTable,
}

impl SpotLight {
    /// The part of the intensity at an angle to the axis.
    fn part(&self, cosine: f64) -> f64 {
        let part = ((cosine - self.outer) / (self.inner - self.outer)).clamp(0.0, 1.0);
        part * part * (3.0 - 2.0 * part)
    }
}

impl Emitter for SpotLight {
    fn sample_incident(
        &self,
        point: DVec3,
        _: Option<DVec3>,
        _: [f64; 2],
        wavelength_set: usize,
    ) -> Option<LightSample> {
        let light_sample = from_point(self.at - point, self.strength.of(wavelength_set))?;
        let part = self.part(-light_sample.towards.dot(self.axis));
        (part > 0.0).then(|| LightSample { irradiance: light_sample.irradiance * part, ..light_sample })
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

    fn intensity(&self, _: Option<DVec3>, direction: DVec3, wavelength_set: usize) -> Channels {
        self.strength.of(wavelength_set) * self.part(direction.dot(self.axis))
    }

    fn power(&self, _: f64, wavelength_set: usize) -> Channels {
        self.strength.of(wavelength_set) * (TAU * (1.0 - 0.5 * (self.inner + self.outer)))
    }

    fn cone(&self) -> Option<(DVec3, DVec3, f64)> {
        Some((self.at, self.axis, self.outer))
    }
}
