//! The state of the keyboard, and the command line of its command mode.

use super::KeyboardMode;
use crate::line::LineId;
use std::collections::VecDeque;

/// The line of the machine's own command interpreter, which no host has.
pub(super) const LOCAL: LineId = LineId(u64::MAX);

/// Longest command line, in characters.
const MAX_COMMAND: usize = 1000;
/// Command lines that the arrows bring back.
const MAX_REMEMBERED: usize = 50;
const BS: u8 = 8;
const CONTROL_U: u8 = 21;
const DEL: u8 = 127;

/// The state of the keyboard.
#[derive(Debug, Default)]
pub(super) struct Keyboard {
    pub(super) mode: KeyboardMode,
    /// The command line so far.
    pub(super) line: Vec<u8>,
    /// The latest command lines, oldest first.
    pub(super) remembered: VecDeque<Vec<u8>>,
    /// The one of them that was brought back: so many before the next.
    pub(super) back: usize,
    /// Whether a prompt stands at the cursor and waits.
    pub(super) prompted: bool,
    /// The host whose text the terminal received last.
    pub(super) host: Option<LineId>,
    /// What the terminal sent to its host, for whoever observes it.
    pub(super) typed: Vec<u8>,
}

/// What a typed character does to the command line.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Edit {
    /// Shows this.
    Echo(Vec<u8>),
    /// Ends the line.
    Done(Vec<u8>),
}

impl Keyboard {
    /// Where typed characters go now.
    pub(super) fn mode(&self) -> KeyboardMode {
        self.mode
    }

    /// A host is gone.
    pub(super) fn detach(&mut self, line: LineId) {
        self.host = self.host.filter(|host| *host != line);
    }

    /// What a typed character does.
    pub(super) fn edit(&mut self, character: u8) -> Edit {
        match character {
            b'\r' | b'\n' => {
                let line = std::mem::take(&mut self.line);
                self.back = 0;
                if !line.is_empty() && self.remembered.back() != Some(&line) {
                    self.remembered.push_back(line.clone());
                    let excess = self.remembered.len().saturating_sub(MAX_REMEMBERED);
                    self.remembered.drain(..excess);
                }
                Edit::Done(line)
            }
            BS | DEL if self.line.pop().is_some() => Edit::Echo(b"\x08 \x08".to_vec()),
            CONTROL_U => self.replace(Vec::new()),
            b'\t' => self.edit(b' '),
            32..=126 if self.line.len() < MAX_COMMAND => {
                self.line.push(character);
                Edit::Echo(vec![character])
            }
            _ => Edit::Echo(Vec::new()),
        }
    }

    /// Brings a remembered line back: an older one, or a younger one.
    pub(super) fn recall(&mut self, older: bool) -> Edit {
        let wanted = if older { self.back + 1 } else { self.back.saturating_sub(1) };
        if wanted > self.remembered.len() {
            return Edit::Echo(Vec::new());
        }
        self.back = wanted;
        let line = self.remembered.len().checked_sub(wanted).and_then(|at| self.remembered.get(at));
        self.replace(line.cloned().unwrap_or_default())
    }

    fn replace(&mut self, line: Vec<u8>) -> Edit {
        let mut echo = b"\x08 \x08".repeat(self.line.len());
        echo.extend_from_slice(&line);
        self.line = line;
        Edit::Echo(echo)
    }
}
