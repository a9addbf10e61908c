//! Edges of polyhedral solids, rounded by corner cutting.
//!
//! Every face beside a rounded edge is divided by a strip along it, and what then has corners there is cut again
//! and again; all other edges stay sharp. The limit is a quadratic B-spline across each edge.
//!
//! # Shape
//! Where an edge turns by the angle t (the interior angle is pi - t), the rounding begins at the distance d = r tan(t /
//! 2) from the edge on either face: where a ball of the radius r that rolls along it would touch. With x and y the
//! distances from the edge along the faces, the section is the parabola sqrt(x / d) + sqrt(y / d) = 1. It takes d^2
//! sin(t) / 6 off the section of the solid, or adds it where the solid is hollow; a ball takes r^2 (tan(t / 2) - t /
//! 2). At its middle the radius of curvature is d cos(t / 2)^2 / sin(t / 2), which is r cos(t / 2).
//!
//! Near the ends of the edge, within 2 d of a corner where several rounded edges meet, the surface is that of the
//! cutting scheme: smooth, and tangent to the faces. An edge that stays sharp between two that are rounded fades out.
//!
//! # Limits
//! A strip is twice as wide as its half of the rounding, so that a face must be wider than 4 d between two rounded
//! edges.
//!
//! # Source
//! Quadratic B-splines as limits of corner cutting: Chaikin 1974, Riesenfeld 1975; faces of any number of sides: Doo
//! and Sabin 1978. The strips are ours.

mod error;
mod faces;
mod net;
mod surfaces;

pub use error::RoundingError;

use faces::{PolygonFaces, to_segment};
use glam::DVec3;
use net::RoundingNet;
use std::collections::HashMap;

use super::ExactSolid;
use crate::mesh::Mesh;
use crate::subdivision::Polyhedron;

/// The most that an edge may turn, degrees: at 180 a face would lie on the other.
const SHARPEST: f64 = 179.0;
/// Vertices are one if they are no farther apart than about this part of the size.
const FOLD: f64 = 1.0 / (1_u64 << 44) as f64;

/// The edges of a solid that are to be rounded.
#[derive(Clone, Debug, PartialEq)]
pub enum EdgeChoice {
    /// All.
    All,
    /// For each of these points the edge that is nearest to it.
    Nearest(Vec<DVec3>),
}

impl ExactSolid {
    /// The solid with some edges rounded. Faces keep their surfaces; each rounded edge has a new one behind those,
    /// without an exact form.
    ///
    /// - `radius`: of the ball that would touch the faces where the rounding begins, model units.
    /// - `tolerance`: how far the triangles may be from the rounded surface, model units.
    ///
    /// # Errors
    /// [`RoundingError`] if an edge is not between flat faces, or the rounding has no place.
    pub fn rounded(&self, choice: &EdgeChoice, radius: f64, tolerance: f64) -> Result<ExactSolid, RoundingError> {
        let (polyhedron, faces, chosen) = self.net(choice, radius)?;
        let mut mesh = without_folds(polyhedron.tessellated(tolerance)?);
        let surfaces = surfaces::assign(&mut mesh, self, &faces, &chosen);
        Ok(ExactSolid::new(mesh, surfaces)?)
    }

    /// How far triangles that stand for the solid with some edges rounded are from that: the Hausdorff distance, model
    /// units, as [`Polyhedron::distance`] measures it.
    ///
    /// - `mesh`: the triangles, as [`ExactSolid::rounded`] made them for the choice, the radius and the tolerance.
    ///
    /// # Errors
    /// [`RoundingError`] if an edge is not between flat faces, or the rounding has no place.
    pub fn distance_of_rounded(
        &self,
        mesh: &Mesh,
        choice: &EdgeChoice,
        radius: f64,
        tolerance: f64,
    ) -> Result<f64, RoundingError> {
        let (polyhedron, ..) = self.net(choice, radius)?;
        Ok(polyhedron.distance(mesh, tolerance)?)
    }

    /// The polyhedron whose limit is the solid with some edges rounded, the faces, and the chosen edges.
    fn net(&self, choice: &EdgeChoice, radius: f64) -> Result<(Polyhedron, PolygonFaces, Vec<usize>), RoundingError> {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(RoundingError::Radius { radius });
        }
        let mesh = self.solid().mesh();
        let faces = PolygonFaces::of(mesh)?;
        let points = &mesh.vertices;
        let ends = |edge: usize| faces.edges[edge].ends.map(|vertex| points[vertex as usize]);
        let mut chosen: Vec<usize> = match choice {
            EdgeChoice::All => (0..faces.edges.len()).collect(),
            EdgeChoice::Nearest(near) => {
                let distance = |edge: &usize, at: DVec3| to_segment(ends(*edge), at);
                let nearest =
                    |at: &DVec3| (0..faces.edges.len()).min_by(|a, b| distance(a, *at).total_cmp(&distance(b, *at)));
                near.iter().map(nearest).collect::<Option<_>>().ok_or(RoundingError::NoEdges)?
            }
        };
        if chosen.is_empty() {
            return Err(RoundingError::NoEdges);
        }
        chosen.sort_unstable();
        chosen.dedup();
        let mut setbacks = vec![None; faces.edges.len()];
        for &edge in &chosen {
            let [from, to] = ends(edge);
            if faces.edges[edge].faces.iter().any(|face| faces.faces[*face].is_curved) {
                return Err(RoundingError::Curved { from, to });
            }
            let turn = faces.dihedral_turn(edge, points).abs();
            if turn.to_degrees() > SHARPEST {
                return Err(RoundingError::Sharp { from, to, degrees: turn.to_degrees() });
            }
            setbacks[edge] = Some(radius * (0.5 * turn).tan());
        }
        Ok((RoundingNet::polyhedron(&faces, points, &setbacks, radius)?, faces, chosen))
    }
}

/// A closed mesh without triangles that lie on each other, back to back.
///
/// Faces between sharp edges shrink at each step of the cutting, at last to lines; vertices that are no farther apart
/// than [`FOLD`] of the size become one.
fn without_folds(mut mesh: Mesh) -> Mesh {
    let size = mesh.bounds().map_or(1.0, |bounds| bounds.diagonal());
    let mut first: HashMap<[i64; 3], u32> = HashMap::new();
    let place = |(vertex, point): (u32, &DVec3)| {
        let key = (*point / (size * FOLD)).round().to_array().map(|x| x as i64);
        *first.entry(key).or_insert(vertex)
    };
    let same: Vec<u32> = (0..).zip(&mesh.vertices).map(place).collect();
    mesh.triangles.iter_mut().for_each(|corners| *corners = corners.map(|vertex| same[vertex as usize]));
    let from_lowest = |[a, b, c]: [u32; 3]| {
        if a < b && a < c {
            [a, b, c]
        } else if b < c {
            [b, c, a]
        } else {
            [c, a, b]
        }
    };
    let mut is_kept = vec![true; mesh.triangles.len()];
    let mut open: HashMap<[u32; 3], usize> = HashMap::new();
    for (t, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        if a == b || b == c || c == a {
            is_kept[t] = false;
        } else if let Some(back) = open.remove(&from_lowest([a, c, b])) {
            (is_kept[t], is_kept[back]) = (false, false);
        } else {
            open.insert(from_lowest([a, b, c]), t);
        }
    }
    let mut kept = is_kept.iter().copied();
    mesh.triangles.retain(|_| kept.next().unwrap_or(true));
    let mut kept = is_kept.iter().copied();
    mesh.corner_normals.retain(|_| kept.next().unwrap_or(true));
    mesh
}

#[cfg(test)]
mod tests;
