//! Ray tracing over the linear octree, after Whitted 1980 and Cook, Porter and Carpenter 1984: light of all lights with
//! its shadows, reflection and refraction, sharp and blurred.
//!
//! Each pixel is the mean of its samples as a reconstruction filter weighs them: by a box, which is what scenes have
//! without a word, the mean over its area, and coverage the covered share of it. Places in the pixel and on the lens,
//! points of lights, directions and wavelengths are sampled by Owen's scrambled sequences.

mod direct;
mod sampler;
mod segment;
mod vertex;
mod explain;
mod tracer;
mod irradiance;
mod pixel;
mod finisher;
mod accumulation;

#[cfg(test)]
mod caustic_tests;
#[cfg(test)]
mod cleared_tests;
#[cfg(test)]
mod exact_tests;
#[cfg(test)]
mod combined_tests;
#[cfg(test)]
mod light_tests;
#[cfg(test)]
mod motion_tests;
#[cfg(test)]
mod nested_tests;
#[cfg(test)]
mod principled_tests;
#[cfg(test)]
mod photon_store_tests;
#[cfg(test)]
mod texture_tests;
#[cfg(test)]
mod two_way_error_tests;
#[cfg(test)]
mod two_way_extreme_tests;
#[cfg(test)]
mod two_way_tests;
#[cfg(test)]
mod tests;

pub use accumulation::{Accumulated, Checkpoints};
pub use explain::PathNote;
pub(in crate::render) use finisher::RayFinisher;
pub(in crate::render) use tracer::PathScratch;

use super::film::Film;
use super::indirect::IndirectLight;
use super::tally::SHARING;
use super::two_way::{PhotonEstimator, PhotonMapper, PhotonStore};
use super::world::{CameraRays, Media, World};
use super::{RenderError, RenderOrder, Renderer, Rendering, Watch};
use crate::plan::{Plan, Stage};
use crate::scene::{Caustics, Prepared, View};
use crate::stages::stage;
use explain::PathLog;
use pixel::PixelSampler;
use tracer::{PathRules, PathTracer};

/// A ray tracer that holds a scene and its octree.
pub struct RayTracer<'a> {
    plan: &'a Plan,
    world: World<'a>,
    photon_mapper: Option<PhotonMapper<'a>>,
    indirect: Option<Box<dyn IndirectLight>>,
}

/// One sample of a pixel, explained.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Explanation {
    /// The number of the sample.
    pub sample: u32,
    /// The wavelengths that it carries, nm; none if it carries red, green and blue.
    pub wavelengths: Option<Vec<f64>>,
    /// Notes of the events, in order.
    pub notes: Vec<PathNote>,
    /// Radiance of the sample, linear sRGB.
    pub radiance: [f64; 3],
}

impl<'a> RayTracer<'a> {
    /// Takes a world, and prepares photon tracing if the plan asks for it.
    ///
    /// - `plan`: of the world. Where it needs radiosity, the light of a solution is to be given by
    ///   [`RayTracer::with_indirect`].
    /// - `photon_store`: where photon maps are stored beyond this tracer; nowhere without one.
    pub fn new(world: World<'a>, plan: &'a Plan, photon_store: Option<&'a PhotonStore>) -> RayTracer<'a> {
        let keeps = |object| plan.includes_object(object);
        let photon_mapper = plan.needs(Stage::PhotonMap).then(|| {
            let _stage = stage!("allocating photon paths");
            PhotonMapper::new(&world, keeps, photon_store)
        });
        RayTracer { plan, world, photon_mapper: photon_mapper.flatten(), indirect: None }
    }

    /// Takes indirect light of diffuse surfaces from there.
    pub fn with_indirect(self, indirect: Box<dyn IndirectLight>) -> RayTracer<'a> {
        RayTracer { indirect: Some(indirect), ..self }
    }

