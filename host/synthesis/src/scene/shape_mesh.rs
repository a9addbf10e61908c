//! What tessellation makes of a shape.

use crate::mesh::{Mesh, Polylines};
use crate::surface::Surface;
use std::sync::Arc;

/// Triangles of a shape, and what they belong to.
#[derive(Clone, Default)]
pub struct ShapeMesh {
    /// The triangles, in own coordinates.
    pub mesh: Mesh,
    /// The exact surfaces that the triangles name; none where only triangles are known.
    pub surfaces: Vec<Option<Arc<dyn Surface>>>,
    /// For each triangle of a composite its innermost operand, numbered consecutively in the order of the script; empty
    /// for other shapes.
    pub operand_of: Vec<u32>,
    /// Lines, in own coordinates.
    pub lines: Polylines,
}
