//! What exists from the start besides functions, as it was then.

use crate::{port::ObjectId, structure::Node};
use protocol::command::Input;

/// The initial structures and arcs, as they are at the start.
#[derive(Debug, Default)]
pub(super) struct InitialStructures {
    pub(super) nodes: Vec<(ObjectId, Node)>,
    pub(super) arcs: Vec<(ObjectId, u16, ObjectId, Input)>,
}
