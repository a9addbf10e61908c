//! PREFIX and FOLLOW: operate nodes that are put into a structure that exists, and taken out again.
//!
//! # Source
//! The commands as remembered: PREFIX puts a node above what a name denotes, which the name then denotes; FOLLOW puts
//! one directly below an operate node. Ours: inside a structure, where an operate node applies to all that follows,
//! so do the new ones; nodes that follow a prefix go with it.

use super::{
    MassMemory, Refusal,
    insertions::{Insertion, Kind},
};
use crate::{
    port::ObjectId,
    structure::{Member, Node, Operation},
};
use protocol::Name;

/// Most nodes that PREFIX and FOLLOW put at one name. Ours.
const MAX_INSERTIONS: usize = 1000;

impl MassMemory {
    /// PREFIX name WITH operation.
    ///
    /// # Errors
    /// [`Refusal`] for a name without a display node, or of the system.
    pub fn prefix(&mut self, name: &Name, operation: Operation) -> Result<(), Refusal> {
        let id = self.editable(name)?;
        let leaking = matches!(self.structures.node(id), Some(Node::Operate { descendant: None, .. }));
        let group = if leaking { self.structures.home(id) } else { None };
        let below = self.objects.anonymous().map_err(|_| Refusal::Full)?;
        let descendant = if group.is_some() { None } else { Some(below) };
        if let Some(before) = self.structures.define(id, Node::operate(operation, descendant)) {
            self.structures.define(below, before);
        }
        if let Some(group) = group {
            self.structures.insert_behind(group, Some(id), below);
        }
        self.remember(id, Insertion { kind: Kind::Prefix, node: below, group });
        Ok(())
    }

    /// FOLLOW name WITH operation.
    ///
    /// # Errors
    /// [`Refusal`] for a name that denotes no operate node, or a structure that does not begin with one.
    pub fn follow(&mut self, name: &Name, operation: Operation) -> Result<(), Refusal> {
        let id = self.editable(name)?;
        let no_operate = Refusal::Misfit(name.clone(), "no operate node that could be followed");
        let (descendant, group, anchor) = match self.structures.node(id) {
            Some(Node::Operate { descendant: Some(below), .. }) => (Some(*below), None, None),
            Some(Node::Operate { descendant: None, .. }) => (None, self.structures.home(id), Some(id)),
            Some(Node::Group(members)) if self.begins_with_operate(members) => (None, Some(id), None),
            _ => return Err(no_operate),
        };
        let node = self.add_anonymous(Node::operate(operation, descendant))?;
        match group {
            Some(group) => self.structures.insert_behind(group, anchor, node),
            None => self.structures.set_descendant(id, Some(node)),
        };
        self.remember(id, Insertion { kind: Kind::Follower, node, group });
        Ok(())
    }

    /// REMOVE PREFIX OF name: the latest prefix goes, with the nodes that follow it.
    ///
    /// # Errors
    /// [`Refusal`] for a name without a prefix.
    pub fn remove_prefix(&mut self, name: &Name) -> Result<(), Refusal> {
        let (id, place) = self.latest(name, Kind::Prefix)?;
        let above = self.insertions.cut(id, place);
        let Some((prefix, followers)) = above.split_first() else { return Ok(()) };
        if let Some(group) = prefix.group {
            self.structures.take_out(group, prefix.node);
        }
        if let Some(original) = self.structures.undefine(prefix.node) {
            self.structures.define(id, original);
        }
        self.objects.release(prefix.node);
        let gone = self.detach(followers);
        self.undefine_all(gone);
        Ok(())
    }

    /// REMOVE FOLLOWER OF name: the latest follower goes.
    ///
    /// # Errors
    /// [`Refusal`] for a name without a follower.
    pub fn remove_follower(&mut self, name: &Name) -> Result<(), Refusal> {
        let (id, place) = self.latest(name, Kind::Follower)?;
        let Some(follower) = self.insertions.take(id, place) else { return Ok(()) };
        if follower.group.is_none() {
            let below = self.descendant(follower.node);
            let mut above = id;
            while let Some(next) = self.descendant(above) {
                if next == follower.node {
                    self.structures.set_descendant(above, below);
                    break;
                }
                above = next;
            }
        }
        let gone = self.detach(&[follower]);
        self.undefine_all(gone);
        Ok(())
    }

    fn remember(&mut self, id: ObjectId, insertion: Insertion) {
        self.insertions.push(id, insertion);
    }

    /// The display node that PREFIX or FOLLOW may change.
    fn editable(&mut self, name: &Name) -> Result<ObjectId, Refusal> {
        let id = self.objects.find(name.as_str()).ok_or_else(|| Refusal::NotFound(name.clone()))?;
        let id = self.structures.follow(id);
        if self.network.function(id).is_some() {
            return Err(Refusal::Misfit(name.clone(), "a function and no display node"));
        }
        if self.structures.node(id).is_none() {
            return Err(Refusal::NotFound(name.clone()));
        }
        let crowd = self.insertions.at(id).len() >= MAX_INSERTIONS;
        if crowd || self.is_full() { Err(Refusal::Full) } else { Ok(id) }
    }

    fn latest(&self, name: &Name, kind: Kind) -> Result<(ObjectId, usize), Refusal> {
        let id = self.objects.find(name.as_str()).ok_or_else(|| Refusal::NotFound(name.clone()))?;
        let id = self.structures.follow(id);
        let place = self.insertions.at(id).iter().rposition(|i| i.kind == kind);
        let none = match kind {
            Kind::Prefix => "a name without a prefix",
            Kind::Follower => "a name without a follower",
        };
        place.map(|place| (id, place)).ok_or_else(|| Refusal::Misfit(name.clone(), none))
    }

    fn descendant(&self, id: ObjectId) -> Option<ObjectId> {
        match self.structures.node(id) {
            Some(Node::Operate { descendant, .. }) => *descendant,
            _ => None,
        }
    }

    /// Whether the first node of a structure is an operate node that applies to the others.
    fn begins_with_operate(&self, members: &[Member]) -> bool {
        let applies = |node: Option<&Node>| matches!(node, Some(Node::Operate { descendant: None, .. }));
        match members.first() {
            Some(Member::Unnamed(node)) => applies(Some(node)),
            Some(Member::Named(id)) => applies(self.structures.node(*id)),
            _ => false,
        }
    }
}
