//! Messages that wait for a host on the parallel interface.

use std::collections::VecDeque;

/// Messages that wait for RDNET; later ones are dropped. Ours.
pub(super) const MAX_MESSAGES: usize = 1000;
/// Bytes of messages that wait for RDNET. Ours.
const MAX_MESSAGE_BYTES: usize = 8 << 20;
/// Messages of the function network that wait for a host on the parallel interface.
#[derive(Debug, Default)]
pub(super) struct Mailbox {
    pub(super) open: bool,
    pub(super) messages: VecDeque<Vec<u8>>,
    pub(super) bytes: usize,
    pub(super) lost: u64,
}

impl Mailbox {
    /// A message for the host; dropped and counted when too many wait, and nothing if the host is not attached.
    pub(super) fn push(&mut self, message: &[u8]) {
        if !self.open {
            return;
        }
        if self.messages.len() >= MAX_MESSAGES || self.bytes + message.len() > MAX_MESSAGE_BYTES {
            self.lost += 1;
            return;
        }
        self.bytes += message.len();
        self.messages.push_back(message.to_vec());
    }

    /// The oldest message.
    pub(super) fn pop(&mut self) -> Option<Vec<u8>> {
        let message = self.messages.pop_front()?;
        self.bytes -= message.len();
        Some(message)
    }
}
