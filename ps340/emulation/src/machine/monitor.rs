//! When the machine raises an alarm about its memory, and when nobody is there.

use super::FRAMES_PER_SECOND;

/// Percent by which the use of memory must fall before an alarm fires again. Ours.
const HYSTERESIS: f64 = 5.0;

/// What the monitor saw last.
#[derive(Debug, Default)]
pub(super) struct Monitor {
    /// The limit at which each alarm fired, while that lasts.
    alerted: [Option<f64>; 2],
    /// The frame at which somebody last did something.
    active: u64,
}

impl Monitor {
    /// Whether an alarm fires: when the use of memory reaches its limit, once until it falls or the limit changes.
    ///
    /// - `alarm`: the alarm, by its index.
    /// - `percent`: of the memory that is in use.
    pub(super) fn alarms(&mut self, alarm: usize, percent: f64, limit: f64) -> bool {
        let alerted = &mut self.alerted[alarm];
        if percent < limit - HYSTERESIS || alerted.is_some_and(|before| before != limit) {
            *alerted = None;
        }
        let speaks = percent >= limit && alerted.is_none();
        if speaks {
            *alerted = Some(limit);
        }
        speaks
    }

    /// Somebody did something at a frame.
    pub(super) fn note_activity(&mut self, frame: u64) {
        self.active = frame;
    }

    /// Minutes for which nobody has done anything.
    pub(super) fn idle_minutes(&self, frame: u64) -> f64 {
        (frame - self.active) as f64 / (60 * FRAMES_PER_SECOND) as f64
    }
}
