//! The knob of adaptive tessellation: how far triangles are from the exact surfaces, and how far their planes turn away.

use super::{Knob, Options, Study, StudyError, Trial, sweep};
use crate::mesh::Mesh;
use crate::render::Watch;
use crate::scene::{Prepared, Scene, Shape};
use crate::solid::Primitive;
use crate::surface::{Surface, Tolerance, chord_error, rational_sphere, teapot, tessellate, tessellate_adaptively};
use glam::DVec2;
use std::time::Instant;

/// The coarsest tolerance, as a part of the diagonal of the largest object.
const COARSEST: f64 = 1.0 / 50.0;
/// How much finer the next setting is.
const STEP: f64 = 3.0;
/// Steps along the sides of a triangle at which its distance to the surface is measured.
const MEASURED_STEPS: usize = 4;

/// The patches of one object.
type Patches = Vec<Box<dyn Surface>>;

/// Exact surfaces of a scene, in the coordinates of their objects.
struct Residual {
    objects: Vec<Patches>,
    coarsest: f64,
    settings: u32,
}

/// Makes the study of a scene.
pub(super) fn study(scene: &Scene, options: &Options, watch: &Watch<'_>) -> Result<Study, StudyError> {
    let objects: Vec<Patches> = scene.objects.iter().filter_map(|object| patches(&object.shape)).collect();
    if objects.is_empty() {
        return Err(StudyError::Nothing("no object of the scene is a spline surface"));
    }
    let coarsest = Prepared::new(scene)?.bounds.diagonal() * COARSEST;
    sweep(&Residual { objects, coarsest, settings: options.settings.clamp(1, 9) }, watch)
}

/// The exact surface of a shape as patches; `None` for other shapes.
fn patches(shape: &Shape) -> Option<Patches> {
    fn boxed<S: Surface + 'static>(patches: impl IntoIterator<Item = S>) -> Patches {
        patches.into_iter().map(|patch| Box::new(patch) as Box<dyn Surface>).collect()
    }
    match shape {
        Shape::Teapot => Some(boxed(teapot())),
        Shape::Solid(Primitive::Sphere { radius }) => {
            rational_sphere(*radius).ok().map(|sphere| boxed(sphere.patches().to_vec()))
        }
        _ => None,
    }
}

impl Knob for Residual {
    type Answer = Vec<Mesh>;

    fn setting(&self) -> &'static str {
        "tolerance (model units)"
    }

    /// The reference is the surface itself.
    fn settings(&self) -> (Vec<f64>, f64) {
        ((0..self.settings).map(|i| self.coarsest / STEP.powi(i as i32)).collect(), 0.0)
    }

    fn run(&self, setting: f64, _: &Watch<'_>) -> Result<Trial<Vec<Mesh>>, StudyError> {
        if setting == 0.0 {
            return Ok(Trial { answer: Vec::new(), seconds: 0.0, counts: Vec::new() });
        }
        let tolerance = Tolerance::new(setting, 180.0);
        let start = Instant::now();
        let meshes: Result<Vec<Mesh>, StudyError> =
            self.objects.iter().map(|patches| Ok(tessellate_adaptively(patches, tolerance)?)).collect();
        let (answer, seconds) = (meshes?, start.elapsed().as_secs_f64());
        let grids: Result<Vec<Mesh>, StudyError> =
            self.objects.iter().map(|patches| Ok(tessellate(patches, tolerance)?)).collect();
        let count = |meshes: &[Mesh]| meshes.iter().map(|mesh| mesh.triangles.len()).sum::<usize>() as f64;
        let counts = vec![("triangles", count(&answer)), ("triangles of grids", count(&grids?))];
        Ok(Trial { answer, seconds, counts })
    }

    fn error_names(&self) -> Vec<&'static str> {
        vec!["RMS normal angle (degrees)", "RMS residual (model units)", "greatest residual (model units)"]
    }

    fn errors(&self, trial: &Trial<Vec<Mesh>>, _: &Trial<Vec<Mesh>>) -> Result<Vec<f64>, StudyError> {
        let mut errors = [0.0_f64; 3];
        for (mesh, patches) in trial.answer.iter().zip(&self.objects) {
            let accuracy = chord_error(mesh, patches, MEASURED_STEPS)?;
            for (error, found) in errors.iter_mut().zip([angle(mesh, patches), accuracy.rms, accuracy.maximum]) {
                *error = error.max(found);
            }
        }
        Ok(errors.to_vec())
    }
}

/// The root of the mean square of the angle between the planes of triangles and the surface at their middles, degrees,
/// weighted by area: a sliver may lean far and mean little.
fn angle(mesh: &Mesh, patches: &Patches) -> f64 {
    let (mut sum, mut area) = (0.0, 0.0);
    for triangle in 0..mesh.triangles.len() {
        let uv = mesh.corner_parameters[triangle].iter().sum::<DVec2>() / 3.0;
        let (plane, normal) = (mesh.area_vector(triangle), patches[mesh.surfaces[triangle] as usize].normal(uv));
        let angle = plane.angle_between(normal).to_degrees();
        if angle.is_finite() {
            sum += plane.length() * angle * angle;
            area += plane.length();
        }
    }
    if area > 0.0 { (sum / area).sqrt() } else { 0.0 }
}
