//! What can be wrong with a scene.

use super::sculpture::SculptureError;
use crate::database::DatabaseError;
use crate::memory::MemoryExceeded;
use crate::mesh::{MeshError, NoBunny};
use crate::octree::{InstanceError, OctreeError};
use crate::procedural::terrain::TerrainError;
use crate::solid::{PrimitiveError, RoundingError, SolidError};
use crate::subdivision::SubdivisionError;
use crate::surface::TessellationError;
use std::path::PathBuf;

/// What is wrong with a scene, and with which part of it.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// An object has an impossible value.
    #[error("{object}: {problem}")]
    Object {
        /// The object's name.
        object: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A light has an impossible value.
    #[error("light {number}: {problem}")]
    Light {
        /// The number of the light, counted from 1.
        number: usize,
        /// What is wrong with it.
        problem: String,
    },
    /// The camera cannot see.
    #[error("camera: {0}")]
    Camera(String),
    /// A setting of the whole scene is impossible.
    #[error("{0}")]
    Setting(String),
    /// More of something than PERIS takes.
    #[error("more than {limit} {what}")]
    Limit {
        /// Of what.
        what: &'static str,
        /// How many are allowed.
        limit: u64,
    },
    /// The triangles of an object cannot be made or read.
    #[error("{object}: {source}")]
    Shape {
        /// The object's name.
        object: String,
        /// What is wrong with the shape.
        source: Box<ShapeError>,
    },
    /// An object is wrong that a script asks for at some position.
    #[error("{location}: {source}")]
    Placed {
        /// File, line and column of the script.
        location: String,
        /// What is wrong.
        source: Box<SceneError>,
    },
}

/// A fault that keeps a shape from having triangles.
#[derive(Debug, thiserror::Error)]
pub enum ShapeError {
    /// The mesh cannot be read.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The Stanford bunny was left out of the program.
    #[error(transparent)]
    NoBunny(#[from] NoBunny),
    /// The octree cannot be read.
    #[error("{}: {problem}", path.display())]
    Octree {
        /// The file.
        path: PathBuf,
        /// What is wrong, in words.
        problem: String,
    },
    /// The geometry cannot be had from its database.
    #[error(transparent)]
    Database(#[from] DatabaseError),
    /// The surface cannot be approximated to the tolerance.
    #[error(transparent)]
    Tessellation(#[from] TessellationError),
    /// The sculptured surface cannot be made.
    #[error(transparent)]
    Sculpture(#[from] SculptureError),
    /// The polyhedron cannot be divided.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// There is no such terrain.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// There is no such solid.
    #[error(transparent)]
    Primitive(#[from] PrimitiveError),
    /// The surface encloses nothing.
    #[error("{object} bounds no solid: {source}")]
    Solid {
        /// Name of the object.
        object: String,
        /// What is wrong with the solid.
        source: SolidError,
    },
    /// There is no memory for all triangles.
    #[error(transparent)]
    Memory(#[from] MemoryExceeded),
    /// Its edges cannot be rounded.
    #[error("{object} cannot be rounded: {source}")]
    Rounding {
        /// Name of the object.
        object: String,
        /// What keeps the edges from being rounded.
        source: RoundingError,
    },
    /// A procedural model cannot make it.
    #[error("{0}")]
    Model(String),
    /// Cells for instances cannot lie on it.
    #[error("cells for instances lie on a ground that is not skewed, which {object} is not")]
    NoCells {
        /// Name of the object.
        object: String,
    },
}

/// A reason for which rays have no octree to go through.
#[derive(Debug, thiserror::Error)]
pub enum AccelerationError {
    /// There are too many triangles.
    #[error(transparent)]
    Octree(#[from] OctreeError),
    /// Instances cannot be placed.
    #[error(transparent)]
    Instances(#[from] InstanceError),
}
