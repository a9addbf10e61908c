//! What is being done, on a terminal: the stage, and how much of it is done; and the record of all stages.

use super::cancelled::flag;
use crate::render::Watch;
use crate::stages::{StageEvent, StageRecord, StageTotal};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How often the time is told.
const TICK: Duration = Duration::from_millis(200);
/// The stage that ends the work on a picture.
const LAST: &str = "rendering";
/// Steps of the bar.
const STEPS: u64 = 1000;

/// How much of a stage is done.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Progress {
    /// The part that is done, `0..=all`.
    pub(super) done: f64,
    /// All that is to be done; 0 where that is not known.
    pub(super) all: f64,
    /// The unit that is counted, such as `samples`.
    pub(super) unit: String,
}

/// A stage that is open.
struct OpenStage {
    id: u64,
    parent: Option<u64>,
    name: &'static str,
    progress: Progress,
    is_opaque: bool,
    begin: Instant,
    /// Whether a stage within which it is keeps it to itself.
    is_hidden: bool,
}

/// What is being done.
struct State {
    /// Whether it is shown.
    is_shown: bool,
    open: Vec<OpenStage>,
    /// The last stage that was begun or gone on with.
    current: &'static str,
    /// The line on the terminal, and the stage of which it tells.
    bar: Option<(u64, ProgressBar)>,
    /// What the stages are part of.
    whole: String,
    /// What follows.
    then: String,
    record: StageRecord,
}

static STATE: LazyLock<Mutex<State>> = LazyLock::new(|| {
    Mutex::new(State {
        is_shown: false,
        open: Vec::new(),
        current: "",
        bar: None,
        whole: String::new(),
        then: String::new(),
        record: StageRecord::new(false),
    })
});

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on, stages are recorded, and shown on standard error if that is a terminal.
///
/// - `quiet`: not even then. `profiles`: whether a profile is wanted.
pub(super) fn begin(quiet: bool, profiles: bool) {
    let mut state = state();
    state.is_shown = !quiet && std::io::stderr().is_terminal();
    state.record = StageRecord::new(profiles);
}

/// Takes note of an event of a stage.
pub(super) fn observe(event: StageEvent) {
    let mut state = state();
    state.record.add(&event);
    match event {
        StageEvent::Begin { part: Some(_), .. } => {}
        StageEvent::Begin { id, parent, name, all, unit, is_opaque, part: None } => {
            let is_hidden =
                parent.and_then(|id| state.stage(id)).is_some_and(|outer| outer.is_hidden || outer.is_opaque);
            let progress = Progress { done: 0.0, all, unit };
            state.open.push(OpenStage { id, parent, name, progress, is_opaque, is_hidden, begin: Instant::now() });
            state.show_innermost();
        }
        StageEvent::Progress { id, done } => {
            let Some(stage) = state.open.iter_mut().find(|stage| stage.id == id) else { return };
            stage.progress.done = done;
            state.show_progress(id);
        }
        StageEvent::End { id } => {
            state.open.retain(|stage| stage.id != id);
            state.show_innermost();
        }
    }
}

impl State {
    fn stage(&self, id: u64) -> Option<&OpenStage> {
        self.open.iter().find(|stage| stage.id == id)
    }

