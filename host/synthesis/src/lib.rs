//! Materials, lights, scenes, databases and plans, and the renderers.
//!
//! The order of the modules is their layer order, lowest first.

pub use foundation::{color, encoding, memory, numeric, picture, polygon, spelling, stages};
pub use modelling::{curve, intersection, mesh, octree, procedural, solid, subdivision, surface};

pub mod illumination;
pub mod database;
pub mod scene;
pub mod plan;
pub mod render;
