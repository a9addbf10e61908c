//! The host's side of the line: scenes, dial networks and images for a PS 340, and the view back from it.

mod error;
mod initial_view;
mod patience;
pub mod emulator;
pub mod facets;
pub mod network;
pub mod raster;
pub mod session;
pub mod structure;
pub mod tiles;

pub use emulator::Emulator;
pub use error::WorkstationError;
pub use initial_view::InitialView;
pub use patience::Patience;
pub use session::Session;
pub use structure::{Drawing, Lines, Shown};
