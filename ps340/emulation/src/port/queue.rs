//! The messages that wait at one input.

use super::{
    Backlog, Literal, PortSpec, QueueRole,
    backlog::QueueHandle,
    moves::{self, PLACEHOLDER},
};
use protocol::{Kind, Value};

/// The messages that wait at one input: a queue, or one constant.
///
/// The first message lies in the port itself, those after it in a [`Backlog`], so that a network that keeps up
/// never touches the heap.
#[derive(Debug)]
pub struct Port {
    value: Value,
    tail: QueueHandle,
    /// The kinds that the input accepts, and flags: one word, since all of it is asked at each arrival.
    state: u32,
}

/// A firing consumes a message here.
const ACTIVE: u32 = 1 << 16;
/// A message is here.
const FILLED: u32 = 1 << 17;
/// A message arrived since the function last asked.
const FRESH: u32 = 1 << 18;
/// The function waits for a first value, though the input is a constant.
const REQUIRED: u32 = 1 << 19;

/// What became of a message that arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// It is the first that the function was waiting for at this input.
    Awaited,
    /// It is queued after others, or replaced a constant.
    Queued,
    /// The queue was full: it is lost.
    Lost,
}

impl Port {
    /// An empty port without a function.
    pub const UNUSED: Port = Port { value: PLACEHOLDER, tail: QueueHandle::NOTHING, state: 0 };

    /// An input as a new instance has it.
    pub fn new(spec: &PortSpec) -> Port {
        let (value, flags) = match &spec.role {
            QueueRole::Active => (PLACEHOLDER, ACTIVE),
            QueueRole::Constant => (PLACEHOLDER, REQUIRED),
            QueueRole::Optional => (PLACEHOLDER, 0),
            QueueRole::Default(literal) => (Literal::value(literal), FILLED),
        };
        Port { value, tail: QueueHandle::NOTHING, state: flags | spec.kinds.bits() }
    }

    /// Whether the input accepts a kind of message.
    #[inline]
    pub const fn accepts(&self, kind: Kind) -> bool {
        self.state & (1 << kind as u32) != 0
    }

    /// Whether a firing consumes a message here.
    #[inline]
    pub const fn is_active(&self) -> bool {
        self.state & ACTIVE != 0
    }

    /// Whether the function waits for a message here.
    #[inline]
    pub const fn is_wanting(&self) -> bool {
        self.state & FILLED == 0 && self.state & (ACTIVE | REQUIRED) != 0
    }

    /// Whether no message waits here.
    #[inline]
    pub const fn is_empty(&self) -> bool {
        self.state & FILLED == 0
    }

    /// The first message, or the constant.
    #[inline]
    pub fn first(&self) -> Option<&Value> {
        if self.is_empty() { None } else { Some(&self.value) }
    }

    /// The messages that wait here, the first first; or the constant.
    pub fn messages<'a>(&'a self, backlog: &'a Backlog) -> impl Iterator<Item = &'a Value> {
        self.first().into_iter().chain(backlog.messages(self.tail))
    }

    /// How many messages wait here.
    pub fn len(&self, backlog: &Backlog) -> usize {
        usize::from(!self.is_empty()) + backlog.length(self.tail)
    }

    /// Bytes of the strings that wait here.
    pub fn string_bytes(&self, backlog: &Backlog) -> usize {
        self.messages(backlog).map(string_bytes).sum()
    }

    /// Bytes of the string that the next firing consumes here.
    pub fn leaving_bytes(&self) -> usize {
        if self.is_active() { self.first().map_or(0, string_bytes) } else { 0 }
    }

    /// Takes in a message, which the caller has checked with [`accepts`](Self::accepts). It is moved out of its slot.
    #[inline(always)]
    pub fn arrive(&mut self, message: &mut Value, backlog: &mut Backlog) -> Arrival {
        let state = self.state;
        if state & (ACTIVE | FILLED) == ACTIVE | FILLED {
            return if backlog.push(&mut self.tail, message) { Arrival::Queued } else { Arrival::Lost };
        }
        moves::shift(message, &mut self.value);
        self.state = state | FILLED | FRESH;
        if state & FILLED == 0 && state & (ACTIVE | REQUIRED) != 0 { Arrival::Awaited } else { Arrival::Queued }
    }

    /// Removes the first message of a queue.
    ///
    /// - Returns whether the queue is empty now.
    #[inline(always)]
    pub fn consume(&mut self, backlog: &mut Backlog) -> bool {
        if self.tail != QueueHandle::NOTHING && backlog.pop(&mut self.tail, &mut self.value) {
            return false;
        }
        moves::clear(&mut self.value);
        self.state &= !FILLED;
        true
    }

    /// Makes the input a queue. The constant, if there is one, is its first message.
    pub fn make_active(&mut self) {
        self.state |= ACTIVE;
    }

