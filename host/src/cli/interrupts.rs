//! Signals that ask the program to end: Ctrl-C, a request to terminate, a terminal that is closed.
//!
//! Files are written whole or not at all, databases keep their last transaction, and a PS 340 of our own ends when its
//! operator commands do. So the program may end at any time, and does so at once, unless there is work in memory that
//! is worth keeping: whoever holds such work says so by [`InterruptGuard`], and is then asked to stop and to write it.
//!
//! It ends in the same way where more memory is wanted than it may hold.

use super::cancelled::flag;
use super::{Exit, progress};
use crate::memory;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGXFSZ};
use signal_hook::iterator::Signals;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How long a thread that wanted too much memory waits for the one that says so.
const REPORT_TIMEOUT: Duration = Duration::from_secs(1);

/// Bytes that were wanted beyond the limit; 0 before that.
static EXCESS_BYTES: AtomicU64 = AtomicU64::new(0);
static STATE: Mutex<State> = Mutex::new(State { guards: 0, saved: String::new() });

struct State {
    /// How many hold work that is worth keeping.
    guards: usize,
    /// What is kept already, in words.
    saved: String,
}

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on, signals end the program as this module says, and so does a want of more memory than it may hold.
///
/// - `name`: of the sub-command, for messages.
/// - `most`: bytes that the program may hold; none for no limit.
pub(super) fn begin(name: &str, most: Option<u64>) {
    // A file that grows beyond a limit is an error of its writer, and no reason to end without a word.
    let is_refused = signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false))).err();
    let hangup = (!processes::is_ignored(SIGHUP as u32)).then_some(SIGHUP);
    let wanted = [SIGINT, SIGTERM, SIGUSR1].into_iter().chain(hangup);
    let signals = match (Signals::new(wanted), is_refused) {
        (Ok(signals), None) => signals,
        (Err(error), _) | (_, Some(error)) => {
            return tracing::warn!("Ctrl-C will end the process at once: {error}");
        }
    };
    let name = name.to_owned();
    std::thread::spawn(move || serve(signals, &name));
    if let Some(most) = most {
        memory::limit_to(most, end_for_memory);
    }
}

fn serve(mut signals: Signals, name: &str) {
    for signal in signals.forever() {
        let wanted = EXCESS_BYTES.load(Ordering::Relaxed);
        if signal == SIGUSR1 && wanted == 0 {
            continue;
        }
        // Who begins to keep something now must wait, and find out that it is too late.
        let state = state();
        if wanted > 0 {
            let limit = memory::readable(memory::limit().unwrap_or_default());
            let event = format!("stopped at {limit} of memory when {} more were wanted", memory::readable(wanted));
            let hint = " (--memory SIZE sets how much there is)";
            end(name, &event, hint, &state, Exit::Failed);
        }
        if state.guards == 0 || flag().swap(true, Ordering::Relaxed) {
            end(name, "interrupted", "", &state, Exit::Interrupted);
        }
    }
}

/// Says what happened while what was done, and ends.
fn end(name: &str, event: &str, hint: &str, state: &State, exit: Exit) -> ! {
    let stage = progress::current();
    progress::clear();
    let kept = match (state.guards, state.saved.as_str()) {
        (1.., _) if exit == Exit::Interrupted => "not waiting for what is being written",
        (_, "") => "nothing is written",
        (_, kept) => kept,
    };
    let space = if stage.is_empty() { "" } else { " while " };
    eprintln!("peris {name}: {event}{space}{stage}{hint}; {kept}");
    let _naming = files::naming();
    std::process::exit(exit as i32);
}

/// Ends the program where more memory is wanted than it may hold.
///
/// The thread that wants it may hold any lock, so another one reports.
fn end_for_memory(wanted: u64) -> ! {
    EXCESS_BYTES.store(wanted.max(1), Ordering::Relaxed);
    if signal_hook::low_level::raise(SIGUSR1).is_ok() {
        std::thread::sleep(REPORT_TIMEOUT);
    }
    signal_hook::low_level::exit(Exit::Failed as i32)
}

/// What an interruption says from now on of what is kept already.
pub(super) fn note_saved(what: impl Into<String>) {
    state().saved = what.into();
}

/// Work in memory that is worth keeping: as long as this lives, the first signal asks to stop, and only the second ends
/// the program.
pub(super) struct InterruptGuard(());

impl InterruptGuard {
    /// From now on there is something to keep.
    pub(super) fn begin() -> InterruptGuard {
        state().guards += 1;
        InterruptGuard(())
    }
}

impl Drop for InterruptGuard {
    fn drop(&mut self) {
        state().guards -= 1;
    }
}
