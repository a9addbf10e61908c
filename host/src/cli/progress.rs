//! What is being done, on a terminal: the stage, and how much of it is done.

use super::interrupts;
use crate::render::Watch;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How often the time is told.
const TICK: Duration = Duration::from_millis(200);

/// Whether stages are shown.
static SHOWN: AtomicBool = AtomicBool::new(false);
/// The stage, and its line on the terminal.
static STAGE: Mutex<(&str, Option<ProgressBar>)> = Mutex::new(("", None));

fn state() -> MutexGuard<'static, (&'static str, Option<ProgressBar>)> {
    STAGE.lock().unwrap_or_else(PoisonError::into_inner)
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
        bar.set_message(name.trim_start_matches("while "));
        bar.enable_steady_tick(TICK);
        bar
    });
    *state() = (name, bar);
}

/// So much of the stage is done.
pub(super) fn update(done: u64, all: u64) {
    if let (_, Some(bar)) = &*state() {
        if bar.length().is_none()
            && let Ok(style) = ProgressStyle::with_template("{msg} [{bar:40}] {pos}/{len}, {eta} to go")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_length(all);
        bar.set_position(done);
    }
}

/// Takes the line off the terminal, before something else is said.
pub(super) fn clear() {
    if let Some(bar) = state().1.take() {
        bar.finish_and_clear();
    }
}

/// The stage, in words that follow `interrupted`; none at the beginning.
pub(super) fn current() -> &'static str {
    state().0
}

/// One who watches work for the person at the terminal, and stops it after a signal.
pub(super) fn watch() -> Watch<'static> {
    Watch { cancelled: interrupts::flag(), progress: &update, stage: &stage, memo: None }
}
