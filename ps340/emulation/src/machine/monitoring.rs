//! What the machine watches by itself: the use of memory, and whether somebody is there.

use super::Machine;
use crate::memory::MASS_MEMORY;
use protocol::Value;

/// The alarms of memory.
const ALERTS: [&str; 2] = ["MEMORY_ALERT", "MEMALERT"];

impl Machine {
    /// The use of memory in one line. Ours; it fits the strip over the function keys.
    pub(super) fn memory_line(&self) -> String {
        let used = self.memory.bytes();
        let free = MASS_MEMORY.saturating_sub(used);
        format!("MEMORY {used:>10} bytes in use {free:>10} bytes free")
    }

    /// Somebody does something: the screen saver waits again.
    pub(super) fn activity(&mut self) {
        self.monitor.note_activity(self.frame);
        self.tube.blanked = false;
    }

    /// Looks after memory and screen, once a frame.
    pub(super) fn monitor(&mut self) {
        let percent = self.memory.bytes() as f64 / MASS_MEMORY as f64 * 100.0;
        for (place, name) in ALERTS.into_iter().enumerate() {
            let Some(limit) = self.constant(name, 1) else { continue };
            if self.monitor.alarms(place, percent, limit) {
                let text = Value::string(self.memory_line());
                self.emit(vec![(name, 1, text)]);
            }
        }
        let minutes = self.constant("SCREENSAVE", 2).unwrap_or(0.0);
        let idle = self.monitor.idle_minutes(self.frame);
        self.tube.blanked |= minutes > 0.0 && idle >= minutes;
    }

    /// The number at a constant input of a system function.
    fn constant(&self, name: &str, input: u16) -> Option<f64> {
        let port = self.memory.network.port(self.memory.objects.find(name)?, input)?;
        port.first().and_then(Value::number)
    }
}
