//! What the machine watches by itself: the use of memory, and whether somebody is there.

use super::{FRAMES_PER_SECOND, Machine};
use crate::memory::MASS_MEMORY;
use protocol::Value;

/// The alarms of memory.
const ALERTS: [&str; 2] = ["MEMORY_ALERT", "MEMALERT"];
/// Percent by which the use of memory must fall before an alarm speaks again. Ours.
const RELIEF: f64 = 5.0;

/// What was seen last.
#[derive(Debug, Default)]
pub(super) struct Watch {
    /// The limit at which each alarm spoke, while that lasts.
    alerted: [Option<f64>; 2],
    /// The frame at which somebody last did something.
    active: u64,
}

impl Machine {
    /// The use of memory in one line. Ours; it fits the strip over the function keys.
    pub(super) fn memory_line(&self) -> String {
        let used = self.memory.bytes();
        let free = MASS_MEMORY.saturating_sub(used);
        format!("MEMORY {used:>10} bytes in use {free:>10} bytes free")
    }

    /// Somebody does something: the screen saver waits again.
    pub(super) fn activity(&mut self) {
        self.watch.active = self.frame;
        self.tube.blanked = false;
    }

    /// Looks after memory and screen, once a frame.
    pub(super) fn watch(&mut self) {
        let percent = self.memory.bytes() as f64 / MASS_MEMORY as f64 * 100.0;
        for (place, name) in ALERTS.into_iter().enumerate() {
            let Some(limit) = self.constant(name, 1) else { continue };
            let alerted = &mut self.watch.alerted[place];
            if percent < limit - RELIEF || alerted.is_some_and(|before| before != limit) {
                *alerted = None;
            }
            if percent >= limit && alerted.is_none() {
                *alerted = Some(limit);
                let text = Value::string(self.memory_line());
                self.emit(vec![(name, 1, text)]);
            }
        }
        let minutes = self.constant("SCREENSAVE", 2).unwrap_or(0.0);
        let idle = (self.frame - self.watch.active) as f64 / (60 * FRAMES_PER_SECOND) as f64;
        self.tube.blanked |= minutes > 0.0 && idle >= minutes;
    }

    /// The number at a constant input of a system function.
    fn constant(&self, name: &str, input: u16) -> Option<f64> {
        let port = self.memory.network.port(self.memory.objects.find(name)?, input)?;
        port.first().and_then(Value::number)
    }
}
