//! The mass memory: names, display structure and function network together, and the operations that touch more than one.

use crate::{
    functions::{self, devices::Initial},
    network::Network,
    objects::Objects,
    port::{Effect, ObjectId},
    structure::{Node, NodeFault, Structures},
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
    /// The structures that exist from the start, as they are then.
    initial_nodes: Vec<(ObjectId, Node)>,
    /// The arcs that exist from the start.
    initial_arcs: Vec<(ObjectId, u16, ObjectId, Input)>,
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

    /// Makes an initial structure, which exists from the start. The user may redefine it.
    ///
    /// # Errors
    /// [`Refusal`], if the name is none.
    pub fn define_initial_node(&mut self, name: &str, node: Node) -> Result<(), Refusal> {
        let name = Name::new(name).map_err(|_| Refusal::Full)?;
        let id = self.define_node(&name, node.clone())?;
        self.initial_nodes.push((id, node));
        Ok(())
    }

    /// Makes an arc between initial objects, which INITIALIZE restores; nothing if one of them does not exist.
    pub fn connect_initial(&mut self, from: &str, output: u16, to: &str, input: Input) {
        if let (Some(from), Some(to)) = (self.objects.find(from), self.objects.find(to)) {
            self.initial_arcs.push((from, output, to, input));
            self.restore_arcs();
        }
    }

    /// Gives an initial structure the definition that it had at the start. Returns false if the object is none.
    pub fn restore(&mut self, id: ObjectId) -> bool {
        let Some((_, node)) = self.initial_nodes.iter().find(|(initial, _)| *initial == id) else { return false };
        if let Some(before) = self.structures.define(id, node.clone()) {
            self.undefine_all(before.own_members());
        }
        true
    }

    /// Gives all initial structures the definitions that they had at the start.
    pub fn restore_structures(&mut self) {
        let ids: Vec<ObjectId> = self.initial_nodes.iter().map(|(id, _)| *id).collect();
        for id in ids {
            self.restore(id);
        }
    }

    /// INITIALIZE CONNECTIONS: only the arcs that exist from the start are left.
    pub fn restore_arcs(&mut self) {
        self.network.retain_arcs(|_, _, _| false);
        for (from, output, to, input) in &self.initial_arcs {
            // The arcs of the start are few and lead to inputs that exist.
            let connected = self.network.connect(*from, *output, *to, *input);
            debug_assert!(connected.is_ok(), "{connected:?}");
        }
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
        if self.objects.is_system(id) {
            return Err(Refusal::System(name.clone()));
        }
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

    /// INITIALIZE: user objects, all connections and the display list go, initial structures are restored.
    pub fn initialize(&mut self) {
        self.restore_structures();
        let gone: Vec<ObjectId> = self.objects.clear_user().collect();
        self.undefine_all(gone);
        self.structures.clear_displayed();
        self.restore_arcs();
    }

    fn user_object(&mut self, name: &Name) -> Result<ObjectId, Refusal> {
        let id = self.object(name)?;
        if self.objects.is_system(id) && self.network.function(id).is_some() {
            return Err(Refusal::System(name.clone()));
        }
        Ok(id)
    }
}
