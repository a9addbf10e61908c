//! Curves, surfaces, solids and meshes, their Boolean operations and intersections, the linear octree, and procedural
//! models.
//!
//! The order of the modules is their layer order, lowest first.

pub use foundation::{color, encoding, memory, numeric, picture, polygon, spelling, stages};

pub mod curve;
pub mod mesh;
pub mod octree;
pub mod subdivision;
pub mod surface;
pub mod solid;
pub mod intersection;
pub mod procedural;
