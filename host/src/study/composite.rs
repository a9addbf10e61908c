//! The knob of composites: how far the triangles of their operands are from the exact surfaces, and what the volume and the
//! area of the results make of it.

use super::{Knob, Options, Study, StudyError, Trial, sweep};
use crate::mesh::Mesh;
use crate::render::Watch;
use crate::scene::{Prepared, Scene, Shape};
use crate::surface::Tolerance;
use std::time::Instant;

/// The coarsest tolerance, as a part of the diagonal of the scene.
const COARSEST: f64 = 1.0 / 50.0;
/// How much finer the next setting is.
const STEP: f64 = 3.0;

/// The composites of a scene.
struct Composites<'a> {
    shapes: Vec<&'a Shape>,
    coarsest: f64,
    angle: f64,
    settings: u32,
}

/// Makes the study of a scene.
pub(super) fn study(scene: &Scene, options: &Options, watch: &Watch<'_>) -> Result<Study, StudyError> {
    let shapes = scene.objects.iter().map(|object| &object.shape);
    let shapes: Vec<&Shape> = shapes.filter(|shape| matches!(shape, Shape::Composite(_))).collect();
    if shapes.is_empty() {
        return Err(StudyError::Nothing("no object of the scene is made of others"));
    }
    let coarsest = Prepared::new(scene)?.bounds.diagonal() * COARSEST;
    let (angle, settings) = (scene.settings.geometry.angle, options.settings.clamp(1, 9));
    sweep(&Composites { shapes, coarsest, angle, settings }, watch)
}

impl Knob for Composites<'_> {
    type Answer = Vec<Mesh>;

    fn setting(&self) -> &'static str {
        "tolerance (model units)"
    }

    /// The reference is nine times finer than the finest.
    fn settings(&self) -> (Vec<f64>, f64) {
        let setting = |i: u32| self.coarsest / STEP.powi(i as i32);
        ((0..self.settings).map(setting).collect(), setting(self.settings + 1))
    }

    fn run(&self, setting: f64, _: &Watch<'_>) -> Result<Trial<Vec<Mesh>>, StudyError> {
        let start = Instant::now();
        let made: Result<Vec<Mesh>, StudyError> =
            self.shapes.iter().map(|s| Ok(s.tessellate(Tolerance::new(setting, self.angle))?.mesh)).collect();
        let (answer, seconds) = (made?, start.elapsed().as_secs_f64());
        let triangles = answer.iter().map(|mesh| mesh.triangles.len()).sum::<usize>() as f64;
        Ok(Trial { answer, seconds, counts: vec![("triangles", triangles)] })
    }

    fn error_names(&self) -> Vec<&'static str> {
        vec!["relative error of the volume", "relative error of the area"]
    }

    fn errors(&self, trial: &Trial<Vec<Mesh>>, reference: &Trial<Vec<Mesh>>) -> Result<Vec<f64>, StudyError> {
        let greatest = |measure: fn(&Mesh) -> f64| {
            let pairs = trial.answer.iter().zip(&reference.answer).map(|(one, two)| [one, two].map(measure));
            pairs
                .filter(|[_, exact]| *exact != 0.0)
                .map(|[found, exact]| (found / exact - 1.0).abs())
                .fold(0.0, f64::max)
        };
        Ok(vec![greatest(Mesh::signed_volume), greatest(Mesh::area)])
    }
}
