//! Who watches a rendering: what is told while it works, and how it is stopped.

use super::memo::Memo;
use std::sync::atomic::{AtomicBool, Ordering};

/// How much of a stage of the work is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The part that is done, `0..=all`.
    pub done: f64,
    /// All that is to be done.
    pub all: f64,
    /// The unit that is counted, such as `samples`.
    pub unit: &'static str,
}

impl Progress {
    /// Progress of so many of so many.
    pub fn of(done: u64, all: u64, unit: &'static str) -> Progress {
        Progress { done: done as f64, all: all as f64, unit }
    }
}

/// Who watches a rendering and may stop it.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Set from outside to stop after the rows that are being rendered.
    pub cancelled: &'a AtomicBool,
    /// Called when more of the stage is done; from any thread.
    pub progress: &'a (dyn Fn(Progress) + Sync),
    /// Called when another stage of the work begins, with words such as `while rendering`.
    pub stage: &'a (dyn Fn(&'static str) + Sync),
    /// The memo in which results of long computations are kept, if there is one.
    pub memo: Option<&'a Memo>,
}

/// Is never set.
static NEVER: AtomicBool = AtomicBool::new(false);

impl Watch<'_> {
    /// Nobody watches.
    pub const NOBODY: Watch<'static> = Watch { cancelled: &NEVER, progress: &|_| {}, stage: &|_| {}, memo: None };

    /// One who may stop what another watches, and sees nothing of it.
    pub fn quiet(&self) -> Watch<'_> {
        Watch { cancelled: self.cancelled, ..Watch::NOBODY }
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}
