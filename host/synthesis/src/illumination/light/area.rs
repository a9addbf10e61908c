//! A surface that emits the same radiance in all directions of its front, and is seen.

use super::LightShape;
use super::emitter::Emitter;
use super::light_sample::{EmissionSample, EmittingSides, LightHit, LightOrigin, LightPoint, LightSample};
use crate::color::{Channels, SpectralTable};
use crate::numeric::bounds::Bounds;
use crate::numeric::ray::Ray;
use crate::numeric::sampling::sphere;
use glam::DVec3;
use std::f64::consts::PI;

/// A surface that emits.
#[derive(Clone, Debug)]
pub(super) struct AreaLight {
    pub(super) patch: LightShape,
    /// Radiance, W/(m² sr).
    pub(super) strength: SpectralTable,
    /// Whether an object stands in its place, which rays hit instead.
    pub(super) has_body: bool,
}

impl Emitter for AreaLight {
    fn sample_incident(
        &self,
        point: DVec3,
        _: Option<DVec3>,
        uniform: [f64; 2],
        wavelength_set: usize,
    ) -> Option<LightSample> {
        let drawn = self.patch.sample(point, uniform)?;
        let irradiance = self.strength.of(wavelength_set) * drawn.pdf.recip();
        Some(LightSample { towards: drawn.towards, distance: drawn.distance, irradiance, pdf: Some(drawn.pdf) })
    }

    /// A sphere's points lie on a smaller one, so that they are spread as its disc is, as seen from anywhere.
    fn points(&self, count: u32) -> Vec<LightPoint> {
        LightPoint::spread(count, |uniform| {
            let (at, normal) = self.patch.sample_area(uniform, count == 1);
            (at, self.patch.projected_area(), normal, EmittingSides::Front)
        })
    }

    #[inline]
    fn incident_from(&self, from: &LightPoint, point: DVec3, wavelength_set: usize) -> Option<LightSample> {
        from.incident(self.strength.of(wavelength_set), point)
    }

    fn origin(&self) -> LightOrigin {
        LightOrigin::Within(Bounds::of(self.patch.bounds()))
    }

    fn sample_emission(&self, uniform: [f64; 2], _: usize) -> Option<EmissionSample> {
        let (at, normal) = emission_point(&self.patch, uniform)?;
        Some(EmissionSample::Point { at, normal: Some(normal), area: self.patch.area() })
    }

    fn intensity(&self, normal: Option<DVec3>, direction: DVec3, wavelength_set: usize) -> Channels {
        let strength = self.strength.of(wavelength_set);
        normal.map_or(strength, |normal| strength * (self.patch.area() * normal.dot(direction).max(0.0)))
    }

    fn power(&self, _: f64, wavelength_set: usize) -> Channels {
        self.strength.of(wavelength_set) * (PI * self.patch.area())
    }

    fn is_delta(&self) -> bool {
        false
    }

    fn is_surface(&self) -> bool {
        !self.has_body
    }

    fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64, wavelength_set: usize) -> Option<LightHit> {
        if self.has_body {
            return None;
        }
        let (t, front) = self.patch.intersect(ray, t_min, t_max)?;
        let length = ray.direction.length();
        let radiance = if front { self.strength.of(wavelength_set) } else { Channels::ZERO };
        Some(LightHit { t, radiance, pdf: self.patch.pdf(ray.origin, ray.direction / length, t * length) })
    }

    fn pdf_on_object(&self, from: DVec3, towards: DVec3, distance: f64, _: f64) -> f64 {
        if self.has_body { self.patch.pdf(from, towards, distance) } else { 0.0 }
    }

    fn emission_on_object(&self, is_outside: bool, wavelength_set: usize) -> Channels {
        if self.has_body && is_outside { self.strength.of(wavelength_set) } else { Channels::ZERO }
    }
}

/// A point of a patch, sampled evenly by area, and the normal on the side that emits.
fn emission_point(patch: &LightShape, uniform: [f64; 2]) -> Option<(DVec3, DVec3)> {
    match *patch {
        LightShape::Sphere { center, radius } => {
            let normal = sphere(uniform);
            Some((center + normal * radius, normal))
        }
        LightShape::Rectangle { .. } | LightShape::Disc { .. } => {
            let (at, normal) = patch.sample_area(uniform, false);
            Some((at, normal?))
        }
    }
}
