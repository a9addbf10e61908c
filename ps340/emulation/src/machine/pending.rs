//! What functions request of the next update: matrices, vectors, picks, and the picture itself.

use crate::port::ObjectId;
use glam::DVec2;
use protocol::Name;

/// Requests of one kind that wait for an update; more are refused. Ours.
const MAX_WAITING: usize = 1_000;

/// Requests that wait for the next update.
#[derive(Debug, Default)]
pub(super) struct PendingRequests {
    pub(super) transforms: Vec<TransformRequest>,
    pub(super) picks: Vec<Pick>,
    /// Nodes whose picture is to be written back; `None` for all that is displayed.
    pub(super) write_backs: Vec<Option<ObjectId>>,
}

/// A request for the matrix or vectors of an XFORM node.
#[derive(Debug)]
pub(super) struct TransformRequest {
    /// The function that asked.
    pub(super) function: ObjectId,
    /// The node.
    pub(super) node: Name,
    /// What gets the data as its definition, besides the message.
    pub(super) destination: Option<Name>,
    /// Of vectors: the first one, from 1.
    pub(super) first: u32,
    /// Of vectors: how many.
    pub(super) count: u32,
}

/// A request for a pick.
#[derive(Debug)]
pub(super) struct Pick {
    /// The function that asked.
    pub(super) function: ObjectId,
    /// The centre of the box.
    pub(super) at: DVec2,
    /// Whether pick coordinates are requested.
    pub(super) coordinates: bool,
    /// Updates that are still tried.
    pub(super) frames: u32,
}

impl PendingRequests {
    /// Whether nothing waits.
    pub(super) fn is_empty(&self) -> bool {
        self.transforms.is_empty() && self.picks.is_empty() && self.write_backs.is_empty()
    }

    /// Whether the strokes of the picture themselves are needed.
    pub(super) fn need_strokes(&self) -> bool {
        !self.write_backs.is_empty()
    }

    /// One more; false if there is no space.
    pub(super) fn add_transform(&mut self, request: TransformRequest) -> bool {
        let room = self.transforms.len() < MAX_WAITING;
        if room {
            self.transforms.push(request);
        }
        room
    }

    /// A new pick of a function takes the place of the one before.
    pub(super) fn add_pick(&mut self, pick: Pick) -> bool {
        self.picks.retain(|other| other.function != pick.function);
        let room = self.picks.len() < MAX_WAITING;
        if room {
            self.picks.push(pick);
        }
        room
    }

    /// Only one write-back of a node is made at a time.
    pub(super) fn add_write_back(&mut self, node: Option<ObjectId>) {
        if !self.write_backs.contains(&node) {
            self.write_backs.push(node);
        }
    }
}
