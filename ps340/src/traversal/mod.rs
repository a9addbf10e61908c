//! One update of the picture: walk the display structure, transform, clip, project, and emit strokes.
//!
//! On the way it answers what was asked for: matrices and vectors at XFORM nodes, the first thing drawn in the pick
//! box, and which strokes lie below WRITEBACK nodes.
//!
//! # Source
//! The traversal and the viewing mathematics are the usual left-handed ones with row vectors.
//! Not modelled: limits of the matrix stack, the fixed-point arithmetic of the pipeline.

mod clip;
mod gather;
pub mod font;
mod phase;
mod state;
mod outline;
mod pick;
pub mod stroke;
mod update;
mod walk;
pub mod write_back;

pub use clip::{Clipper, ScreenMap};
pub use gather::{Block, Gathered, Plane, Sight, newell};
pub use pick::{PickHit, PickRequest, PickedKind};
pub use state::State;
pub use stroke::Stroke;
pub use update::{Requests, Transformed, Trouble, Update};
pub use walk::{
    MAX_DEPTH, MAX_GATHERED, MAX_KEPT, MAX_VECTORS, MAX_VISITS, alone, draw_in_parts, gather, update, update_into,
};

#[cfg(test)]
mod tests;
