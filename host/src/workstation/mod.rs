//! The host's side of the line: scenes, dial networks and images for a PS 340, and the view back from it.

mod error;
mod initial_view;
mod timeouts;
mod names;
mod drawing;
mod structure_commands;
pub mod facets;
pub mod raster;
pub mod tiles;
mod parts;
mod instancing;
pub mod network;
pub mod motion;
mod flip_book;
pub mod structure;
pub mod session;
pub mod emulator;

pub use drawing::{Drawing, DrawnEdges, MotionPeriod};
pub use emulator::Emulator;
pub use error::WorkstationError;
pub use flip_book::FlipBook;
pub use initial_view::InitialView;
pub use names::ROOT;
pub use session::Session;
pub use structure_commands::{DrawnInstances, DrawnMotion, StructureCommands};
pub use timeouts::Timeouts;
