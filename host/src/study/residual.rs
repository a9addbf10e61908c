//! The knob of exact surfaces: how far triangles are from them, and how far their planes turn away. The triangles are
//! adaptive where a shape has its surfaces as a whole, else those of its scene.

use super::{Knob, Options, Study, StudyError, Trial, sweep};
use crate::mesh::Mesh;
use crate::render::Watch;
use crate::scene::{Prepared, Scene, Shape};
use crate::solid::Primitive;
use crate::surface::{
    SplineSurface, Surface, Tolerance, chord_error, rational_sphere, rational_torus, tessellate_adaptively,
};
use glam::DVec2;
use std::sync::Arc;
use std::time::Instant;

/// The coarsest tolerance, as a part of the diagonal of the largest object.
const COARSEST: f64 = 1.0 / 50.0;
/// How much finer the next setting is.
const STEP: f64 = 3.0;
/// Steps along the sides of a triangle at which its distance to the surface is measured.
const MEASURED_STEPS: usize = 4;

/// The surfaces of one shape.
type Surfaces = Vec<Arc<dyn Surface>>;

/// A shape of exact surfaces, in its own coordinates.
struct ExactShape<'a> {
    shape: &'a Shape,
    /// Its surfaces, if it has each as a whole: then their triangles are adaptive.
    whole: Option<Surfaces>,
}

/// Exact surfaces of a scene.
struct Residual<'a> {
    shapes: Vec<ExactShape<'a>>,
    coarsest: f64,
    angle: f64,
    settings: u32,
}

/// Makes the study of a scene.
pub(super) fn study(scene: &Scene, options: &Options, watch: &Watch<'_>) -> Result<Study, StudyError> {
    let coarsest = Prepared::new(scene)?.bounds.diagonal() * COARSEST;
    let angle = scene.settings.geometry.angle;
    let mut shapes = Vec::new();
    scene.objects.iter().try_for_each(|object| collect(&object.shape, Tolerance::new(coarsest, angle), &mut shapes))?;
    if shapes.is_empty() {
        return Err(StudyError::Nothing("no object of the scene has curved surfaces that are known exactly"));
    }
    sweep(&Residual { shapes, coarsest, angle, settings: options.settings.clamp(1, 9) }, watch)
}

/// Adds a shape if its surfaces are known, or else the operands that it is made of.
fn collect<'a>(shape: &'a Shape, tolerance: Tolerance, shapes: &mut Vec<ExactShape<'a>>) -> Result<(), StudyError> {
    match shape {
        Shape::Composite(composite) => composite.operands.iter().try_for_each(|o| collect(&o.shape, tolerance, shapes)),
        Shape::Subdivision(_) | Shape::Terrain(_) => Ok(()),
        _ if shape.is_exact_and_curved() => {
            shapes.push(ExactShape { shape, whole: whole(shape, tolerance)? });
            Ok(())
        }
        _ => Ok(()),
    }
}

/// The surfaces of shapes that have them as a whole: round ones as closed rational forms.
fn whole(shape: &Shape, tolerance: Tolerance) -> Result<Option<Surfaces>, StudyError> {
    let rational = match shape {
        Shape::Solid(solid) => match solid.primitive() {
            Primitive::Sphere { radius } => rational_sphere(*radius).ok(),
            Primitive::Torus { ring, tube } => rational_torus(*ring, *tube).ok(),
            _ => None,
        },
        Shape::Sculpture(sculpture) if sculpture.is_trimmed() => return Ok(None),
        Shape::Sculpture(_) | Shape::Teapot => return Ok(shape.tessellate(tolerance)?.surfaces.into_iter().collect()),
        _ => None,
    };
    let patches =
        |surface: SplineSurface| surface.patches().iter().map(|p| Arc::new(p.clone()) as Arc<dyn Surface>).collect();
    Ok(rational.map(patches))
}

impl Knob for Residual<'_> {
    type Answer = Vec<(Mesh, Surfaces)>;

    fn setting(&self) -> &'static str {
        "tolerance (model units)"
    }

    /// The reference is the surface itself.
    fn settings(&self) -> (Vec<f64>, f64) {
        ((0..self.settings).map(|i| self.coarsest / STEP.powi(i as i32)).collect(), 0.0)
    }

    fn run(&self, setting: f64, _: &Watch<'_>) -> Result<Trial<Self::Answer>, StudyError> {
        if setting == 0.0 {
            return Ok(Trial { answer: Vec::new(), seconds: 0.0, counts: Vec::new() });
        }
        let start = Instant::now();
        let triangles = |exact: &ExactShape<'_>| match &exact.whole {
            Some(whole) => Ok((tessellate_adaptively(whole, Tolerance::new(setting, 180.0))?, whole.clone())),
            None => {
                let made = exact.shape.tessellate(Tolerance::new(setting, self.angle))?;
                Ok((made.mesh, made.surfaces.into_iter().flatten().collect()))
            }
        };
        let answer: Result<Self::Answer, StudyError> = self.shapes.iter().map(triangles).collect();
        let (answer, seconds) = (answer?, start.elapsed().as_secs_f64());
        let count = answer.iter().map(|(mesh, _)| mesh.triangles.len()).sum::<usize>();
        let mut of_scene = 0;
        for exact in &self.shapes {
            of_scene += exact.shape.tessellate(Tolerance::new(setting, self.angle))?.mesh.triangles.len();
        }
        let counts = vec![("triangles", count as f64), ("triangles of the scene", of_scene as f64)];
        Ok(Trial { answer, seconds, counts })
    }

    fn error_names(&self) -> Vec<&'static str> {
        vec!["RMS normal angle (degrees)", "RMS residual (model units)", "greatest residual (model units)"]
    }

    fn errors(&self, trial: &Trial<Self::Answer>, _: &Trial<Self::Answer>) -> Result<Vec<f64>, StudyError> {
        let mut errors = [0.0_f64; 3];
        for (mesh, surfaces) in &trial.answer {
            let accuracy = chord_error(mesh, surfaces, MEASURED_STEPS)?;
            for (error, found) in errors.iter_mut().zip([angle(mesh, surfaces), accuracy.rms, accuracy.maximum]) {
                *error = error.max(found);
            }
        }
        Ok(errors.to_vec())
    }
}

/// The root of the mean square of the angle between the planes of triangles and the surface at their middles, degrees,
/// weighted by area: a thin triangle may lean far and mean little.
fn angle(mesh: &Mesh, surfaces: &Surfaces) -> f64 {
    let (mut sum, mut area) = (0.0, 0.0);
    for triangle in 0..mesh.triangles.len() {
        let uv = mesh.corner_parameters[triangle].iter().sum::<DVec2>() / 3.0;
        let (plane, normal) = (mesh.area_vector(triangle), surfaces[mesh.surfaces[triangle] as usize].normal(uv));
        let angle = plane.angle_between(normal).to_degrees();
        if angle.is_finite() {
            sum += plane.length() * angle * angle;
            area += plane.length();
        }
    }
    if area > 0.0 { (sum / area).sqrt() } else { 0.0 }
}
