//! Points and strokes of a character.

/// A point of a character, x right and y up in cells, and whether the pen draws on its way there.
pub type GlyphPoint = ([f32; 2], bool);

/// The strokes of a glyph: start and end of each, in cells. A stroke of no length is a dot; a point that is
/// only moved to draws nothing.
pub fn strokes(glyph: &[GlyphPoint]) -> impl Iterator<Item = [[f32; 2]; 2]> + '_ {
    glyph.windows(2).filter(|pair| pair[1].1).map(|pair| [pair[0].0, pair[1].0])
}
