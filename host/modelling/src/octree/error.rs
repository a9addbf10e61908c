//! Errors of building an octree.

use glam::DVec3;

use crate::numeric::triangle::MAX_MAGNITUDE;

/// Most triangles that one octree takes.
pub const MAX_TRIANGLES: usize = 1 << 28;

/// A reason for which an octree cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OctreeError {
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} is not finite")]
    NonFiniteVertex {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A coordinate is beyond [`MAX_MAGNITUDE`].
    #[error("vertex {vertex} is farther than {MAX_MAGNITUDE:e} from the origin")]
    VertexTooFar {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {index}, but there are only {vertices}")]
    IndexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex that it names.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A coordinate is outside the modelling cube, which was given.
    #[error("vertex {vertex} is outside the modelling cube")]
    VertexOutside {
        /// Index of the vertex.
        vertex: usize,
    },
    /// More triangles than [`MAX_TRIANGLES`].
    #[error("{triangles} triangles are more than the {MAX_TRIANGLES} that one octree takes")]
    TooManyTriangles {
        /// Number of triangles.
        triangles: usize,
    },
}

/// Says what an octree does not take of some vertices and triangles.
pub(super) fn check(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), OctreeError> {
    if let Some(vertex) = vertices.iter().position(|p| !p.is_finite()) {
        return Err(OctreeError::NonFiniteVertex { vertex });
    }
    if let Some(vertex) = vertices.iter().position(|p| p.abs().max_element() > MAX_MAGNITUDE) {
        return Err(OctreeError::VertexTooFar { vertex });
    }
    if triangles.len() > MAX_TRIANGLES {
        return Err(OctreeError::TooManyTriangles { triangles: triangles.len() });
    }
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&index) = corners.iter().find(|&&i| i as usize >= vertices.len()) {
            return Err(OctreeError::IndexOutOfRange { triangle, index, vertices: vertices.len() });
        }
    }
    Ok(())
}
