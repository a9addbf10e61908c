//! One update of the picture: walk the display structure, transform, clip, project, and emit strokes.

pub mod font;
pub mod stroke;

pub use stroke::Stroke;
