//! One instance of a function.

use super::pool::Run;
use crate::{
    functions::FunctionRow,
    port::{ObjectId, Problem},
};
use protocol::command::Input;

/// One instance of a function: its row, where its ports and arcs lie, and what it waits for.
#[derive(Debug)]
pub(super) struct Instance {
    pub(super) row: &'static FunctionRow,
    pub(super) object: ObjectId,
    /// Inputs, then memory.
    pub(super) ports: Run,
    pub(super) outputs: Run,
    /// Number of inputs among the ports.
    pub(super) inputs: u16,
    /// The n of a family.
    pub(super) size: u16,
    /// Inputs at which it waits for a message.
    pub(super) missing: u16,
    /// How many of them may be missing when it fires.
    pub(super) slack: u16,
    /// Whether an active input accepts strings.
    pub(super) strings: bool,
    /// Whether it stands in the list of those that are ready.
    pub(super) queued: bool,
}

/// The row of an empty slot.
static VACANT: FunctionRow = FunctionRow { behaviour: |_| Err(Problem::Mismatch), ..FunctionRow::PLAIN };

impl Instance {
    /// An empty slot: it is never ready.
    pub(super) fn vacant() -> Instance {
        Instance {
            row: &VACANT,
            object: ObjectId(u32::MAX),
            ports: Run::default(),
            outputs: Run::default(),
            inputs: 0,
            size: 0,
            missing: 1,
            slack: 0,
            strings: false,
            queued: false,
        }
    }

    /// Whether it can fire.
    #[inline]
    pub(super) const fn is_ready(&self) -> bool {
        self.missing <= self.slack
    }

    /// The place among the ports of an input.
    #[inline]
    pub(super) fn input(&self, input: Input) -> Option<usize> {
        match input {
            Input::Number(n) if n >= 1 && n <= u32::from(self.inputs) => Some(n as usize - 1),
            _ => None,
        }
    }
}
