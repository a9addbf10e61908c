//! What the vector screen shows besides the displayed structure: the cursor, the message line, the terminal's text.
//!
//! These strokes are made anew only when something of them changes.
//!
//! # Source
//! That the system itself displays CURSOR and moves it with the tablet is confirmed; that it does so while stylus or
//! puck is in range is ours.

use super::{
    KeyboardMode, Machine,
    tube::{CursorKey, TextKey, TextStrokes, Tube},
};
use crate::{
    interpreter::Message,
    structure::State,
    terminal::{MESSAGE_ROW, text_line},
    traversal::{self, Stroke, Update},
};
use glam::{DMat4, DVec3};
use std::borrow::Cow;

/// Frames for which blinking characters are seen, and then not seen. Ours.
const BLINK_FRAMES: u64 = 30;

impl Machine {
    /// The strokes that the screen that is looked at shows: those of the structure, then terminal, message line and
    /// cursor, as far as the keys GRAPH and TERM and the screen saver let them be seen.
    pub fn visible_strokes(&self) -> Cow<'_, [Stroke]> {
        let Tube { graphics, blanked, overlay, .. } = &self.tube;
        match (*blanked, *graphics) {
            (true, _) => Cow::Borrowed(&[]),
            (false, false) => Cow::Borrowed(overlay),
            (false, true) if overlay.is_empty() && self.latest.update.scopes.is_empty() => {
                Cow::Borrowed(&self.latest.update.strokes)
            }
            (false, true) => self.latest.update.on_screen(self.controls().screen).chain(overlay).copied().collect(),
        }
    }

    /// The strokes over the picture: terminal, message line and cursor.
    pub fn overlay(&self) -> &[Stroke] {
        &self.tube.overlay
    }

    /// One line each on the switches of keyboard and screen.
    pub fn switches(&self) -> String {
        let word = |on| if on { "on" } else { "off" };
        let Self { tube, .. } = self;
        let saver = if tube.blanked { ", blanked" } else { "" };
        let mode = self.keyboard_mode().word();
        format!("keyboard: {mode}\nscreen: graphics {}, text {}{saver}", word(tube.graphics), word(tube.text))
    }

    /// Whether the strokes over the picture are those of now.
    pub(super) fn overlay_is_current(&self) -> bool {
        self.words_are_current() && self.cursor_is_current()
    }

    /// Brings the strokes over the picture up to date.
    pub(super) fn update_overlay(&mut self) {
        if self.overlay_is_current() {
            return;
        }
        if !self.words_are_current() {
            self.update_words();
        }
        if !self.cursor_is_current() {
            self.update_cursor();
        }
        let screen = self.controls().screen;
        let Tube { text_strokes: words, cursor, overlay, overlay_version, .. } = &mut self.tube;
        overlay.clear();
        overlay.extend(words.strokes.iter().chain(cursor.on_screen(screen)));
        *overlay_version += 1;
    }

    fn update_words(&mut self) {
        let key = self.words_key();
        let TextStrokes { strokes, blinking } = &mut self.tube.text_strokes;
        *strokes = text_line(MESSAGE_ROW, self.panel.message(), self.terminal.ink());
        *blinking = key.terminal.is_some() && self.terminal.blinks();
        if let Some((_, cursor)) = key.terminal {
            strokes.extend(self.terminal.strokes(key.lit, cursor));
        }
        self.tube.message = self.panel.message().to_vec();
        // Whether something blinks may just have changed, and with it whether it is lit: then the next frame draws it.
        self.tube.text_key = Some(key);
    }

    fn update_cursor(&mut self) {
        let key = self.cursor_key();
        let before = self.tube.cursor.fault;
        self.tube.cursor_key = key;
        self.tube.cursor = match (key, self.memory.objects.find("CURSOR")) {
            (Some(key), Some(cursor)) => {
                let [x, y] = key.position;
                let ctm = DMat4::from_translation(DVec3::new(x, y, 0.0));
                traversal::alone(&self.memory.structures, self.frame, cursor, State { ctm, ..State::default() })
            }
            _ => Update::default(),
        };
        // A fault of the cursor that was reported before is not reported again.
        if let Some(fault) = self.tube.cursor.fault.filter(|fault| before != Some(*fault)) {
            self.report(Message::Update(fault));
        }
    }

    fn words_are_current(&self) -> bool {
        self.tube.text_key == Some(self.words_key()) && self.tube.message == self.panel.message()
    }

    fn words_key(&self) -> TextKey {
        // The cursor of the terminal is seen while the keyboard belongs to it.
        let mark = self.keyboard.mode() != KeyboardMode::Interactive;
        TextKey {
            terminal: self.tube.text.then(|| (self.terminal.version(), mark)),
            lit: !self.tube.text_strokes.blinking || (self.frame / BLINK_FRAMES).is_multiple_of(2),
            ink: *self.terminal.ink(),
        }
    }

    /// A cursor may also change by itself, at a rate.
    fn cursor_is_current(&self) -> bool {
        let stays = self.tube.cursor.next_change.is_none_or(|change| self.frame < change);
        self.tube.cursor_key == self.cursor_key() && stays
    }

    fn cursor_key(&self) -> Option<CursorKey> {
        let place = self.devices.pointer()?;
        Some(CursorKey { structure: self.memory.structures.version(), position: place })
    }
}
