//! Triangle meshes, and what can be said of them without knowing their surfaces.

use glam::{DVec2, DVec3};

/// Triangles over shared vertices.
///
/// Counter-clockwise corners seen from outside, in the right-handed modelling space (x right, y up, z
/// towards the viewer). The per-corner tables are either empty or as long as `triangles`.
#[derive(Clone, Debug, Default, PartialEq)]
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
/// shim
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    /// shim
    #[error("shim")]
    Shim,
}
impl Mesh {
    /// shim
    pub fn read(_: &std::path::Path) -> Result<Mesh, MeshError> {
        Err(MeshError::Shim)
    }
    /// shim
    pub fn write(&self, _: &std::path::Path) -> Result<(), MeshError> {
        Err(MeshError::Shim)
    }
}
