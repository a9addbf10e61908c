//! The knob of the renderer: samples in each pixel.

use super::{Knob, Options, Study, StudyError, Trial, resized, sweep};
use crate::picture::{Picture, difference};
use crate::plan::Plan;
use crate::render::ray_tracing::RayTracer;
use crate::render::{Order, Renderer, Watch};
use crate::scene::{Prepared, Scene};

/// Added to the seed of the reference, so that its samples are independent of those under test.
const REFERENCE_SEED: u64 = 0x5EED;

/// Samples in each pixel: 1, 2, 4, ... against a reference with many.
struct Samples<'a> {
    prepared: &'a Prepared,
    tracer: RayTracer<'a>,
    options: Options,
}

/// Makes the study of a scene.
pub(super) fn study(scene: &Scene, options: &Options, watch: &Watch<'_>) -> Result<Study, StudyError> {
    let mut scene = resized(scene, options);
    scene.settings.samples = options.samples;
    let prepared = Prepared::new(&scene)?;
    let plan = Plan::new(&prepared, &prepared.view());
    let tracer = RayTracer::new(&prepared, &plan)?;
    sweep(&Samples { prepared: &prepared, tracer, options: *options }, watch)
}

impl Knob for Samples<'_> {
    type Answer = Picture;

    fn setting(&self) -> &'static str {
        "samples per pixel"
    }

    fn settings(&self) -> (Vec<f64>, f64) {
        let tried = (0..self.options.settings.min(16)).map(|i| 2f64.powi(i as i32));
        (tried.filter(|n| *n < f64::from(self.options.samples)).collect(), f64::from(self.options.samples))
    }

    fn run(&self, setting: f64, watch: &Watch<'_>) -> Result<Trial<Picture>, StudyError> {
        let samples = setting as u32;
        let shift = if samples == self.options.samples { REFERENCE_SEED } else { 0 };
        let seed = self.prepared.settings.seed.wrapping_add(shift);
        let order = Order { samples, seed, threads: self.options.threads, ..Order::of(&self.prepared.settings) };
        let rendering = self.tracer.render(&self.prepared.view(), &order, watch)?;
        let counts = vec![("rays", rendering.rays.total() as f64)];
        Ok(Trial { answer: rendering.picture, seconds: rendering.seconds, counts })
    }

    fn error_names(&self) -> Vec<&'static str> {
        vec!["RMSE", "relative MSE"]
    }

    fn errors(&self, trial: &Trial<Picture>, reference: &Trial<Picture>) -> Result<Vec<f64>, StudyError> {
        let d = difference(&trial.answer, &reference.answer)?;
        Ok(vec![d.rmse, d.relative_mse])
    }
}
