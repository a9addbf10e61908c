//! Fonts: how the characters of a text are drawn, in the unit cell.

mod glyph;
mod standard;
mod chosen;

pub use chosen::Font;
pub use glyph::{GlyphPoint, strokes};
