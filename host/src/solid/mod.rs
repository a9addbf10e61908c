//! Solids: closed surfaces with an inside, and what can be done with them.

pub mod boolean;
mod error;
mod tangle;
mod bodies;
mod import;
mod mass;
mod repair;
mod exact;
mod glue;
mod body;
pub mod primitive;
mod rounded;

pub use body::{Body, Face, Measures};
pub use boolean::{Counts, Expression, Outcome};
pub use error::{OpenLoop, SolidError};
pub use exact::{ExactSolid, moved};
pub use glue::GlueError;
pub(crate) use import::retain;
pub use mass::Mass;
pub use primitive::{Primitive, PrimitiveError};
pub use repair::{Repair, boundary};
pub use rounded::{EdgeChoice, RoundingError};

use crate::mesh::Mesh;
use crate::octree::Sorted;
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// What a closed surface bounds.
///
/// Its mesh is closed and consistently oriented: every edge is run through as often one way as the other. No triangle
/// lacks an area. The surface is simple: it winds once around what is inside and not at all around what is outside. It may
/// touch itself, as where two cubes share an edge.
///
/// Results have rounded points. Where surfaces lie within a few roundings of each other, that could make a result cross
/// itself; it is then made simple again, for which points move by a few roundings more, or refused. An expression that is
/// given to [`Solid::evaluate`] as a whole is rounded only once.
///
/// Coordinates below 8e-62 of the largest, of one solid or of all operands of an operation, are rounded to 9e-78 of that.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    mesh: Mesh,
    /// Its triangles by place, once someone asked for them.
    sorted: OnceLock<Arc<Sorted>>,
    /// Those that make one face with another, once an operation asked for them.
    mates: OnceLock<Arc<Vec<u32>>>,
}

impl PartialEq for Solid {
    fn eq(&self, other: &Solid) -> bool {
        self.mesh == other.mesh
    }
}

impl Solid {
    /// A mesh that is known to be what a solid has.
    fn of(mesh: Mesh) -> Solid {
        Solid { mesh, sorted: OnceLock::new(), mates: OnceLock::new() }
    }

    /// Takes a mesh; vertices at the same place become one, and triangles without an area are dissolved.
    ///
    /// # Errors
    /// [`SolidError`], which names the places, if the mesh is not closed, is not consistently oriented, faces inwards, or
    /// crosses itself.
    pub fn new(mesh: Mesh) -> Result<Solid, SolidError> {
        let (solid, crossing) = Solid::resolved(mesh)?;
        crossing.map_or(Ok(solid), Err)
    }

    /// Takes a mesh whose surface may cross itself: the solid is all that it winds around more than not at all. Gives the
    /// error too that [`Solid::new`] would have given.
    ///
    /// # Errors
    /// [`SolidError`] as for [`Solid::new`], but for crossings.
    pub fn resolved(mesh: Mesh) -> Result<(Solid, Option<SolidError>), SolidError> {
        import::imported(mesh)
    }

    /// Its surface.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Its surface, for keeps.
    pub fn into_mesh(self) -> Mesh {
        self.mesh
    }

    /// Its triangles by place.
    pub fn sorted(&self) -> &Sorted {
        self.sorted.get_or_init(|| Arc::new(Sorted::new(&self.mesh.vertices, &self.mesh.triangles)))
    }

    fn operand(&self) -> boolean::Operand<'_> {
        let mates = self.mates.get_or_init(|| Arc::new(boolean::mates(&self.mesh)));
        boolean::Operand { mesh: &self.mesh, sorted: self.sorted(), mates, overlaps: &[] }
    }

    /// Evaluates an expression over some solids at once. The result may be empty.
    ///
    /// # Errors
    /// [`SolidError::Unsettled`] if the result crosses itself when it is rounded, and that could not be mended.
    pub fn evaluate(operands: &[&Solid], expression: &Expression) -> Result<(Solid, Outcome), SolidError> {
        // All on threads of the pool, so that this one does not wait for them at each step.
        let mut outcome = rayon::scope(|_| {
            let operands = operands.par_iter().map(|solid| solid.operand()).collect();
            boolean::evaluate(operands, expression)
        })?;
        let mesh = std::mem::take(&mut outcome.mesh);
        Ok((Solid::of(mesh), outcome))
    }

    /// What is in either.
    ///
    /// # Errors
    /// As of [`Solid::evaluate`].
    pub fn union(&self, other: &Solid) -> Result<Solid, SolidError> {
        self.with(other, Expression::Union)
    }

    /// What is in both.
    ///
    /// # Errors
    /// As of [`Solid::evaluate`].
    pub fn intersection(&self, other: &Solid) -> Result<Solid, SolidError> {
        self.with(other, Expression::Intersection)
    }

    /// What is in this one and not in the other.
    ///
    /// # Errors
    /// As of [`Solid::evaluate`].
    pub fn difference(&self, other: &Solid) -> Result<Solid, SolidError> {
        let expression = Expression::difference(Expression::Operand(0), Expression::Operand(1));
        Solid::evaluate(&[self, other], &expression).map(|(solid, _)| solid)
    }

    fn with(&self, other: &Solid, operation: fn(Vec<Expression>) -> Expression) -> Result<Solid, SolidError> {
        let both = vec![Expression::Operand(0), Expression::Operand(1)];
        Solid::evaluate(&[self, other], &operation(both)).map(|(solid, _)| solid)
    }
}

#[cfg(test)]
mod tests;