    /// Shows the stage that began last of those that are open.
    fn show_innermost(&mut self) {
        let Some(stage) = self.open.iter().rev().find(|stage| !stage.is_hidden) else {
            return self.clear();
        };
        let (id, name, is_known) = (stage.id, stage.name, stage.progress.done > 0.0);
        self.current = name;
        if !self.is_shown || self.bar.as_ref().is_some_and(|(shown, _)| *shown == id) {
            return;
        }
        self.clear();
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("{msg} {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(format!("{}{name}", self.whole));
        bar.enable_steady_tick(TICK);
        self.bar = Some((id, bar));
        if is_known {
            self.show_progress(id);
        }
    }

    /// Shows how much of a stage is done, if that stage is shown.
    fn show_progress(&mut self, id: u64) {
        if self.is_shown && self.bar.is_none() {
            // The line was taken off the terminal meanwhile.
            return self.show_innermost();
        }
        let Some((_, bar)) = self.bar.as_ref().filter(|(shown, _)| *shown == id) else { return };
        let Some(OpenStage { name, progress, begin, .. }) = self.stage(id) else { return };
        if bar.length().is_none()
            && let Ok(style) = ProgressStyle::with_template("{prefix} [{bar:24}] {msg}")
        {
            bar.set_style(style.progress_chars("=> "));
            bar.set_prefix(format!("{}{name}", self.whole));
        }
        bar.set_length(STEPS);
        bar.set_position((progress.done / progress.all * STEPS as f64) as u64);
        let left = left(progress, begin.elapsed());
        let then = if *name == LAST { "" } else { self.then.as_str() };
        bar.set_message(format!("{}{left}{then}", describe(progress)));
    }

    fn clear(&mut self) {
        if let Some((_, bar)) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

/// How much of how much, such as `12 of 48 samples`.
pub(super) fn describe(Progress { done, all, unit }: &Progress) -> String {
    let decimals = usize::from(*done < 10.0 && done.fract() != 0.0);
    format!("{done:.decimals$} of {all} {unit}")
}

/// Minutes and seconds.
pub(super) fn clock(seconds: f64) -> String {
    let seconds = seconds.ceil() as u64;
    format!("{}:{:02}", seconds / 60, seconds % 60)
}

/// The time that is left, as far as what is done tells it.
pub(super) fn left(progress: &Progress, elapsed: Duration) -> String {
    let seconds = elapsed.as_secs_f64() * (progress.all / progress.done - 1.0);
    if seconds.is_finite() { format!(", {} left", clock(seconds)) } else { String::new() }
}

/// The innermost stage within the one of a name, and how much of it is done as far as that is known.
pub(super) fn within(root: &str) -> Option<(&'static str, Option<Progress>)> {
    let state = state();
    let is_within = |stage: &&OpenStage| {
        let outer = std::iter::successors(Some(*stage), |stage| stage.parent.and_then(|id| state.stage(id)));
        !stage.is_hidden && outer.into_iter().any(|outer| outer.name == root)
    };
    let stage = state.open.iter().rev().find(is_within)?;
    Some((stage.name, Some(stage.progress.clone()).filter(|progress| progress.done > 0.0)))
}

/// What follows the stages before the last one, for their lines, such as `48 samples`.
pub(super) fn follow(what: &str) {
    state().then = format!(", then {what}");
}

/// What the stages from now on are part of, for their lines, such as `frame 12 of 240`.
pub(super) fn lead(what: &str) {
    let mut state = state();
    // A line that is shown has another beginning.
    state.clear();
    state.whole = format!("{what}: ");
}

/// Takes the line off the terminal, before something else is said.
pub(super) fn clear() {
    state().clear();
}

/// The stage that was begun or gone on with last; empty at the beginning.
pub(super) fn current() -> &'static str {
    state().current
}

/// How long stages took that have ended.
pub(super) fn totals() -> Vec<StageTotal> {
    state().record.totals()
}

/// Writes the profile of all stages that have ended: [`StageRecord::write_profile`].
pub(super) fn write_profile(to: &mut dyn Write) -> std::io::Result<()> {
    state().record.write_profile(to)
}

/// One who watches work for the person at the terminal, and stops it after a signal.
pub(super) fn watch() -> Watch<'static> {
    Watch { cancelled: flag(), memo: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_and_times_are_short() {
        let of = |done, all| Progress { done, all, unit: "samples".into() };
        assert_eq!(describe(&of(0.25, 48.0)), "0.2 of 48 samples");
        assert_eq!(describe(&of(12.4, 48.0)), "12 of 48 samples");
        assert_eq!(left(&of(12.0, 48.0), Duration::from_secs(30)), ", 1:30 left");
        assert_eq!(left(&of(0.0, 48.0), Duration::from_secs(30)), "");
        assert_eq!(["0:00", "0:01", "1:01"], [0.0, 0.2, 60.2].map(clock));
    }
}
