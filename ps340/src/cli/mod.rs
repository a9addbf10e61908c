//! The sub-commands of `ps340`: tools for people who write programs for the machine.

mod error;
mod reference;
mod decode;
mod lint;
mod play;
mod tool;

pub use tool::{Tool, run};
