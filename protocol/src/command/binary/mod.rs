//! The binary form of the commands: little-endian records, an opcode and fields. Ours.
//!
//! A record never straddles two packets. A vector list is several records: begin, parts, end, so that a list of any
//! length travels in packets of limited length, as the three vector-list calls of the library of the time did. Every
//! field of every record stands in `PROTOCOL.md`.

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

/// Bit of the flags of a vector list: block normalized.
const FLAG_BLOCK: u8 = 1;
/// Bit of the flags of a vector list: an estimate is given.
const FLAG_ESTIMATE: u8 = 2;

#[cfg(test)]
mod tests;
