//! The messages after the first at each input: a pool of queues for the ports that need one.

use super::moves::{self, PLACEHOLDER};
use protocol::Value;

/// Most messages that wait at one input; later ones are lost, counted and reported. Ours.
pub const MAX_QUEUE: usize = 10_000;

/// Slots above which the memory of a queue that comes back is freed.
const RETAINED_SLOTS: usize = 64;

/// The queues of all ports of a network.
///
/// The first message lies in its port; only the others need a queue. The queue that came back last is handed out next,
/// so that a wave of messages that runs through a large network works in the memory of a few queues.
#[derive(Debug, Default)]
pub struct Backlog {
    queues: Vec<Ring>,
    free: Vec<u32>,
}

/// The handle of the queue that a port has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct QueueHandle(u32);

/// Messages in slots that are used again and again: a ring.
#[derive(Debug, Default)]
struct Ring {
    /// As many as a power of two, or none.
    slots: Vec<Value>,
    first: usize,
    length: usize,
}

impl QueueHandle {
    /// No queue.
    pub(super) const NOTHING: QueueHandle = QueueHandle(u32::MAX);
}

impl Backlog {
    /// Without queues.
    pub const fn new() -> Backlog {
        Backlog { queues: Vec::new(), free: Vec::new() }
    }

    /// How many queues are in use.
    pub const fn capacity_in_use(&self) -> usize {
        self.queues.len() - self.free.len()
    }

    /// Moves a message to the end, and hands out a queue if the port has none yet.
    ///
    /// - Returns false if the queue is full, or there is no number for one more queue; the message stays.
    #[inline(always)]
    pub(super) fn push(&mut self, handle: &mut QueueHandle, message: &mut Value) -> bool {
        if *handle == QueueHandle::NOTHING {
            let Some(number) = self.free.pop().or_else(|| self.more()) else { return false };
            *handle = QueueHandle(number);
        }
        let ring = &mut self.queues[handle.0 as usize];
        if ring.length + 1 >= MAX_QUEUE {
            return false;
        }
        ring.push(message);
        true
    }

    /// Moves the message that came first to a slot. A queue that is empty comes back.
    ///
    /// - Returns false if there is no message.
    #[inline(always)]
    pub(super) fn pop(&mut self, handle: &mut QueueHandle, to: &mut Value) -> bool {
        match self.queues.get_mut(handle.0 as usize) {
            Some(ring) if ring.length > 0 => {
                ring.pop(to);
                true
            }
            _ => {
                self.take_back(handle);
                false
            }
        }
    }

    /// Moves the message that came last to a slot, if there is one; the others go with the queue.
    pub(super) fn pop_last(&mut self, handle: &mut QueueHandle, to: &mut Value) {
        if let Some(last) = self.queues.get_mut(handle.0 as usize).and_then(Ring::last) {
            moves::shift(last, to);
        }
        self.take_back(handle);
    }

    /// The messages, the first first.
    pub(super) fn messages(&self, handle: QueueHandle) -> impl Iterator<Item = &Value> {
        self.queues.get(handle.0 as usize).into_iter().flat_map(Ring::messages)
    }

    /// How many messages there are.
    pub(super) fn length(&self, handle: QueueHandle) -> usize {
        self.queues.get(handle.0 as usize).map_or(0, |ring| ring.length)
    }

    /// Takes a queue back, with whatever is in it.
    #[inline(never)]
    pub(super) fn take_back(&mut self, handle: &mut QueueHandle) {
        if let Some(ring) = self.queues.get_mut(handle.0 as usize) {
            if ring.length > 0 || ring.slots.len() > RETAINED_SLOTS {
                *ring = Ring::default();
            }
            self.free.push(handle.0);
            *handle = QueueHandle::NOTHING;
        }
    }

    /// Makes one more queue.
    #[cold]
    fn more(&mut self) -> Option<u32> {
        let number =
            u32::try_from(self.queues.len()).ok().filter(|&number| QueueHandle(number) != QueueHandle::NOTHING)?;
        self.queues.push(Ring::default());
        Some(number)
    }
}

impl Ring {
    #[inline(always)]
    fn push(&mut self, message: &mut Value) {
        if self.length == self.slots.len() {
            self.grow();
        }
        let last = (self.first + self.length) & (self.slots.len() - 1);
        moves::shift(message, &mut self.slots[last]);
        self.length += 1;
    }

    /// Moves the first message, which must be there, to a slot.
    #[inline(always)]
    fn pop(&mut self, to: &mut Value) {
        moves::shift(&mut self.slots[self.first], to);
        self.first = (self.first + 1) & (self.slots.len() - 1);
        self.length -= 1;
    }

    fn last(&mut self) -> Option<&mut Value> {
        let last = (self.first + self.length.checked_sub(1)?) & (self.slots.len() - 1);
        Some(&mut self.slots[last])
    }

    fn messages(&self) -> impl Iterator<Item = &Value> {
        (0..self.length).map(|index| &self.slots[(self.first + index) & (self.slots.len() - 1)])
    }

    /// Doubles the slots of a ring that is full.
    #[cold]
    fn grow(&mut self) {
        self.slots.rotate_left(self.first);
        self.first = 0;
        self.slots.resize_with((2 * self.length).max(4), || PLACEHOLDER);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_queue_that_came_back_is_handed_out_again() {
        let mut backlog = Backlog::new();
        let (mut a, mut b, mut place) = (QueueHandle::NOTHING, QueueHandle::NOTHING, PLACEHOLDER);
        assert!(!backlog.pop(&mut a, &mut place));
        for i in 0..3 {
            assert!(backlog.push(&mut a, &mut Value::Integer(i)));
        }
        for i in 0..3 {
            assert!(backlog.pop(&mut a, &mut place) && place == Value::Integer(i));
        }
        assert_eq!(backlog.capacity_in_use(), 1, "it comes back when it is asked in vain");
        assert!(!backlog.pop(&mut a, &mut place));
        assert_eq!((a, backlog.capacity_in_use()), (QueueHandle::NOTHING, 0));
        backlog.push(&mut b, &mut Value::Integer(5));
        backlog.push(&mut a, &mut Value::Integer(6));
        backlog.push(&mut a, &mut Value::Integer(7));
        assert_eq!((b, backlog.capacity_in_use()), (QueueHandle(0), 2));
        backlog.pop_last(&mut a, &mut place);
        assert_eq!(place, Value::Integer(7));
        assert_eq!((backlog.length(a), backlog.length(b), backlog.capacity_in_use()), (0, 1, 1));
    }

    #[test]
    fn a_ring_keeps_the_order_while_it_grows_and_goes_round() {
        let (mut ring, mut place, mut next_in, mut next_out) = (Ring::default(), PLACEHOLDER, 0, 0);
        for burst in [3, 5, 1, 40, 2, 100] {
            for _ in 0..burst {
                ring.push(&mut if next_in % 2 == 0 {
                    Value::string(next_in.to_string())
                } else {
                    Value::Integer(next_in)
                });
                next_in += 1;
            }
            assert_eq!(ring.messages().count(), (next_in - next_out) as usize);
            for _ in 0..burst * 2 / 3 {
                ring.pop(&mut place);
                let expected =
                    if next_out % 2 == 0 { Value::string(next_out.to_string()) } else { Value::Integer(next_out) };
                assert_eq!(place, expected);
                next_out += 1;
            }
        }
    }
}
