//! The display structure: nodes, what they do to the state below them and accept as message sinks, and the list of
//! displayed roots.

mod fault;
mod value;
mod matrix_factors;
mod identifiers;
mod state;
mod operation;
mod node;
mod inputs;
mod copy;
mod physical;
mod word;

pub use copy::{CopyFault, copy};
pub use fault::NodeFault;
pub use identifiers::{IdentifierChains, Identifiers};
pub use matrix_factors::MatrixFactors;
pub use node::{Labels, Member, Node, Polygons, Rendered, Vectors};
pub use operation::{Asked, Degenerate, Operation};
pub use physical::{PhysicalFault, VECTOR_WORDS};
pub use state::{ALL_SCOPES, State};

use crate::{
    pattern::{self, PatternFault},
    port::ObjectId,
};
use protocol::{
    Value,
    command::{Input, Pattern, VectorList},
};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Names of names of names: how far an alias leads. Ours.
const MAX_ALIASES: usize = 64;

/// The nodes of all objects, and the display list.
#[derive(Debug, Default)]
pub struct Structures {
    nodes: Vec<Option<Node>>,
    /// The displayed roots by the order of DISPLAY, and the position of each in that order.
    displayed: BTreeMap<u64, ObjectId>,
    positions: HashMap<ObjectId, u64>,
    next_position: u64,
    /// The structure that each member of a structure was made in, as far as it is still there.
    homes: HashMap<ObjectId, ObjectId>,
    /// Objects that are other names of objects; their nodes are instances of these.
    aliases: HashMap<ObjectId, ObjectId>,
    /// Lists whose vectors changed under a pattern.
    stale: BTreeSet<ObjectId>,
    bytes: usize,
    version: u64,
    /// How many lines are between BEGIN and END, and the version that is shown until then.
    holds: u32,
    held_version: u64,
    frame: u64,
}

impl Structures {
    /// The node of an object; none if the object is undefined or a function.
    pub fn node(&self, id: ObjectId) -> Option<&Node> {
        self.nodes.get(id.index()).and_then(Option::as_ref)
    }

    fn node_mut(&mut self, id: ObjectId) -> Option<&mut Node> {
        self.nodes.get_mut(id.index()).and_then(Option::as_mut)
    }

    /// Makes `node` the definition of an object, and returns the one before.
    pub fn define(&mut self, id: ObjectId, node: Node) -> Option<Node> {
        if self.nodes.len() <= id.index() {
            self.nodes.resize_with(id.index() + 1, || None);
        }
        self.bytes += node.bytes();
        self.version += 1;
        self.homes.extend(node.own_members().into_iter().map(|member| (member, id)));
        self.aliases.remove(&id);
        let before = self.nodes[id.index()].replace(node);
        self.bytes -= before.as_ref().map_or(0, Node::bytes);
        before
    }

    /// Takes the definition of an object away, and returns it.
    pub fn undefine(&mut self, id: ObjectId) -> Option<Node> {
        let before = self.nodes.get_mut(id.index()).and_then(Option::take)?;
        self.aliases.remove(&id);
        self.bytes -= before.bytes();
        self.version += 1;
        Some(before)
    }

    /// Makes an object another name of `target`, and returns the definition that it had. What refers to it shows the
    /// target; messages for it are the target's.
    pub fn define_alias(&mut self, id: ObjectId, target: ObjectId) -> Option<Node> {
        let before = self.define(id, Node::Instance(vec![target]));
        self.aliases.insert(id, target);
        before
    }

    /// The object that `id` is another name of, or `id` itself.
    pub fn follow(&self, id: ObjectId) -> ObjectId {
        let mut at = id;
        for _ in 0..MAX_ALIASES {
            match self.aliases.get(&at) {
                Some(target) => at = *target,
                None => break,
            }
        }
        at
    }

