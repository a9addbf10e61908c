//! The host lines that are open, and how messages go to each.

use super::{PlainText, host_line::HostLine, mailbox::Mailbox, parallel_line::ParallelLine};
use crate::line::LineId;
use protocol::wire::{MessageForm, MessageWriter};
use std::collections::BTreeMap;

/// What the machine keeps for its hosts.
#[derive(Debug, Default)]
pub(super) struct Lines {
    /// Hosts that send a stream, and the machine's own command line.
    pub(super) hosts: BTreeMap<LineId, HostLine>,
    /// Hosts on the parallel interface.
    pub(super) parallels: BTreeMap<LineId, ParallelLine>,
    /// Messages for the hosts of `parallels`.
    pub(super) mailboxes: BTreeMap<LineId, Mailbox>,
    /// How messages go to each host that sends a stream.
    pub(super) writers: BTreeMap<LineId, MessageWriter>,
    /// The line whose commands are carried out, if it asked for messages of its own.
    pub(super) reporting_to: Option<LineId>,
}

impl Lines {
    /// A line opens on which a stream comes.
    pub(super) fn attach(&mut self, line: LineId, plain_text: PlainText) {
        self.hosts.insert(line, HostLine::new(line, plain_text));
        self.writers.insert(line, MessageWriter::default());
    }

    /// A line opens on the parallel interface. Returns what the machine sends there.
    pub(super) fn attach_parallel(&mut self, line: LineId, plain_text: PlainText) -> Vec<u8> {
        let mut bytes = Vec::new();
        let parallel = ParallelLine::new(line, plain_text, &mut bytes);
        self.parallels.insert(line, parallel);
        bytes
    }

    /// The messages that wait for a host on the parallel interface.
    pub(super) fn mailbox(&mut self, line: LineId) -> &mut Mailbox {
        self.mailboxes.entry(line).or_default()
    }

    /// What is reported from now on is about the commands of a line: if it asked for messages of its own, the reports
    /// go to it alone.
    pub(super) fn report_to(&mut self, line: LineId) {
        let own = |writer: &MessageWriter| writer.form() == MessageForm::Own;
        self.reporting_to = self.writers.get(&line).is_some_and(own).then_some(line);
    }

    /// The recipients of what an instance of the host line sends: lines with a writer.
    ///
    /// - `of`: the line to which the instance belongs, if it belongs to one.
    pub(super) fn recipients(&self, of: Option<LineId>) -> Vec<(LineId, MessageWriter)> {
        let hears = |line: &LineId, writer: &MessageWriter| match of {
            Some(owner) => *line == owner,
            None => writer.form() != MessageForm::Own,
        };
        self.writers.iter().filter(|(line, writer)| hears(line, writer)).map(|(line, w)| (*line, *w)).collect()
    }

    /// The lines that asked for messages of their own.
    pub(super) fn with_own_messages(&self) -> impl Iterator<Item = LineId> {
        let own = self.writers.iter().filter(|(_, writer)| writer.form() == MessageForm::Own);
        own.map(|(line, _)| *line)
    }

    /// The host of the terminal: the one that is wanted, if it is there, or else the one that came first.
    pub(super) fn terminal_host(&self, wanted: Option<LineId>) -> Option<LineId> {
        let host = wanted.filter(|line| self.writers.contains_key(line));
        host.or_else(|| self.writers.keys().next().copied())
    }
}
