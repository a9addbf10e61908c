//! The results of one firing, until they are delivered.

use super::moves;
use protocol::Value;

/// The results of one firing, as pairs of output and message, in their order.
///
/// Most firings have one result: it has a slot of its own, so that it passes without touching the heap.
#[derive(Debug)]
pub struct Outbox {
    first: (u16, Value),
    filled: bool,
    more: Vec<(u16, Value)>,
}

impl Default for Outbox {
    fn default() -> Outbox {
        Outbox::new()
    }
}

impl Outbox {
    /// An empty one.
    pub const fn new() -> Outbox {
        Outbox { first: (0, moves::PLACEHOLDER), filled: false, more: Vec::new() }
    }

    /// Adds a result.
    #[inline(never)]
    pub(super) fn push(&mut self, output: u16, message: &mut Value) {
        match self.next(output) {
            Some(place) => moves::shift(message, place),
            None => self.more.push((output, std::mem::replace(message, moves::PLACEHOLDER))),
        }
    }

    /// Adds a real.
    #[inline(always)]
    pub(super) fn push_real(&mut self, output: u16, number: f64) {
        match self.next(output) {
            Some(place) => moves::put_real(number, place),
            None => self.push_more(output, number),
        }
    }

    #[inline(never)]
    fn push_more(&mut self, output: u16, number: f64) {
        self.more.push((output, Value::Real(number)));
    }

    /// The slot of the first result, if it is still free.
    #[inline(always)]
    fn next(&mut self, output: u16) -> Option<&mut Value> {
        if self.filled {
            return None;
        }
        self.filled = true;
        self.first.0 = output;
        Some(&mut self.first.1)
    }

    /// The first result, to be moved on.
    #[inline]
    pub fn first(&mut self) -> Option<&mut (u16, Value)> {
        self.filled.then_some(&mut self.first)
    }

    /// Whether there are results after the first.
    #[inline]
    pub const fn has_more(&self) -> bool {
        !self.more.is_empty()
    }

    /// The results after the first.
    pub fn more(&mut self) -> &mut [(u16, Value)] {
        &mut self.more
    }

    /// Notes that the only result was moved on.
    #[inline(always)]
    pub fn note_delivery(&mut self) {
        self.filled = false;
    }

    /// Forgets all results.
    #[inline]
    pub fn clear(&mut self) {
        self.filled = false;
        moves::clear(&mut self.first.1);
        if !self.more.is_empty() {
            self.more.clear();
        }
    }
}
