//! Who watches long work: how it is stopped, and where its results are kept. How far it is, its stages tell:
//! [`crate::stages`].

use super::memo::Memo;
use std::sync::atomic::{AtomicBool, Ordering};

/// Who watches long work and may stop it.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Set from outside to stop after the rows that are being rendered.
    pub cancelled: &'a AtomicBool,
    /// The memo in which results of long computations are kept, if there is one.
    pub memo: Option<&'a Memo>,
}

/// Is never set.
static NEVER: AtomicBool = AtomicBool::new(false);

impl Watch<'_> {
    /// Nobody watches.
    pub const NOBODY: Watch<'static> = Watch { cancelled: &NEVER, memo: None };

    /// One who may stop what another watches, and keeps nothing of it.
    pub fn without_memo(&self) -> Watch<'_> {
        Watch { memo: None, ..*self }
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}
