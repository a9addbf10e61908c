//! The time of the machine: frames, and how much it does in a step.

/// Frames a second: the nominal refresh rate, as remembered from the manuals.
pub const FRAMES_PER_SECOND: u64 = 60;
/// Messages that functions deliver in one step of the machine: a frame, or some input (at least one a firing). What is
/// left waits for the next step, so that a network that never rests stops neither the display nor the lines. Ours.
pub const WORK_PER_STEP: u64 = 200_000;

/// Microseconds since the machine was made.
pub type Micros = u64;

/// The time of a frame, for clocks.
pub(super) const fn centiseconds(frame: u64) -> u64 {
    frame * 100 / FRAMES_PER_SECOND
}

/// When a frame begins.
pub fn time_of_frame(frame: u64) -> Micros {
    frame * 1_000_000 / FRAMES_PER_SECOND
}
