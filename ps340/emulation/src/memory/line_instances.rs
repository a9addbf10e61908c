//! The instances that host lines have for themselves, as a table.

use crate::port::{LineId, ObjectId};
use std::collections::BTreeMap;

/// The instances of all lines that have some.
#[derive(Debug, Default)]
pub(super) struct LineInstances {
    pub(super) lines: BTreeMap<LineId, Vec<LineInstance>>,
    /// The line whose command is carried out.
    pub(super) speaker: Option<LineId>,
}

/// One instance of a line.
#[derive(Debug)]
pub(super) struct LineInstance {
    /// The initial instance with the name.
    pub(super) shared: ObjectId,
    /// The one of the line.
    pub(super) own: ObjectId,
}

impl LineInstances {
    /// The instance of the line whose command is carried out, in place of the initial one with the name; that one
    /// itself if the line has none.
    pub(super) fn in_place_of(&self, id: ObjectId) -> ObjectId {
        let instances = self.speaker.and_then(|line| self.lines.get(&line));
        let own = instances.and_then(|instances| instances.iter().find(|instance| instance.shared == id));
        own.map_or(id, |instance| instance.own)
    }
}
