//! The mass memory as a whole: definitions of names, and what they take.

use super::{
    Refusal, System,
    initial::InitialStructures,
    insertions::{Insertion, Insertions},
    line_instances::LineInstances,
};
use crate::{
    functions::{self, devices::InitialInstance},
    network::Network,
    objects::Objects,
    port::{Effect, ObjectId},
    structure::{Node, Structures},
};
use protocol::{Name, Value};
use std::collections::HashSet;

/// Bytes of names, nodes and open structures that the machine holds. The real ones had 1 to 4 megabytes; ours, so that
/// a hostile host cannot take all memory of the computer. Queues and lines have limits of their own.
pub const MASS_MEMORY: usize = 2 << 30;

/// What a name table, a function and its queues take, for the account of memory.
const OBJECT_BYTES: usize = 256;

/// Everything that commands and messages change.
#[derive(Debug, Default)]
pub struct MassMemory {
    /// The names.
    pub objects: Objects,
    /// The display structure.
    pub structures: Structures,
    /// The function network.
    pub network: Network,
    /// What the network wants of its surroundings, in order.
    pub effects: Vec<Effect>,
    pub(super) initial: InitialStructures,
    /// Settings of the machine.
    pub system: System,
    /// Whether the command at hand comes from a line in configure mode, which may change what is the system's.
    pub privileged: bool,
    pub(super) insertions: Insertions,
    pub(super) line_instances: LineInstances,
}

impl MassMemory {
    /// The object of a name, made if need be.
    ///
    /// # Errors
    /// [`Refusal::Full`].
    pub fn object(&mut self, name: &Name) -> Result<ObjectId, Refusal> {
        if let Ok(id) = self.objects.object(name) {
            return Ok(id);
        }
        self.reuse_deleted();
        self.objects.object(name).map_err(|_| Refusal::Full)
    }

    /// The object whose messages a name takes: see [`resolve`](Self::resolve). None if the name is not known.
    pub fn target(&self, name: &Name) -> Option<ObjectId> {
        self.objects.find(name.as_str()).map(|id| self.resolve(id))
    }

    /// The object that takes the messages for another: the one that it is another name of, and in a command of a line
    /// with instances of its own, those.
    pub fn resolve(&self, id: ObjectId) -> ObjectId {
        self.line_instances.in_place_of(self.structures.follow(id))
    }

    /// Bytes in use.
    pub fn bytes(&self) -> usize {
        self.structures.bytes() + self.objects.len() * OBJECT_BYTES + self.system.working_storage as usize
    }

    /// Whether nothing more fits in.
    pub fn is_full(&self) -> bool {
        self.bytes() >= MASS_MEMORY
    }

    /// Whether an object has a definition.
    pub fn is_defined(&self, id: ObjectId) -> bool {
        self.network.function(id).is_some() || self.structures.node(id).is_some()
    }

    /// Makes a display node the definition of a name; what belonged to the definition before goes.
    ///
    /// # Errors
    /// [`Refusal::Full`], [`Refusal::System`]; what belongs to `node` then goes.
    pub fn define_node(&mut self, name: &Name, node: Node) -> Result<ObjectId, Refusal> {
        let room = self.bytes() + node.bytes() <= MASS_MEMORY;
        let id = if room { self.user_object(name) } else { Err(Refusal::Full) };
        match id {
            Ok(id) => {
                self.replace(id, |structures| {
                    let kept = node.own_members();
                    (structures.define(id, node), kept)
                });
                Ok(id)
            }
            Err(refusal) => {
                self.undefine_all(node.own_members());
                Err(refusal)
            }
        }
    }

    /// Makes a name another name of an object.
    ///
    /// # Errors
    /// [`Refusal::Full`], [`Refusal::System`], or the object is the name's own.
    pub fn define_alias(&mut self, name: &Name, target: ObjectId) -> Result<ObjectId, Refusal> {
        let id = self.user_object(name)?;
        if self.structures.follow(target) == id {
            return Err(Refusal::Misfit(name.clone(), "no other name of itself"));
        }
        self.replace(id, |structures| (structures.define_alias(id, target), Vec::new()));
        Ok(id)
    }

    /// Makes an object without a name of a node.
    ///
    /// # Errors
    /// [`Refusal::Full`]; what belongs to `node` then goes.
    pub fn add_anonymous(&mut self, node: Node) -> Result<ObjectId, Refusal> {
        let room = self.bytes() + node.bytes() <= MASS_MEMORY;
        match self.objects.anonymous() {
            Ok(id) if room => {
                self.structures.define(id, node);
                Ok(id)
            }
            made => {
                made.into_iter().for_each(|id| self.objects.release(id));
                self.undefine_all(node.own_members());
                Err(Refusal::Full)
            }
        }
    }

    /// Gives an object another definition. What belonged to the one before goes, but for what `define` keeps.
    pub(super) fn replace(
        &mut self,
        id: ObjectId,
        define: impl FnOnce(&mut Structures) -> (Option<Node>, Vec<ObjectId>),
    ) {
        self.network.undefine(id);
        let mut gone = self.insertions_of(id);
        let (before, kept) = define(&mut self.structures);
        if let Some(before) = before {
            let kept: HashSet<ObjectId> = kept.into_iter().collect();
            gone.extend(before.own_members().into_iter().filter(|o| !kept.contains(o)));
        }
        self.undefine_all(gone);
    }

