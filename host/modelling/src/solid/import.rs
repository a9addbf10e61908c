//! From meshes to solids: what must hold is checked, what does no harm is repaired.

use super::boolean::{Lattice, Resolution, resolve};
use super::cleaning::{check_edges, dissolve, without_collapsed};
use super::self_intersection::overlaps;
use super::shells::{Shells, certain_volume};
use super::{Solid, SolidError};
use crate::mesh::Mesh;

impl Solid {
    /// Takes a mesh; vertices at the same place become one, and triangles without an area are dissolved.
    ///
    /// # Errors
    /// [`SolidError`], which names the places, if the mesh is not closed, is not consistently oriented, faces inwards,
    /// or crosses itself.
    pub fn new(mesh: Mesh) -> Result<Solid, SolidError> {
        let (solid, crossing) = Solid::resolved(mesh)?;
        crossing.map_or(Ok(solid), Err)
    }

    /// Takes a mesh whose surface may cross itself: the solid is all points where its winding number is positive. Gives
    /// the error too that [`Solid::new`] would have given.
    ///
    /// # Errors
    /// [`SolidError`] as for [`Solid::new`], but for crossings.
    pub fn resolved(mesh: Mesh) -> Result<(Solid, Option<SolidError>), SolidError> {
        imported(mesh)
    }
}

/// Does something with a mesh whose coordinates predicates can be exact with, and brings back what comes of it.
pub fn on_lattice<T>(
    mut mesh: Mesh,
    make: impl FnOnce(Mesh) -> Result<(Solid, T), SolidError>,
    bring_back: impl FnOnce(T, &Lattice) -> T,
) -> Result<(Solid, T), SolidError> {
    mesh.validate()?;
    let Some(lattice) = Lattice::of(std::iter::once(&mesh)) else { return make(mesh) };
    lattice.lay(&mut mesh);
    let (mut solid, rest) = make(mesh).map_err(|error| error.brought_back(&lattice))?;
    lattice.bring_back(&mut solid.mesh);
    Ok((Solid::of(solid.mesh), bring_back(rest, &lattice)))
}

/// Checks and cleans a mesh. Where its surface crosses itself, that of what it bounds is given, and the error.
///
/// Coordinates below 2^-203 of the largest are rounded to 2^-256 of that.
pub fn imported(mesh: Mesh) -> Result<(Solid, Option<SolidError>), SolidError> {
    on_lattice(mesh, imported_on_lattice, |crossing, lattice| Some(crossing?.brought_back(lattice)))
}

/// Checks and cleans a mesh that is on a lattice, as [`imported`] does.
pub fn imported_on_lattice(mesh: Mesh) -> Result<(Solid, Option<SolidError>), SolidError> {
    let is_empty = mesh.triangles.is_empty();
    let mut mesh = without_collapsed(mesh);
    let sheets = check_edges(&mesh)?;
    dissolve(&mut mesh);
    let is_turned = certain_volume(&mesh, 0..mesh.triangles.len()) < 0.0;
    let solid = Solid::of(mesh);
    if is_turned && let Some(error) = inside_out(&solid) {
        return Err(error);
    }
    let overlaps = overlaps(solid.mesh(), solid.sorted())?;
    if overlaps.is_empty() && sheets == 1 {
        return Ok((solid, None));
    }
    let Resolution { outcome, is_same, improper_winding: odd } = resolve(solid.mesh(), &overlaps)?;
    if let Some((..0, _)) = odd
        && let Some(error) = inside_out(&solid)
    {
        return Err(error);
    }
    if outcome.mesh.triangles.is_empty() && !is_empty {
        return Err(SolidError::BoundsNothing);
    }
    let crossing = odd.map(|(winding, near)| SolidError::Crossing { winding, near, overlaps: overlaps.len() });
    Ok((if is_same { solid } else { Solid::of(outcome.mesh) }, crossing))
}

/// The error of a solid of which shells face inwards, if some do.
fn inside_out(solid: &Solid) -> Option<SolidError> {
    let mesh = solid.mesh();
    let bodies = Shells::of(mesh);
    let turned = bodies.inside_out(mesh, solid.sorted());
    let largest = turned.iter().copied().min_by(|&one, &two| bodies.volume(one).total_cmp(&bodies.volume(two)))?;
    let near = mesh.corners(bodies.triangles(largest)[0] as usize)[0];
    let volume = bodies.volume(largest);
    Some(SolidError::InsideOut { bodies: turned.len(), of: bodies.count(), volume, near })
}