    /// A message for an input of a node.
    ///
    /// # Errors
    /// The fault of the machine, if the node has no such input or does not take the value there. The node
    /// then keeps what it had.
    pub fn accept(&mut self, id: ObjectId, input: Input, value: Value) -> Result<(), NodeFault> {
        let frame = self.frame;
        let node = self.node_mut(id).ok_or(NodeFault::Undefined { input })?;
        // Neither a variable nor the position of the pick box is part of the picture.
        let pick_box = node.operation().is_some_and(|operation| operation.pick_box_size().is_some());
        let shown = !pick_box && !matches!(node, Node::Variable(_));
        let grown = inputs::accept(node, input, value, frame)?;
        self.grow(id, grown);
        self.version += u64::from(shown);
        Ok(())
    }

    /// SEND VL: the vectors of `source` take the places from `input` of a list on.
    ///
    /// # Errors
    /// A node that is no vector list, a position past the one after the last, an input that names no position.
    pub fn overwrite(&mut self, id: ObjectId, input: Input, source: &VectorList) -> Result<(), NodeFault> {
        let Some(Node::Vectors(vectors)) = self.node_mut(id) else { return Err(NodeFault::Vectors { input }) };
        let grown = inputs::overwrite(&mut vectors.list, input, source)?;
        self.grow(id, grown);
        self.version += 1;
        Ok(())
    }

    /// SEND number*mode: marks `count` vectors from `input` of a list on as lines or positions.
    ///
    /// # Errors
    /// A node that is no vector list or a list of dots, a range that is not all there.
    pub fn mark(&mut self, id: ObjectId, input: Input, count: u32, lines: bool) -> Result<(), NodeFault> {
        let Some(Node::Vectors(vectors)) = self.node_mut(id) else { return Err(NodeFault::Vectors { input }) };
        let grown = inputs::mark(&mut vectors.list, input, count, lines)?;
        self.grow(id, grown);
        self.version += 1;
        Ok(())
    }

    /// PATTERN ... WITH: a list is drawn in the dashes of a pattern from now on, in the place of those before.
    ///
    /// # Errors
    /// None for a node that is no vector list; else what is wrong with the pattern or its dashes.
    pub fn set_pattern(&mut self, id: ObjectId, pattern: Pattern) -> Result<(), Option<PatternFault>> {
        let Some(Node::Vectors(vectors)) = self.node_mut(id) else { return Err(None) };
        let dashes = pattern::dashed(&vectors.list, &pattern).map_err(Some)?;
        self.set_dashes(id, Some((pattern, dashes)));
        Ok(())
    }

    /// ERASE PATTERN: a list is drawn as it was given. Returns whether it had a pattern.
    pub fn erase_pattern(&mut self, id: ObjectId) -> bool {
        let dashed = matches!(self.node(id), Some(Node::Vectors(vectors)) if vectors.dashed.is_some());
        if dashed {
            self.set_dashes(id, None);
        }
        dashed
    }

    /// Makes the dashes of the lists that changed since they were made. A list whose dashes are too many loses its
    /// pattern; these are returned. To be done before an update.
    pub fn renew_dashes(&mut self) -> Vec<(ObjectId, PatternFault)> {
        let mut faults = Vec::new();
        for id in std::mem::take(&mut self.stale) {
            let Some(Node::Vectors(vectors)) = self.node(id) else { continue };
            let Some((pattern, _)) = &vectors.dashed else { continue };
            let renewed = pattern::dashed(&vectors.list, pattern).map(|dashes| (pattern.clone(), dashes));
            let renewed = renewed.map_err(|fault| faults.push((id, fault))).ok();
            self.set_dashes(id, renewed);
        }
        faults
    }

    fn set_dashes(&mut self, id: ObjectId, dashed: Option<(Pattern, VectorList)>) {
        let Some(node) = self.nodes.get_mut(id.index()).and_then(Option::as_mut) else { return };
        self.bytes -= node.bytes();
        if let Node::Vectors(vectors) = node {
            vectors.dashed = dashed;
        }
        self.bytes += node.bytes();
        self.version += 1;
    }

    /// Accounts for a node that changed by a message.
    fn grow(&mut self, id: ObjectId, bytes: isize) {
        self.bytes = self.bytes.saturating_add_signed(bytes);
        if let Some(Node::Vectors(vectors)) = self.node(id)
            && vectors.dashed.is_some()
        {
            self.stale.insert(id);
        }
    }

