//! Solids from meshes that are none.
//!
//! What is a solid already is not touched. Of any other mesh, vertices at one place become one, at boundaries also
//! those that are apart by rounding only; triangles that keep the surface from being closed are left out; triangles are
//! reversed to agree with their neighbours; boundary loops are closed where a patch is found that provably meets
//! nothing; shells that face inwards and lie in no other are reversed; and what crosses itself is divided there, and
//! what is not its border left out. Each step does nothing to what needs nothing.

mod closing;
mod joining;
mod orientation;
mod patches;
mod surplus;

use super::cleaning::{check_edges, without_collapsed};
use super::import::{imported_on_lattice, on_lattice};
use super::shells::Shells;
use super::{Solid, SolidError};
use crate::mesh::{BoundaryLoop, Mesh};
use crate::octree::TriangleBvh;
use joining::join_near;
use orientation::{turn, turn_alike};
use serde::Serialize;
use std::fmt;
use surplus::{remove_dangling, remove_duplicates};

/// What was done to a mesh to make it a solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Repair {
    /// Triangles left out because corners of them coincide.
    pub collapsed: usize,
    /// Vertices at boundaries joined with others that are the same but for roundings to single precision.
    pub joined: usize,
    /// Triangles left out because another has the same corners and the surface was not closed there.
    pub duplicates: usize,
    /// Triangles of dangling faces left out: walls within a body, or open sheets that stick out of one.
    #[serde(rename = "fins")]
    pub dangling: usize,
    /// Triangles reversed to agree with their neighbours.
    #[serde(rename = "turned")]
    pub reoriented: usize,
    /// Boundary loops closed.
    pub loops: usize,
    /// Triangles added to close them.
    pub added: usize,
    /// Shells reversed because they faced inwards.
    pub bodies: usize,
    /// Whether the surface was divided where it crossed itself, and what is not its border left out.
    pub is_resolved: bool,
}

impl Repair {
    /// Whether nothing was done: the mesh was a solid already.
    pub fn is_nothing(&self) -> bool {
        *self == Repair::default()
    }
}

/// What was done, in words.
impl fmt::Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let s = |count: usize| if count == 1 { "" } else { "s" };
        let Repair {
            joined,
            collapsed,
            duplicates,
            dangling: fins,
            reoriented: turned,
            loops,
            added,
            bodies,
            is_resolved,
        } = *self;
        let (vertices, triangles) = (if joined == 1 { "vertex" } else { "vertices" }, s(collapsed));
        let done = [
            (joined, format!("{joined} {vertices} joined at boundaries that were apart by rounding")),
            (collapsed, format!("{collapsed} collapsed triangle{triangles} left out")),
            (duplicates, format!("{duplicates} double triangle{} left out", s(duplicates))),
            (fins, format!("{fins} triangle{} of dangling faces left out", s(fins))),
            (turned, format!("{turned} triangle{} reversed to agree with their neighbours", s(turned))),
            (loops, format!("{loops} boundary loop{} closed with {added} triangle{}", s(loops), s(added))),
            (bodies, format!("{bodies} shell{} turned outwards", if bodies == 1 { "" } else { "s" })),
            (usize::from(is_resolved), "divided where it crossed itself".to_owned()),
        ];
        let done: Vec<String> = done.into_iter().filter(|(count, _)| *count > 0).map(|(_, words)| words).collect();
        f.write_str(if done.is_empty() { "nothing" } else { "" })?;
        f.write_str(&done.join(", "))
    }
}

impl Solid {
    /// Makes a solid of a mesh: joins vertices at one place, leaves out double triangles and dangling faces, reverses
    /// triangles so that neighbours agree, closes boundary loops where a patch meets nothing else, reverses shells that
    /// face inwards and lie in no other, and makes the surface simple. A mesh that is a solid already is taken as it
    /// is.
    ///
    /// Cost: n log n in the triangles, linear in the places where three of them cross, k^3 in the edges of a loop up to
    /// a limit.
    ///
    /// # Errors
    /// [`SolidError`] if numbers are wrong, or the mesh is not closed even then: a loop that no patch closes without
    /// meeting the surface, a surface with one side only, or one that bounds nothing.
    pub fn repaired(mesh: Mesh) -> Result<(Solid, Repair), SolidError> {
        match Solid::new(mesh.clone()) {
            Ok(solid) => Ok((solid, Repair::default())),
            Err(problem) => Solid::repaired_of(mesh, &problem),
        }
    }

