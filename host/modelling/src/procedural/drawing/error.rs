//! Reasons for which a drawing does not become triangles.

use crate::memory::MemoryExceeded;
use crate::surface::TessellationError;

/// A reason for which a drawing does not become triangles.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DrawingError {
    /// A length of detail that is none.
    #[error("a detail of {0} is not a positive number")]
    Detail(f64),
    /// A patch of a surface that does not become triangles.
    #[error(transparent)]
    Patch(#[from] TessellationError),
    /// More memory than is left.
    #[error(transparent)]
    Memory(#[from] MemoryExceeded),
}
