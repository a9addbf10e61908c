//! The knob of the modeller: how closely triangles follow the exact surfaces.

use super::options::resized;
use super::{Knob, Options, Study, StudyError, Trial, sweep};
use crate::picture::{Picture, difference};
use crate::plan::Plan;
use crate::render::ray_tracer;
use crate::render::{RenderOrder, Renderer, Watch};
use crate::scene::{Prepared, Scene};
use std::time::Instant;

/// The coarsest tolerance, as a fraction of the diagonal of the largest curved object.
const COARSEST: f64 = 1.0 / 60.0;
/// How much finer the next setting is.
const STEP: f64 = 2.0;
/// How much finer the reference is than the finest setting.
const REFERENCE_STEP: f64 = 8.0;

/// Tessellation tolerance: each a half of the one before, against an eighth of the last.
struct Tessellation {
    scene: Scene,
    options: Options,
    coarsest: f64,
}

/// What a tolerance gives: the picture, and the distance between triangles and exact surfaces.
struct Answer {
    picture: Picture,
    chord_error: f64,
}

/// Makes the study of a scene.
pub(super) fn study(scene: &Scene, options: &Options, watch: &Watch<'_>) -> Result<Study, StudyError> {
    sweep(&Tessellation::new(scene, options)?, watch)
}

impl Tessellation {
    fn new(scene: &Scene, options: &Options) -> Result<Tessellation, StudyError> {
        let mut scene = resized(scene, options);
        scene.settings.image.samples = options.samples;
        let prepared = Prepared::new(&scene)?;
        let curved = scene.objects.iter().zip(&prepared.objects).filter(|(o, _)| o.shape.is_exact_and_curved());
        let largest = curved.map(|(_, p)| p.bounds.diagonal()).fold(0.0, f64::max);
        if largest == 0.0 {
            return Err(StudyError::Nothing("no object of the scene is tessellated from a curved surface"));
        }
        // The camera stays where it is, even if it was framed automatically; every object follows the knob.
        scene.camera = Some(prepared.camera);
        scene.objects.iter_mut().for_each(|o| o.tolerance = None);
        Ok(Tessellation { scene, options: *options, coarsest: largest * COARSEST })
    }
}

impl Knob for Tessellation {
    type Answer = Answer;

    fn setting(&self) -> &'static str {
        "tolerance (scene units)"
    }

    fn settings(&self) -> (Vec<f64>, f64) {
        let count = self.options.settings.clamp(1, 10);
        let all: Vec<f64> = (0..count).map(|i| self.coarsest / STEP.powi(i as i32)).collect();
        let finest = self.coarsest / STEP.powi(count as i32 - 1);
        (all, finest / REFERENCE_STEP)
    }

    fn run(&self, setting: f64, watch: &Watch<'_>) -> Result<Trial<Answer>, StudyError> {
        let mut scene = self.scene.clone();
        scene.settings.geometry.tolerance = Some(setting);
        let start = Instant::now();
        let prepared = Prepared::new(&scene)?;
        let plan = Plan::new(&prepared, &prepared.view());
        let tracer = ray_tracer(&prepared, &plan)?;
        let build = start.elapsed().as_secs_f64();
        let order = RenderOrder { threads: self.options.threads, ..RenderOrder::of(&scene.settings) };
        let rendering = tracer.render(&prepared.view(), &order, watch)?;
        let chord_error = scene.chord_error()?;
        let counts = vec![
            ("triangles", prepared.triangles.len() as f64),
            ("build (s)", build),
            ("render (s)", rendering.seconds),
        ];
        let answer = Answer { picture: rendering.picture, chord_error };
        Ok(Trial { answer, seconds: build + rendering.seconds, counts })
    }

    fn error_names(&self) -> Vec<&'static str> {
        vec!["chord error (scene units)", "image RMSE", "image relative MSE"]
    }

    fn errors(&self, trial: &Trial<Answer>, reference: &Trial<Answer>) -> Result<Vec<f64>, StudyError> {
        let d = difference(&trial.answer.picture, &reference.answer.picture)?;
        Ok(vec![trial.answer.chord_error, d.rmse, d.relative_mse])
    }
}
