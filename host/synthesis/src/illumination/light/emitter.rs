//! The interface of every light: light samples at a point, emission samples, its origin.

use super::light_sample::{EmissionSample, LightHit, LightOrigin, LightPoint, LightSample};
use crate::color::Channels;
use crate::numeric::ray::Ray;
use glam::DVec3;

/// A light of one kind, prepared for rendering. [`LightSource`](super::LightSource) says what each function gives.
pub(super) trait Emitter {
    /// A light sample at a point, if nothing stands between.
    fn sample_incident(
        &self,
        point: DVec3,
        normal: Option<DVec3>,
        uniform: [f64; 2],
        wavelength_set: usize,
    ) -> Option<LightSample>;

    /// A few points that stand for it.
    fn points(&self, count: u32) -> Vec<LightPoint>;

    /// The light sample at a point from one of its points.
    fn incident_from(&self, _: &LightPoint, point: DVec3, wavelength_set: usize) -> Option<LightSample> {
        // What has no size is its only point, and the middle of a disc in the sky stands for it.
        self.sample_incident(point, None, [0.0; 2], wavelength_set)
    }

    /// The origin of its light.
    fn origin(&self) -> LightOrigin;

    /// An emission sample: where light leaves it.
    fn sample_emission(&self, uniform: [f64; 2], wavelength_set: usize) -> Option<EmissionSample>;

    /// Flux in each solid angle that leaves such a place.
    fn intensity(&self, normal: Option<DVec3>, direction: DVec3, wavelength_set: usize) -> Channels;

    /// All flux that it sends out.
    fn power(&self, radius: f64, wavelength_set: usize) -> Channels;

    /// Whether it is a delta light: its light comes from one direction only at every point.
    fn is_delta(&self) -> bool {
        true
    }

    /// Whether it is a surface of its own, which rays hit.
    fn is_surface(&self) -> bool {
        false
    }

    /// Whether it is worth sampling with photons.
    fn emits_photons(&self) -> bool {
        true
    }

    /// Whether it is an infinite light, which is seen where rays hit nothing.
    fn is_infinite(&self) -> bool {
        false
    }

    /// Whether it surrounds everything.
    fn is_sky(&self) -> bool {
        false
    }

    /// The light hit of a ray with a surface of its own.
    fn intersect(&self, _: &Ray, _: f64, _: f64, _: usize) -> Option<LightHit> {
        None
    }

    /// The light hit of a sky.
    fn sky_radiance(&self, _: &Ray, _: Option<DVec3>, _: usize) -> Option<LightHit> {
        None
    }

    /// The pdf of a direction in which its object is hit.
    fn pdf_on_object(&self, _: DVec3, _: DVec3, _: f64, _: f64) -> f64 {
        0.0
    }

    /// The radiance of a side of its object.
    fn emission_on_object(&self, _: bool, _: usize) -> Channels {
        Channels::ZERO
    }

    /// The cone outside of which nothing is sent.
    fn cone(&self) -> Option<(DVec3, DVec3, f64)> {
        None
    }
}
