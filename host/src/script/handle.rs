//! Objects as scripts hold them, and what calls return.

use rhai::Dynamic;

/// What a script holds of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Handle(pub(super) usize);

/// The value of a call, or what was wrong with it.
pub(super) type CallResult = Result<Dynamic, String>;
