//! Procedural models: few numbers and a seed, from which a scene is made at any time, again and again alike.

mod varied;
mod wind;
pub mod terrain;
pub mod drawing;
pub mod grammar;
pub mod plant;
pub mod rock;

pub use varied::{Varied, VariedError, channel};
pub use wind::{Wind, WindError};
