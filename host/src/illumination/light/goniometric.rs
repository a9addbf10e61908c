//! A luminaire that was measured: a point whose intensity is a table over the directions.

use super::Goniometry;
use super::emitter::Emitter;
use super::light_sample::{EmissionSample, LightOrigin, LightPoint, LightSample, from_point};
use crate::color::observer::LUMENS_PER_WATT;
use crate::color::{Channels, SpectralTable};
use crate::numeric::cubature::GAUSS;
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Parts of the angles over which the power of a luminaire is summed.
const PARTS: usize = 24;

/// A measured luminaire.
#[derive(Clone, Debug)]
pub(super) struct GoniometricLight {
    pub(super) at: DVec3,
    /// From the axes of the table to those of the scene.
    pub(super) axes: DMat3,
    /// Candelas.
    pub(super) table: Arc<Goniometry>,
    /// Factor of the table.
    pub(super) strength: SpectralTable,
}

impl GoniometricLight {
    /// - `down`: where the vertical angle is 0. `front`: about where the horizontal angle is 0.
    pub(super) fn new(
        at: DVec3,
        [down, front]: [DVec3; 2],
        table: Arc<Goniometry>,
        strength: SpectralTable,
    ) -> GoniometricLight {
        let up = -down.normalize_or(DVec3::NEG_Y);
        let y = up.cross(front).normalize_or(up.any_orthonormal_vector());
        GoniometricLight { at, axes: DMat3::from_cols(y.cross(up), y, up), table, strength }
    }
}

impl Emitter for GoniometricLight {
    fn sample_incident(
        &self,
        point: DVec3,
        _: Option<DVec3>,
        _: [f64; 2],
        wavelength_set: usize,
    ) -> Option<LightSample> {
        let light_sample = from_point(self.at - point, self.strength.of(wavelength_set))?;
        let watts = self.table.candelas(self.axes.transpose() * -light_sample.towards) / LUMENS_PER_WATT;
        (watts > 0.0).then(|| LightSample { irradiance: light_sample.irradiance * watts, ..light_sample })
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
        self.strength.of(wavelength_set) * (self.table.candelas(self.axes.transpose() * direction) / LUMENS_PER_WATT)
    }

    fn power(&self, _: f64, wavelength_set: usize) -> Channels {
        let lumens = over_the_sphere(|direction| self.table.candelas(direction));
        self.strength.of(wavelength_set) * (lumens / LUMENS_PER_WATT)
    }
}

/// The integral of a function of directions.
fn over_the_sphere(function: impl Fn(DVec3) -> f64) -> f64 {
    let part = (PARTS as f64).recip();
    let points =
        || (0..PARTS).flat_map(|k| GAUSS.iter().map(move |(at, weight)| ((k as f64 + at) * part, weight * part)));
    let ring = |(x, weight): (f64, f64)| {
        let (down, sine) = ((PI * x).cos(), (PI * x).sin());
        let along = |(y, weight): (f64, f64)| {
            let (sin, cos) = (TAU * y).sin_cos();
            function(DVec3::new(sine * cos, sine * sin, down)) * weight
        };
        points().map(along).sum::<f64>() * TAU * PI * sine * weight
    };
    points().map(ring).sum()
}
