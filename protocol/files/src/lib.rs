//! How both programs read and write files: within limits, and whole or not at all.
//!
//! A file is written under no name, or another name in the same folder, synchronised, and only then given its own name.
//! Whoever reads the name finds the older file or the whole new one, whatever happens in between.

mod error;
mod draft;
mod destination;
mod sandbox;
mod log_file;
mod read;

pub use destination::{Destination, Folder, Writer};
pub use draft::naming;
pub use error::{Problem, WriteError};
pub use log_file::LogFile;
pub use read::{open, read, read_text};
pub use sandbox::Sandbox;