    /// Makes an initial instance, which exists from the start.
    ///
    /// # Errors
    /// [`Refusal`], if the table of initial instances is wrong.
    pub fn define_initial(&mut self, initial: &InitialInstance) -> Result<ObjectId, Refusal> {
        let row = initial.function;
        let type_name = || Name::new(row.name).map_err(|_| Refusal::Full);
        let name = Name::new(&initial.name).map_err(|_| Refusal::Full)?;
        let id = self.object(&name)?;
        let defined = self.network.define(id, row, initial.device);
        defined.map_err(|e| type_name().map_or(Refusal::Full, |t| Refusal::FunctionSize(t, e.to_string())))?;
        Ok(id)
    }

    /// Makes a function instance the definition of a name. Connections to it stay, its own go.
    ///
    /// # Errors
    /// [`Refusal`]; the name then keeps its definition.
    pub fn define_function(&mut self, name: &Name, function: &Name, size: Option<u16>) -> Result<ObjectId, Refusal> {
        let row = functions::find(function.as_str()).ok_or_else(|| Refusal::NoFunction(function.clone()))?;
        if self.bytes() + OBJECT_BYTES > MASS_MEMORY {
            return Err(Refusal::Full);
        }
        let id = self.user_object(name)?;
        if self.objects.is_system(id) && !self.privileged {
            return Err(Refusal::System(name.clone()));
        }
        let defined = self.network.define(id, row, size);
        defined.map_err(|e| Refusal::FunctionSize(function.clone(), e.to_string()))?;
        let mut gone = self.insertions_of(id);
        gone.extend(self.structures.undefine(id).iter().flat_map(Node::own_members));
        self.undefine_all(gone);
        Ok(id)
    }

    /// Takes definitions away, with the nodes that were named inside them; returns all whose definitions went. What
    /// refers to the names refers to nothing until they are defined again.
    pub fn undefine_all(&mut self, mut ids: Vec<ObjectId>) -> Vec<ObjectId> {
        let mut gone = Vec::new();
        while let Some(id) = ids.pop() {
            self.network.undefine(id);
            ids.extend(self.insertions_of(id));
            if let Some(node) = self.structures.undefine(id) {
                ids.extend(node.own_members());
            }
            self.objects.release(id);
            gone.push(id);
        }
        gone
    }

    /// The value of a variable; none if nothing was stored yet.
    ///
    /// # Errors
    /// The name is no variable.
    pub fn variable(&self, name: &Name) -> Result<Option<&Value>, Refusal> {
        match self.target(name).and_then(|id| self.structures.node(id)) {
            Some(Node::Variable(value)) => Ok(value.as_ref()),
            Some(_) => Err(Refusal::Misfit(name.clone(), "no variable")),
            None => Err(Refusal::NotFound(name.clone())),
        }
    }

    /// INCLUDE. Returns false if `into` is a node that holds no others.
    ///
    /// # Errors
    /// [`Refusal::Full`].
    pub fn include(&mut self, name: &Name, into: &Name) -> Result<bool, Refusal> {
        let (member, group) = (self.object(name)?, self.object(into)?);
        let group = self.structures.follow(group);
        if self.is_full() {
            return Err(Refusal::Full);
        }
        Ok(self.network.function(group).is_none() && self.structures.include(member, group))
    }

    /// Releases the memory of what has gone.
    pub fn shrink(&mut self) {
        self.structures.shrink();
        self.objects.shrink();
        self.effects.shrink_to_fit();
    }

    /// RESERVE_WORKING_STORAGE: a larger request takes the place of one before.
    ///
    /// # Errors
    /// [`Refusal::Full`].
    pub fn reserve(&mut self, bytes: u32) -> Result<(), Refusal> {
        let more = bytes.saturating_sub(self.system.working_storage);
        if self.bytes() + more as usize > MASS_MEMORY {
            return Err(Refusal::Full);
        }
        self.system.working_storage += more;
        Ok(())
    }

    /// Clears references to objects that were deleted, so that their numbers can be used again. Not while the network
    /// wants something of its surroundings, which may concern them.
    pub fn reuse_deleted(&mut self) {
        if self.effects.is_empty() {
            self.structures.forget(|id| self.objects.is_deleted(id));
            self.objects.reuse_deleted();
        }
    }

    /// Forgets what was put in at an object, and returns the anonymous objects of it.
    pub(super) fn insertions_of(&mut self, id: ObjectId) -> Vec<ObjectId> {
        match self.insertions.take_all(id) {
            Some(insertions) => self.detach(&insertions),
            None => Vec::new(),
        }
    }

    /// Takes anonymous objects out of the structures that hold them.
    pub(super) fn detach(&mut self, insertions: &[Insertion]) -> Vec<ObjectId> {
        for insertion in insertions {
            if let Some(group) = insertion.group {
                self.structures.take_out(group, insertion.node);
            }
        }
        insertions.iter().map(|insertion| insertion.node).collect()
    }

    fn user_object(&mut self, name: &Name) -> Result<ObjectId, Refusal> {
        let id = self.object(name)?;
        if self.objects.is_system(id) && self.network.function(id).is_some() && !self.privileged {
            return Err(Refusal::System(name.clone()));
        }
        Ok(id)
    }
}
