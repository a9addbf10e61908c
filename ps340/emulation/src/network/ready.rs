//! The list of those that are ready to fire.

use crate::port::ObjectId;

/// A queue of objects in slots that are used again and again: a ring.
///
/// It does what the queue of the standard library does, in half the steps: the number of slots is a power of two.
#[derive(Debug, Default)]
pub(super) struct Ready {
    slots: Vec<ObjectId>,
    first: usize,
    length: usize,
}

impl Ready {
    /// An empty list.
    pub(super) const fn new() -> Ready {
        Ready { slots: Vec::new(), first: 0, length: 0 }
    }

    /// Whether nobody stands here.
    pub(super) const fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Adds one at the end.
    #[inline(always)]
    pub(super) fn push_back(&mut self, object: ObjectId) {
        if self.length == self.slots.len() {
            self.grow();
        }
        let last = (self.first + self.length) & (self.slots.len() - 1);
        self.slots[last] = object;
        self.length += 1;
    }

    /// Puts one that was taken back to the front.
    pub(super) fn put_back(&mut self, object: ObjectId) {
        if self.length == self.slots.len() {
            self.grow();
        }
        self.first = self.first.wrapping_sub(1) & (self.slots.len() - 1);
        self.slots[self.first] = object;
        self.length += 1;
    }

    /// The first.
    #[inline(always)]
    pub(super) fn first(&self) -> Option<ObjectId> {
        if self.length == 0 { None } else { self.slots.get(self.first).copied() }
    }

    /// Drops the first, which must be there.
    #[inline(always)]
    pub(super) fn drop_first(&mut self) {
        self.first = (self.first + 1) & (self.slots.len() - 1);
        self.length -= 1;
    }

    /// Takes the first.
    #[inline(always)]
    pub(super) fn pop_front(&mut self) -> Option<ObjectId> {
        if self.length == 0 {
            return None;
        }
        let object = self.slots[self.first];
        self.first = (self.first + 1) & (self.slots.len() - 1);
        self.length -= 1;
        Some(object)
    }

    /// All, the first first.
    pub(super) fn iter(&self) -> impl Iterator<Item = ObjectId> {
        (0..self.length).map(|index| self.slots[(self.first + index) & (self.slots.len() - 1)])
    }

    /// Doubles the slots of a list that is full.
    #[cold]
    fn grow(&mut self) {
        self.slots.rotate_left(self.first);
        self.first = 0;
        self.slots.resize((2 * self.length).max(16), ObjectId(u32::MAX));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::VecDeque;

    #[test]
    fn it_does_what_the_queue_of_the_standard_library_does() {
        let (mut ready, mut model, mut state) = (Ready::new(), VecDeque::new(), 1_u32);
        for _ in 0..20_000 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let object = ObjectId(state);
            match state >> 30 {
                0 | 1 => (ready.push_back(object), model.push_back(object)).0,
                2 => (ready.put_back(object), model.push_front(object)).0,
                _ => assert_eq!(ready.pop_front(), model.pop_front()),
            }
            assert_eq!(ready.is_empty(), model.is_empty());
        }
        assert!(model.len() > 100 && ready.iter().eq(model));
    }
}
