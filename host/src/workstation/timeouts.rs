//! How long the workstation may take.

use std::time::Duration;

/// How long the workstation may take before the host gives up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timeouts {
    /// Until the line is open, or until a PS 340 of our own is ready.
    pub attach: Duration,
    /// Until it answers, or reads more of what is sent.
    pub answer: Duration,
    /// Until an operator command is carried out.
    pub operator_command: Duration,
}

impl Timeouts {
    /// One time for everything.
    ///
    /// - `seconds`: 1 and above.
    pub fn of(seconds: u32) -> Timeouts {
        let time = Duration::from_secs(seconds.into());
        Timeouts { attach: time, answer: time, operator_command: time }
    }
}

impl Default for Timeouts {
    fn default() -> Timeouts {
        let [attach, answer, order] = [30, 30, 120].map(Duration::from_secs);
        Timeouts { attach, answer, operator_command: order }
    }
}
