//! Character sets: ASCII, British, and the graphics for lines, with the strokes of those that the font has not.

/// A set of characters that a host designates with `ESC (` or `ESC )`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum CharacterSet {
    /// ASCII.
    #[default]
    Ascii,
    /// ASCII with a pound sign for `#`.
    British,
    /// Graphics for lines in the place of small letters.
    Graphics,
}

/// What an undefined character shows.
pub(super) const CHECKERED: char = '▒';

/// One graphic: its code, its character, and polylines in the cell, where x and y are -1..=1 from the centre.
struct Graphic {
    code: u8,
    character: char,
    lines: &'static [&'static [[f32; 2]]],
}

const fn graphic(code: u8, character: char, lines: &'static [&'static [[f32; 2]]]) -> Graphic {
    Graphic { code, character, lines }
}

const CENTER: [f32; 2] = [0.0, 0.0];
const LEFT: [f32; 2] = [-1.0, 0.0];
const RIGHT: [f32; 2] = [1.0, 0.0];
const UP: [f32; 2] = [0.0, 1.0];
const DOWN: [f32; 2] = [0.0, -1.0];
const TEXT_BOX: &[[f32; 2]] = &[[-0.6, -0.6], [0.6, -0.6], [0.6, 0.6], [-0.6, 0.6], [-0.6, -0.6]];

/// The graphics by their codes, as the VT100 had them. The strokes are ours.
const GRAPHICS: &[Graphic] = &[
    graphic(b'_', ' ', &[]),
    graphic(b'`', '◆', &[&[[-0.6, 0.0], [0.0, 0.5], [0.6, 0.0], [0.0, -0.5], [-0.6, 0.0]]]),
    graphic(
        b'a',
        CHECKERED,
        &[&[[-0.8, -0.8], [0.8, 0.8]], &[[-0.8, 0.8], [0.8, -0.8]], &[LEFT, UP, RIGHT, DOWN, LEFT]],
    ),
    graphic(b'b', '␉', &[TEXT_BOX]),
    graphic(b'c', '␌', &[TEXT_BOX]),
    graphic(b'd', '␍', &[TEXT_BOX]),
    graphic(b'e', '␊', &[TEXT_BOX]),
    graphic(b'f', '°', &[&[[0.0, 0.3], [0.3, 0.5], [0.0, 0.7], [-0.3, 0.5], [0.0, 0.3]]]),
    graphic(b'g', '±', &[&[[-0.6, 0.2], [0.6, 0.2]], &[[0.0, 0.6], [0.0, -0.2]], &[[-0.6, -0.5], [0.6, -0.5]]]),
    graphic(b'h', '␤', &[TEXT_BOX]),
    graphic(b'i', '␋', &[TEXT_BOX]),
    graphic(b'j', '┘', &[&[LEFT, CENTER, UP]]),
    graphic(b'k', '┐', &[&[LEFT, CENTER, DOWN]]),
    graphic(b'l', '┌', &[&[RIGHT, CENTER, DOWN]]),
    graphic(b'm', '└', &[&[RIGHT, CENTER, UP]]),
    graphic(b'n', '┼', &[&[LEFT, RIGHT], &[UP, DOWN]]),
    graphic(b'o', '⎺', &[&[[-1.0, 0.8], [1.0, 0.8]]]),
    graphic(b'p', '⎻', &[&[[-1.0, 0.4], [1.0, 0.4]]]),
    graphic(b'q', '─', &[&[LEFT, RIGHT]]),
    graphic(b'r', '⎼', &[&[[-1.0, -0.4], [1.0, -0.4]]]),
    graphic(b's', '⎽', &[&[[-1.0, -0.8], [1.0, -0.8]]]),
    graphic(b't', '├', &[&[UP, DOWN], &[CENTER, RIGHT]]),
    graphic(b'u', '┤', &[&[UP, DOWN], &[CENTER, LEFT]]),
    graphic(b'v', '┴', &[&[LEFT, RIGHT], &[CENTER, UP]]),
    graphic(b'w', '┬', &[&[LEFT, RIGHT], &[CENTER, DOWN]]),
    graphic(b'x', '│', &[&[UP, DOWN]]),
    graphic(b'y', '≤', &[&[[0.6, 0.6], [-0.6, 0.1], [0.6, -0.4]], &[[-0.6, -0.6], [0.6, -0.6]]]),
    graphic(b'z', '≥', &[&[[-0.6, 0.6], [0.6, 0.1], [-0.6, -0.4]], &[[-0.6, -0.6], [0.6, -0.6]]]),
    graphic(b'{', 'π', &[&[[-0.6, 0.3], [0.6, 0.3]], &[[-0.3, 0.3], [-0.3, -0.5]], &[[0.3, 0.3], [0.3, -0.5]]]),
    graphic(b'|', '≠', &[&[[-0.6, 0.2], [0.6, 0.2]], &[[-0.6, -0.2], [0.6, -0.2]], &[[0.5, 0.5], [-0.5, -0.5]]]),
    graphic(
        b'}',
        '£',
        &[&[[0.5, 0.4], [0.2, 0.6], [-0.2, 0.4], [-0.2, -0.4], [-0.5, -0.6], [0.6, -0.6]], &[[-0.5, 0.0], [0.3, 0.0]]],
    ),
    graphic(b'~', '·', &[&[[-0.1, 0.0], [0.1, 0.0]]]),
];

impl CharacterSet {
    /// The set that the final byte of a designation means; ASCII for those that the terminal has not.
    pub(super) fn designated(last: u8) -> CharacterSet {
        match last {
            b'A' => CharacterSet::British,
            b'0' | b'2' => CharacterSet::Graphics,
            _ => CharacterSet::Ascii,
        }
    }

    /// The character of a code.
    pub(super) fn character(self, code: u8) -> char {
        match self {
            _ if !(32..127).contains(&code) => CHECKERED,
            CharacterSet::British if code == b'#' => '£',
            CharacterSet::Graphics => {
                GRAPHICS.iter().find(|g| g.code == code).map_or(char::from(code), |g| g.character)
            }
            _ => char::from(code),
        }
    }
}

/// The polylines of a graphic, in a cell of -1..=1; none for a character that is no graphic.
pub(super) fn strokes(character: char) -> &'static [&'static [[f32; 2]]] {
    GRAPHICS.iter().find(|g| g.character == character).map_or(&[], |g| g.lines)
}