    /// Makes the input a constant: the message that came last. The others go.
    ///
    /// - `required`: whether the function waits for a value here.
    pub fn make_constant(&mut self, required: bool, backlog: &mut Backlog) {
        backlog.pop_last(&mut self.tail, &mut self.value);
        self.state = self.state & !(ACTIVE | REQUIRED) | if required { REQUIRED } else { 0 };
    }

    /// Gives back the queue, with the messages in it, before the port itself goes.
    pub fn abandon(&mut self, backlog: &mut Backlog) {
        backlog.take_back(&mut self.tail);
    }

    /// The first message or the constant; a placeholder if there is none.
    #[inline]
    pub(super) const fn peek(&self) -> &Value {
        if self.is_empty() { &PLACEHOLDER } else { &self.value }
    }

    /// Takes the content of the first message of a queue, which stays as a placeholder until it is consumed; copies a
    /// constant.
    #[inline]
    pub fn take(&mut self) -> Value {
        match &mut self.value {
            Value::Real(number) => Value::Real(*number),
            value if self.state & ACTIVE != 0 => std::mem::replace(value, PLACEHOLDER),
            value => value.clone(),
        }
    }

    /// The first message of a queue, to be worked on and moved out.
    #[inline]
    pub fn first_mut(&mut self) -> Option<&mut Value> {
        if self.state & (ACTIVE | FILLED) == ACTIVE | FILLED { Some(&mut self.value) } else { None }
    }

    /// Sets the constant, as the function itself does.
    pub(super) fn set(&mut self, value: Value) {
        self.value = value;
        self.state |= FILLED;
    }

    /// Forgets the constant.
    pub(super) fn forget(&mut self) {
        self.value = PLACEHOLDER;
        self.state &= !FILLED;
    }

    /// Whether a message arrived since this was last asked.
    pub(super) fn take_fresh(&mut self) -> bool {
        let fresh = self.state & FRESH != 0;
        self.state &= !FRESH;
        fresh
    }
}

/// Bytes of what the user made as large as it is: text, names, vectors.
#[inline]
pub(super) fn string_bytes(value: &Value) -> usize {
    value.heap_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::port::{KindSet, MAX_QUEUE};

    fn arrive(port: &mut Port, backlog: &mut Backlog, number: i32) -> Arrival {
        port.arrive(&mut Value::Integer(number), backlog)
    }

    #[test]
    fn a_queue_keeps_the_order_and_a_constant_the_last() {
        let mut backlog = Backlog::new();
        let mut queue = Port::new(&PortSpec::active(KindSet::ANY, ""));
        let mut constant = Port::new(&PortSpec::constant(KindSet::ANY, ""));
        for i in 0..5 {
            let expected = if i == 0 { Arrival::Awaited } else { Arrival::Queued };
            assert_eq!(arrive(&mut queue, &mut backlog, i), expected);
            assert_eq!(arrive(&mut constant, &mut backlog, i), expected);
        }
        for i in 0..5 {
            assert_eq!(queue.first(), Some(&Value::Integer(i)));
            assert_eq!(queue.consume(&mut backlog), i == 4);
        }
        assert_eq!(queue.first(), None);
        assert_eq!((constant.first(), constant.len(&backlog)), (Some(&Value::Integer(4)), 1));
        assert_eq!(backlog.capacity_in_use(), 0);
    }

    #[test]
    fn a_full_queue_loses_the_newest() {
        let mut backlog = Backlog::new();
        let mut queue = Port::new(&PortSpec::active(KindSet::ANY, ""));
        for i in 0..MAX_QUEUE {
            assert_ne!(arrive(&mut queue, &mut backlog, i as i32), Arrival::Lost);
        }
        assert_eq!(arrive(&mut queue, &mut backlog, -1), Arrival::Lost);
        assert_eq!(queue.len(&backlog), MAX_QUEUE);
        assert_eq!(queue.messages(&backlog).last(), Some(&Value::Integer(MAX_QUEUE as i32 - 1)));
    }

    #[test]
    fn a_queue_becomes_its_last_message_and_a_constant_a_queue_of_one() {
        let mut backlog = Backlog::new();
        let mut port = Port::new(&PortSpec::active(KindSet::ANY, ""));
        for i in 0..3 {
            arrive(&mut port, &mut backlog, i);
        }
        port.make_constant(true, &mut backlog);
        assert_eq!((port.first(), port.len(&backlog), backlog.capacity_in_use()), (Some(&Value::Integer(2)), 1, 0));
        port.make_active();
        arrive(&mut port, &mut backlog, 7);
        assert!(!port.consume(&mut backlog));
        assert_eq!(port.first(), Some(&Value::Integer(7)));
        assert!(port.consume(&mut backlog) && port.is_wanting());
    }

    #[test]
    fn a_port_is_three_quarters_of_a_cache_line() {
        assert_eq!(size_of::<Port>(), 48);
    }
}
