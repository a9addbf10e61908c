//! What the machine keeps for a host on the parallel interface.

use super::{PlainText, addresses::Addresses, host_line::HostLine};
use crate::{line::LineId, memory::MassMemory};
use protocol::parallel::{Code, CommandWord, ParallelFrameReader, write_word};

/// What the machine keeps for a host on the parallel interface.
#[derive(Debug)]
pub(super) struct ParallelLine {
    pub(super) line: LineId,
    pub(super) plain_text: PlainText,
    pub(super) frames: ParallelFrameReader,
    /// Reads what WRNET writes.
    pub(super) host: HostLine,
    pub(super) attached: Option<Attached>,
    pub(super) state: ParallelState,
    pub(super) addresses: Addresses,
    /// The frame of the machine at which the current command is given up.
    pub(super) deadline: u64,
    /// Bytes that began no frame, since the latest frame that one began.
    pub(super) noise: u64,
}

/// What a host that attached may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Attached {
    /// Everything.
    ForAll,
    /// Read and write memory.
    ForMemory,
}

/// What the host is to send next.
#[derive(Debug)]
pub(super) enum ParallelState {
    /// A command.
    Idle,
    /// Nothing: RDNET waits for a message.
    Mail(CommandWord),
    /// The byte count.
    Count(CommandWord),
    /// The swap flag.
    Flag(CommandWord, u16),
    /// The block.
    Block(CommandWord, u16, bool),
    /// Nothing: WRPHY_SYNC waits for the refresh.
    Refresh(CommandWord, Vec<u8>),
}

impl ParallelLine {
    /// A line on which nothing has been sent; the machine announces that it is there.
    pub(super) fn new(line: LineId, plain_text: PlainText, out: &mut Vec<u8>) -> ParallelLine {
        write_word(Code::Reset as u16, out);
        ParallelLine {
            line,
            plain_text,
            frames: ParallelFrameReader::default(),
            host: HostLine::new(line, plain_text),
            attached: None,
            state: ParallelState::Idle,
            addresses: Addresses::default(),
            deadline: 0,
            noise: 0,
        }
    }

    /// Gives up what is open. Returns the name of the structure that was.
    pub(super) fn abandon(&mut self, memory: &mut MassMemory) -> Option<String> {
        self.host.abandon(memory)
    }
}
