//! The interpreters that belong to functions, and what waits for them.

use crate::{
    interpreter::Interpreter,
    port::{ObjectId, StreamKind},
};
use protocol::command::{BinaryDecoder, CommandReader};
use std::collections::{BTreeMap, VecDeque};

/// The interpreters of functions, and what waits for them.
#[derive(Debug, Default)]
pub(super) struct Streams {
    pub(super) interpreters: BTreeMap<ObjectId, StreamReader>,
    pub(super) waiting: VecDeque<StreamChunk>,
    pub(super) bytes: usize,
    pub(super) lost: u64,
    /// Whether a chunk is being interpreted.
    pub(super) busy: bool,
}

/// A chunk of a stream that waits.
#[derive(Debug)]
pub(super) struct StreamChunk {
    pub(super) function: ObjectId,
    pub(super) stream: StreamKind,
    pub(super) bytes: Box<[u8]>,
    pub(super) fresh: bool,
}

/// The readers of a function, and its interpreter.
#[derive(Debug, Default)]
pub(super) struct StreamReader {
    pub(super) text: CommandReader,
    pub(super) binary: BinaryDecoder,
    pub(super) interpreter: Interpreter,
}

impl Streams {
    /// Whether all queues are empty.
    pub(super) fn are_empty(&self) -> bool {
        self.waiting.is_empty()
    }
}
