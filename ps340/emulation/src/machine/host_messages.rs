//! The latest messages to the host.

use std::collections::VecDeque;

/// Messages to the host that wait for the operator.
const MAX_HOST_MESSAGES: usize = 1000;
/// Bytes of them; but the latest is always kept.
const MAX_HOST_MESSAGE_BYTES: usize = 1 << 20;

/// The latest messages to the host, for the operator.
#[derive(Debug, Default)]
pub(super) struct HostMessages {
    messages: VecDeque<Vec<u8>>,
    bytes: usize,
}

impl HostMessages {
    /// One more message; the oldest give way.
    pub(super) fn push(&mut self, message: &[u8]) {
        while self.messages.len() >= MAX_HOST_MESSAGES || self.bytes + message.len() > MAX_HOST_MESSAGE_BYTES {
            if self.pop().is_none() {
                break;
            }
        }
        self.bytes += message.len();
        self.messages.push_back(message.to_vec());
    }

    /// The oldest message.
    pub(super) fn pop(&mut self) -> Option<Vec<u8>> {
        let oldest = self.messages.pop_front()?;
        self.bytes -= oldest.len();
        Some(oldest)
    }
}
