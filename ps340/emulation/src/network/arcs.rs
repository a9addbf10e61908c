//! The arcs that leave one output, in the order in which they were connected.

use crate::port::ObjectId;
use protocol::command::Input;

/// Most arcs that leave one output. It bounds the memory that one firing can ask for. Ours.
pub const MAX_ARCS: usize = 4_096;

/// Where an arc ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Destination {
    /// The object.
    pub object: ObjectId,
    /// The input.
    pub input: Input,
}

/// The arcs that leave one output. The first lies here, since most outputs have one only.
#[derive(Debug, Default)]
pub(super) struct OutputArcs {
    first: Option<Destination>,
    others: Vec<Destination>,
}

impl OutputArcs {
    /// How many arcs leave the output.
    #[inline]
    pub(super) fn len(&self) -> usize {
        usize::from(self.first.is_some()) + self.others.len()
    }

    /// The only arc, if there is exactly one.
    #[inline]
    pub(super) fn sole(&self) -> Option<Destination> {
        self.first.filter(|_| self.others.is_empty())
    }

    /// Arc `index`, from 0.
    #[inline]
    pub(super) fn get(&self, index: usize) -> Option<Destination> {
        match index {
            0 => self.first,
            _ => self.others.get(index - 1).copied(),
        }
    }

    /// The arcs.
    pub(super) fn iter(&self) -> impl Iterator<Item = Destination> {
        self.first.into_iter().chain(self.others.iter().copied())
    }

    /// Adds an arc; one that exists stays as it is.
    ///
    /// - Returns false if there are [`MAX_ARCS`] already.
    pub(super) fn connect(&mut self, to: Destination) -> bool {
        if self.iter().any(|arc| arc == to) {
            return true;
        }
        if self.first.is_none() {
            self.first = Some(to);
            return true;
        }
        if self.others.len() + 1 >= MAX_ARCS {
            return false;
        }
        self.others.push(to);
        true
    }

    /// Keeps the arcs for which `keep` is true.
    pub(super) fn retain(&mut self, mut keep: impl FnMut(Destination) -> bool) {
        self.first = self.first.filter(|&arc| keep(arc));
        self.others.retain(|&arc| keep(arc));
        if self.first.is_none() && !self.others.is_empty() {
            self.first = Some(self.others.remove(0));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn to(object: u32) -> Destination {
        Destination { object: ObjectId(object), input: Input::Number(1) }
    }

    #[test]
    fn arcs_keep_their_order_and_come_once() {
        let mut output = OutputArcs::default();
        for object in [3, 1, 2, 1, 3] {
            assert!(output.connect(to(object)));
        }
        assert_eq!(output.iter().collect::<Vec<_>>(), [to(3), to(1), to(2)]);
        output.retain(|arc| arc != to(3));
        assert_eq!((output.get(0), output.get(1), output.get(2)), (Some(to(1)), Some(to(2)), None));
        output.retain(|arc| arc != to(2));
        assert_eq!((output.sole(), output.len()), (Some(to(1)), 1));
        output.retain(|_| false);
        assert_eq!((output.sole(), output.len()), (None, 0));
    }

    #[test]
    fn fan_out_has_a_limit() {
        let mut output = OutputArcs::default();
        assert!((0..MAX_ARCS as u32).all(|object| output.connect(to(object))));
        assert!(!output.connect(to(u32::MAX)));
        assert!(output.connect(to(5)), "an arc that exists is no new one");
        assert_eq!((output.sole(), output.len()), (None, MAX_ARCS));
    }
}
