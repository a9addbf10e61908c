//! The mass memory: names, display structure and function network together, and the operations that touch more than one.

use crate::{
    functions::{self, devices::Initial},
    network::Network,
    objects::Objects,
    port::{Effect, ObjectId},
    structure::{Node, NodeFault, PhysicalFault, Structures},
};
use protocol::{Name, Value, command::Input};
use std::collections::HashSet;

/// Bytes of names, nodes and open structures that the machine holds. The real ones had 1 to 4 megabytes; ours, so that a
/// hostile host cannot take all memory of the computer. Queues and lines have limits of their own.
pub const MASS_MEMORY: usize = 2 << 30;

/// What a name table, a function and its queues take, for the account of memory.
const OBJECT_BYTES: usize = 256;

/// Why an operation on the mass memory was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The mass memory is full.
    #[error("Insufficient memory")]
    Full,
    /// A name of the system may not be redefined or deleted.
    #[error("{0} belongs to the system")]
    System(Name),
    /// A function type that does not exist.
    #[error("Name not found: F:{0}")]
    NoFunction(Name),
    /// A function type cannot be made in this size.
    #[error("{1}")]
    FunctionSize(Name, String),
}

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
}

impl MassMemory {
    /// The object of a name, made if need be.
    ///
    /// # Errors
    /// [`Refusal::Full`].
    pub fn object(&mut self, name: &Name) -> Result<ObjectId, Refusal> {
        self.objects.object(name).map_err(|_| Refusal::Full)
    }

    /// Bytes in use.
    pub fn bytes(&self) -> usize {
        self.structures.bytes() + self.objects.len() * OBJECT_BYTES
    }

    /// Whether an object has a definition.
    pub fn is_defined(&self, id: ObjectId) -> bool {
        self.network.function(id).is_some() || self.structures.node(id).is_some()
    }

    /// Makes a display node the definition of a name; what belonged to the definition before goes.
    ///
    /// # Errors
    /// [`Refusal::Full`], [`Refusal::System`].
    pub fn define_node(&mut self, name: &Name, node: Node) -> Result<ObjectId, Refusal> {
        if self.bytes() + node.bytes() > MASS_MEMORY {
            return Err(Refusal::Full);
        }
        let id = self.user_object(name)?;
        self.network.undefine(id);
        let kept: HashSet<ObjectId> = node.own_members().into_iter().collect();
        if let Some(before) = self.structures.define(id, node) {
            let orphans = before.own_members().into_iter().filter(|o| !kept.contains(o)).collect();
            self.undefine_all(orphans);
        }
        Ok(id)
    }

    /// Makes an initial instance, which exists from the start.
    ///
    /// # Errors
    /// [`Refusal`], if the table of initial instances is wrong.
    pub fn define_initial(&mut self, initial: &Initial) -> Result<ObjectId, Refusal> {
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
        let defined = self.network.define(id, row, size);
        defined.map_err(|e| Refusal::FunctionSize(function.clone(), e.to_string()))?;
        if let Some(before) = self.structures.undefine(id) {
            self.undefine_all(before.own_members());
        }
        Ok(id)
    }

    /// DELETE: takes definitions away, with the nodes that were named inside them. What refers to the names
    /// refers to nothing until they are defined again.
    pub fn undefine_all(&mut self, mut ids: Vec<ObjectId>) {
        while let Some(id) = ids.pop() {
            self.network.undefine(id);
            if let Some(node) = self.structures.undefine(id) {
                ids.extend(node.own_members());
            }
        }
    }

    /// Sends a message to an object: at once into a node, or into the queue of a function.
    ///
    /// # Errors
    /// The fault of a node that does not take it. Faults of functions come as effects.
    pub fn send(&mut self, to: ObjectId, input: Input, value: Value) -> Result<(), NodeFault> {
        if self.network.function(to).is_some() {
            self.network.send(to, input, value, &mut self.effects);
            Ok(())
        } else {
            self.accept(to, input, value)
        }
    }

    /// A message for a node. Data nodes do not grow when the mass memory is full.
    ///
    /// # Errors
    /// The fault of a node that does not take it.
    pub fn accept(&mut self, node: ObjectId, input: Input, value: Value) -> Result<(), NodeFault> {
        let grows = matches!(input, Input::Append | Input::Substitute) || matches!(value, Value::String(_));
        if grows && self.bytes() > MASS_MEMORY {
            return Err(NodeFault::Full { input });
        }
        self.structures.accept(node, input, value)
    }

    /// How many words of memory the data of an object has, for the parallel interface; 0 if they cannot be read.
    pub fn physical_words(&self, id: ObjectId) -> usize {
        self.structures.physical_words(id).unwrap_or(0)
    }

    /// Reads words of the data of an object, from word `offset` on.
    ///
    /// # Errors
    /// [`PhysicalFault`].
    pub fn physical_read(&self, id: ObjectId, offset: usize, count: usize) -> Result<Vec<u16>, PhysicalFault> {
        self.structures.physical_read(id, offset, count)
    }

    /// Writes words of the data of an object, from word `offset` on: all of them, or none.
    ///
    /// # Errors
    /// [`PhysicalFault`].
    pub fn physical_write(&mut self, id: ObjectId, offset: usize, words: &[u16]) -> Result<(), PhysicalFault> {
        self.structures.physical_write(id, offset, words)
    }

    /// INCLUDE. Returns false if `into` is a node that holds no others.
    ///
    /// # Errors
    /// [`Refusal::Full`].
    pub fn include(&mut self, name: &Name, into: &Name) -> Result<bool, Refusal> {
        let (member, group) = (self.object(name)?, self.object(into)?);
        if self.bytes() > MASS_MEMORY {
            return Err(Refusal::Full);
        }
        Ok(self.network.function(group).is_none() && self.structures.include(member, group))
    }

    /// INITIALIZE: user objects, all connections and the display list go.
    pub fn initialize(&mut self) {
        let gone: Vec<ObjectId> = self.objects.clear_user().collect();
        self.undefine_all(gone);
        self.structures.clear_displayed();
        self.network.retain_arcs(|_, _, _| false);
    }

    fn user_object(&mut self, name: &Name) -> Result<ObjectId, Refusal> {
        let id = self.object(name)?;
        if self.objects.is_system(id) && self.network.function(id).is_some() {
            return Err(Refusal::System(name.clone()));
        }
        Ok(id)
    }
}
