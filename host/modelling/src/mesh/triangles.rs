//! The triangles of a mesh over shared vertices, with what is known at their corners.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// The most vertices or triangles of a mesh; indices leave room for marks.
pub(super) const MAX_COUNT: usize = (u32::MAX / 4) as usize;

/// Triangles over shared vertices.
///
/// Counter-clockwise corners seen from outside, in the right-handed modelling space (x right, y up, z
/// towards the viewer). The per-corner tables are either empty or as long as `triangles`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Positions.
    pub vertices: Vec<DVec3>,
    /// Corners of each triangle, indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
    /// Unit normals of the exact surface (or of the file) at the corners.
    pub corner_normals: Vec<[DVec3; 3]>,
    /// Surface parameters (or texture coordinates) of the corners.
    pub corner_parameters: Vec<[DVec2; 3]>,
    /// The surface that each triangle approximates, an index into the surfaces of the object.
    pub surfaces: Vec<u32>,
}

impl Mesh {
    /// The positions of the corners of triangle `triangle`.
    ///
    /// # Panics
    /// If the triangle or one of its vertices does not exist; [`Mesh::validate`] excludes the latter.
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        let [a, b, c] = self.triangles[triangle];
        [self.vertices[a as usize], self.vertices[b as usize], self.vertices[c as usize]]
    }
}
