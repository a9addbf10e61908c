//! What making an operation of a command needs beside the command, and what can be wrong with it.

use crate::{
    port::ObjectId,
    structure::state::{CONDITIONAL_BITS, MAX_LEVEL},
};

/// An operation that cannot be: numbers that are not finite or out of range, a view of nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Degenerate(pub &'static str);

/// What a command does not say itself.
#[derive(Clone, Copy)]
pub(super) struct Context {
    /// What the name of a font means.
    pub font: Option<ObjectId>,
    /// The frame from which phases count.
    pub since: u64,
}

/// A level of detail in a command.
///
/// # Errors
/// It is out of range.
pub(super) fn checked_level(level: u16) -> Result<u16, Degenerate> {
    if level <= MAX_LEVEL { Ok(level) } else { Err(Degenerate("a level of detail is 0 to 32767")) }
}

/// The number of a conditional bit in a command.
///
/// # Errors
/// It is out of range.
pub(super) fn checked_bit(bit: u8) -> Result<u8, Degenerate> {
    if bit < CONDITIONAL_BITS { Ok(bit) } else { Err(Degenerate("a conditional bit is 0 to 14")) }
}
