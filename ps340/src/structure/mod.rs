//! The display structure: nodes, what they accept as message sinks, and the list of displayed roots.

mod fault;
mod inputs;
mod node;

pub use fault::NodeFault;
pub use node::{Labels, Member, Node, Operation, Polygons, Vectors};

use crate::port::ObjectId;
use protocol::{Value, command::Input};
use std::collections::{BTreeMap, HashMap};

/// The nodes of all objects, and the display list.
#[derive(Debug, Default)]
pub struct Structures {
    nodes: Vec<Option<Node>>,
    /// The displayed roots by the order of DISPLAY, and the place of each in that order.
    displayed: BTreeMap<u64, ObjectId>,
    places: HashMap<ObjectId, u64>,
    next_place: u64,
    /// The structure in which each named member was defined.
    homes: HashMap<ObjectId, ObjectId>,
    bytes: usize,
    version: u64,
}

impl Structures {
    /// The node of an object; none if the object is undefined or a function.
    pub fn node(&self, id: ObjectId) -> Option<&Node> {
        self.nodes.get(id.index()).and_then(Option::as_ref)
    }

    /// Makes `node` the definition of an object, and returns the one before.
    pub fn define(&mut self, id: ObjectId, node: Node) -> Option<Node> {
        if self.nodes.len() <= id.index() {
            self.nodes.resize_with(id.index() + 1, || None);
        }
        self.bytes += node.bytes();
        self.version += 1;
        self.homes.extend(node.own_members().into_iter().map(|member| (member, id)));
        let before = self.nodes[id.index()].replace(node);
        self.bytes -= before.as_ref().map_or(0, Node::bytes);
        before
    }

    /// Takes the definition of an object away, and returns it.
    pub fn undefine(&mut self, id: ObjectId) -> Option<Node> {
        let before = self.nodes.get_mut(id.index()).and_then(Option::take)?;
        self.homes.remove(&id);
        self.bytes -= before.bytes();
        self.version += 1;
        Some(before)
    }

    /// A message for an input of a node.
    ///
    /// # Errors
    /// The fault of the machine, if the node has no such input or does not take the value there. The node
    /// then keeps what it had.
    pub fn accept(&mut self, id: ObjectId, input: Input, value: Value) -> Result<(), NodeFault> {
        let node = self.nodes.get_mut(id.index()).and_then(Option::as_mut).ok_or(NodeFault::NoSuchInput { input })?;
        // Only data grows or shrinks by messages.
        let data = matches!(node, Node::Vectors(_) | Node::Characters(_));
        let before = if data { node.bytes() } else { 0 };
        let result = inputs::accept(node, input, value);
        if data {
            self.bytes = self.bytes + node.bytes() - before;
        }
        self.version += u64::from(result.is_ok());
        result
    }

    /// INCLUDE: `member` becomes the last descendant of an instance or a structure. An undefined object
    /// becomes an instance first. Returns false if the object is another kind of node.
    pub fn include(&mut self, member: ObjectId, into: ObjectId) -> bool {
        if self.node(into).is_none() {
            self.define(into, Node::Instance(Vec::new()));
        }
        match self.nodes.get_mut(into.index()) {
            Some(Some(Node::Instance(members))) => members.push(member),
            Some(Some(Node::Group(members))) => members.push(Member::Included(member)),
            _ => return false,
        }
        self.version += 1;
        self.bytes += node::MEMBER_BYTES;
        true
    }

    /// REMOVE ... FROM: the first occurrence of `member` leaves the instance or structure. Returns false if
    /// there was none.
    pub fn exclude(&mut self, member: ObjectId, from: ObjectId) -> bool {
        let found = match self.nodes.get_mut(from.index()) {
            Some(Some(Node::Instance(members))) => {
                members.iter().position(|m| *m == member).map(|at| members.remove(at)).is_some()
            }
            Some(Some(Node::Group(members))) => {
                let is_it = |m: &Member| matches!(m, Member::Included(id) if *id == member);
                members.iter().position(is_it).map(|at| members.remove(at)).is_some()
            }
            _ => false,
        };
        if found {
            self.version += 1;
            self.bytes -= node::MEMBER_BYTES;
        }
        found
    }

    /// DISPLAY: adds a root; nothing happens if it is there already.
    pub fn display(&mut self, id: ObjectId) {
        if !self.places.contains_key(&id) {
            self.places.insert(id, self.next_place);
            self.displayed.insert(self.next_place, id);
            self.next_place += 1;
            self.version += 1;
        }
    }

    /// REMOVE: takes a root away. Returns whether it was there.
    pub fn remove(&mut self, id: ObjectId) -> bool {
        let place = self.places.remove(&id);
        if let Some(place) = place {
            self.displayed.remove(&place);
            self.version += 1;
        }
        place.is_some()
    }

    /// Empties the display list.
    pub fn clear_displayed(&mut self) {
        self.displayed.clear();
        self.places.clear();
        self.version += 1;
    }

    /// The members that follow a named member in the structure where it was defined; none if it stands in none.
    ///
    /// An operate node there applies to them also when something else refers to it.
    pub fn followers(&self, member: ObjectId) -> &[Member] {
        fn find(members: &[Member], wanted: ObjectId) -> Option<&[Member]> {
            members.iter().enumerate().find_map(|(place, member)| match member {
                Member::Named(id) if *id == wanted => Some(&members[place + 1..]),
                Member::Unnamed(Node::Group(inner)) => find(inner, wanted),
                _ => None,
            })
        }
        match self.homes.get(&member).and_then(|home| self.node(*home)) {
            Some(Node::Group(members)) => find(members, member).unwrap_or(&[]),
            _ => &[],
        }
    }

    /// One more than the largest number of an object with a node.
    pub fn extent(&self) -> usize {
        self.nodes.len()
    }

    /// The displayed roots, in the order of DISPLAY.
    pub fn displayed(&self) -> impl Iterator<Item = ObjectId> {
        self.displayed.values().copied()
    }

    /// Counts every change, so that a picture knows whether it is of now.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Memory that the nodes take, in bytes (nearly: what grows with the user's data is counted).
    pub fn bytes(&self) -> usize {
        self.bytes
    }
}

#[cfg(test)]
mod tests;
