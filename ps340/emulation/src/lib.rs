//! The emulation of the machine, which is deterministic: functions, structures, displays, memory, lines and operators.
//!
//! The order of the modules is their layer order, lowest first.

pub mod hue;
pub mod matrices;
pub mod curve;
pub mod pattern;
pub mod port;
pub mod functions;
pub mod network;
pub mod structure;
pub mod objects;
pub mod memory;
pub mod traversal;
pub mod rendering;
pub mod terminal;
pub mod picture;
pub mod calligraphic;
pub mod raster;
pub mod disk;
pub mod interpreter;
pub mod line;
pub mod machine;
pub mod example;
pub mod operator;
