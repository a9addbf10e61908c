//! What a person at the machine does, as a text protocol: one operator command a line, one reply a line.
//!
//! A reply begins with `ok` or `error`. Line ends inside a reply are written `\n`.

mod fault;
mod word_reader;
mod graph;
mod command;
mod reading;
mod inspect;
mod display;
mod table;
mod perform;
mod reply;

pub use command::{DisplayCommand, Inspection, OperatorCommand, OperatorCommandRow, Screen};
pub use fault::OperatorCommandError;
pub use graph::{Language, Subject, title};
pub use inspect::brief;
pub use perform::{CommandOutcome, Wait, perform};
pub use reading::unescape;
pub use reply::reply;
pub use table::{parse, rows};

#[cfg(test)]
mod tests;
