//! Messages to objects: into a node at once, or into the queue of a function.

use super::MassMemory;
use crate::{
    port::{Effect, ObjectId},
    structure::{Node, NodeFault, Operation},
};
use protocol::{Value, command::Input};

impl MassMemory {
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
        let node = self.structures.follow(node);
        if self.network.function(node).is_some() {
            return self.send(node, input, value);
        }
        let grows = matches!(input, Input::Append | Input::Substitute) || matches!(value, Value::String(_));
        if grows && self.is_full() {
            return Err(NodeFault::Full { input });
        }
        if input == Input::Number(1) && self.rendering_node(node).is_some() {
            return self.request_rendering(node, value);
        }
        if input == Input::Number(1) && self.is_write_back(node) {
            return match value {
                Value::Boolean(true) => {
                    self.effects.push(Effect::RequestWriteBack { node: Some(node) });
                    Ok(())
                }
                Value::Boolean(false) => Ok(()),
                value => Err(NodeFault::Kind { input, kind: value.kind() }),
            };
        }
        self.structures.accept(node, input, value)
    }

    fn is_write_back(&self, id: ObjectId) -> bool {
        self.structures.node(id).and_then(Node::operation).is_some_and(Operation::writes_back)
    }
}
