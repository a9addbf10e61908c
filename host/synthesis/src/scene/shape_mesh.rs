//! What tessellation makes of a shape.

use crate::mesh::{Mesh, Polylines};
use crate::surface::Surface;
use glam::DVec3;
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

/// Corner normals of flat faces; none of length for a triangle without area.
pub(super) fn flat_normals(mesh: &Mesh) -> Vec<[DVec3; 3]> {
    (0..mesh.triangles.len()).map(|triangle| [mesh.face_normal(triangle).unwrap_or(DVec3::ZERO); 3]).collect()
}
