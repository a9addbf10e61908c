//! Samples of pixels: a camera ray for each, and the radiance of its path.

use super::explain::PathLog;
use super::sampler::{PathSampler, SampleDimension};
use super::tracer::{FirstHit, PathScratch, PathTracer};
use crate::render::RenderOrder;
use crate::render::tally::{PixelSample, RadianceByClass};
use crate::render::world::{AHEAD, BoundedRay, CameraRays, World};
use glam::DVec3;

/// What samples the pixels of a picture.
pub(super) struct PixelSampler<'a> {
    pub(super) world: &'a World<'a>,
    pub(super) tracer: PathTracer<'a>,
    pub(super) eye: &'a CameraRays,
    pub(super) order: &'a RenderOrder,
}

impl PixelSampler<'_> {
    /// One sample, its light by classes, and its wavelength set.
    pub(super) fn sample(
        &self,
        [x, y]: [u32; 2],
        index: u32,
        scratch: &mut PathScratch,
        log: PathLog<'_>,
    ) -> (PixelSample, RadianceByClass, usize) {
        let PixelSampler { world, eye, order, .. } = self;
        let pixel = u64::from(y) * u64::from(order.width) + u64::from(x);
        let sampler = PathSampler::new(order.seed, pixel, index, order.samples);
        let sampler = match world.moves() || eye.moves() {
            true => sampler.at_random_time(world.prepared().settings.geometry.shutter),
            false => sampler,
        };
        let ([dx, dy], weight) = sampler.position(order.filter);
        let at = [f64::from(x) + dx, f64::from(y) + dy];
        let bounded = eye.ray_at(at, sampler.point(SampleDimension::Lens), sampler.time);
        self.sample_along(bounded, weight, &sampler, scratch, log)
    }

    /// The sample of a camera ray, its light by classes, and its wavelength set.
    ///
    /// - `bounded`: none where nothing is seen. `weight`: of the sample in its pixel.
    pub(super) fn sample_along(
        &self,
        bounded: Option<BoundedRay>,
        weight: f64,
        sampler: &PathSampler,
        scratch: &mut PathScratch,
        log: PathLog<'_>,
    ) -> (PixelSample, RadianceByClass, usize) {
        let PixelSampler { world, order, .. } = self;
        let wavelengths = &world.appearance.wavelengths;
        let wavelength_set = wavelengths.set_at(sampler.point(SampleDimension::Wavelengths)[0]);
        let Some(bounded) = bounded else {
            let background = world.appearance.escaped_radiance(&AHEAD, None, wavelength_set, |_, _| 1.0);
            let radiance =
                if order.matte { DVec3::ZERO } else { weight * wavelengths.to_srgb(wavelength_set, background) };
            let classes = [radiance, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO];
            let sample = PixelSample { radiance, weight, albedo: DVec3::splat(weight), ..PixelSample::default() };
            return (sample, classes, wavelength_set);
        };
        let result = self.tracer.radiance(&bounded, wavelength_set, sampler, scratch, log);
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
}
