//! PERIS, the host: models an environment, keeps it in a linear octree, renders it, and shows it on a PS 340.
//!
//! The order of the modules is their layer order, lowest first.

pub mod numeric;
pub mod mesh;
pub mod surface;
