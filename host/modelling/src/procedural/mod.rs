//! Procedural models: few numbers and a seed, from which a scene is made at any time, again and again alike.

mod wind;

pub use wind::{Wind, WindError};
