//! A listing of a dialogue over the parallel interface for people.

use super::{
    AddressList, Code, CommandWord, DONE, ERROR, INFORMATION, ParallelError, ParallelFrame, ParallelFrameReader,
    write_block, write_word,
};
use std::fmt::Write;

/// Bytes in a row.
const ROW: usize = 16;
/// Rows of a block that are shown.
const ROWS: usize = 4;

/// The sender of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The host.
    Host,
    /// The machine.
    Machine,
}

/// Lists frames of both sides, in the order in which they were sent.
#[derive(Clone, Debug, Default)]
pub struct ParallelListing {
    host: ParallelFrameReader,
    machine: ParallelFrameReader,
    /// The command in progress.
    command: Option<Code>,
    /// What the next words of the host are, last one first.
    from_host: Vec<&'static str>,
    /// What the next words of the machine are, last one first.
    from_machine: Vec<&'static str>,
}

impl ParallelListing {
    /// Lists what a side sends next; a frame is listed when it is complete.
    pub fn push(&mut self, side: Side, bytes: &[u8], out: &mut String) {
        let reader = if side == Side::Host { &mut self.host } else { &mut self.machine };
        reader.push(bytes);
        let frames: Vec<ParallelFrame> = reader.by_ref().collect();
        for frame in frames {
            let mut raw = Vec::new();
            let meaning = match &frame {
                ParallelFrame::Word(word) => {
                    write_word(*word, &mut raw);
                    self.word(side, *word)
                }
                ParallelFrame::Block(bytes) => {
                    write_block(bytes, &mut raw);
                    self.block(side, bytes)
                }
                ParallelFrame::Reset => {
                    raw.push(b'R');
                    self.from_host.clear();
                    self.from_machine.clear();
                    "pulse of the reset line".into()
                }
                ParallelFrame::Noise(byte) => {
                    raw.push(*byte);
                    "dropped: it begins no frame".into()
                }
            };
            row(side, &raw, &meaning, out);
        }
    }

    fn word(&mut self, side: Side, word: u16) -> String {
        let expected = if side == Side::Host { self.from_host.pop() } else { self.from_machine.pop() };
        match expected {
            Some("error") => match ParallelError::from_number(word) {
                Some(error) => format!("error {word}: {error}"),
                None => format!("error {word}"),
            },
            Some(what) => format!("{what} {word}"),
            None if side == Side::Host => match CommandWord::from_word(word) {
                Some(command) => {
                    self.command = Some(command.code);
                    format!("{word:04x} {}", command.code.name())
                }
                None => format!("{word:04x} no command"),
            },
            None => self.answer(word),
        }
    }

    fn answer(&mut self, word: u16) -> String {
        let name = Code::of(word).map_or("no command", Code::name);
        let reply = match word & 0x0ff0 {
            0 if Code::of(word) == Some(Code::Reset) => "ready",
            0 => {
                if Code::of(word).is_some_and(Code::has_transfer) {
                    self.from_host = vec!["swap flag", "byte count"];
                }
                "ready"
            }
            DONE => "DMA done",
            INFORMATION if Code::of(word) == Some(Code::Lookup) => {
                self.from_machine = vec!["low word of the address", "high word of the address"];
                "address information"
            }
            INFORMATION => {
                self.from_machine = vec!["byte count"];
                "byte count follows"
            }
            ERROR => {
                self.from_machine = vec!["error"];
                self.from_host.clear();
                "error"
            }
            _ => "no answer",
        };
        format!("{word:04x} {name}: {reply}")
    }

    fn block(&self, side: Side, bytes: &[u8]) -> String {
        let text = format!("block of {} bytes", bytes.len());
        match self.command {
            Some(Code::Lookup | Code::WriteNet | Code::ReadNet) => format!("{text}: \"{}\"", bytes.escape_ascii()),
            Some(Code::ReadPhysical | Code::WritePhysical | Code::WritePhysicalSync) if side == Side::Host => {
                match AddressList::read(bytes) {
                    Ok((list, _)) => list.0.iter().fold(text, |mut text, block| {
                        // Writing into a string does not fail.
                        let _ = write!(text, ": {} words at {:08x}", block.words, block.address);
                        text
                    }),
                    Err(error) => format!("{text}: {error}"),
                }
            }
            _ => text,
        }
    }
}

fn row(side: Side, raw: &[u8], meaning: &str, out: &mut String) {
    let name = if side == Side::Host { "host" } else { "PS" };
    let rows = raw.len().div_ceil(ROW);
    for (index, bytes) in raw.chunks(ROW).take(ROWS).enumerate() {
        let hex: Vec<String> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        let (name, meaning) = if index == 0 { (name, meaning) } else { ("", "") };
        let line = format!("{name:<5} {:<48} {meaning}", hex.join(" "));
        out.push_str(line.trim_end());
        out.push('\n');
    }
    if rows > ROWS {
        // Writing into a string does not fail.
        let _ = writeln!(out, "{:54} {} bytes more", "", raw.len() - ROWS * ROW);
    }
}
