//! What PREFIX and FOLLOW put in, by the objects at which it was put.

use crate::port::ObjectId;
use std::collections::HashMap;

/// What PREFIX and FOLLOW did to each object, the latest last.
#[derive(Debug, Default)]
pub(super) struct Insertions(HashMap<ObjectId, Vec<Insertion>>);

/// One node that was put in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Insertion {
    pub(super) kind: Kind,
    /// The anonymous object: for a prefix what the name denoted before, else the follower.
    pub(super) node: ObjectId,
    /// The structure that holds the anonymous object as a member of its own.
    pub(super) group: Option<ObjectId>,
}

/// Where a node was put in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Above what a name denotes.
    Prefix,
    /// Below an operate node.
    Follower,
}

impl Insertions {
    /// The insertions at an object.
    pub(super) fn at(&self, id: ObjectId) -> &[Insertion] {
        self.0.get(&id).map_or(&[], Vec::as_slice)
    }

    /// Adds one at an object, as its latest.
    pub(super) fn push(&mut self, id: ObjectId, insertion: Insertion) {
        self.0.entry(id).or_default().push(insertion);
    }

    /// Takes all at an object; none if there are none.
    pub(super) fn take_all(&mut self, id: ObjectId) -> Option<Vec<Insertion>> {
        self.0.remove(&id)
    }

    /// Takes the insertions at an object from `place` on.
    pub(super) fn cut(&mut self, id: ObjectId, place: usize) -> Vec<Insertion> {
        let Some(all) = self.0.get_mut(&id) else { return Vec::new() };
        let cut = all.split_off(place);
        if all.is_empty() {
            self.0.remove(&id);
        }
        cut
    }

    /// Takes one insertion.
    pub(super) fn take(&mut self, id: ObjectId, place: usize) -> Option<Insertion> {
        let all = self.0.get_mut(&id)?;
        let taken = all.remove(place);
        if all.is_empty() {
            self.0.remove(&id);
        }
        Some(taken)
    }

    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }
}
