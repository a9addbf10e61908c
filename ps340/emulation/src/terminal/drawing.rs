//! The terminal's text as strokes over the picture.
//!
//! Rows run from the top of the screen; the message line stands below the last one. Sizes and positions are ours.

use super::{
    Attributes, COLUMNS, ROWS, Terminal,
    graphics::{self, CHECKERED},
    setup,
};
use crate::{
    hue,
    traversal::{
        Stroke,
        font::{self, Font},
    },
};

/// The row of the message line, below the rows of the terminal.
pub const MESSAGE_ROW: usize = ROWS;

/// Left edge of the first column, and top of the first row, in screen units.
const LEFT: f32 = -0.96;
const TOP: f32 = 0.97;
/// Width and height of a cell.
const WIDTH: f32 = 0.024;
const HEIGHT: f32 = 0.077;
/// Size of the font's unit cell, and how much of it a character fills from left to right.
const SCALE: [f32; 2] = [0.028, 0.052];
const FILLED: f32 = 0.66;
/// From the lower edge of a cell to the base line.
const BASE: f32 = 0.021;
/// Intensity of a character, and of a bold one.
const NORMAL: f32 = 0.75;
const BOLD: f32 = 1.0;

/// What the text is drawn with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ink {
    /// Degrees, 0 is blue.
    pub hue: f64,
    /// 0 white, 1 pure.
    pub saturation: f64,
    /// Whether the colour tube draws it in colour; otherwise it is white.
    pub csm: bool,
}

impl Default for Ink {
    /// White, ours; TECOLOR chooses a colour.
    fn default() -> Ink {
        Ink { hue: 0.0, saturation: 0.0, csm: true }
    }
}

impl Ink {
    /// Linear red, green and blue.
    fn color(&self) -> [f32; 3] {
        if self.csm { hue::rgb(self.hue as f32, self.saturation as f32) } else { [1.0; 3] }
    }
}

impl Terminal {
    /// The strokes of the screen.
    ///
    /// - `lit`: whether blinking characters are seen at the moment.
    /// - `cursor`: whether the cursor is drawn, if it is visible at all.
    pub fn strokes(&self, lit: bool, cursor: bool) -> Vec<Stroke> {
        let mut pen = Pen { color: self.ink.color(), strokes: Vec::new() };
        if self.in_setup {
            for (row, line) in setup::page(&self.modes).lines().take(ROWS).enumerate() {
                pen.line(row, line.chars().map(|c| (c, Attributes::default())), true);
            }
            return pen.strokes;
        }
        for row in 0..ROWS {
            pen.line(row, self.screen.row(row).iter().map(|cell| (cell.character, cell.attributes)), lit);
        }
        if self.modes.reverse_screen {
            pen.frame(0, ROWS, 0, COLUMNS);
        }
        if cursor && self.modes.cursor_visible {
            let (row, column) = self.screen.cursor();
            pen.frame(row, row + 1, column, column + 1);
        }
        pen.strokes
    }

    /// Whether a character on the screen comes and goes.
    pub fn blinks(&self) -> bool {
        !self.in_setup && (0..ROWS).any(|row| self.screen.row(row).iter().any(|cell| cell.attributes.blink))
    }
}

/// The strokes of a line of plain bytes in one row; what does not fit is cut, control characters are blanks.
pub fn text_line(row: usize, text: &[u8], ink: &Ink) -> Vec<Stroke> {
    let mut pen = Pen { color: ink.color(), strokes: Vec::new() };
    let character = |byte: &u8| if byte.is_ascii_control() { ' ' } else { char::from(*byte) };
    pen.line(row, text.iter().map(|byte| (character(byte), Attributes::default())), true);
    pen.strokes
}

struct Pen {
    color: [f32; 3],
    strokes: Vec<Stroke>,
}

/// Lower left corner of a cell.
fn corner(row: usize, column: usize) -> [f32; 2] {
    [LEFT + column as f32 * WIDTH, TOP - (row + 1) as f32 * HEIGHT]
}

impl Pen {
    fn line(&mut self, row: usize, cells: impl Iterator<Item = (char, Attributes)>, lit: bool) {
        // Where a run of reversed cells began.
        let mut run = None;
        let cells = cells.take(COLUMNS).chain([(' ', Attributes::default())]);
        for (column, (character, attributes)) in cells.enumerate() {
            match (attributes.reverse, run) {
                (true, None) => run = Some(column),
                (false, Some(start)) => {
                    self.frame(row, row + 1, start, column);
                    run = None;
                }
                _ => {}
            }
            if lit || !attributes.blink {
                self.cell(row, column, character, attributes);
            }
        }
    }

    fn cell(&mut self, row: usize, column: usize, character: char, attributes: Attributes) {
        let intensity = if attributes.bold { BOLD } else { NORMAL };
        let [x, y] = corner(row, column);
        if attributes.underline {
            let below = y + BASE - 0.01;
            self.stroke([x, below], [x + WIDTH, below], intensity);
        }
        match u8::try_from(character) {
            Ok(code) if code.is_ascii() => {
                let inset = (WIDTH - FILLED * SCALE[0]) / 2.0;
                let place = |p: [f32; 2]| [x + inset + p[0] * SCALE[0], y + BASE + p[1] * SCALE[1]];
                for [start, end] in font::strokes(Font::Standard.glyph(code)) {
                    self.stroke(place(start), place(end), intensity);
                }
            }
            _ => {
                let known = graphics::strokes(character);
                let lines = if known.is_empty() { graphics::strokes(CHECKERED) } else { known };
                let place = |p: [f32; 2]| [x + (1.0 + p[0]) * WIDTH / 2.0, y + (1.0 + p[1]) * HEIGHT / 2.0];
                for line in lines {
                    line.windows(2).for_each(|ends| self.stroke(place(ends[0]), place(ends[1]), intensity));
                }
            }
        }
    }

    /// A frame around cells; ends are one past the last.
    fn frame(&mut self, top: usize, bottom: usize, left: usize, right: usize) {
        let [x0, y1] = [corner(0, left)[0], corner(top, 0)[1] + HEIGHT];
        let [x1, y0] = [corner(0, right)[0], corner(bottom, 0)[1] + HEIGHT];
        let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]];
        corners.windows(2).for_each(|ends| self.stroke(ends[0], ends[1], NORMAL));
    }

    fn stroke(&mut self, start: [f32; 2], end: [f32; 2], intensity: f32) {
        self.strokes.push(Stroke { start, end, intensity: [intensity; 2], color: self.color });
    }
}