    /// Makes a solid of a mesh that is none, as [`Solid::repaired`] does.
    ///
    /// - `problem`: what [`Solid::new`] says of the mesh.
    ///
    /// # Errors
    /// [`SolidError`] if numbers are wrong, or the mesh is not closed even after repair.
    pub fn repaired_of(mesh: Mesh, problem: &SolidError) -> Result<(Solid, Repair), SolidError> {
        let is_two_sided = match problem {
            // Nothing helps these.
            SolidError::Mesh(_) | SolidError::TooManyIntersections { .. } => return Err(problem.clone()),
            // Each triangle may be there twice, to be seen from both sides.
            SolidError::BoundsNothing => true,
            _ => false,
        };
        on_lattice(mesh, |mesh| repaired_on_lattice(mesh, is_two_sided), |repair, _| repair)
    }
}

/// Makes a solid of a mesh that is on a lattice and is none.
///
/// - `is_two_sided`: whether of triangles with the same corners one is enough, wherever they are.
fn repaired_on_lattice(mesh: Mesh, is_two_sided: bool) -> Result<(Solid, Repair), SolidError> {
    let mut repair = Repair::default();
    let before = mesh.triangles.len();
    let mut mesh = without_collapsed(mesh);
    if is_two_sided || check_edges(&mesh).is_err() {
        repair.joined = join_near(&mut mesh);
        mesh = without_collapsed(mesh);
    }
    repair.collapsed = before - mesh.triangles.len();
    if is_two_sided || check_edges(&mesh).is_err() {
        repair.duplicates = remove_duplicates(&mut mesh, is_two_sided);
        repair.reoriented = turn_alike(&mut mesh);
        repair.dangling = remove_dangling(&mut mesh);
        refuse_one_sided(&mesh)?;
        let closed = closing::close(&mut mesh);
        (repair.loops, repair.added) = (closed.loops, closed.triangles);
        if !closed.open.is_empty() {
            return Err(SolidError::Open { loops: closed.open });
        }
    }
    repair.bodies = turn_bodies(&mut mesh);
    let (solid, crossing) = imported_on_lattice(mesh)?;
    repair.is_resolved = crossing.is_some();
    Ok((solid, repair))
}

/// The boundary loops that a mesh has once its triangles agree with their neighbours.
pub fn boundary(mesh: &Mesh) -> Vec<BoundaryLoop> {
    let mut mesh = without_collapsed(mesh.clone());
    turn_alike(&mut mesh);
    mesh.boundary_loops()
}

/// Reverses shells that face inwards and lie in no other, all of them if the whole does; returns how many were
/// reversed.
fn turn_bodies(mesh: &mut Mesh) -> usize {
    let mut bodies = Shells::of(mesh);
    let is_inside_out = (0..bodies.count()).map(|body| bodies.volume(body)).sum::<f64>() < 0.0;
    if is_inside_out {
        (0..mesh.triangles.len()).for_each(|triangle| turn(mesh, triangle));
        bodies = Shells::of(mesh);
    }
    let mut is_turned = vec![is_inside_out; bodies.count()];
    let sorted = TriangleBvh::new(&mesh.vertices, &mesh.triangles);
    for body in bodies.inside_out(mesh, &sorted) {
        is_turned[body] ^= true;
        bodies.triangles(body).iter().for_each(|&triangle| turn(mesh, triangle as usize));
    }
    is_turned.iter().filter(|turned| **turned).count()
}

/// An error where two triangles with an edge in common cannot agree, as in a strip with one side only.
fn refuse_one_sided(mesh: &Mesh) -> Result<(), SolidError> {
    if mesh.edge_report().misoriented > 0 { check_edges(mesh).map(|_| ()) } else { Ok(()) }
}

#[cfg(test)]
mod tests;
