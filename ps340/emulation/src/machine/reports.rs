//! The machine's own numbered messages: those that wait to be reported, the latest, and how many of them one frame
//! admits.

use crate::interpreter::Message;
use std::collections::VecDeque;

/// Messages of the machine that reach ERROR, WARNING and INFORMATION between two frames, those reported to one line
/// alone not counted; the rest are logged and counted only, so that a message that causes messages ends. The terminal
/// shows as many of all.
pub const REPORTS_PER_FRAME: u64 = 1000;
/// Messages of the machine between two frames that are written to the log of the process one by one.
const LOGGED_PER_FRAME: u64 = 20;
/// Messages of the machine that are stored for whoever asks for the log.
const LOG_LINES: usize = 1000;

/// Messages of the machine.
#[derive(Debug, Default)]
pub(super) struct Reports {
    /// Messages that wait to be reported.
    pub(super) pending: Vec<Message>,
    /// The latest that were reported, oldest first.
    log: VecDeque<String>,
    /// Messages since the latest frame: all, those given to ERROR, WARNING or INFORMATION, and those that were too many
    /// for these.
    reported: u64,
    emitted: u64,
    unreported: u64,
}

impl Reports {
    /// One more that waits to be reported.
    pub(super) fn push(&mut self, message: Message) {
        self.pending.push(message);
    }

    /// The latest that were reported, oldest first.
    pub(super) fn log(&self) -> impl Iterator<Item = &str> {
        self.log.iter().map(String::as_str)
    }

    /// Whether the next goes to the log of the process by itself.
    pub(super) fn are_few(&self) -> bool {
        self.reported < LOGGED_PER_FRAME
    }

    /// Logs the text of one more that is reported. Returns whether the terminal may show it.
    pub(super) fn log_text(&mut self, text: &str) -> bool {
        if self.log.len() >= LOG_LINES {
            self.log.pop_front();
        }
        self.reported += 1;
        self.log.push_back(text.to_owned());
        self.reported <= REPORTS_PER_FRAME
    }

    /// Whether one more reaches ERROR, WARNING or INFORMATION, which it counts.
    pub(super) fn admits_one(&mut self) -> bool {
        let heard = self.emitted < REPORTS_PER_FRAME;
        *if heard { &mut self.emitted } else { &mut self.unreported } += 1;
        heard
    }

    /// Begins another frame: how many messages were too many for the log of the process since the latest, and how many
    /// reached neither ERROR nor WARNING.
    pub(super) fn begin_frame(&mut self) -> (u64, u64) {
        let [reported, unheard] = [&mut self.reported, &mut self.unreported].map(std::mem::take);
        self.emitted = 0;
        (reported.saturating_sub(LOGGED_PER_FRAME), unheard)
    }
}
