//! Messages for rendering nodes, and the renderings in vectors that these keep.
//!
//! # Source
//! Numbers of the renderings, toggling and saving under a name as remembered, partly seen in clients.

use super::{MassMemory, Refusal};
use crate::{
    port::{Effect, ObjectId, Rendering, RenderingRequest},
    structure::{Member, Node, NodeFault},
};
use protocol::{Name, Value, command::Input};

impl MassMemory {
    /// Whether a node is a rendering node of solids (true) or surfaces (false); none if it is none.
    pub fn rendering_node(&self, id: ObjectId) -> Option<bool> {
        self.structures.node(id)?.operation()?.renders_solids()
    }

    /// A message for input `<1>` of a rendering node, which becomes a request to the machine.
    ///
    /// # Errors
    /// The message is none that such a node takes.
    pub(super) fn request_rendering(&mut self, node: ObjectId, value: Value) -> Result<(), NodeFault> {
        let input = Input::Number(1);
        let request = match value {
            Value::Boolean(show) => RenderingRequest::Show(show),
            Value::Integer(0) => RenderingRequest::Toggle,
            Value::Integer(number) => {
                RenderingRequest::Render(Rendering::from_number(number).ok_or(NodeFault::Range { input })?)
            }
            Value::String(text) => {
                let name = std::str::from_utf8(&text).ok().and_then(|text| Name::new(text.trim()).ok());
                RenderingRequest::Save(name.ok_or(NodeFault::Range { input })?)
            }
            value => return Err(NodeFault::Kind { input, kind: value.kind() }),
        };
        self.effects.push(Effect::RequestRendering { node, request });
        Ok(())
    }

    /// Gives a rendering node a rendering in vectors, which it shows.
    ///
    /// # Errors
    /// [`Refusal::Full`]; the node is then as before.
    pub fn set_rendered(&mut self, node: ObjectId, members: Vec<Member>) -> Result<(), Refusal> {
        if self.bytes() + members.iter().map(Member::bytes).sum::<usize>() > super::MASS_MEMORY {
            return Err(Refusal::Full);
        }
        self.structures.set_rendered(node, members);
        Ok(())
    }

    /// Gives the last rendering of a node a name of its own: a vector list, or a structure of lists in several colours.
    /// Returns false if there is no rendering.
    ///
    /// # Errors
    /// [`Refusal::Full`], [`Refusal::System`].
    pub fn save_rendered(&mut self, node: ObjectId, name: &Name) -> Result<bool, Refusal> {
        let Some(rendered) = self.structures.rendered(node) else { return Ok(false) };
        let saved = match rendered.members.as_slice() {
            [Member::Unnamed(only @ Node::Vectors(_))] => only.clone(),
            members => Node::Group(members.to_vec()),
        };
        self.define_node(name, saved)?;
        Ok(true)
    }
}
