//! Switches of the vector screen, and what is drawn over the picture.

use crate::{
    terminal::Ink,
    traversal::{Stroke, Update},
};

/// Switches of the screen, and what is drawn over the picture.
#[derive(Debug)]
pub(super) struct Tube {
    /// Whether the displayed structure is seen.
    pub(super) graphics: bool,
    /// Whether the terminal's text is seen.
    pub(super) text: bool,
    /// Whether nothing is seen, since nobody is there.
    pub(super) blanked: bool,
    pub(super) text_strokes: TextStrokes,
    pub(super) text_key: Option<TextKey>,
    pub(super) message: Vec<u8>,
    pub(super) cursor: Update,
    pub(super) cursor_key: Option<CursorKey>,
    /// The strokes of text and cursor.
    pub(super) overlay: Vec<Stroke>,
    /// A number that changes with them.
    pub(super) overlay_version: u64,
}

/// The text strokes of terminal and message line.
#[derive(Debug, Default)]
pub(super) struct TextStrokes {
    pub(super) strokes: Vec<Stroke>,
    pub(super) blinking: bool,
}

/// What the text strokes of terminal and message line were made of, but for the message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TextKey {
    /// Version of the terminal, and whether its cursor is drawn; none if it is not seen.
    pub(super) terminal: Option<(u64, bool)>,
    /// Whether blinking characters are seen.
    pub(super) lit: bool,
    pub(super) ink: Ink,
}

/// What the strokes of the cursor were made of: version of the structure, and position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CursorKey {
    pub(super) structure: u64,
    pub(super) position: [f64; 2],
}

impl Default for Tube {
    fn default() -> Tube {
        Tube {
            graphics: true,
            text: true,
            blanked: false,
            text_strokes: TextStrokes::default(),
            text_key: None,
            message: Vec::new(),
            cursor: Update::default(),
            cursor_key: None,
            overlay: Vec::new(),
            overlay_version: 0,
        }
    }
}

impl Tube {
    /// The switches as at the start; what is drawn next is another picture than all before.
    pub(super) fn restarted(&self) -> Tube {
        Tube { overlay_version: self.overlay_version + 1, ..Tube::default() }
    }

    /// A number that changes with the strokes over the picture.
    pub(super) fn overlay_version(&self) -> u64 {
        self.overlay_version
    }

    /// Lets the strokes over the picture be made anew.
    pub(super) fn forget_overlay(&mut self) {
        self.text_key = None;
        self.cursor_key = None;
    }
}
