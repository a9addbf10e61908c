//! Shapes in their own coordinates, and their triangles.

use super::composite::{Composite, MAX_NESTING};
use crate::mesh::{self, Mesh, MeshError};
use crate::solid::SolidError;
use crate::surface::{self, Sphere, TessellationError, Tolerance, box_faces, chord_error, ground, tessellate};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Largest turn of the normal from vertex to vertex, degrees: beyond it, interpolated normals are no longer those of the
/// surface, however loose the tolerance.
const LARGEST_TURN_DEGREES: f64 = 45.0;
/// Steps along the sides of a triangle at which its distance to the exact surface is measured.
const MEASURED_STEPS: usize = 6;

/// Why a shape has no triangles.
#[derive(Debug, thiserror::Error)]
pub enum ShapeError {
    /// The mesh cannot be read.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The surface cannot be approximated to the tolerance.
    #[error(transparent)]
    Tessellation(#[from] TessellationError),
    /// The surface encloses nothing.
    #[error("{object} bounds no solid: {source}")]
    Solid {
        /// Name of the object.
        object: String,
        /// Why.
        source: SolidError,
    },
}

/// The form of an object in its own coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// The Utah teapot, standing on y = 0, its spout towards +x.
    Teapot,
    /// The Stanford bunny, about 2 high.
    Bunny,
    /// A sphere around the origin.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A box around the origin.
    Box {
        /// Its sides along x, y and z.
        size: DVec3,
    },
    /// A square in the plane y = 0 around the origin, seen from above.
    Ground {
        /// Its side.
        size: f64,
    },
    /// A mesh from an OBJ, STL or PLY file.
    Mesh {
        /// The file.
        path: PathBuf,
    },
    /// A solid made of other objects.
    Composite(Box<Composite>),
}

impl Shape {
    /// The word for the kind.
    pub fn word(&self) -> &'static str {
        match self {
            Shape::Teapot => "teapot",
            Shape::Bunny => "bunny",
            Shape::Sphere { .. } => "sphere",
            Shape::Box { .. } => "box",
            Shape::Ground { .. } => "ground",
            Shape::Mesh { .. } => "mesh",
            Shape::Composite(composite) => composite.operation.word(),
        }
    }

    /// Checks the measures; the problem in words.
    pub(super) fn check(&self) -> Result<(), String> {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        match self {
            Shape::Teapot | Shape::Bunny | Shape::Mesh { .. } => Ok(()),
            Shape::Sphere { radius } if positive(*radius) => Ok(()),
            Shape::Sphere { radius } => Err(format!("radius {radius} is not a length above 0")),
            Shape::Box { size } if positive(size.x) && positive(size.y) && positive(size.z) => Ok(()),
            Shape::Box { size } => Err(format!("size {size} has a side that is not a length above 0")),
            Shape::Ground { size } if positive(*size) => Ok(()),
            Shape::Ground { size } => Err(format!("size {size} is not a length above 0")),
            Shape::Composite(composite) if composite.nesting > MAX_NESTING => {
                Err(format!("solids are nested more than {MAX_NESTING} deep"))
            }
            Shape::Composite(composite) => {
                composite.operands.iter().try_for_each(|o| o.check().map_err(|error| error.to_string()))
            }
        }
    }

    /// Whether it is tessellated from a curved surface that is known exactly.
    pub fn is_exact_and_curved(&self) -> bool {
        match self {
            Shape::Composite(composite) => composite.operands.iter().any(|o| o.shape.is_exact_and_curved()),
            _ => matches!(self, Shape::Teapot | Shape::Sphere { .. }),
        }
    }

    /// Triangles within `chord` of the shape, in own coordinates.
    ///
    /// # Errors
    /// [`ShapeError`] if the file cannot be read, or the tolerance asks for too many triangles.
    pub fn mesh(&self, chord: f64) -> Result<Mesh, ShapeError> {
        let tolerance = Tolerance::new(chord, LARGEST_TURN_DEGREES);
        match self {
            Shape::Composite(composite) => composite.mesh(chord),
            Shape::Bunny => Ok(mesh::bunny()),
            Shape::Mesh { path } => Ok(mesh::read(path)?),
            Shape::Teapot => Ok(tessellate(&surface::teapot(), tolerance)?),
            Shape::Sphere { radius } => Ok(tessellate(&[Sphere::new(DVec3::ZERO, *radius)], tolerance)?),
            Shape::Box { size } => Ok(tessellate(&box_faces(*size * -0.5, *size * 0.5), tolerance)?),
            Shape::Ground { size } => Ok(tessellate(&[ground(DVec3::ZERO, *size)], tolerance)?),
        }
    }

    /// Largest measured distance between `mesh`, made by [`Shape::mesh`], and the exact surface, in own coordinates.
    ///
    /// 0 for shapes that have no exact surface or are flat.
    pub(super) fn chord_error(&self, mesh: &Mesh) -> Result<f64, ShapeError> {
        let accuracy = match self {
            Shape::Teapot => chord_error(mesh, &surface::teapot(), MEASURED_STEPS)?,
            Shape::Sphere { radius } => chord_error(mesh, &[Sphere::new(DVec3::ZERO, *radius)], MEASURED_STEPS)?,
            // Composites ask their operands.
            Shape::Box { .. } | Shape::Ground { .. } | Shape::Bunny | Shape::Mesh { .. } | Shape::Composite(_) => {
                return Ok(0.0);
            }
        };
        Ok(accuracy.maximum)
    }
}
