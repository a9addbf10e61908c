//! The PS 340: a deterministic machine in a thin shell.
//!
//! The machine is the crate `emulation`; what is here has its process, its window and its tools. The order of the modules
//! is their layer order, lowest first.

pub use emulation::{
    calligraphic, curve, disk, example, functions, hue, interpreter, line, machine, matrices, memory, network, objects,
    operator, pattern, picture, port, raster, rendering, structure, terminal, traversal,
};

pub mod shell;
#[cfg(feature = "window")]
pub mod console;
pub mod play;
pub mod lint;
pub mod cli;
pub mod process;
