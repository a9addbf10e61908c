//! Light sources: lights prepared for rendering.

use super::environment::EnvironmentLight;
use super::light_sample::{EmissionSample, LightHit, LightOrigin, LightPoint, LightSample};
use super::mesh::MeshLight;
use super::{AnyEmitter, Light, LightShape};
use crate::color::{Channels, SpectralTable, WavelengthSets};
use crate::numeric::ray::Ray;
use glam::DVec3;

/// A light source: a light prepared for rendering.
#[derive(Clone, Debug)]
pub struct LightSource(AnyEmitter);

impl LightSource {
    /// A light, prepared. It should have been checked before.
    pub fn new(light: &Light, wavelengths: &WavelengthSets) -> LightSource {
        LightSource(light.emitter(wavelengths))
    }

    /// The light; of one that is a sky, directions are then sampled through portals from where these are.
    ///
    /// - `portals`: rectangles whose normals, across x up, point inwards.
    pub fn with_portals(self, portals: &[LightShape]) -> LightSource {
        match self.0 {
            AnyEmitter::Sky(EnvironmentLight { sky, strength }) if !portals.is_empty() => {
                LightSource(AnyEmitter::Sky(EnvironmentLight { sky: Box::new(sky.with_portals(portals)), strength }))
            }
            other => LightSource(other),
        }
    }

    /// Triangles that emit the same radiance on both sides; none without area.
    pub fn of_triangles(corners: Vec<[DVec3; 3]>, radiance: SpectralTable) -> Option<LightSource> {
        Some(LightSource(AnyEmitter::Mesh(MeshLight::new(corners, radiance)?)))
    }

    /// A light sample at a point if nothing stands between; none where no light comes, and at the light itself.
    ///
    /// - `normal`: of the element at the point, unit length, if there is one: directions above it are sampled more
    ///   often.
    /// - `uniform`: a point of the unit square, which chooses the point of a light that has a size.
    #[inline]
    pub fn sample_incident(
        &self,
        point: DVec3,
        normal: Option<DVec3>,
        uniform: [f64; 2],
        wavelength_set: usize,
    ) -> Option<LightSample> {
        self.0.emitter().sample_incident(point, normal, uniform, wavelength_set)
    }

    /// Points that stand for it: itself if it has no size, the middle of a disc in the sky, none for another sky.
    ///
    /// - `count`: of them where it has a size, 1 and more; a single one is in its middle.
    pub fn points(&self, count: u32) -> Vec<LightPoint> {
        self.0.emitter().points(count.max(1))
    }

    /// The light sample from one of [`LightSource::points`] if nothing stands between.
    #[inline]
    pub fn incident_from(&self, from: &LightPoint, point: DVec3, wavelength_set: usize) -> Option<LightSample> {
        self.0.emitter().incident_from(from, point, wavelength_set)
    }

    /// The origin of its light.
    pub fn origin(&self) -> LightOrigin {
        self.0.emitter().origin()
    }

    /// An emission sample: where light leaves the source; none where there is none.
    ///
    /// - `uniform`: a point of the unit square.
    pub fn sample_emission(&self, uniform: [f64; 2], wavelength_set: usize) -> Option<EmissionSample> {
        self.0.emitter().sample_emission(uniform, wavelength_set)
    }

    /// Flux in each solid angle that leaves a place of [`LightSource::sample_emission`] in a direction, over the pdf of
    /// the place, W/sr.
    ///
    /// - `normal`: of the surface there, if it is one. `direction`: where it goes, unit length.
    pub fn intensity(&self, normal: Option<DVec3>, direction: DVec3, wavelength_set: usize) -> Channels {
        self.0.emitter().intensity(normal, direction, wavelength_set)
    }

    /// All flux that it sends out, W; of light from infinitely far away, what goes through a sphere of a radius.
    pub fn power(&self, radius: f64, wavelength_set: usize) -> Channels {
        self.0.emitter().power(radius, wavelength_set)
    }

    /// The light hit of a ray with a light that is a surface of its own.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64, wavelength_set: usize) -> Option<LightHit> {
        self.0.emitter().intersect(ray, t_min, t_max, wavelength_set)
    }

    /// The light hit of a sky; none of another light, and beside a disc.
    ///
    /// - `ray`: of unit length, from the point from which it is seen.
    /// - `normal`: of the element from which it is seen, as in [`LightSource::sample_incident`].
    #[inline]
    pub fn sky_radiance(&self, ray: &Ray, normal: Option<DVec3>, wavelength_set: usize) -> Option<LightHit> {
        self.0.emitter().sky_radiance(ray, normal, wavelength_set)
    }

    /// The pdf of a direction by [`LightSource::sample_incident`] in which the object is hit that emits its light, 1/sr; 0
    /// for a light that is no object.
    ///
    /// - `from`: where the ray begins. `towards`: unit length. `distance`: from there to the hit, scene units. `cosine`:
    ///   between the direction and the normal of the triangle that is hit, any sign.
    pub fn pdf_on_object(&self, from: DVec3, towards: DVec3, distance: f64, cosine: f64) -> f64 {
        self.0.emitter().pdf_on_object(from, towards, distance, cosine)
    }

    /// Radiance of the object that emits its light, W/(m² sr): a lamp's emits on the outside of its triangles, another on
    /// both sides; 0 for a light that is no object.
    pub fn emission_on_object(&self, is_outside: bool, wavelength_set: usize) -> Channels {
        self.0.emitter().emission_on_object(is_outside, wavelength_set)
    }

    /// Whether it is a delta light: its light comes from one direction only at every point.
    pub fn is_delta(&self) -> bool {
        self.0.emitter().is_delta()
    }

    /// Whether it is a surface of its own, which rays hit.
    #[inline]
    pub fn is_surface(&self) -> bool {
        self.0.emitter().is_surface()
    }

    /// Whether it is worth sampling with photons: camera paths find a sky of one radiance everywhere.
    #[inline]
    pub fn emits_photons(&self) -> bool {
        self.0.emitter().emits_photons()
    }

    /// The cone outside of which nothing is sent: its tip, its axis, unit length, and the cosine of its half angle;
    /// none if light goes everywhere.
    pub fn cone(&self) -> Option<(DVec3, DVec3, f64)> {
        self.0.emitter().cone()
    }

    /// Whether it is an infinite light, which is seen where rays hit nothing: a sky, or a disc in it.
    #[inline]
    pub fn is_infinite(&self) -> bool {
        self.0.emitter().is_infinite()
    }

    /// Whether it surrounds everything: no disc in the sky does.
    #[inline]
    pub fn is_sky(&self) -> bool {
        self.0.emitter().is_sky()
    }
}

#[cfg(test)]
impl LightSource {
    /// The word for its kind.
    pub(super) fn kind(&self) -> &'static str {
        self.0.kind()
    }
}
