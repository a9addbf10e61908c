//! The interpreters that belong to functions, and what waits for them.

use crate::{
    interpreter::Interpreter,
    port::{ObjectId, Stream},
};
use protocol::command::{BinaryDecoder, CommandReader};
use std::collections::{BTreeMap, VecDeque};

/// The interpreters of functions, and what waits for them.
#[derive(Debug, Default)]
pub(super) struct Streams {
    pub(super) interpreters: BTreeMap<ObjectId, Reader>,
    pub(super) waiting: VecDeque<Piece>,
    pub(super) bytes: usize,
    pub(super) lost: u64,
    /// Whether a piece is being interpreted.
    pub(super) busy: bool,
}

/// A message that waits.
#[derive(Debug)]
pub(super) struct Piece {
    pub(super) function: ObjectId,
    pub(super) stream: Stream,
    pub(super) bytes: Box<[u8]>,
    pub(super) fresh: bool,
}

/// The readers of a function, and its interpreter.
#[derive(Debug, Default)]
pub(super) struct Reader {
    pub(super) text: CommandReader,
    pub(super) binary: BinaryDecoder,
    pub(super) interpreter: Interpreter,
}

impl Streams {
    /// Whether nothing waits.
    pub(super) fn are_quiet(&self) -> bool {
        self.waiting.is_empty()
    }
}
