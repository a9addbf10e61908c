//! What goes to the hosts at the end of a step.

use crate::line::LineId;
use std::collections::BTreeMap;

/// Bytes that one step may have for a host; messages that come on top are lost and counted. Ours.
pub(super) const MAX_STEP_BYTES: usize = 4 << 20;

/// Bytes for a host.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HostOutput {
    /// On which line.
    pub line: LineId,
    /// Whole messages, one after the other.
    pub bytes: Vec<u8>,
    /// How many these are.
    pub messages: u64,
    /// Messages for which there was no space.
    pub lost: u64,
}

/// What goes to each host.
#[derive(Debug, Default)]
pub(super) struct Outgoing {
    outputs: BTreeMap<LineId, HostOutput>,
}

impl Outgoing {
    /// One more message for a host. A single one always has space.
    pub(super) fn push(&mut self, line: LineId, message: Vec<u8>) {
        let output = self.outputs.entry(line).or_insert_with(|| HostOutput { line, ..HostOutput::default() });
        if output.bytes.is_empty() {
            output.bytes = message;
        } else if output.bytes.len() + message.len() <= MAX_STEP_BYTES {
            output.bytes.extend_from_slice(&message);
        } else {
            output.lost += 1;
            return;
        }
        output.messages += 1;
    }

    /// All of it, by line; nothing is left.
    pub(super) fn take(&mut self) -> Vec<HostOutput> {
        std::mem::take(&mut self.outputs).into_values().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_of_a_line_follow_one_another_and_too_many_are_counted() {
        let (mut outgoing, [one, two]) = (Outgoing::default(), [LineId(1), LineId(2)]);
        outgoing.push(two, b"a".to_vec());
        outgoing.push(one, vec![7; 2 * MAX_STEP_BYTES]);
        outgoing.push(two, b"b".to_vec());
        outgoing.push(one, b"c".to_vec());
        let [first, second] = &outgoing.take()[..] else { panic!("two lines") };
        assert_eq!((first.line, first.bytes.len(), first.messages, first.lost), (one, 2 * MAX_STEP_BYTES, 1, 1));
        assert_eq!((second.line, &second.bytes[..], second.messages, second.lost), (two, &b"ab"[..], 2, 0));
        assert!(outgoing.take().is_empty());
    }
}