    /// The world.
    pub fn world(&self) -> &World<'a> {
        &self.world
    }

    /// The photon map of the first pass; none if no lamp emits photons, or if tracing was stopped.
    pub(super) fn photon_estimator(&self, watch: &Watch<'_>) -> Option<PhotonEstimator<'_>> {
        self.photon_mapper.as_ref().and_then(|two_way| two_way.trace_pass(&self.world, 0, watch))
    }

    /// The scene.
    pub fn prepared(&self) -> &Prepared {
        self.world.appearance.prepared
    }

    fn eye(&self, view: &View, order: &RenderOrder) -> Result<CameraRays, RenderError> {
        let prepared = self.world.appearance.prepared;
        let eye = CameraRays::new(view, order.width, order.height, &prepared.bounds).ok_or(RenderError::View)?;
        if !self.plan.needs(Stage::Textures) {
            return Ok(eye);
        }
        // The samples of a pixel share it. The slope of a relief is taken over something, at least.
        let filter = prepared.settings.light.texture_filter.max(1e-3);
        Ok(eye.with_cones(filter / f64::from(order.footprints).sqrt()))
    }

    /// A sampler of the pixels of a picture.
    ///
    /// - `photons`: the photon map, if one is needed. `records_features`: whether a denoiser needs features.
    fn pixel_sampler<'b>(
        &'b self,
        photons: Option<&'b PhotonEstimator<'b>>,
        eye: &'b CameraRays,
        order: &'b RenderOrder,
        records_features: bool,
    ) -> PixelSampler<'b> {
        let light = &self.world.appearance.prepared.settings.light;
        let depth = light.reflection_depth;
        let tracer = PathTracer::new(
            &self.world,
            PathRules {
                depth: if self.plan.needs(Stage::Reflection) { depth } else { 0 },
                shadows: self.plan.needs(Stage::Shadows),
                caustics: match light.caustics {
                    // Camera paths must not count again what is in the photon map.
                    _ if self.photon_mapper.is_some() => Caustics::PhotonMapped,
                    Caustics::PathTraced => Caustics::PathTraced,
                    _ => Caustics::LeftOut,
                },
                records_features,
            },
            photons,
            self.indirect.as_deref(),
            eye.place().map(|place| Media::around(&self.world, place)).unwrap_or_default(),
        );
        PixelSampler { world: &self.world, tracer, eye, order }
    }

    /// Explains how the samples of a pixel come to their radiance.
    ///
    /// - `most`: no more samples than this are explained.
    ///
    /// # Errors
    /// [`RenderError::View`].
    pub fn explain(
        &self,
        view: &View,
        order: &RenderOrder,
        pixel: [u32; 2],
        most: u32,
    ) -> Result<Vec<Explanation>, RenderError> {
        let eye = self.eye(view, order)?;
        let told = |index: u32| {
            let pass = index / SHARING;
            let two_way = self.photon_mapper.as_ref();
            let photons = two_way.and_then(|two_way| two_way.trace_pass(&self.world, pass, &Watch::NOBODY));
            let sampler = self.pixel_sampler(photons.as_ref(), &eye, order, false);
            let (mut notes, mut scratch) = (Vec::new(), PathScratch::default());
            let (sample, _, wavelength_set) = sampler.sample(pixel, index, &mut scratch, PathLog::to(&mut notes));
            let wavelengths = &self.world.appearance.wavelengths;
            let wavelengths = wavelengths.is_spectral().then(|| wavelengths.at(wavelength_set).to_vec());
            Explanation { sample: index, wavelengths, notes, radiance: sample.radiance.to_array() }
        };
        Ok((0..order.samples.min(most)).map(told).collect())
    }
}

impl Renderer for RayTracer<'_> {
    fn left_out(&self, _: &View) -> Vec<&'static str> {
        Vec::new()
    }

    fn render(&self, view: &View, order: &RenderOrder, watch: &Watch<'_>) -> Result<Rendering, RenderError> {
        self.resume(Film::new(order.width, order.height)?, view, order, watch, None)
    }
}
