//! One update of the picture: walk the display structure, transform, clip, project, and emit strokes.
//!
//! # Source
//! The traversal and the viewing mathematics are the usual left-handed ones with row vectors.
//! Not modelled: limits of the matrix stack, the fixed-point arithmetic of the pipeline.

mod clip;
pub mod font;
mod state;
pub mod stroke;
mod walk;

pub use clip::{Clipper, ScreenMap};
pub use state::State;
pub use stroke::Stroke;
pub use walk::{MAX_DEPTH, MAX_VECTORS, MAX_VISITS, Trouble, Update, alone, update};

#[cfg(test)]
mod tests;
