//! A stage that is open.

use std::time::{Duration, Instant};
use tracing::Span;
use tracing::span::EnteredSpan;

/// The target of the spans of stages, by which filters know them.
pub const TARGET: &str = "peris::stage";

/// Opens a stage of the work: `stage!("building the octree")`, or `stage!("rendering", 48.0, "samples")` where it is
/// known how much there is to do. Its name follows `while` in messages.
///
/// The stages within one that is `opaque`, as in `stage!("studying", 9.0, "measurements", opaque)`, are timed, but not
/// shown to the person who waits.
#[macro_export]
macro_rules! stage {
    ($name:literal) => {
        $crate::stages::stage!(@ $name, 0.0, "", false)
    };
    ($name:literal, opaque) => {
        $crate::stages::stage!(@ $name, 0.0, "", true)
    };
    ($name:literal, $all:expr, $unit:expr) => {
        $crate::stages::stage!(@ $name, $all, $unit, false)
    };
    ($name:literal, $all:expr, $unit:expr, opaque) => {
        $crate::stages::stage!(@ $name, $all, $unit, true)
    };
    (@ $name:literal, $all:expr, $unit:expr, $opaque:literal) => {
        $crate::stages::StageSpan::enter(tracing::info_span!(
            target: $crate::stages::TARGET,
            $name,
            all = $all,
            unit = $unit,
            opaque = $opaque,
            done = tracing::field::Empty
        ))
    };
}

/// Opens a part of a stage, for profiles: `part!(stage, "block", n)` is the part with the number `n` of a stage, on any
/// thread. It ends when what is given back is dropped.
#[macro_export]
macro_rules! part {
    ($stage:expr, $name:literal, $number:expr) => {
        tracing::debug_span!(target: $crate::stages::TARGET, parent: $stage.span(), $name, number = $number as u64)
            .entered()
    };
}

/// A stage that is open in the thread in which it began, until this is dropped.
#[derive(Debug)]
pub struct StageSpan {
    span: EnteredSpan,
    begin: Instant,
}

impl StageSpan {
    /// Enters a span with the [`TARGET`] of stages.
    pub fn enter(span: Span) -> StageSpan {
        StageSpan { span: span.entered(), begin: Instant::now() }
    }

    /// Says how much of the stage is done; from any thread.
    ///
    /// - `done`: in the unit of the stage, from 0 to all that there is to do.
    pub fn progress(&self, done: f64) {
        self.span.record("done", done);
    }

    /// Wall-clock time since it began.
    pub fn elapsed(&self) -> Duration {
        self.begin.elapsed()
    }

    /// Wall-clock time since it began, seconds.
    pub fn seconds(&self) -> f64 {
        self.elapsed().as_secs_f64()
    }

    /// The span, as the parent of others.
    pub fn span(&self) -> &Span {
        &self.span
    }
}
