//! Samples by rays for a renderer that sees all else without them: at places of the picture that it tells, through a
//! pinhole, of a scene that stands still.

use super::explain::PathLog;
use super::irradiance::GatheredIrradiance;
use super::pixel::PixelSampler;
use super::sampler::PathSampler;
use super::tracer::{PathRules, PathScratch, PathTracer};
use crate::illumination::optics::Interreflection;
use crate::plan::{Plan, Stage};
use crate::render::RenderOrder;
use crate::render::tally::PixelSample;
use crate::render::world::{CameraRays, Media, SurfaceElement, World};
use crate::scene::Caustics;

/// Finds samples of pixels by rays.
pub(in crate::render) struct RayFinisher<'a>(PixelSampler<'a>);

impl<'a> RayFinisher<'a> {
    /// - `world`: without caustics, in which nothing moves. `eye`: with cones that are as wide as a sample.
    pub(in crate::render) fn new(
        world: &'a World<'a>,
        plan: &Plan,
        eye: &'a CameraRays,
        order: &'a RenderOrder,
    ) -> RayFinisher<'a> {
        let rules = PathRules {
            depth: world.appearance.prepared.settings.light.reflection_depth,
            shadows: plan.needs(Stage::Shadows),
            caustics: Caustics::LeftOut,
            records_features: false,
        };
        let around = eye.place().map(|place| Media::around(world, place)).unwrap_or_default();
        RayFinisher(PixelSampler { world, tracer: PathTracer::new(world, rules, None, None, around), eye, order })
    }

    /// The irradiance at an element by skies and surfaces around it, on the side of the viewer.
    ///
    /// - `number`: of its random numbers. `count`: of directions.
    pub(in crate::render) fn irradiance(
        &self,
        element: &SurfaceElement,
        number: u64,
        count: u32,
        scratch: &mut PathScratch,
    ) -> GatheredIrradiance {
        let PixelSampler { world, tracer, order, .. } = &self.0;
        let is_followed = world.prepared().settings.light.interreflection == Interreflection::Followed;
        tracer.irradiance(element, [order.seed, number], (count, is_followed), scratch)
    }

    /// A sample of a pixel.
    ///
    /// - `pixel`: column and row. `at`: the place of the sample in the picture. `index`: of the sample in the pixel.
    pub(in crate::render) fn sample(
        &self,
        [column, row]: [usize; 2],
        at: [f64; 2],
        index: u32,
        scratch: &mut PathScratch,
    ) -> PixelSample {
        let PixelSampler { eye, order, .. } = &self.0;
        let pixel = row as u64 * u64::from(order.width) + column as u64;
        let sampler = PathSampler::new(order.seed, pixel, index, order.samples);
        self.0.sample_along(eye.ray(at, [0.5; 2]), 1.0, &sampler, scratch, PathLog::SILENT).0
    }
}
