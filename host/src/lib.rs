//! PERIS, the host: models an environment, keeps it in a linear octree, renders it, and shows it on a PS 340.
//!
//! The order of the modules is their layer order, lowest first.

pub mod memory;
pub mod stages;
pub mod encoding;
pub mod spelling;
pub mod numeric;
pub mod color;
pub mod polygon;
pub mod picture;
pub mod curve;
pub mod mesh;
pub mod octree;
pub mod subdivision;
pub mod surface;
pub mod solid;
pub mod intersection;
pub mod illumination;
pub mod database;
pub mod scene;
pub mod plan;
pub mod render;
pub mod study;
pub mod script;
pub mod workstation;
pub mod production;
pub mod cli;
