//! Messages for rendering nodes: what they ask for, and the answer at their output.
//!
//! # Source
//! Numbers of the renderings, toggling, saving under a name and the message at the end as remembered, partly seen in
//! clients. Not modelled: the renderings themselves. A request is kept in the node and fails with E 10 and FALSE.

use super::MassMemory;
use crate::{
    port::ObjectId,
    structure::{Node, NodeFault, Operation, RenderingFault},
};
use protocol::{Value, command::Input};

impl MassMemory {
    /// Whether a node is a rendering node.
    pub(super) fn is_rendering(&self, id: ObjectId) -> bool {
        matches!(self.structures.node(id), Some(Node::Operate { operation: Operation::Rendering { .. }, .. }))
    }

    /// A message for input `<1>` of a rendering node. What it asks for ends with TRUE or FALSE from output `<1>`.
    ///
    /// # Errors
    /// Why there is no rendering, or the message is none that such a node takes.
    pub(super) fn render(&mut self, id: ObjectId, value: &Value) -> Result<(), NodeFault> {
        let input = Input::Number(1);
        let done = match value {
            Value::Boolean(false) => Ok(()),
            Value::Integer(0) | Value::Boolean(true) | Value::String(_) => {
                Err(NodeFault::Rendering(RenderingFault::Nothing))
            }
            Value::Integer(number @ 1..=8) => {
                let number = *number as u8;
                self.structures.request_rendering(id, number);
                match self.system.working_storage {
                    0 => Err(NodeFault::NoWorkingStorage),
                    _ => Err(NodeFault::Rendering(RenderingFault::Unavailable(number))),
                }
            }
            Value::Integer(_) => return Err(NodeFault::Range { input }),
            _ => return Err(NodeFault::Kind { input, kind: value.kind() }),
        };
        self.network.emit(id, 1, Value::Boolean(done.is_ok()), &mut self.effects);
        done
    }
}
