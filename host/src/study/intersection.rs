//! The knobs of curves of intersection: how closely triangles follow the surfaces that meet, and how long Newton's
//! iteration goes on.

use super::{Knob, Options, Study, StudyError, Trial, sweep};
use crate::intersection::{CurvePrecision, Intersection};
use crate::render::Watch;
use crate::scene::{Prepared, Scene, object_intersections};
use glam::DVec3;
use std::time::Instant;

/// The coarsest tolerance of the triangles, as a part of the diagonal of the scene.
const COARSEST: f64 = 1.0 / 50.0;
/// How much finer the next one is.
const STEP: f64 = 3.0;
/// The coarsest tolerance of Newton's iteration.
const LOOSEST: f64 = 1e-1;
/// How much finer the next one is.
const NEWTON_STEP: f64 = 1e-2;
/// The tolerance of the triangles while that of the iteration is studied, as a part of the diagonal.
const MIDDLE: f64 = 1.0 / 500.0;

/// What is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum IntersectionParameter {
    Triangles,
    Newton,
}

/// The objects of a scene.
struct IntersectionStudy {
    scene: Scene,
    diagonal: f64,
    settings: u32,
    parameter: IntersectionParameter,
}

/// Makes the study of the tolerance of triangles.
pub(super) fn triangles(scene: &Scene, options: &Options, watch: &Watch<'_>) -> Result<Study, StudyError> {
    study(scene, options, watch, IntersectionParameter::Triangles)
}

/// Makes the study of the tolerance of Newton's iteration.
pub(super) fn newton(scene: &Scene, options: &Options, watch: &Watch<'_>) -> Result<Study, StudyError> {
    study(scene, options, watch, IntersectionParameter::Newton)
}

fn study(
    scene: &Scene,
    options: &Options,
    watch: &Watch<'_>,
    what: IntersectionParameter,
) -> Result<Study, StudyError> {
    let mut scene = scene.clone();
    scene.objects.iter_mut().for_each(|object| object.tolerance = None);
    if object_intersections(&scene, &CurvePrecision::default())?.iter().all(|m| m.intersection.branches.is_empty()) {
        return Err(StudyError::Nothing("no two objects of the scene meet in a curve"));
    }
    let diagonal = Prepared::new(&scene)?.bounds.diagonal();
    sweep(&IntersectionStudy { scene, diagonal, settings: options.settings.clamp(1, 7), parameter: what }, watch)
}

impl Knob for IntersectionStudy {
    type Answer = Vec<Intersection>;

    fn setting(&self) -> &'static str {
        match self.parameter {
            IntersectionParameter::Triangles => "tolerance of the triangles (scene units)",
            IntersectionParameter::Newton => "Newton tolerance (part of the size)",
        }
    }

    /// The reference of either is nine times finer than the finest, or what rounding allows.
    fn settings(&self) -> (Vec<f64>, f64) {
        let setting = |i: u32| match self.parameter {
            IntersectionParameter::Triangles => self.diagonal * COARSEST / STEP.powi(i as i32),
            IntersectionParameter::Newton => LOOSEST * NEWTON_STEP.powi(i as i32),
        };
        ((0..self.settings).map(setting).collect(), setting(self.settings + 1))
    }

    fn run(&self, setting: f64, _: &Watch<'_>) -> Result<Trial<Vec<Intersection>>, StudyError> {
        let mut scene = self.scene.clone();
        let (tolerance, newton) = match self.parameter {
            IntersectionParameter::Triangles => (setting, CurvePrecision::default().newton),
            IntersectionParameter::Newton => (self.diagonal * MIDDLE, setting),
        };
        scene.settings.geometry.tolerance = Some(tolerance);
        let start = Instant::now();
        let found = object_intersections(&scene, &CurvePrecision { newton, chord: None })?;
        let seconds = start.elapsed().as_secs_f64();
        let answer: Vec<Intersection> = found.into_iter().map(|meeting| meeting.intersection).collect();
        let count = |of: fn(&Intersection) -> usize| answer.iter().map(of).sum::<usize>() as f64;
        let counts = vec![
            ("points", count(|found| found.points().count())),
            ("not accurate", count(|found| found.points().filter(|point| point.inaccuracy.is_some()).count())),
            ("pairs of triangles", count(|found| found.counts.pairs)),
        ];
        Ok(Trial { answer, seconds, counts })
    }

    fn error_names(&self) -> Vec<&'static str> {
        vec!["greatest residual (scene units)", "lines from the curve (scene units)"]
    }

    fn errors(
        &self,
        trial: &Trial<Vec<Intersection>>,
        reference: &Trial<Vec<Intersection>>,
    ) -> Result<Vec<f64>, StudyError> {
        let residual = trial.answer.iter().flat_map(Intersection::points).map(|p| p.residual).fold(0.0, f64::max);
        let lines = |found: &[Intersection]| -> Vec<[DVec3; 2]> {
            let runs = found.iter().flat_map(|found| found.branches.iter().map(|branch| branch.positions()));
            runs.flat_map(|run| run.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>()).collect()
        };
        let exact = lines(&reference.answer);
        let middle = |[a, b]: &[DVec3; 2]| {
            let at = a.midpoint(*b);
            exact.iter().map(|line| to_line(*line, at)).fold(f64::INFINITY, f64::min)
        };
        let away = lines(&trial.answer).iter().map(middle).fold(0.0, f64::max);
        Ok(vec![residual, away])
    }
}

/// The distance of a point from a line between two others.
fn to_line([from, to]: [DVec3; 2], at: DVec3) -> f64 {
    let along = to - from;
    let part = (at - from).dot(along) / along.length_squared();
    at.distance(from + along * if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 })
}
