//! What the vector screen shows besides the displayed structure: the cursor, the message line, the terminal's text.
//!
//! These strokes stand behind those of the traversal. They are made anew only when something of them changes.
//!
//! # Source
//! That the system itself displays CURSOR and moves it with the tablet is confirmed; that it does so while stylus or puck
//! is in range is ours.

use super::{KeyboardMode, Machine};
use crate::{
    terminal::{Ink, MESSAGE_ROW, text_line},
    traversal::{self, State, Stroke},
};
use glam::{DMat4, DVec3};

/// Frames for which blinking characters are seen, and then not seen. Ours.
const BLINK_FRAMES: u64 = 30;

/// Switches of the screen, and what was drawn over the picture.
#[derive(Debug)]
pub(super) struct Tube {
    /// Whether the displayed structure is seen.
    pub(super) graphics: bool,
    /// Whether the terminal's text is seen.
    pub(super) text: bool,
    /// Whether nothing is seen, since nobody is there.
    pub(super) blanked: bool,
    words: Words,
    words_of: Option<WordsKey>,
    message: Vec<u8>,
    cursor: Vec<Stroke>,
    cursor_of: Option<CursorKey>,
    /// Strokes of the traversal at the front of the update, and strokes behind them.
    traversed: usize,
    added: usize,
    /// Which update they were added to.
    update: Option<u64>,
}

/// Strokes of terminal and message line.
#[derive(Debug, Default)]
struct Words {
    strokes: Vec<Stroke>,
    blinking: bool,
}

/// Of what the strokes of terminal and message line were made, but for the message.
#[derive(Clone, Copy, Debug, PartialEq)]
struct WordsKey {
    /// Version of the terminal, and whether its cursor is drawn; none if it is not seen.
    terminal: Option<(u64, bool)>,
    /// Whether blinking characters are seen.
    lit: bool,
    ink: Ink,
}

/// Of what the strokes of the cursor were made: version of the structure, and place.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CursorKey {
    structure: u64,
    place: [f64; 2],
}

impl Default for Tube {
    fn default() -> Tube {
        Tube {
            graphics: true,
            text: true,
            blanked: false,
            words: Words::default(),
            words_of: None,
            message: Vec::new(),
            cursor: Vec::new(),
            cursor_of: None,
            traversed: 0,
            added: 0,
            update: None,
        }
    }
}

impl Machine {
    /// The strokes that the vector screen shows: those of the structure, then cursor, message line and terminal, as
    /// far as the keys GRAPH and TERM and the screen saver let them be seen.
    pub fn visible_strokes(&self) -> &[Stroke] {
        let strokes = self.update.strokes.as_slice();
        match (self.tube.blanked, self.tube.graphics) {
            (true, _) => &[],
            (false, true) => strokes,
            (false, false) => self.overlay(),
        }
    }

    /// The strokes over the picture of the latest update: cursor, message line and terminal.
    pub fn overlay(&self) -> &[Stroke] {
        let strokes = self.update.strokes.as_slice();
        strokes.get(strokes.len().saturating_sub(self.tube.added)..).unwrap_or(&[])
    }

    /// One line on the switches of keyboard and screen.
    pub fn switches(&self) -> String {
        let word = |on| if on { "on" } else { "off" };
        let Self { tube, .. } = self;
        let saver = if tube.blanked { ", blanked" } else { "" };
        let mode = self.keyboard_mode().word();
        format!("keyboard: {mode}\nscreen: graphics {}, text {}{saver}", word(tube.graphics), word(tube.text))
    }

    /// Whether the strokes over the picture are those of now.
    pub(super) fn overlay_is_current(&self) -> bool {
        self.tube.words_of == Some(self.words_key())
            && self.tube.message == self.panel.message()
            && self.tube.cursor_of == self.cursor_key()
    }

    /// Brings the strokes over the picture up to date, behind those of the latest update.
    pub(super) fn update_overlay(&mut self) {
        let replaced = self.tube.update.replace(self.counters.updates) != Some(self.counters.updates);
        if replaced {
            self.tube.traversed = self.update.strokes.len();
        } else if self.overlay_is_current() {
            return;
        }
        self.update_words();
        self.update_cursor();
        self.update.strokes.truncate(self.tube.traversed);
        self.update.strokes.extend_from_slice(&self.tube.words.strokes);
        self.update.strokes.extend_from_slice(&self.tube.cursor);
        self.tube.added = self.update.strokes.len() - self.tube.traversed;
    }

    fn update_words(&mut self) {
        let key = self.words_key();
        if self.tube.words_of == Some(key) && self.tube.message == self.panel.message() {
            return;
        }
        let Words { strokes, blinking } = &mut self.tube.words;
        *strokes = text_line(MESSAGE_ROW, self.panel.message(), self.terminal.ink());
        *blinking = key.terminal.is_some() && self.terminal.blinks();
        if let Some((_, cursor)) = key.terminal {
            strokes.extend(self.terminal.strokes(key.lit, cursor));
        }
        self.tube.message = self.panel.message().to_vec();
        // Whether something blinks may just have changed, and the key with it.
        self.tube.words_of = Some(self.words_key());
    }

    fn update_cursor(&mut self) {
        let key = self.cursor_key();
        if self.tube.cursor_of == key {
            return;
        }
        self.tube.cursor_of = key;
        self.tube.cursor = match (key, self.memory.objects.find("CURSOR")) {
            (Some(key), Some(cursor)) => {
                let [x, y] = key.place;
                let ctm = DMat4::from_translation(DVec3::new(x, y, 0.0));
                traversal::alone(&self.memory.structures, cursor, State { ctm, ..State::default() })
            }
            _ => Vec::new(),
        };
    }

    fn words_key(&self) -> WordsKey {
        // The cursor of the terminal is seen while the keyboard belongs to it.
        let mark = self.keyboard.mode() != KeyboardMode::Interactive;
        WordsKey {
            terminal: self.tube.text.then(|| (self.terminal.version(), mark)),
            lit: !self.tube.words.blinking || (self.frame / BLINK_FRAMES).is_multiple_of(2),
            ink: *self.terminal.ink(),
        }
    }

    fn cursor_key(&self) -> Option<CursorKey> {
        let place = self.devices.pointer()?;
        Some(CursorKey { structure: self.memory.structures.version(), place })
    }
}
