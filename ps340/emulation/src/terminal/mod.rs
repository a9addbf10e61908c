//! The terminal emulator: an ANSI terminal of the VT100 class, 24 rows of 80 columns, shown over the picture.
//!
//! Bytes from a host or from ES_TE go in with [`Terminal::feed`]; what the terminal answers (device attributes, cursor
//! position) comes out of [`Terminal::take_replies`]; the text is drawn as strokes of the standard font.
//!
//! # Source
//! That the machine had an ANSI emulation which obeys `ESC [ H ESC [ J` is confirmed by clients; which functions of it
//! is not known. Ours are those of ANSI X3.64 that a VT100 had, and of its successor the insertion and deletion of
//! lines and characters.
//! Not modelled: 132 columns, lines of double height or width, smooth scrolling, the answerback message, the printer.
//! Bytes above 127 are no characters of such a terminal: each shows as a checkered cell.

mod drawing;
mod graphics;
mod keys;
mod modes;
mod operation;
mod screen;
mod sequence;
mod setup;

pub use drawing::{Ink, MESSAGE_ROW, text_line};
pub use keys::{SPECIAL_KEYS, SpecialKey};
pub use modes::Modes;
pub use screen::{Attributes, COLUMNS, Cell, ROWS};

use graphics::CharacterSet;
use screen::TerminalScreen;
use sequence::Sequences;

/// The most bytes of answers that wait for the host; a host that asks without reading gets no more. Ours.
pub const MAX_REPLIES: usize = 4096;

/// The terminal: what it shows and how it reads.
#[derive(Debug, Default)]
pub struct Terminal {
    sequences: Sequences,
    screen: TerminalScreen,
    modes: Modes,
    sets: [CharacterSet; 2],
    /// The index of the one of `sets` that is in use: 1 after SO.
    shift: usize,
    replies: Vec<u8>,
    ink: Ink,
    in_setup: bool,
    version: u64,
}

impl Terminal {
    /// Takes characters and control sequences, in pieces of any size.
    pub fn feed(&mut self, bytes: &[u8]) {
        if bytes.is_empty() {
            return;
        }
        self.version += 1;
        for byte in bytes {
            let action = self.sequences.push(*byte);
            self.perform(action);
        }
    }

    /// What the terminal answers to what it was asked, since this was last called.
    pub fn take_replies(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.replies)
    }

    /// Counts changes, so that a drawing knows whether it is of now.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// The modes that hosts and the set-up page switch.
    pub fn modes(&self) -> &Modes {
        &self.modes
    }

    /// Row and column of the cursor, from 0.
    pub fn cursor(&self) -> (usize, usize) {
        self.screen.cursor()
    }

    /// The cell at a row and column from 0; a blank outside the screen.
    pub fn cell(&self, row: usize, column: usize) -> Cell {
        self.screen.row(row).get(column).copied().unwrap_or_default()
    }

    /// The rows as text without blanks at their ends, and without empty rows at the end; on the set-up page, that page.
    pub fn text(&self) -> String {
        let page = if self.in_setup { setup::page(&self.modes) } else { self.screen.text() };
        page.trim_end_matches('\n').to_string()
    }

    /// What the text is drawn with.
    pub fn ink(&self) -> &Ink {
        &self.ink
    }

    /// Changes hue, saturation or colour mode of the text.
    pub fn set_ink(&mut self, ink: Ink) {
        self.ink = ink;
        self.version += 1;
    }

    /// Whether the set-up page is shown.
    pub fn in_setup(&self) -> bool {
        self.in_setup
    }

    /// Opens or closes the set-up page.
    pub fn toggle_setup(&mut self) {
        self.in_setup = !self.in_setup;
        self.version += 1;
    }

    /// A character typed on the set-up page: a digit flips its feature, 0 resets the terminal.
    pub fn type_in_setup(&mut self, character: u8) {
        if character == b'0' {
            self.reset();
        } else {
            setup::flip(&mut self.modes, character);
        }
        self.version += 1;
    }

    /// Back to the state at the start, except for the ink and the set-up page.
    fn reset(&mut self) {
        self.screen = TerminalScreen::default();
        self.modes = Modes::default();
        self.sets = Default::default();
        self.shift = 0;
    }

    fn reply(&mut self, text: &str) {
        if self.replies.len() + text.len() <= MAX_REPLIES {
            self.replies.extend_from_slice(text.as_bytes());
        }
    }
}

#[cfg(test)]
mod tests;
