//! Smooth surfaces of arbitrary topology, by recursive corner cutting of a polyhedron ("cutting and grinding").
//!
//! Each step cuts every corner and every edge: each face, each edge and each vertex gives way to a new face. All
//! new positions are averages of old ones, so that the surface stays within the convex hull of each face's
//! neighbourhood, and a change stays near its place. On regular parts (four corners a face, four faces a vertex) the
//! limit is the biquadratic B-spline; elsewhere its tangent planes are still continuous.
//!
//! Borders are quadratic B-spline curves of the border polygons, with their ends where a vertex has one face only.
//! Edges that are sharp for ever are creases: curves of the same kind, at which both sides end as at a border. Where
//! more than two creases and borders meet, and at sharp vertices, the surface has a corner.
//!
//! Edges of finite sharpness s are creases for so many steps. Each step divides what lies beside them by two, so that
//! the rounding that comes in the end is 2^-s as wide. A fraction of s holds the rounding by that much in the first
//! smooth step: between flat faces the distance of the surface from the edge falls with s without jumps, by 2^-s. What
//! lies farther off jumps a little at whole numbers, since there faces are divided.
//!
//! # Source
//! Doo and Sabin 1978; semi-sharp creases by steps after DeRose, Kass and Truong 1998; the rules at creases are ours.

mod error;
mod polyhedron;
mod rings;
mod weights;
mod smooth;
mod creases;
mod limit;
mod face_cuts;
mod sharp;
mod adaptive;

pub use error::SubdivisionError;
pub use polyhedron::Polyhedron;

use std::borrow::Cow;

use crate::mesh::Mesh;
use crate::octree::hausdorff;
use polyhedron::MOST_CORNERS;

/// So many times finer are the triangles between points with which others are measured.
const FINER: f64 = 8.0;

impl Polyhedron {
    /// The polyhedron after so many steps.
    ///
    /// A step makes four corners of one. Vertex h of the result of one step is what corner h becomes, as long as
    /// nothing is sharp and there is no border.
    ///
    /// # Errors
    /// A result of more than 2^28 corners, or faces that touch each other twice at a crease.
    pub fn subdivided(&self, steps: usize) -> Result<Polyhedron, SubdivisionError> {
        let growth = u32::try_from(steps).ok().and_then(|steps| 4_usize.checked_pow(steps)).unwrap_or(usize::MAX);
        let corners = self.corners.len().saturating_mul(growth);
        if corners > MOST_CORNERS {
            return Err(SubdivisionError::TooLarge { corners });
        }
        let mut result = self.clone();
        for _ in 0..steps {
            result = if result.is_smooth() { smooth::refined(&result) } else { sharp::refined(&result)? };
        }
        Ok(result)
    }

    /// Triangles between points of the limit surface, with its normals at their corners.
    ///
    /// The vertices are the limit points of the faces, exact but for rounding; there are triangles for each vertex of
    /// the polyhedron. Normals differ between the triangles at a crease. Finite sharpness is used up first, by as many
    /// steps as it lasts.
    ///
    /// # Errors
    /// A result of more than 2^28 corners, or faces that touch each other twice at a crease.
    pub fn limit(&self) -> Result<Mesh, SubdivisionError> {
        let lasting = self.lasting()?;
        Ok(limit::mesh(&lasting))
    }

    /// Triangles of the limit surface that are small only where it is curved, with its normals at their corners.
    ///
    /// All vertices lie on the limit surface, and there are no cracks. Faces that several creases or borders hold
    /// apart, such as a strip one face wide or a flat cap, are not divided, but follow the curves around them. Surfaces
    /// of the mesh are the patches that one step leaves around each vertex; parameters are places in a regular polygon.
    ///
    /// - `tolerance`: how far the middle of a triangle or side may be from the surface, in units of the positions.
    ///
    /// # Errors
    /// A tolerance that is not positive, or so small that more than two million patches do not meet it; else as
    /// [`Polyhedron::subdivided`].
    pub fn tessellated(&self, tolerance: f64) -> Result<Mesh, SubdivisionError> {
        if tolerance.is_nan() || tolerance <= 0.0 {
            return Err(SubdivisionError::Tolerance { tolerance });
        }
        adaptive::mesh(&self.lasting()?.subdivided(1)?, tolerance)
    }

    /// How far the limit surface and triangles that stand for it are from each other: the Hausdorff distance, in units
    /// of the positions, as far as vertices and middles of triangles tell.
    ///
    /// The triangles for an eighth of the tolerance stand for the surface; their vertices lie on it.
    ///
    /// - `mesh`: the triangles.
    /// - `tolerance`: for which they were made.
    ///
    /// # Errors
    /// A tolerance that is not positive, or so small that more than two million patches do not meet a part of it; a result of
    /// more than 2^28 corners.
    pub fn distance(&self, mesh: &Mesh, tolerance: f64) -> Result<f64, SubdivisionError> {
        Ok(hausdorff(&self.tessellated(tolerance / FINER)?, mesh, usize::MAX))
    }

    /// The polyhedron after as many steps as its finite sharpness lasts.
    fn lasting(&self) -> Result<Cow<'_, Polyhedron>, SubdivisionError> {
        let all = self.edge_sharpness.iter().chain(&self.vertex_sharpness);
        let longest = all.copied().filter(|sharpness| sharpness.is_finite()).fold(0.0, f64::max);
        if longest == 0.0 {
            return Ok(Cow::Borrowed(self));
        }
        self.subdivided(longest.ceil().min(f64::from(u16::MAX)) as usize).map(Cow::Owned)
    }
}

#[cfg(test)]
mod tests;
