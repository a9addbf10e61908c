//! One row of the table of functions.

use crate::port::{Elapsed, Firing, Literal, PortSpec, Problem};
use protocol::Value;

/// Largest n of a family such as ROUTE(n). Ours.
pub const MAX_SIZE: u16 = 127;

/// What a function does when it fires: reads its inputs, sends its results. On a problem nothing is sent.
pub type Behaviour = fn(&mut Firing) -> Result<(), Problem>;

/// What a behaviour with two inputs and one result does with the commonest values, worked out where the message lies.
///
/// Returns false, and changes nothing, if the values are others or the result is not finite.
pub type InPlace = fn(message: &mut Value, constant: &Value, position: QueuePosition) -> bool;

/// The one of two inputs that is the queue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QueuePosition {
    /// Input 1; input 2 is a constant.
    MessageFirst,
    /// Input 2; input 1 is a constant.
    ConstantFirst,
}

/// What a clock does when time passes: returns how many outputs it left out.
pub type ClockBehaviour = fn(&mut Firing, &Elapsed) -> Result<u64, Problem>;

/// What a function is and does.
#[derive(Debug)]
pub struct FunctionRow {
    /// The type without `F:`, or the name of an initial instance.
    pub name: &'static str,
    /// What it computes, in a few words.
    pub summary: &'static str,
    /// Where our knowledge comes from.
    pub source: Source,
    /// The inputs, from input 1.
    pub inputs: &'static [PortSpec],
    /// What leaves each output, from output 1.
    pub outputs: &'static [&'static str],
    /// Whether n in F:NAME(n) multiplies inputs or outputs.
    pub family: Family,
    /// When it fires.
    pub rule: Rule,
    /// Values that it remembers between firings.
    pub memory: u8,
    /// What it does when it fires.
    pub behaviour: Behaviour,
    /// What it does when it fires, in the place of its input, if that pays.
    pub in_place: Option<InPlace>,
    /// What it does as time passes, if it is a clock.
    pub clock: Option<ClockBehaviour>,
    /// Examples.
    pub examples: &'static [FunctionExample],
}

/// Where the knowledge about a function comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// How sure we are.
    pub confidence: Confidence,
    /// What the source leaves open and we decided, or who relied on it.
    pub note: &'static str,
}

/// How sure we are of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Confidence {
    /// Programs of the time relied on it.
    Confirmed,
    /// The manuals say so, as they are remembered.
    Manual,
    /// A plausible reconstruction.
    Uncertain,
}

/// What n multiplies in F:NAME(n).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// A single function: no n.
    Single,
    /// n inputs: the first input of the row stands n times less the others.
    Inputs,
    /// n outputs like the one of the row.
    Outputs,
    /// n inputs and n outputs.
    Channels,
    /// An initial instance that belongs to device n.
    Device,
}

/// When a function fires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// When every active input has a message and every required constant a value.
    All,
    /// When any active input has a message.
    Any,
}

/// Messages sent to a new instance, in order, and what comes of them.
#[derive(Clone, Copy, Debug)]
pub struct FunctionExample {
    /// The n of a family, else 0.
    pub size: u16,
    /// Input and message.
    pub sends: &'static [(u16, Literal)],
    /// Output and message, in order. Reals match within 1e-12 of their size.
    pub results: &'static [(u16, Literal)],
    /// Numbers of the messages about faults, in order.
    pub faults: &'static [u16],
}

/// The inputs and outputs of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Number of inputs.
    pub inputs: u16,
    /// Number of outputs.
    pub outputs: u16,
    /// n, or 0.
    pub size: u16,
}

