//! The font of a text: the standard one, or one of the user.

use super::{GlyphPoint, standard};
use protocol::command::FontCharacter;
use std::collections::BTreeMap;

/// A font: the standard one, or one of the user.
#[derive(Clone, Copy, Debug)]
pub enum Font<'a> {
    /// Every printable character of ASCII.
    Standard,
    /// BEGIN_FONT ... END_FONT: the characters that are defined, by code.
    User(&'a BTreeMap<u8, FontCharacter>),
}

impl<'a> Font<'a> {
    /// The points of a character; none if the font does not have it.
    pub fn glyph(self, code: u8) -> &'a [GlyphPoint] {
        match self {
            Font::Standard => standard::glyph(code),
            Font::User(characters) => characters.get(&code).map_or(&[], |character| character.points.as_slice()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{super::strokes, *};

    #[test]
    fn a_user_font_draws_its_lines_and_nothing_for_moves_and_missing_characters() {
        // The first point counts as a move whatever it says.
        let points =
            vec![([0.0, 0.0], true), ([1.0, 0.0], true), ([0.0, 1.0], false), ([0.5, 0.5], false), ([0.5, 0.5], true)];
        let characters = BTreeMap::from([(7, FontCharacter { code: 7, estimate: None, points })]);
        let font = Font::User(&characters);
        let found: Vec<_> = strokes(font.glyph(7)).collect();
        assert_eq!(found, [[[0.0, 0.0], [1.0, 0.0]], [[0.5, 0.5], [0.5, 0.5]]]);
        assert_eq!(strokes(font.glyph(b'A')).count(), 0);
        assert_eq!(strokes(font.glyph(200)).count(), 0);
    }

    #[test]
    fn no_two_characters_of_the_standard_font_are_alike() {
        for code in 33..=126_u8 {
            for other in 33..code {
                let alike = Font::Standard.glyph(code) == Font::Standard.glyph(other);
                assert!(!alike, "{} and {}", code as char, other as char);
            }
        }
    }
}
