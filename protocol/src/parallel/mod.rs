//! The words of the parallel interface, and how they travel over a stream of bytes. `PARALLEL.md` shows the dialogues.
//!
//! # Source
//! Codes, replies and the order of words are those of a UNIX driver of the time. The frames around them, the reply that
//! reports an error, and everything called ours are of this project.

mod address;
mod frame;
mod listing;

pub use address::{AddressList, Block, MAX_BLOCKS};
pub use frame::{MAX_BLOCK_BYTES, ParallelFrame, ParallelFrameReader, write_block, write_reset, write_word};
pub use listing::{ParallelListing, Side};

/// Added to a command word in the answer that its block has been taken or given.
pub const DONE: u16 = 0x0a00;
/// Added to a command word in the answer that gives a value before a block or instead of one: LOOKUP an address, the
/// reads a byte count.
pub const INFORMATION: u16 = 0x0100;
/// Added to a command word in the answer that reports an error, whose number follows. Ours.
pub const ERROR: u16 = 0x0f00;
/// Longest name in a LOOKUP, in bytes.
pub const MAX_LOOKUP: usize = 256;

/// What a host can command: the highest four bits of a command word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u16)]
pub enum Code {
    /// Gives up what is under way.
    Abort = 0x1000,
    /// Brings the interface to its beginning.
    Reset = 0x3000,
    /// Logical read: the next message of the function network to the host.
    ReadNet = 0x5000,
    /// The address of a named object.
    Lookup = 0x8000,
    /// Reads memory.
    ReadPhysical = 0x9000,
    /// Writes memory between two refreshes.
    WritePhysicalSync = 0xa000,
    /// Writes memory.
    WritePhysical = 0xb000,
    /// Logical write: text and packets.
    WriteNet = 0xc000,
    /// The host leaves.
    Detach = 0xd000,
    /// The host comes.
    Attach = 0xe000,
    /// The host comes, for memory only.
    DiagnosticAttach = 0xf000,
}

impl Code {
    /// All codes with their names.
    pub const ALL: [(Code, &str); 11] = [
        (Code::Abort, "ABORT"),
        (Code::Reset, "RESET"),
        (Code::ReadNet, "RDNET"),
        (Code::Lookup, "LOOKUP"),
        (Code::ReadPhysical, "RDPHY"),
        (Code::WritePhysicalSync, "WRPHY_SYNC"),
        (Code::WritePhysical, "WRPHY"),
        (Code::WriteNet, "WRNET"),
        (Code::Detach, "DETACH"),
        (Code::Attach, "ATTACH"),
        (Code::DiagnosticAttach, "DATTACH"),
    ];

    /// The code in the highest four bits of a word.
    pub fn of(word: u16) -> Option<Code> {
        Code::ALL.iter().map(|row| row.0).find(|code| *code as u16 == word & 0xf000)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Code::ALL.iter().find(|row| row.0 == self).map_or("", |row| row.1)
    }

    /// Whether byte count, swap flag and a block follow.
    pub const fn has_transfer(self) -> bool {
        matches!(
            self,
            Code::ReadNet
                | Code::Lookup
                | Code::ReadPhysical
                | Code::WritePhysicalSync
                | Code::WritePhysical
                | Code::WriteNet
        )
    }
}

/// A command word: a code, and in its lowest four bits the number of the unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CommandWord {
    /// What.
    pub code: Code,
    /// The workstation at the host, 0 to 15; the machine answers with the same.
    pub unit: u8,
}

impl CommandWord {
    /// The command of a word, if it is one.
    pub fn from_word(word: u16) -> Option<CommandWord> {
        if word & 0x0ff0 != 0 {
            return None;
        }
        Code::of(word).map(|code| CommandWord { code, unit: (word & 15) as u8 })
    }

    /// Its word.
    pub const fn word(self) -> u16 {
        self.code as u16 | self.unit as u16 & 15
    }
}

/// What goes wrong on the interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[repr(u16)]
pub enum ParallelError {
    /// The other side did not take a word in time. Only a host can see this.
    #[error("handshake time-out")]
    Handshake = 1,
    /// A byte count that is not allowed, or a block of another length.
    #[error("bad byte count")]
    ByteCount = 2,
    /// An address at which there is no memory, or not enough of it.
    #[error("bad address")]
    Address = 3,
    /// A word that is no command, or one that is not allowed now.
    #[error("bad command")]
    Command = 4,
    /// A name that stands for nothing.
    #[error("name time-out")]
    Name = 5,
    /// The words and blocks of a command did not all come in time.
    #[error("command time-out")]
    Timeout = 6,
    /// Words that memory cannot hold, e.g. a vector that is not finite. Ours.
    #[error("bad data")]
    Data = 7,
}

impl ParallelError {
    /// All of them; 1 to 6 are the numbers of the driver.
    pub const ALL: [ParallelError; 7] = [
        ParallelError::Handshake,
        ParallelError::ByteCount,
        ParallelError::Address,
        ParallelError::Command,
        ParallelError::Name,
        ParallelError::Timeout,
        ParallelError::Data,
    ];

    /// The error with a number.
    pub fn from_number(number: u16) -> Option<ParallelError> {
        ParallelError::ALL.into_iter().find(|error| *error as u16 == number)
    }
}

/// Exchanges the bytes of each word, as the swap flag asks. A last odd byte stays.
pub fn swap(bytes: &mut [u8]) {
    bytes.chunks_exact_mut(2).for_each(|word| word.swap(0, 1));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn command_words_read_back() {
        for (code, name) in Code::ALL {
            let command = CommandWord { code, unit: 9 };
            assert_eq!(CommandWord::from_word(command.word()), Some(command));
            assert_eq!((code.name(), Code::of(code as u16 | DONE)), (name, Some(code)));
        }
        for word in [0, 0x2000, 0x4000, 0x6000, 0x7000, 0x8a00, 0x8010] {
            assert_eq!(CommandWord::from_word(word), None, "{word:04x}");
        }
    }

    #[test]
    fn swapping_twice_changes_nothing() {
        let mut bytes = *b"abcde";
        swap(&mut bytes);
        assert_eq!(&bytes, b"badce");
        swap(&mut bytes);
        assert_eq!(&bytes, b"abcde");
    }
}
