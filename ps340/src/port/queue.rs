//! The messages that wait at one input.

use super::{KindSet, Literal, PortSpec, Role};
use protocol::{Kind, Value};
use std::collections::VecDeque;

/// Most messages that wait at one input; later ones are lost, counted and reported. Ours.
pub const MAX_QUEUE: usize = 10_000;

/// Capacity of an empty queue above which its memory is given back.
const KEPT_CAPACITY: usize = 64;

/// What a message has when its content was taken out.
const HUSK: Value = Value::Boolean(false);

/// The messages that wait at one input: a queue, or one constant.
///
/// The first message lies in the port itself, so that a network that keeps up never touches the heap.
#[derive(Debug)]
pub struct Port {
    value: Value,
    rest: Option<Box<Rest>>,
    kinds: KindSet,
    active: bool,
    awaited: bool,
    filled: bool,
    fresh: bool,
}

/// The second message and all after it.
#[derive(Debug, Default)]
struct Rest {
    messages: VecDeque<Value>,
    lost: u64,
}

/// What became of a message that arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// It is the first that the function was waiting for at this input.
    Awaited,
    /// It waits behind others, or replaced a constant.
    Kept,
    /// The queue was full: it was lost, as the count says, with those before it.
    Lost(u64),
}

impl Port {
    /// An empty port without a function.
    pub const UNUSED: Port = Port {
        value: HUSK,
        rest: None,
        kinds: KindSet::NONE,
        active: false,
        awaited: false,
        filled: false,
        fresh: false,
    };

    /// An input as a new instance has it.
    pub fn new(spec: &PortSpec) -> Port {
        let default = match &spec.role {
            Role::Default(literal) => Some(Literal::value(literal)),
            _ => None,
        };
        Port {
            kinds: spec.kinds,
            active: spec.role == Role::Active,
            awaited: matches!(spec.role, Role::Active | Role::Constant),
            filled: default.is_some(),
            value: default.unwrap_or(HUSK),
            ..Port::UNUSED
        }
    }

    /// Whether the input accepts a kind of message.
    pub const fn accepts(&self, kind: Kind) -> bool {
        self.kinds.contains(kind)
    }

    /// Whether a firing consumes a message here.
    pub const fn is_active(&self) -> bool {
        self.active
    }

    /// Whether the function waits for a message here.
    pub const fn is_wanting(&self) -> bool {
        self.awaited && !self.filled
    }

    /// The first message, or the constant.
    pub fn first(&self) -> Option<&Value> {
        self.filled.then_some(&self.value)
    }

    /// How many messages wait here.
    pub fn len(&self) -> usize {
        usize::from(self.filled) + self.rest.as_ref().map_or(0, |rest| rest.messages.len())
    }

    /// Whether no message waits here.
    pub const fn is_empty(&self) -> bool {
        !self.filled
    }

    /// Bytes of the strings that wait here. Memory cells, which take no messages, do not count.
    pub fn string_bytes(&self) -> usize {
        if self.kinds == KindSet::NONE {
            return 0;
        }
        let rest = self.rest.iter().flat_map(|rest| rest.messages.iter());
        self.first().into_iter().chain(rest).map(string_bytes).sum()
    }

    /// Bytes of the string that the next firing consumes here.
    pub fn leaving_bytes(&self) -> usize {
        if self.active && self.filled { string_bytes(&self.value) } else { 0 }
    }

    /// Takes in a message, which the caller has checked with [`accepts`](Self::accepts).
    #[inline]
    pub fn arrive(&mut self, value: Value) -> Arrival {
        if self.filled && self.active {
            return self.queue(value);
        }
        let awaited = self.awaited && !self.filled;
        self.value = value;
        self.filled = true;
        self.fresh = true;
        if awaited { Arrival::Awaited } else { Arrival::Kept }
    }

    /// Counts a message that found no place.
    #[cold]
    pub fn lose(&mut self) -> Arrival {
        let rest = self.rest.get_or_insert_default();
        rest.lost += 1;
        Arrival::Lost(rest.lost)
    }

    #[cold]
    fn queue(&mut self, value: Value) -> Arrival {
        let rest = self.rest.get_or_insert_default();
        if rest.messages.len() + 1 >= MAX_QUEUE {
            return self.lose();
        }
        rest.messages.push_back(value);
        Arrival::Kept
    }

    /// Removes the first message of a queue.
    ///
    /// - Returns whether the queue is empty now.
    #[inline]
    pub fn consume(&mut self) -> bool {
        if let Some(rest) = &mut self.rest {
            if let Some(next) = rest.messages.pop_front() {
                self.value = next;
                return false;
            }
            if rest.messages.capacity() > KEPT_CAPACITY {
                rest.messages = VecDeque::new();
            }
        }
        self.value = HUSK;
        self.filled = false;
        true
    }

    /// The first message or the constant; a husk if there is none.
    #[inline]
    pub(super) const fn peek(&self) -> &Value {
        &self.value
    }

    /// Takes the content of the first message of a queue, which stays as a husk until it is consumed; copies a
    /// constant.
    #[inline]
    pub(super) fn take(&mut self) -> Value {
        if self.active { std::mem::replace(&mut self.value, HUSK) } else { self.value.clone() }
    }

    /// Sets the constant, as the function itself does.
    pub(super) fn set(&mut self, value: Value) {
        self.value = value;
        self.filled = true;
    }

    /// Forgets the constant.
    pub(super) fn forget(&mut self) {
        self.value = HUSK;
        self.filled = false;
    }

    /// Whether a message arrived since this was last asked.
    pub(super) fn take_fresh(&mut self) -> bool {
        std::mem::take(&mut self.fresh)
    }
}

/// Bytes of the string in a value, 0 for other kinds.
fn string_bytes(value: &Value) -> usize {
    match value {
        Value::String(text) => text.len(),
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_queue_keeps_the_order_and_a_constant_the_last() {
        let mut queue = Port::new(&PortSpec::active(KindSet::ANY, ""));
        let mut constant = Port::new(&PortSpec::constant(KindSet::ANY, ""));
        for i in 0..5 {
            let expected = if i == 0 { Arrival::Awaited } else { Arrival::Kept };
            assert_eq!(queue.arrive(Value::Integer(i)), expected);
            assert_eq!(constant.arrive(Value::Integer(i)), expected);
        }
        for i in 0..5 {
            assert_eq!(queue.first(), Some(&Value::Integer(i)));
            assert_eq!(queue.consume(), i == 4);
        }
        assert_eq!(queue.first(), None);
        assert_eq!((constant.first(), constant.len()), (Some(&Value::Integer(4)), 1));
    }

    #[test]
    fn a_full_queue_loses_the_newest_and_counts() {
        let mut queue = Port::new(&PortSpec::active(KindSet::ANY, ""));
        for i in 0..MAX_QUEUE {
            assert!(!matches!(queue.arrive(Value::Integer(i as i32)), Arrival::Lost(_)));
        }
        assert_eq!(queue.arrive(Value::Integer(-1)), Arrival::Lost(1));
        assert_eq!(queue.arrive(Value::Integer(-1)), Arrival::Lost(2));
        assert_eq!(queue.len(), MAX_QUEUE);
        let mut last = None;
        while let Some(value) = queue.first().cloned() {
            last = Some(value);
            queue.consume();
        }
        assert_eq!(last, Some(Value::Integer(MAX_QUEUE as i32 - 1)));
    }

    #[test]
    fn a_port_is_one_cache_line() {
        assert!(size_of::<Port>() <= 64, "{}", size_of::<Port>());
    }
}
