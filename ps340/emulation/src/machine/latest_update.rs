//! The latest update, and what functions request of the next.

use super::pending::PendingRequests;
use crate::traversal::Update;

/// The latest update, and the requests that wait for another.
#[derive(Debug, Default)]
pub(super) struct LatestUpdate {
    pub(super) update: Update,
    /// Version of the structure that `update` shows; none before the first.
    pub(super) version: Option<u64>,
    /// What functions request of the next update.
    pub(super) pending: PendingRequests,
}
