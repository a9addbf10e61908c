//! What is being done, on a terminal: the stage, and how much of it is done.

use super::cancelled::flag;
use crate::render::{Progress, Watch};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How often the time is told.
const TICK: Duration = Duration::from_millis(200);

/// Whether stages are shown.
static SHOWN: AtomicBool = AtomicBool::new(false);
/// The stage that ends the work on a picture.
const LAST: &str = "while rendering";
/// Steps of the bar.
const STEPS: u64 = 1000;

/// What is being done.
struct State {
    stage: &'static str,
    /// Its line on the terminal.
    bar: Option<ProgressBar>,
    begin: Instant,
    /// What follows.
    then: String,
}

static STATE: LazyLock<Mutex<State>> =
    LazyLock::new(|| Mutex::new(State { stage: "", bar: None, begin: Instant::now(), then: String::new() }));

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on, stages are shown on standard error if that is a terminal.
///
/// - `quiet`: not even then.
pub(super) fn begin(quiet: bool) {
    SHOWN.store(!quiet && std::io::stderr().is_terminal(), Ordering::Relaxed);
}

/// A stage begins: what is done, such as `while rendering`.
pub(super) fn stage(name: &'static str) {
    clear();
    let bar = SHOWN.load(Ordering::Relaxed).then(|| {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("{msg} {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(words(name));
        bar.enable_steady_tick(TICK);
        bar
    });
    let mut state = state();
    (state.stage, state.bar, state.begin) = (name, bar, Instant::now());
}

/// So much of the stage is done.
pub(super) fn update(amount: Progress) {
    let state = state();
    if let Some(bar) = &state.bar {
        if bar.length().is_none()
            && let Ok(style) = ProgressStyle::with_template("{prefix} [{bar:24}] {msg}")
        {
            bar.set_style(style.progress_chars("=> "));
            bar.set_prefix(words(state.stage));
        }
        bar.set_length(STEPS);
        bar.set_position((amount.done / amount.all * STEPS as f64) as u64);
        let left = left(amount, state.begin.elapsed());
        let then = if state.stage == LAST { "" } else { state.then.as_str() };
        bar.set_message(format!("{}{left}{then}", describe(amount)));
    }
}

/// How much of how much, such as `12 of 48 samples`.
pub(super) fn describe(Progress { done, all, unit }: Progress) -> String {
    let decimals = usize::from(done < 10.0 && done.fract() != 0.0);
    format!("{done:.decimals$} of {all} {unit}")
}

/// Minutes and seconds.
pub(super) fn clock(seconds: f64) -> String {
    let seconds = seconds.ceil() as u64;
    format!("{}:{:02}", seconds / 60, seconds % 60)
}

/// The time that is left, as far as what is done tells it.
fn left(amount: Progress, elapsed: Duration) -> String {
    let seconds = elapsed.as_secs_f64() * (amount.all / amount.done - 1.0);
    if seconds.is_finite() { format!(", {} left", clock(seconds)) } else { String::new() }
}

/// A stage in words.
pub(super) fn words(stage: &'static str) -> &'static str {
    stage.strip_prefix("while ").unwrap_or(stage)
}

/// What follows the stages before the last one, for their lines, such as `48 samples`.
pub(super) fn follow(what: &str) {
    state().then = format!(", then {what}");
}

/// Takes the line off the terminal, before something else is said.
pub(super) fn clear() {
    if let Some(bar) = state().bar.take() {
        bar.finish_and_clear();
    }
}

/// The stage, in words that follow `interrupted`; none at the beginning.
pub(super) fn current() -> &'static str {
    state().stage
}

/// One who watches work for the person at the terminal, and stops it after a signal.
pub(super) fn watch() -> Watch<'static> {
    Watch { cancelled: flag(), progress: &update, stage: &stage, memo: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_and_times_are_short() {
        let of = |done, all| Progress { done, all, unit: "samples" };
        assert_eq!(describe(of(0.25, 48.0)), "0.2 of 48 samples");
        assert_eq!(describe(of(12.4, 48.0)), "12 of 48 samples");
        assert_eq!(describe(Progress::of(3, 6, "rounds")), "3 of 6 rounds");
        assert_eq!(left(of(12.0, 48.0), Duration::from_secs(30)), ", 1:30 left");
        assert_eq!(left(of(0.0, 48.0), Duration::from_secs(30)), "");
        assert_eq!(["0:00", "0:01", "1:01"], [0.0, 0.2, 60.2].map(clock));
    }
}
