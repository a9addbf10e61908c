//! What the host and the PS 340 agree on: values, names, packets and the command language. No I/O.
//!
//! The order of the modules is their layer order, lowest first.

pub mod address;
pub mod capture;
pub mod parallel;
pub mod name;
pub mod value;
pub mod record;
pub mod raster;
pub mod command;
pub mod wire;
pub mod listing;

pub use name::Name;
pub use value::{Kind, Value};
