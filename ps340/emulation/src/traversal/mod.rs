//! One update of the picture: walk the display structure, transform, clip, project, and emit strokes.
//!
//! On the way it answers what was asked for: matrices and vectors at XFORM nodes, the first thing drawn in the pick
//! box, and which strokes lie below WRITEBACK nodes.
//!
//! # Source
//! The traversal and the viewing mathematics are the usual left-handed ones with row vectors.
//! Not modelled: limits of the matrix stack, the fixed-point arithmetic of the pipeline.

mod limits;
pub mod stroke;
mod phase;
pub mod font;
mod clip;
mod gather;
mod outline;
mod pick;
mod update;
mod walk;
pub mod write_back;

pub use clip::{Clipper, ScreenMap};
pub use gather::{Gathered, Plane, PolygonBlock, newell};
pub use limits::{MAX_DEPTH, MAX_GATHERED, MAX_STORED_VECTORS, MAX_VECTORS, MAX_VISITS};
pub use pick::{PickHit, PickRequest, PickedKind};
pub use stroke::Stroke;
pub use update::{Requests, Transformed, Update, UpdateFault};
pub use walk::{alone, draw_in_parts, gather, update, update_into};

#[cfg(test)]
mod tests;
