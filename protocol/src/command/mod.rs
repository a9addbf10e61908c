//! The command language: text and binary forms of the same plain data.

pub mod syntax;
pub mod number;
mod matrix;
pub mod spelling;
pub mod words;
pub mod token;
pub mod error;
pub mod parse;
pub mod print;
mod operate;
pub mod reader;
pub mod binary;
#[cfg(any(test, feature = "proptest"))]
pub mod strategy;
pub mod reference;

pub use binary::{BinaryDecoder, encode};
pub use error::{CommandError, Problem};
pub use parse::parse;
pub use print::print;
pub use reader::{CommandReader, Spanned};
pub use syntax::*;

/// Most points in one vector list. Ours: 256 MiB of points.
pub const MAX_POINTS: usize = 16 << 20;

/// Longest statement in bytes, from its first character to its `;`. Ours: enough for two million vectors as text.
pub const MAX_STATEMENT: usize = 64 << 20;

/// Longest text in quotes, in bytes, as remembered from the manuals. Values that functions and binary records make are
/// limited by [`MAX_STRING`](crate::value::MAX_STRING) instead.
pub const MAX_TEXT: usize = 240;
