//! What functions and display nodes have in common: identity, kinds that an input accepts, queues, faults, effects.

mod backlog;
mod effect;
mod fault;
mod firing;
mod kinds;
mod literal;
mod outbox;
mod moves;
mod queue;
mod rendering;

pub use backlog::{Backlog, MAX_QUEUE};
pub use effect::{DialSetting, Effect, FileName, Label, MAX_FILE_NAME, StreamKind, TabletCommand};
pub use fault::{Cause, Fault, Problem};
pub use firing::{Elapsed, Firing};
pub use kinds::KindSet;
pub use literal::{Literal, PickLiteral};
pub use outbox::Outbox;
pub use queue::{Arrival, Port};
pub use rendering::{Rendering, RenderingRequest};

/// The identity of a named object, function or display node, for as long as the object's name exists.
///
/// Numbers are dense, from 0: tables are indexed by them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId(pub u32);

impl ObjectId {
    /// No object: what referred to one that was deleted refers to this.
    pub const NOTHING: ObjectId = ObjectId(u32::MAX);

    /// The object at `index` of the tables.
    pub const fn new(index: usize) -> ObjectId {
        ObjectId(index as u32)
    }

    /// Its index in the tables.
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// The identity of a host line; numbers are never used twice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LineId(pub u64);

/// An input of a function: what it accepts and how messages wait there.
#[derive(Clone, Copy, Debug)]
pub struct PortSpec {
    /// The kinds of message that it accepts; others are faults on arrival.
    pub kinds: KindSet,
    /// How messages wait and whether the function waits for them.
    pub role: QueueRole,
    /// What it is for, in a few words, with unit and range.
    pub summary: &'static str,
}

/// How messages wait at an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QueueRole {
    /// A queue. A firing consumes one message of it.
    Active,
    /// The most recent value, used again and again. The function waits for the first one.
    Constant,
    /// A constant that the function can do without.
    Optional,
    /// A constant with this value at the start.
    Default(Literal),
}

impl PortSpec {
    /// An active input.
    pub const fn active(kinds: KindSet, summary: &'static str) -> PortSpec {
        PortSpec { kinds, role: QueueRole::Active, summary }
    }

    /// A constant input that must have a value before the function fires.
    pub const fn constant(kinds: KindSet, summary: &'static str) -> PortSpec {
        PortSpec { kinds, role: QueueRole::Constant, summary }
    }

    /// A constant input that may stay without a value.
    pub const fn optional(kinds: KindSet, summary: &'static str) -> PortSpec {
        PortSpec { kinds, role: QueueRole::Optional, summary }
    }

    /// A constant input with a value at the start.
    pub const fn default(kinds: KindSet, value: Literal, summary: &'static str) -> PortSpec {
        PortSpec { kinds, role: QueueRole::Default(value), summary }
    }
}