    /// Changes the descendant of an operate node. Returns false for another kind of node.
    pub fn set_descendant(&mut self, id: ObjectId, below: Option<ObjectId>) -> bool {
        let Some(Node::Operate { descendant, .. }) = self.node_mut(id) else { return false };
        *descendant = below;
        self.version += 1;
        true
    }

    /// The last rendering in vectors of a rendering node; none if there is none.
    pub fn rendered(&self, id: ObjectId) -> Option<&Rendered> {
        if let Some(Node::Operate { rendered, .. }) = self.node(id) { rendered.as_deref() } else { None }
    }

    /// Gives a rendering node a rendering in vectors, which it shows in the place of the original. Harmless for other
    /// nodes.
    pub fn set_rendered(&mut self, id: ObjectId, members: Vec<Member>) {
        if let Some(Node::Operate { operation, rendered, .. }) = self.node_mut(id)
            && operation.renders_solids().is_some()
        {
            let new = Rendered { members, shown: true };
            let bytes = new.bytes();
            let before = rendered.replace(Box::new(new));
            self.bytes += bytes;
            self.bytes -= before.map_or(0, |before| before.bytes());
            self.version += 1;
        }
    }

    /// Shows the last rendering in vectors of a rendering node, or the original. Returns false if there is none.
    pub fn show_rendered(&mut self, id: ObjectId, show: bool) -> bool {
        let Some(Node::Operate { rendered: Some(rendered), .. }) = self.node_mut(id) else { return false };
        rendered.shown = show;
        self.version += 1;
        true
    }

    /// Puts `member` into a structure as its own, after the member `anchor` or, without one, after the first.
    /// Returns false if there is no such position.
    pub fn insert_behind(&mut self, group: ObjectId, anchor: Option<ObjectId>, member: ObjectId) -> bool {
        let Some(Node::Group(members)) = self.node_mut(group) else { return false };
        let place = match anchor {
            Some(anchor) => members.iter().position(|m| *m == Member::Named(anchor)),
            None => (!members.is_empty()).then_some(0),
        };
        let Some(place) = place else { return false };
        members.insert(place + 1, Member::Named(member));
        self.homes.insert(member, group);
        self.bytes += node::MEMBER_BYTES;
        self.version += 1;
        true
    }

    /// Takes a member of its own out of a structure. Harmless if it is not there.
    pub fn take_out(&mut self, group: ObjectId, member: ObjectId) {
        let Some(Node::Group(members)) = self.node_mut(group) else { return };
        if let Some(place) = members.iter().position(|m| *m == Member::Named(member)) {
            members.remove(place);
            self.bytes -= node::MEMBER_BYTES;
            self.version += 1;
        }
    }

    /// INCLUDE: `member` becomes the last descendant of an instance or a structure. An undefined object
    /// becomes an instance first. Returns false if the object is another kind of node.
    pub fn include(&mut self, member: ObjectId, into: ObjectId) -> bool {
        if self.node(into).is_none() {
            self.define(into, Node::Instance(Vec::new()));
        }
        match self.node_mut(into) {
            Some(Node::Instance(members)) => members.push(member),
            Some(Node::Group(members)) => members.push(Member::Included(member)),
            _ => return false,
        }
        self.version += 1;
        self.bytes += node::MEMBER_BYTES;
        true
    }

