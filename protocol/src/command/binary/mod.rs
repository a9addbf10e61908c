//! The binary form of the commands: little-endian records, an opcode and fields. Ours.
//!
//! A record never straddles two packets. A vector list is several records: begin, parts, end, so that a list of any
//! length travels in packets of limited length, as the three vector-list calls of the library of the time did. What is
//! sent often has a record of its own; every other command travels as its text, in one record or several. Every field
//! of every record stands in `PROTOCOL.md`.

mod decode;
mod encode;
mod opcode;

pub use crate::record::{BinaryError, BinaryProblem, EncodeError};
pub use decode::{BinaryDecoder, Commands};
pub use encode::{encode, records, records_in_parts};
pub use opcode::Opcode;

/// Most vectors in one part of a vector list; larger lists have several parts. Ours: an eighth of a megabyte, which
/// stays in the caches between line and list.
pub const PART_POINTS: usize = 8192;

/// Most bytes of text in one record; longer commands have several records. Ours.
pub const PART_TEXT: usize = 32_768;

/// Bit of the flags of a vector list: block normalized.
const FLAG_BLOCK: u8 = 1;
/// Bit of the flags of a vector list: an estimate is given.
const FLAG_ESTIMATE: u8 = 2;
/// Bit of the flags of a vector list: internal units.
const FLAG_INTERNAL: u8 = 4;
/// The two bits of the flags of a vector list that say what the fourth component is begin with this one.
const FOURTH_BIT: u32 = 3;

#[cfg(test)]
mod tests;
