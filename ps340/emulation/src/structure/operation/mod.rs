//! What operate nodes do to the state below them and at their inputs, and which commands make them: a row for each, in
//! the file of its family.

mod asked;
mod doubt;
mod given;
mod making;
mod printed;
mod text;
mod transformation;
mod viewing;
mod attribute;
mod condition;
mod rendering;
mod table;

pub use asked::Asked;
pub(super) use given::Given;
pub use making::Degenerate;
pub use table::Operation;

use crate::port::ObjectId;
use glam::DVec2;
use protocol::{Name, command::Operate};

impl Operation {
    /// The object that a command names beside its descendant: the font of CHARACTER FONT.
    pub fn named_in(operate: &Operate) -> Option<&Name> {
        if let Operate::CharacterFont(font) = operate { Some(font) } else { None }
    }

    /// The object that it refers to: the font of CHARACTER FONT.
    pub fn reference(&self) -> Option<ObjectId> {
        if let Operation::Font(font) = self { *font } else { None }
    }

    /// Lets it refer to [`ObjectId::NOTHING`] in the place of an object that has gone.
    pub fn forget(&mut self, is_gone: &impl Fn(ObjectId) -> bool) {
        if let Operation::Font(Some(font)) = self
            && is_gone(*font)
        {
            *font = ObjectId::NOTHING;
        }
    }

    /// Whether it renders solids (true) or surfaces (false); none if it renders nothing.
    pub fn renders_solids(&self) -> Option<bool> {
        if let Operation::Rendering { solid } = self { Some(*solid) } else { None }
    }

    /// Half the size of the pick box that it places; none if it places none.
    pub fn pick_box_size(&self) -> Option<DVec2> {
        if let Operation::PickLocation { size, .. } = self { Some(*size) } else { None }
    }

    /// Whether it is WRITEBACK.
    pub fn writes_back(&self) -> bool {
        matches!(self, Operation::WriteBack)
    }

    /// Whether the node sends messages, from output 1.
    pub fn has_output(&self) -> bool {
        self.renders_solids().is_some() || self.writes_back()
    }
}

#[cfg(test)]
mod tests;
