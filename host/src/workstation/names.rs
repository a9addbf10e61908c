//! The names that a scene of ours has on the workstation.

use protocol::Name;

/// The name of the structure that holds a scene.
pub const ROOT: &str = "PERIS";

/// The node of the root that sets the level of detail.
pub(super) const DETAIL: &str = "DETAIL";

/// A name that is known to be legal, such as those in this folder.
pub(super) fn name(text: &str) -> Name {
    Name::new(text).unwrap_or_else(|e| unreachable!("{text}: {e}"))
}
