//! Commands become edits of objects, network and structure.

mod message;
mod definition;
mod draft;
mod edit;
mod flow;
mod session;
mod service;
mod execute;

#[cfg(test)]
mod tests;

pub use draft::MAX_NESTING;
pub use message::{Class, Message};
pub use session::{Interpreter, MAX_BEGINS};
