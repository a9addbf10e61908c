//! What can be wrong with a polyhedron, and where.

/// A fault that keeps a polyhedron from being made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SubdivisionError {
    /// A position is not finite, or so far out that its square would not be.
    #[error("vertex {vertex} is not finite, or farther out than 1e150")]
    NotFinite {
        /// The vertex, from 0.
        vertex: usize,
    },
    /// A face with fewer than three corners.
    #[error("face {face} has {corners} corners; it needs three")]
    TooFewCorners {
        /// The face, from 0.
        face: usize,
        /// How many corners it has.
        corners: usize,
    },
    /// A face names a vertex that does not exist.
    #[error("face {face} names vertex {vertex}, but there are only {vertices}")]
    NoSuchVertex {
        /// The face, from 0.
        face: usize,
        /// The vertex that it names.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A side of a face that begins and ends at one vertex.
    #[error("face {face} names vertex {vertex} twice in a row")]
    RepeatedVertex {
        /// The face, from 0.
        face: usize,
        /// The vertex.
        vertex: u32,
    },
    /// An edge of more than two faces.
    #[error("the edge from vertex {} to vertex {} belongs to {count} faces, among them {} and {}", ends[0], ends[1], faces[0], faces[1])]
    CrowdedEdge {
        /// Its ends, the lower vertex first.
        ends: [u32; 2],
        /// How many faces.
        count: usize,
        /// Two of them.
        faces: [usize; 2],
    },
    /// Two faces that run the same way along their common edge.
    #[error("faces {} and {} run the same way from vertex {} to vertex {}", faces[0], faces[1], ends[0], ends[1])]
    Orientation {
        /// The ends of the edge, the lower vertex first.
        ends: [u32; 2],
        /// The two faces.
        faces: [usize; 2],
    },
    /// A vertex that does not exist.
    #[error("there is no vertex {vertex}, only {vertices}")]
    Unknown {
        /// The vertex, from 0.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// Two vertices that no face joins by a side.
    #[error("there is no edge from vertex {} to vertex {}", ends[0], ends[1])]
    NoSuchEdge {
        /// The two vertices.
        ends: [u32; 2],
    },
    /// A sharpness below zero or not a number.
    #[error("a sharpness of {sharpness} is neither zero nor positive")]
    Sharpness {
        /// What was given.
        sharpness: f64,
    },
    /// More corners than indices of 32 bits can tell apart.
    #[error("{corners} corners of faces are too many")]
    TooLarge {
        /// How many there are or would be.
        corners: usize,
    },
    /// A tolerance that is not positive.
    #[error("a tolerance of {tolerance} is not positive")]
    Tolerance {
        /// What was given.
        tolerance: f64,
    },
}
