//! The PS 340: a deterministic machine in a thin shell.
//!
//! The order of the modules is their layer order, lowest first.

pub mod hue;

pub mod traversal;

pub mod picture;

pub mod calligraphic;

pub mod raster;
