//! Ray tracing over the linear octree, after Whitted 1980 and Cook, Porter and Carpenter 1984: light of all lights with
//! its shadows, reflection and refraction, sharp and blurred.
//!
//! Each pixel is the mean of its samples as a reconstruction filter weighs them: by a box, which is what scenes have
//! without a word, the mean over its area, and coverage the covered share of it. Places in the pixel and on the lens,
//! points of lights, directions and wavelengths are sampled by Owen's scrambled sequences.

mod accumulation;
mod direct;
mod sampler;
mod segment;
mod vertex;
mod explain;
mod tracer;

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

use super::film::Film;
use super::indirect::IndirectLight;
use super::tally::{PixelSample, RadianceByClass, SHARING};
use super::two_way::{PhotonEstimator, PhotonMapper, PhotonStore};
use super::world::{AHEAD, CameraRays, Media, World};
use super::{RenderError, RenderOrder, Renderer, Rendering, Watch};
use crate::plan::{Plan, Stage};
use crate::scene::{Prepared, View};
use explain::PathLog;
use glam::DVec3;
use sampler::{PathSampler, SampleDimension};
use tracer::{FirstHit, PathScratch, PathTracer};

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
        let two_way = plan.needs(Stage::PhotonMap).then(|| PhotonMapper::new(&world, keeps, photon_store)).flatten();
        RayTracer { plan, world, photon_mapper: two_way, indirect: None }
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

    fn tracer<'b>(
        &'b self,
        photons: Option<&'b PhotonEstimator<'b>>,
        eye: &CameraRays,
        records_features: bool,
    ) -> PathTracer<'b> {
        let depth = self.world.appearance.prepared.settings.light.reflection_depth;
        let depth = if self.plan.needs(Stage::Reflection) { depth } else { 0 };
        let around = eye.place().map(|place| Media::around(&self.world, place)).unwrap_or_default();
        PathTracer::new(
            &self.world,
            depth,
            self.plan.needs(Stage::Shadows),
            (self.photon_mapper.is_some(), photons),
            self.indirect.as_deref(),
            around,
            records_features,
        )
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

    /// One sample, its light by classes, and its wavelength set.
    fn sample(
        &self,
        (tracer, eye, order): (&PathTracer<'_>, &CameraRays, &RenderOrder),
        [x, y]: [u32; 2],
        index: u32,
        scratch: &mut PathScratch,
        log: PathLog<'_>,
    ) -> (PixelSample, RadianceByClass, usize) {
        let pixel = u64::from(y) * u64::from(order.width) + u64::from(x);
        let sampler = PathSampler::new(order.seed, pixel, index, order.samples);
        let sampler = if self.world.moves() {
            sampler.at_random_time(self.prepared().settings.geometry.shutter)
        } else {
            sampler
        };
        let ([dx, dy], weight) = sampler.position(order.filter);
        let wavelengths = &self.world.appearance.wavelengths;
        let wavelength_set = wavelengths.set_at(sampler.point(SampleDimension::Wavelengths)[0]);
        let at = [f64::from(x) + dx, f64::from(y) + dy];
        let Some(bounded) = eye.ray(at, sampler.point(SampleDimension::Lens)) else {
            let background = self.world.appearance.escaped_radiance(&AHEAD, None, wavelength_set, |_, _| 1.0);
            let radiance =
                if order.matte { DVec3::ZERO } else { weight * wavelengths.to_srgb(wavelength_set, background) };
            let classes = [radiance, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO];
            return (
                PixelSample { radiance, weight, albedo: DVec3::splat(weight), ..PixelSample::default() },
                classes,
                wavelength_set,
            );
        };
        let result = tracer.radiance(&bounded, wavelength_set, &sampler, scratch, log);
        let first =
            result.first.map(|FirstHit { distance, normal, object, material }| (distance, normal, [object, material]));
        let left_out = order.matte && !result.covered;
        let light = |class: usize| {
            weight * (wavelengths.to_srgb(wavelength_set, result.radiance[class]) + result.other_wavelengths[class])
        };
        let classes = if left_out { RadianceByClass::default() } else { [0, 1, 2, 3].map(light) };
        let shared = if left_out { 0.0 } else { weight.abs() * result.shared_variance.sqrt() };
        let sample = PixelSample {
            radiance: classes.into_iter().sum(),
            weight,
            covered: result.covered,
            first,
            albedo: weight * wavelengths.broad_bands(result.albedo),
            normal: weight * result.normal,
            shared,
        };
        (sample, classes, wavelength_set)
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
            let tracer = self.tracer(photons.as_ref(), &eye, false);
            let (mut notes, mut scratch) = (Vec::new(), PathScratch::default());
            let (sample, _, wavelength_set) =
                self.sample((&tracer, &eye, order), pixel, index, &mut scratch, PathLog::to(&mut notes));
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
