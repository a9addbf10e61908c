//! The ground on which the host stands: memory, stages of work, numbers, colours, polygons and pictures.
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
