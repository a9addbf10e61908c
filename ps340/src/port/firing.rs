//! One firing of a function, as its behaviour sees it: inputs, memory, outputs.

use super::{Effect, ObjectId, Port, Problem};
use glam::{DVec2, DVec3};
use protocol::Value;

/// One firing: what a behaviour may read and write.
///
/// Inputs and outputs are numbered from 1, as in the manuals. The inputs for which a function waits have a
/// message when it fires; after it the network removes one message from each active input.
pub struct Firing<'a> {
    object: ObjectId,
    size: u16,
    inputs: &'a mut [Port],
    memory: &'a mut [Port],
    outbox: &'a mut Vec<(u16, Value)>,
    effects: &'a mut Vec<Effect>,
}

/// How much time passed since a clock was last asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Elapsed {
    /// Refresh frames.
    pub frames: u64,
    /// Hundredths of a second.
    pub centiseconds: u64,
    /// Ticks of the system clock, twentieths of a second.
    pub ticks: u64,
}

impl<'a> Firing<'a> {
    /// One firing of an instance.
    ///
    /// - `size`: the n of a family such as ROUTE(n), else 0.
    /// - `ports`: its inputs, then its memory.
    /// - `inputs`: the number of inputs among the ports.
    /// - `outbox`: takes the results, as pairs of output and message.
    pub fn new(
        object: ObjectId,
        size: u16,
        ports: &'a mut [Port],
        inputs: usize,
        outbox: &'a mut Vec<(u16, Value)>,
        effects: &'a mut Vec<Effect>,
    ) -> Firing<'a> {
        let (inputs, memory) = ports.split_at_mut(inputs);
        Firing { object, size, inputs, memory, outbox, effects }
    }

    /// The function that fires.
    pub const fn object(&self) -> ObjectId {
        self.object
    }

    /// The n of a family such as ROUTE(n), else 0.
    pub const fn size(&self) -> u16 {
        self.size
    }

    /// The message at an input for which the function waits.
    #[inline]
    pub fn value(&self, input: u16) -> &Value {
        self.inputs[usize::from(input) - 1].peek()
    }

    /// The message at an input for which the function does not wait.
    pub fn optional(&self, input: u16) -> Option<&Value> {
        self.inputs[usize::from(input) - 1].first()
    }

    /// The message at an input, to pass on: moved from a queue, copied from a constant.
    #[inline]
    pub fn take(&mut self, input: u16) -> Value {
        self.inputs[usize::from(input) - 1].take()
    }

    /// The number at an input.
    ///
    /// # Errors
    /// [`Problem::Kind`] if it is none.
    pub fn number(&self, input: u16) -> Result<f64, Problem> {
        self.value(input).number().ok_or(Problem::Kind(input))
    }

    /// The number at an input for which the function does not wait.
    ///
    /// # Errors
    /// [`Problem::Kind`] if something else is there.
    pub fn optional_number(&self, input: u16) -> Result<Option<f64>, Problem> {
        self.optional(input).map(|value| value.number().ok_or(Problem::Kind(input))).transpose()
    }

    /// The integer at an input.
    ///
    /// # Errors
    /// [`Problem::Kind`] if it is none.
    pub fn integer(&self, input: u16) -> Result<i32, Problem> {
        match self.value(input) {
            Value::Integer(i) => Ok(*i),
            _ => Err(Problem::Kind(input)),
        }
    }

    /// The Boolean at an input.
    ///
    /// # Errors
    /// [`Problem::Kind`] if it is none.
    pub fn boolean(&self, input: u16) -> Result<bool, Problem> {
        match self.value(input) {
            Value::Boolean(b) => Ok(*b),
            _ => Err(Problem::Kind(input)),
        }
    }

    /// The string at an input.
    ///
    /// # Errors
    /// [`Problem::Kind`] if it is none.
    pub fn string(&self, input: u16) -> Result<&[u8], Problem> {
        match self.value(input) {
            Value::String(text) => Ok(text),
            _ => Err(Problem::Kind(input)),
        }
    }

    /// The 2D vector at an input.
    ///
    /// # Errors
    /// [`Problem::Kind`] if it is none.
    pub fn vector2(&self, input: u16) -> Result<DVec2, Problem> {
        match self.value(input) {
            Value::Vector2(v) => Ok(*v),
            _ => Err(Problem::Kind(input)),
        }
    }

    /// The point at an input: a 3D vector, or a 2D vector with z = 0.
    ///
    /// # Errors
    /// [`Problem::Kind`] if it is none.
    pub fn point(&self, input: u16) -> Result<DVec3, Problem> {
        match self.value(input) {
            Value::Vector3(v) => Ok(*v),
            Value::Vector2(v) => Ok(v.extend(0.0)),
            _ => Err(Problem::Kind(input)),
        }
    }

    /// Sends a result from an output.
    ///
    /// # Errors
    /// [`Problem::Overflow`] if a component is not finite: such a value never enters the network.
    #[inline]
    pub fn emit(&mut self, output: u16, value: Value) -> Result<(), Problem> {
        let finite = match &value {
            Value::Real(number) => number.is_finite(),
            Value::Integer(_) => true,
            other => other.is_finite(),
        };
        if !finite {
            return Err(Problem::Overflow);
        }
        self.outbox.push((output, value));
        Ok(())
    }

    /// Asks something of the rest of the machine.
    pub fn effect(&mut self, effect: Effect) {
        self.effects.push(effect);
    }

    /// Replaces the constant at an input, where it serves as an accumulator.
    ///
    /// # Errors
    /// [`Problem::Overflow`] if a component is not finite; the constant stays.
    pub fn accumulate(&mut self, input: u16, value: Value) -> Result<(), Problem> {
        if !value.is_finite() {
            return Err(Problem::Overflow);
        }
        self.inputs[usize::from(input) - 1].set(value);
        Ok(())
    }

    /// Whether a message arrived at a constant input since this was last asked.
    pub fn take_fresh(&mut self, input: u16) -> bool {
        self.inputs[usize::from(input) - 1].take_fresh()
    }

    /// What the function remembers in a cell, from 0.
    pub fn memory(&self, cell: u8) -> Option<&Value> {
        self.memory[usize::from(cell)].first()
    }

    /// Remembers a value in a cell.
    pub fn remember(&mut self, cell: u8, value: Value) {
        self.memory[usize::from(cell)].set(value);
    }

    /// Forgets what is in a cell.
    pub fn forget(&mut self, cell: u8) {
        self.memory[usize::from(cell)].forget();
    }
}
