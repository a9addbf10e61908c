//! PERIS, the host: models an environment, keeps it in a linear octree, renders it, and shows it on a PS 340.
//!
//! It stands on three floors, each a crate that knows nothing of those above it: `foundation`, `modelling` and
//! `synthesis`. What is here is the top: studies, scripts, the workstation and the command line. The order of the modules
//! is their layer order, lowest first.

pub use foundation::{color, encoding, memory, numeric, picture, polygon, spelling, stages};
pub use modelling::{curve, intersection, mesh, octree, procedural, solid, subdivision, surface};
pub use synthesis::{database, illumination, plan, render, scene};

pub mod study;
pub mod script;
pub mod workstation;
pub mod production;
pub mod cli;