/// The reason why F:NAME or F:NAME(n) cannot be instanced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SizeError {
    /// The family needs an n.
    #[error("F:{0} needs a size, as in F:{0}(4)")]
    Missing(&'static str),
    /// The function has no n.
    #[error("F:{0} takes no size")]
    Unexpected(&'static str),
    /// n is 0 or larger than [`MAX_SIZE`].
    #[error("the size of F:{0} is 1 to {MAX_SIZE}, not {1}")]
    OutOfRange(&'static str, u16),
}

impl FunctionRow {
    /// A row to start from: no inputs, no outputs, nothing done.
    pub const PLAIN: FunctionRow = FunctionRow {
        name: "",
        summary: "",
        source: Source { confidence: Confidence::Manual, note: "" },
        inputs: &[],
        outputs: &[],
        family: Family::Single,
        rule: Rule::All,
        memory: 0,
        behaviour: idle,
        in_place: None,
        clock: None,
        examples: &[],
    };

    /// The inputs and outputs of an instance with or without an n.
    ///
    /// # Errors
    /// [`SizeError`] if n is missing, unexpected or out of range.
    pub fn shape(&self, size: Option<u16>) -> Result<Shape, SizeError> {
        let (inputs, outputs) = (self.inputs.len() as u16, self.outputs.len() as u16);
        let n = match (self.family, size) {
            (Family::Single, None) => return Ok(Shape { inputs, outputs, size: 0 }),
            (Family::Single, Some(_)) => return Err(SizeError::Unexpected(self.name)),
            (Family::Device, n) => return Ok(Shape { inputs, outputs, size: n.unwrap_or(0) }),
            (_, None) => return Err(SizeError::Missing(self.name)),
            (_, Some(n)) => n,
        };
        // A family with inputs besides the repeated one needs at least one of each.
        if n > MAX_SIZE || n == 0 || (self.family == Family::Inputs && n < inputs) {
            return Err(SizeError::OutOfRange(self.name, n));
        }
        Ok(match self.family {
            Family::Inputs => Shape { inputs: n, outputs, size: n },
            Family::Outputs => Shape { inputs, outputs: n, size: n },
            _ => Shape { inputs: n, outputs: n, size: n },
        })
    }

    /// What input `input` of an instance is, from 1.
    pub fn input(&self, shape: Shape, input: u16) -> Option<&'static PortSpec> {
        if input == 0 || input > shape.inputs {
            return None;
        }
        let repeated = match self.family {
            Family::Inputs | Family::Channels => shape.inputs - (self.inputs.len() as u16 - 1),
            _ => 1,
        };
        self.inputs.get(usize::from(input.saturating_sub(repeated)))
    }

    /// What input `input` of an instance of size n is, from 1.
    ///
    /// - `size`: n, or 0 for a single function.
    pub fn input_of_size(&self, size: u16, input: u16) -> Option<&'static PortSpec> {
        let size = (self.family != Family::Single).then_some(size);
        self.input(self.shape(size).ok()?, input)
    }
}

impl Source {
    /// Programs of the time relied on it.
    pub const fn confirmed(note: &'static str) -> Source {
        Source { confidence: Confidence::Confirmed, note }
    }

    /// A source in the manuals, as they are remembered.
    pub const fn manual(note: &'static str) -> Source {
        Source { confidence: Confidence::Manual, note }
    }

    /// A plausible reconstruction.
    pub const fn uncertain(note: &'static str) -> Source {
        Source { confidence: Confidence::Uncertain, note }
    }
}

impl FunctionExample {
    /// Messages and results, without faults.
    pub const fn of(sends: &'static [(u16, Literal)], results: &'static [(u16, Literal)]) -> FunctionExample {
        FunctionExample { size: 0, sends, results, faults: &[] }
    }

    /// This example for F:NAME(n).
    pub const fn sized(self, size: u16) -> FunctionExample {
        FunctionExample { size, ..self }
    }

    /// This example with faults.
    pub const fn faults(self, faults: &'static [u16]) -> FunctionExample {
        FunctionExample { faults, ..self }
    }
}

/// The behaviour of an object that only sends what the machine gives it.
fn idle(_: &mut Firing) -> Result<(), Problem> {
    Ok(())
}
