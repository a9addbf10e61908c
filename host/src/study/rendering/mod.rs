//! The knobs of the renderers: run time and error of each setting against a reference that is as good as all knobs make
//! it.
//!
//! Every other knob stays as the scene has it while one is swept. The error of the sweep therefore has a floor where it
//! is no longer that of the knob: then the study says what else it is.

mod best;
mod error_floor;
mod knob;
mod measure;
mod results;
mod report;
mod setup;
#[cfg(test)]
mod tests;

pub use error_floor::ErrorFloor;
pub use knob::{RENDER_KNOBS, RenderKnob};
pub use measure::ErrorMeasures;
pub use results::{KnobStudy, RenderRow, RenderStudy};
pub use setup::{studied, usual};

use super::{Options, StudyError};
use crate::picture::Picture;
use crate::render::{Technique, Watch};
use crate::scene::Scene;
use crate::stages::{StageSpan, stage};
use best::knobs_of;
use error_floor::error_floor;
use measure::ReferencePicture;
use setup::{Setup, StudiedScene, TimedRendering};

/// A setting is tried again, for its shortest time, while it took less than this many seconds in all; in tests always as
/// often, so that what they find does not depend on how busy the machine is.
const SHORT_SECONDS: f64 = if cfg!(test) { f64::INFINITY } else { 0.25 };
/// Most times that one setting is tried.
const MOST_TRIALS: usize = 5;
/// A knob is named as a cause of bias if it takes away more than this part of its square.
const CAUSE: f64 = 0.05;

/// Options that give useful curves of all knobs within a few minutes.
pub const RENDER_OPTIONS: Options = Options { width: 64, samples: 256, settings: 5, threads: None };

/// Sweeps knobs of renderers.
///
/// - `techniques`, `names`: the renderers, and the names of knobs in [`RENDER_KNOBS`]; a knob that a renderer does not
///   have is passed over.
///
/// Being stopped is no error: the study then holds what was finished.
///
/// # Errors
/// [`StudyError`].
pub fn renderers(
    scene: &Scene,
    techniques: &[Technique],
    names: &[&str],
    options: &Options,
    watch: &Watch<'_>,
) -> Result<RenderStudy, StudyError> {
    let base = StudiedScene::new(scene, options)?;
    let chosen: Vec<(Technique, &RenderKnob)> = techniques
        .iter()
        .flat_map(|technique| knobs_of(*technique).map(|knob| (*technique, knob)))
        .filter(|(_, knob)| names.contains(&knob.name))
        .collect();
    let settings = |(technique, knob): &(Technique, &RenderKnob)| {
        if base.idle(*technique, knob).is_some() { 0 } else { (knob.values)(&base).len() as u64 }
    };
    let steps = chosen.iter().map(settings).sum::<u64>();
    let stage = stage!("studying", steps as f64, "measurements", opaque);
    let mut bench = Bench { base: &base, watch, stage, references: Vec::new(), done: 0 };
    let mut study = RenderStudy { knobs: Vec::new(), complete: true };
    for (technique, knob) in chosen {
        let mut found = bench.begin(technique, knob);
        let result = bench.sweep(technique, knob, &mut found);
        match result {
            Ok(()) => study.knobs.push(found),
            Err(StudyError::Interrupted) => {
                if !found.rows.is_empty() {
                    found.verdict = "interrupted".into();
                    study.knobs.push(found);
                }
                study.complete = false;
                break;
            }
            Err(error) => return Err(error),
        }
    }
    Ok(study)
}

/// A scene, and the references that were made of it.
struct Bench<'a> {
    base: &'a StudiedScene,
    watch: &'a Watch<'a>,
    stage: StageSpan,
    references: Vec<(Setup, ReferencePicture)>,
    done: u64,
}

