//! The latest bytes on the host lines.

use crate::line::LineId;
use std::{collections::VecDeque, sync::Arc};

/// Bytes that are kept; older ones go.
pub const MAX_TRAFFIC: usize = 64 << 10;

/// Bytes that passed on a line at once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrafficEntry {
    /// The time of the machine in microseconds.
    pub micros: u64,
    /// On which line.
    pub line: LineId,
    /// Whether the host sent them; else the machine did.
    pub from_host: bool,
    /// What passed: of more than 64 KiB, the first.
    pub bytes: Arc<[u8]>,
}

/// What passed lately.
#[derive(Debug, Default)]
pub struct Traffic {
    entries: VecDeque<TrafficEntry>,
    bytes: usize,
    has_changed: bool,
}

impl Traffic {
    /// Bytes pass.
    pub(super) fn record(&mut self, micros: u64, line: LineId, from_host: bool, bytes: &[u8]) {
        let bytes: Arc<[u8]> = bytes[..bytes.len().min(MAX_TRAFFIC)].into();
        self.bytes += bytes.len();
        self.entries.push_back(TrafficEntry { micros, line, from_host, bytes });
        self.has_changed = true;
        // Many small pieces count as well: each is an entry of a list on the screen.
        while self.bytes > MAX_TRAFFIC || self.entries.len() > MAX_TRAFFIC / 16 {
            let Some(oldest) = self.entries.pop_front() else { break };
            self.bytes -= oldest.bytes.len();
        }
    }

    /// Whether something has passed since this was asked last.
    pub(super) fn take_change(&mut self) -> bool {
        std::mem::take(&mut self.has_changed)
    }

    /// What is kept, oldest first.
    pub(super) fn entries(&self) -> impl Iterator<Item = &TrafficEntry> {
        self.entries.iter()
    }

    pub(super) fn clear(&mut self) {
        *self = Traffic::default();
    }
}
