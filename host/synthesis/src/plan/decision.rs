//! A decision of a plan: whether something is needed, and why.

/// A decision with its reason.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Decision {
    pub(crate) needed: bool,
    pub(crate) reason: String,
}

impl Decision {
    pub(super) fn new(needed: bool, reason: impl Into<String>) -> Decision {
        Decision { needed, reason: reason.into() }
    }
}
