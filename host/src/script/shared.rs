//! Parameters that several functions share.

use super::kinds::{Length, ObjectKind};
use super::parameter::{Optional, Required, optional, required};

/// The object before the dot.
pub(super) const OBJECT: Required<ObjectKind> = required(ObjectKind, "the object");

/// How closely the triangles of a curved object follow it.
pub(super) const TOLERANCE: Optional<Length> =
    optional(Length, "that of the scene", "largest distance between surface and triangles, scene units");
