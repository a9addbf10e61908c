//! Whether a signal asked work to stop.

use std::sync::atomic::AtomicBool;

/// Set by the first signal, while something is to be kept.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Set when work that is worth keeping is to stop.
pub(super) fn flag() -> &'static AtomicBool {
    &INTERRUPTED
}