    /// REMOVE ... FROM: the first occurrence of `member` leaves the instance or structure. Returns false if
    /// there was none.
    pub fn exclude(&mut self, member: ObjectId, from: ObjectId) -> bool {
        let found = match self.node_mut(from) {
            Some(Node::Instance(members)) => {
                members.iter().position(|m| *m == member).map(|at| members.remove(at)).is_some()
            }
            Some(Node::Group(members)) => {
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
        if !self.positions.contains_key(&id) {
            self.positions.insert(id, self.next_position);
            self.displayed.insert(self.next_position, id);
            self.next_position += 1;
            self.version += 1;
        }
    }

    /// REMOVE: takes a root away. Returns whether it was there.
    pub fn remove(&mut self, id: ObjectId) -> bool {
        let place = self.positions.remove(&id);
        if let Some(place) = place {
            self.displayed.remove(&place);
            self.version += 1;
        }
        place.is_some()
    }

    /// Empties the display list.
    pub fn clear_displayed(&mut self) {
        self.displayed.clear();
        self.positions.clear();
        self.version += 1;
    }

    /// Clears references to objects that have gone. The picture stays as it is: nothing was drawn for them.
    pub fn forget(&mut self, is_gone: impl Fn(ObjectId) -> bool) {
        for node in self.nodes.iter_mut().flatten() {
            let before = node.bytes();
            node.forget(&is_gone);
            self.bytes = self.bytes + node.bytes() - before;
        }
        self.homes.retain(|member, home| !is_gone(*member) && !is_gone(*home));
        self.aliases.retain(|_, target| !is_gone(*target));
        self.stale.retain(|id| !is_gone(*id));
    }

    /// Releases the memory of nodes that have gone.
    pub fn shrink(&mut self) {
        let end = self.nodes.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        self.nodes.truncate(end);
        self.nodes.shrink_to_fit();
        let nodes = &self.nodes;
        self.homes.retain(|_, home| nodes.get(home.index()).is_some_and(Option::is_some));
        self.homes.shrink_to_fit();
        self.aliases.shrink_to_fit();
        self.positions.shrink_to_fit();
    }

    /// The members that follow a named member in the structure where it was defined; none if it stands in none.
    ///
    /// An operate node there applies to them also when something else refers to it.
    pub fn followers(&self, member: ObjectId) -> &[Member] {
        match self.homes.get(&member).and_then(|home| self.node(*home)) {
            Some(Node::Group(members)) => {
                let place = members.iter().position(|m| *m == Member::Named(member));
                place.map_or(&[], |place| &members[place + 1..])
            }
            _ => &[],
        }
    }

    /// The structure of which an object is a member of its own.
    pub fn home(&self, member: ObjectId) -> Option<ObjectId> {
        let home = *self.homes.get(&member)?;
        let Some(Node::Group(members)) = self.node(home) else { return None };
        members.contains(&Member::Named(member)).then_some(home)
    }

    /// One more than the largest number of an object with a node.
    pub fn extent(&self) -> usize {
        self.nodes.len()
    }

    /// The displayed roots, in the order of DISPLAY.
    pub fn displayed(&self) -> impl Iterator<Item = ObjectId> {
        self.displayed.values().copied()
    }

    /// Counts every change, so that a picture knows whether it is of now. While the picture is held, that of the
    /// beginning.
    pub fn version(&self) -> u64 {
        if self.is_held() { self.held_version } else { self.version }
    }

    /// BEGIN of a line: no change is shown until [`release`](Self::release).
    pub fn hold(&mut self) {
        if self.holds == 0 {
            self.held_version = self.version;
        }
        self.holds += 1;
    }

    /// END of a line. What changed is shown when no line is between BEGIN and END any more.
    pub fn release(&mut self) {
        self.holds = self.holds.saturating_sub(1);
    }

    /// Whether changes are not to be shown yet.
    pub fn is_held(&self) -> bool {
        self.holds > 0
    }

    /// How many lines are between BEGIN and END.
    pub fn holds(&self) -> u32 {
        self.holds
    }

    /// The frame of the display.
    pub fn frame(&self) -> u64 {
        self.frame
    }

    /// Sets which frame of the display it is: the phases of SET RATE count from the frame in which they were set.
    pub fn set_frame(&mut self, frame: u64) {
        self.frame = frame;
    }

    /// Memory that the nodes take, in bytes (nearly: what grows with the user's data is counted).
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Counts the memory of the nodes anew.
    ///
    /// # Errors
    /// What does not agree with [`bytes`](Self::bytes).
    pub fn audit(&self) -> Result<(), String> {
        let counted: usize = self.nodes.iter().flatten().map(Node::bytes).sum();
        if counted == self.bytes { Ok(()) } else { Err(format!("the nodes take {counted} bytes, not {}", self.bytes)) }
    }
}

#[cfg(test)]
mod tests;
