//! A light without size: a point with a profile of intensities over the directions.

use super::emitter::Emitter;
use super::light_sample::{EmissionSample, LightOrigin, LightPoint, LightSample, from_point};
use crate::color::{Channels, SpectralTable};
use glam::DVec3;
use std::f64::consts::TAU;

/// A point light.
#[derive(Clone, Debug)]
pub(super) struct PointLight<P> {
    pub(super) at: DVec3,
    /// Radiant intensity where the profile is 1, W/sr.
    pub(super) strength: SpectralTable,
    pub(super) profile: P,
}

/// How the intensity of a point changes with the direction.
pub(super) trait AngularProfile {
    /// The part of the strength in a direction in which light leaves, unit length.
    fn part(&self, direction: DVec3) -> f64;

    /// The integral of the part over all directions.
    fn integral(&self) -> f64;

    /// The axis of the cone out of which nothing is sent, and the cosine of its half angle.
    fn cone(&self) -> Option<(DVec3, f64)> {
        None
    }
}

/// Alike in all directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Isotropic;

impl AngularProfile for Isotropic {
    fn part(&self, _: DVec3) -> f64 {
        1.0
    }

    fn integral(&self) -> f64 {
        2.0 * TAU
    }
}

impl<P: AngularProfile> Emitter for PointLight<P> {
    fn sample_incident(
        &self,
        point: DVec3,
        _: Option<DVec3>,
        _: [f64; 2],
        wavelength_set: usize,
    ) -> Option<LightSample> {
        let light_sample = from_point(self.at - point, self.strength.of(wavelength_set))?;
        let part = self.profile.part(-light_sample.towards);
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
        self.strength.of(wavelength_set) * self.profile.part(direction)
    }

    fn power(&self, _: f64, wavelength_set: usize) -> Channels {
        self.strength.of(wavelength_set) * self.profile.integral()
    }

    fn cone(&self) -> Option<(DVec3, DVec3, f64)> {
        self.profile.cone().map(|(axis, cosine)| (self.at, axis, cosine))
    }
}