impl Bench<'_> {
    /// A study without rows.
    fn begin(&self, technique: Technique, knob: &RenderKnob) -> KnobStudy {
        let own = self.base.own(technique);
        KnobStudy {
            technique,
            name: knob.name,
            sets: knob.sets,
            scene: (knob.get)(&own),
            best: (knob.best)(self.base, technique),
            reference: String::new(),
            reference_error: 0.0,
            reference_seconds: 0.0,
            rows: Vec::new(),
            error_floor: None,
            verdict: String::new(),
        }
    }

    fn sweep(&mut self, technique: Technique, knob: &RenderKnob, found: &mut KnobStudy) -> Result<(), StudyError> {
        if let Some(why) = self.base.idle(technique, knob) {
            found.verdict = format!("changes nothing: {why}");
            return Ok(());
        }
        let left_out = self.base.left_out(technique)?;
        // Where a renderer leaves nothing out, ray tracing is its reference, too, unless samples are added.
        let is_whole = left_out.is_empty();
        let by = if is_whole && !technique.row().adds_samples { Technique::RayTracing } else { technique };
        let best = self.base.best(by, knob);
        let reference = self.reference(&best)?;
        let made = &self.references[reference].1;
        (found.reference_error, found.reference_seconds) = (made.error, made.seconds);
        found.reference = described(&best);
        let mut first: Option<Picture> = None;
        let mut changes = false;
        for setting in (knob.values)(self.base) {
            let mut setup = self.base.own(technique);
            (knob.set)(&mut setup, setting);
            let (row, picture) = self.row(knob, &setup, setting, reference)?;
            changes |= *first.get_or_insert_with(|| picture.clone()) != picture;
            found.rows.push(row);
            self.done += 1;
            self.stage.progress(self.done as f64);
        }
        let measured: Vec<ErrorMeasures> = found.rows.iter().map(|row| row.measures).collect();
        found.error_floor = error_floor(&measured, found.reference_error);
        if let Some(ErrorFloor::Bias { causes, .. }) = &mut found.error_floor {
            *causes = self.causes(technique, knob, reference)?;
        }
        let apart = match is_whole {
            true => None,
            false => {
                let traced = self.base.best(Technique::RayTracing, knob);
                let traced = self.reference(&traced)?;
                Some((self.references[traced].1.apart(&self.references[reference].1)?, left_out))
            }
        };
        found.verdict = report::verdict(found, changes, apart);
        Ok(())
    }

    /// Makes a reference, if there is none yet, and tells which it is.
    fn reference(&mut self, best: &Setup) -> Result<usize, StudyError> {
        if let Some(known) = self.references.iter().position(|(setup, _)| setup == best) {
            return Ok(known);
        }
        let reference = ReferencePicture::new(self.base.halves(best, self.watch)?)?;
        self.references.push((*best, reference));
        Ok(self.references.len() - 1)
    }

    /// Tries a setting with several seeds; also the first picture.
    fn row(
        &self,
        knob: &RenderKnob,
        setup: &Setup,
        setting: f64,
        reference: usize,
    ) -> Result<(RenderRow, Picture), StudyError> {
        let spent = |shots: &[TimedRendering]| shots.iter().map(|shot| shot.render).sum::<f64>();
        let is_enough = |shots: &[TimedRendering]| {
            shots.len() >= 2 && (spent(shots) >= SHORT_SECONDS || shots.len() >= MOST_TRIALS)
        };
        let mut shots = self.base.trials(setup, &is_enough, self.watch)?;
        let least = |of: &dyn Fn(&TimedRendering) -> f64| shots.iter().map(of).fold(f64::INFINITY, f64::min);
        let seconds = least(&|shot| if knob.remodels { shot.build + shot.render } else { shot.render });
        let build = least(&|shot| shot.build);
        let measures = self.references[reference].1.measure(&shots)?;
        Ok((RenderRow { setting, seconds, build, measures }, shots.swap_remove(0).picture))
    }

    /// The other knobs that lower the bias of the scene as it is, and by which part of its square.
    fn causes(
        &self,
        technique: Technique,
        but: &RenderKnob,
        reference: usize,
    ) -> Result<Vec<(String, f64)>, StudyError> {
        let own = self.base.own(technique);
        let (before, _) = self.row(but, &own, 0.0, reference)?;
        let before = before.measures;
        let mut causes = Vec::new();
        for knob in
            knobs_of(technique).filter(|knob| knob.name != but.name && self.base.idle(technique, knob).is_none())
        {
            let mut setup = own;
            (knob.set)(&mut setup, (knob.best)(self.base, technique));
            // Models are the same in the reference, and more samples lower noise only.
            if setup == own || knob.is_model || knob.name == "error" {
                continue;
            }
            let after = self.row(knob, &setup, 0.0, reference)?.0.measures;
            let lowered = before.bias_squared - after.bias_squared;
            let error = before.bias_squared_error.hypot(after.bias_squared_error);
            if lowered > measure::CLEAR * error && lowered > CAUSE * before.bias_squared {
                causes.push((knob.name.to_owned(), lowered / before.bias_squared));
            }
        }
        causes.sort_by(|one, two| two.1.total_cmp(&one.1));
        Ok(causes)
    }
}

/// What a setup is, in words.
fn described(setup: &Setup) -> String {
    let knobs = knobs_of(setup.technique).filter(|knob| !knob.is_model).map(|knob| (knob.name, (knob.get)(setup)));
    let parts: Vec<String> = knobs
        .filter(|(_, value)| *value != 0.0)
        .map(|(name, value)| format!("{name} {}", super::sweep::short(value)))
        .collect();
    format!("two halves by {}, {} each", setup.technique.row().word, parts.join(", "))
}
