//! One firing of a function, as its behaviour sees it: inputs, memory, outputs.

use super::{Effect, ObjectId, Outbox, Port, Problem, queue::string_bytes};
use glam::{DMat4, DVec2, DVec3};
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
    outbox: &'a mut Outbox,
    effects: &'a mut Vec<Effect>,
    string_bytes: &'a mut usize,
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
    /// - `inputs`, `memory`: its ports.
    /// - `outbox`: takes the results; `effects`: what it asks of the machine.
    /// - `string_bytes`: bytes of the strings that wait in the network, kept up to date.
    #[inline(always)]
    pub fn new(
        object: ObjectId,
        size: u16,
        inputs: &'a mut [Port],
        memory: &'a mut [Port],
        outbox: &'a mut Outbox,
        effects: &'a mut Vec<Effect>,
        string_bytes: &'a mut usize,
    ) -> Firing<'a> {
        Firing { object, size, inputs, memory, outbox, effects, string_bytes }
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

    /// The 4x4 matrix that a queue gives away, to work on it where it lies; then [`pass`](Self::pass) it on.
    #[inline]
    pub fn matrix4_mut(&mut self, input: u16) -> Option<&mut DMat4> {
        match self.inputs[usize::from(input) - 1].first_mut() {
            Some(Value::Matrix4(matrix)) => Some(matrix),
            _ => None,
        }
    }

    /// Sends the message at an input from an output: moved from a queue, copied from a constant.
    ///
    /// # Errors
    /// [`Problem::Overflow`] if a component is not finite.
    #[inline]
    pub fn pass(&mut self, input: u16, output: u16) -> Result<(), Problem> {
        let port = &mut self.inputs[usize::from(input) - 1];
        match port.first_mut() {
            Some(message) => send(self.outbox, output, message),
            None => send(self.outbox, output, &mut port.take()),
        }
    }

    /// The number at an input.
    ///
    /// # Errors
    /// [`Problem::Kind`] if it is none.
    pub fn number(&self, input: u16) -> Result<f64, Problem> {
        self.value(input).number().ok_or(Problem::Kind(input))
    }

    /// The reals at inputs 1 and 2, if both are reals: the common case of arithmetic.
    #[inline]
    pub fn reals(&self) -> Option<(f64, f64)> {
        match &*self.inputs {
            [first, second, ..] => match (first.peek(), second.peek()) {
                (Value::Real(a), Value::Real(b)) => Some((*a, *b)),
                _ => None,
            },
            _ => None,
        }
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
    #[inline(always)]
    pub fn emit(&mut self, output: u16, value: Value) -> Result<(), Problem> {
        let mut value = value;
        self.emit_from(output, &mut value)
    }

    /// Sends a result from an output. It is moved out of its slot.
    ///
    /// # Errors
    /// [`Problem::Overflow`] if a component is not finite.
    #[inline(always)]
    pub fn emit_from(&mut self, output: u16, value: &mut Value) -> Result<(), Problem> {
        send(self.outbox, output, value)
    }

    /// Sends a real from an output.
    ///
    /// # Errors
    /// [`Problem::Overflow`] if it is not finite.
    #[inline(always)]
    pub fn emit_real(&mut self, output: u16, number: f64) -> Result<(), Problem> {
        send_real(self.outbox, output, number)
    }

    /// Asks something of the rest of the machine.
    pub fn effect(&mut self, effect: Effect) {
        self.effects.push(effect);
    }

    /// Replaces the constant at an input, where it serves as an accumulator. A queue accumulates nothing.
    ///
    /// # Errors
    /// [`Problem::Overflow`] if a component is not finite; the constant stays.
    pub fn accumulate(&mut self, input: u16, value: Value) -> Result<(), Problem> {
        if !value.is_finite() {
            return Err(Problem::Overflow);
        }
        let port = &mut self.inputs[usize::from(input) - 1];
        if !port.is_active() {
            replace(port, Some(value), self.string_bytes);
        }
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
        replace(&mut self.memory[usize::from(cell)], Some(value), self.string_bytes);
    }

    /// Forgets what is in a cell.
    pub fn forget(&mut self, cell: u8) {
        replace(&mut self.memory[usize::from(cell)], None, self.string_bytes);
    }
}

/// Puts a result into the outbox, unless a component is not finite. It is moved out of its slot.
#[inline(always)]
fn send(outbox: &mut Outbox, output: u16, value: &mut Value) -> Result<(), Problem> {
    if let Value::Real(number) = value {
        return send_real(outbox, output, *number);
    }
    if !value.is_finite() {
        return Err(Problem::Overflow);
    }
    outbox.push(output, value);
    Ok(())
}

#[inline(always)]
fn send_real(outbox: &mut Outbox, output: u16, number: f64) -> Result<(), Problem> {
    if !number.is_finite() {
        return Err(Problem::Overflow);
    }
    outbox.push_real(output, number);
    Ok(())
}

/// Replaces what a port holds, and keeps the count of the bytes of strings.
fn replace(port: &mut Port, value: Option<Value>, bytes: &mut usize) {
    *bytes -= port.first().map_or(0, string_bytes);
    match value {
        Some(value) => {
            *bytes += string_bytes(&value);
            port.set(value);
        }
        None => port.forget(),
    }
}
