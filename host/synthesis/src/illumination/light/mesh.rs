//! Triangles of an object that emits the same radiance on both sides.

use super::emitter::Emitter;
use super::light_sample::{EmissionSample, EmittingSides, LightOrigin, LightPoint, LightSample};
use crate::color::{Channels, SpectralTable};
use crate::numeric::bounds::Bounds;
use glam::DVec3;
use std::f64::consts::TAU;

/// Triangles that emit on both sides, sampled evenly by area.
#[derive(Clone, Debug)]
pub(super) struct MeshLight {
    /// Radiance, W/(m² sr).
    strength: SpectralTable,
    corners: Vec<[DVec3; 3]>,
    /// The part of the area up to each.
    below: Vec<f64>,
    area: f64,
}

impl MeshLight {
    /// A light of triangles; none without area.
    pub(super) fn new(corners: Vec<[DVec3; 3]>, strength: SpectralTable) -> Option<MeshLight> {
        let mut area = 0.0;
        let mut below: Vec<f64> = Vec::with_capacity(corners.len());
        for [a, b, c] in &corners {
            area += 0.5 * (*b - *a).cross(*c - *a).length();
            below.push(area);
        }
        if !(area > 0.0 && area.is_finite()) {
            return None;
        }
        below.iter_mut().for_each(|part| *part /= area);
        Some(MeshLight { strength, corners, below, area })
    }

    /// A point, sampled evenly by area, and the normal there.
    fn point(&self, [x, y]: [f64; 2]) -> (DVec3, DVec3) {
        let index = self.below.partition_point(|part| *part <= x).min(self.below.len() - 1);
        let from = if index == 0 { 0.0 } else { self.below[index - 1] };
        let x = ((x - from) / (self.below[index] - from)).clamp(0.0, 1.0);
        let [a, b, c] = self.corners[index];
        let root = x.sqrt();
        let at = a * (1.0 - root) + b * (root * (1.0 - y)) + c * (root * y);
        (at, (b - a).cross(c - a).normalize_or_zero())
    }

    fn sample(&self, point: DVec3, uniform: [f64; 2]) -> Option<(DVec3, f64, f64)> {
        let (at, normal) = self.point(uniform);
        let offset = at - point;
        let distance = offset.length();
        let towards = offset / distance;
        let pdf = distance * distance / (normal.dot(towards).abs() * self.area);
        (distance > 0.0 && pdf.is_finite() && pdf > 0.0).then_some((towards, distance, pdf))
    }
}

impl Emitter for MeshLight {
    fn sample_incident(
        &self,
        point: DVec3,
        _: Option<DVec3>,
        uniform: [f64; 2],
        wavelength_set: usize,
    ) -> Option<LightSample> {
        let (towards, distance, pdf) = self.sample(point, uniform)?;
        let irradiance = self.strength.of(wavelength_set) * pdf.recip();
        Some(LightSample { towards, distance, irradiance, pdf: Some(pdf) })
    }

    fn points(&self, count: u32) -> Vec<LightPoint> {
        LightPoint::spread(count, |uniform| {
            let (at, normal) = self.point(uniform);
            (at, self.area, Some(normal), EmittingSides::Both)
        })
    }

    #[inline]
    fn incident_from(&self, from: &LightPoint, point: DVec3, wavelength_set: usize) -> Option<LightSample> {
        from.incident(self.strength.of(wavelength_set), point)
    }

    fn origin(&self) -> LightOrigin {
        LightOrigin::Within(Bounds::of(self.corners.iter().flatten().copied()))
    }

    fn sample_emission(&self, uniform: [f64; 2], _: usize) -> Option<EmissionSample> {
        let (at, normal) = self.point(uniform);
        Some(EmissionSample::Point { at, normal: Some(normal), area: self.area })
    }

    fn intensity(&self, normal: Option<DVec3>, direction: DVec3, wavelength_set: usize) -> Channels {
        let strength = self.strength.of(wavelength_set);
        normal.map_or(strength, |normal| strength * (self.area * normal.dot(direction).abs()))
    }

    fn power(&self, _: f64, wavelength_set: usize) -> Channels {
        self.strength.of(wavelength_set) * (TAU * self.area)
    }

    fn is_delta(&self) -> bool {
        false
    }

    fn pdf_on_object(&self, _: DVec3, _: DVec3, distance: f64, cosine: f64) -> f64 {
        if cosine == 0.0 { 0.0 } else { distance * distance / (cosine.abs() * self.area) }
    }

    fn emission_on_object(&self, _: bool, wavelength_set: usize) -> Channels {
        self.strength.of(wavelength_set)
    }
}
