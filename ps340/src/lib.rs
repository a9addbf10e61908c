//! The PS 340: a deterministic machine in a thin shell.
//!
//! The order of the modules is their layer order, lowest first.

pub mod matrices;
pub mod port;
pub mod functions;
pub mod network;
pub mod traversal;
