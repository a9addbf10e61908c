//! Gluing solids at faces that they have in common.

use super::{ExactSolid, SolidError};
use crate::mesh::{Mesh, bits};
use glam::DVec3;
use robust::{Coord3D, orient3d};
use std::collections::HashMap;

/// A fault that keeps solids from being glued.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GlueError {
    /// No face of one lies on a face of the other.
    #[error("no face of one solid is a face of the other: their corners must be the same to the bit")]
    NoFace,
    /// The solids have more in common than faces.
    #[error("the solids overlap: they have the volume {volume} in common")]
    Overlap {
        /// The volume, cubic units.
        volume: f64,
    },
    /// What is left is no solid.
    #[error(transparent)]
    Solid(#[from] SolidError),
}

/// A side of a face: where it begins and where it ends.
type Side = [[u64; 3]; 2];

impl ExactSolid {
    /// Both solids in one, without the faces that they have in common. Nothing is divided and no point is made.
    ///
    /// A face is what lies in one plane and is connected; two are the same if their borders are.
    ///
    /// # Errors
    /// [`GlueError`] if there are no such faces or the solids overlap.
    pub fn glued(&self, other: &ExactSolid) -> Result<ExactSolid, GlueError> {
        let (one, two) = (self.solid().mesh(), other.solid().mesh());
        let (one_faces, two_faces) = (FlatFaces::of(one), FlatFaces::of(two));
        let borders: HashMap<&[Side], usize> = one_faces.borders.iter().map(Vec::as_slice).zip(0..).collect();
        let (mut one_goes, mut two_goes) = (vec![false; one_faces.borders.len()], vec![false; two_faces.borders.len()]);
        for (face, border) in two_faces.borders.iter().enumerate() {
            let mut turned: Vec<Side> = border.iter().map(|&[from, to]| [to, from]).collect();
            turned.sort_unstable();
            if let Some(&same) = borders.get(turned.as_slice()) {
                (one_goes[same], two_goes[face]) = (true, true);
            }
        }
        if !two_goes.contains(&true) {
            return Err(GlueError::NoFace);
        }
        let common = self.solid().intersection(other.solid())?;
        if !common.mesh().triangles.is_empty() {
            return Err(GlueError::Overlap { volume: common.mesh().signed_volume() });
        }
        let (mut mesh, mut surfaces) = (one_faces.without(one, &one_goes), self.surfaces().to_vec());
        mesh.append(&two_faces.without(two, &two_goes), surfaces.len() as u32);
        surfaces.extend(other.surfaces().iter().cloned());
        Ok(ExactSolid::new(mesh, surfaces)?)
    }
}

/// The flat faces of a mesh.
struct FlatFaces {
    /// The face of each triangle.
    of: Vec<usize>,
    /// The sides around each face, sorted.
    borders: Vec<Vec<Side>>,
}

impl FlatFaces {
    fn of(mesh: &Mesh) -> FlatFaces {
        let sides = |t: usize| [0, 1, 2].map(|k| [mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]]);
        let all = || (0..mesh.triangles.len()).flat_map(|t| sides(t).map(|side| (side, t)));
        let of_side: HashMap<[u32; 2], usize> = all().collect();
        let mut of = vec![usize::MAX; mesh.triangles.len()];
        let mut borders: Vec<Vec<Side>> = Vec::new();
        for first in 0..of.len() {
            if of[first] != usize::MAX {
                continue;
            }
            let face = borders.len();
            of[first] = face;
            let (mut border, mut stack) = (Vec::new(), vec![first]);
            while let Some(t) = stack.pop() {
                for [a, b] in sides(t) {
                    match of_side.get(&[b, a]) {
                        Some(&next) if of[next] == face => {}
                        Some(&next) if of[next] == usize::MAX && is_flat(mesh, t, next) => {
                            of[next] = face;
                            stack.push(next);
                        }
                        _ => border.push([a, b].map(|vertex| bits(mesh.vertices[vertex as usize]))),
                    }
                }
            }
            border.sort_unstable();
            borders.push(border);
        }
        FlatFaces { of, borders }
    }

    /// The mesh without some faces.
    fn without(&self, mesh: &Mesh, goes: &[bool]) -> Mesh {
        let kept = || (0..mesh.triangles.len()).filter(|t| !goes[self.of[*t]]);
        Mesh {
            vertices: mesh.vertices.clone(),
            triangles: kept().map(|t| mesh.triangles[t]).collect(),
            corner_normals: kept().map(|t| mesh.corner_normals[t]).collect(),
            corner_parameters: kept().map(|t| mesh.corner_parameters[t]).collect(),
            surfaces: kept().map(|t| mesh.surfaces[t]).collect(),
        }
    }
}

/// Whether two triangles are in one plane and face the same way.
fn is_flat(mesh: &Mesh, one: usize, two: usize) -> bool {
    let coord = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    let [a, b, c] = mesh.corners(one);
    let above = |p: DVec3| orient3d(coord(a), coord(b), coord(c), coord(p));
    mesh.corners(two).iter().all(|corner| above(*corner) == 0.0)
        && mesh.area_vector(one).dot(mesh.area_vector(two)) > 0.0
}

#[cfg(test)]
mod tests {
    use super::super::primitive::{block, cylinder, frustum, prism};
    use super::super::{Body, Expression, PrimitiveError};
    use super::*;
    use crate::surface::Tolerance;
    use glam::{DAffine3, DVec2};
    use std::f64::consts::PI;

    fn exact(body: Result<Body, PrimitiveError>, at: DVec3) -> ExactSolid {
        let solid = body.unwrap().solid(Tolerance::new(1e-3, 30.0)).unwrap();
        solid.transformed(&DAffine3::from_translation(at)).unwrap()
    }

    #[test]
    fn solids_are_glued_at_a_face_however_it_is_triangulated() {
        let column = exact(cylinder(1.0, 2.0), DVec3::ZERO);
        let roof = exact(frustum(1.0, 0.0, 1.0), DVec3::Y * 1.5);
        let glued = column.glued(&roof).unwrap();
        assert!((glued.solid().mass().volume - PI * (2.0 + 1.0 / 3.0)).abs() < 0.02);
        let both = Expression::Union(vec![Expression::Operand(0), Expression::Operand(1)]);
        let (union, _) = ExactSolid::evaluate(&[&column, &roof], &both).unwrap();
        assert!((union.solid().mass().volume - glued.solid().mass().volume).abs() < 1e-13);
        // Disc, cylinder and the two of the column; of the cone only its side is left.
        let mut seen = glued.solid().mesh().surfaces.clone();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen, [0, 1, 4]);
        // A square cut from the other corner.
        let corners = |k: usize| [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y][k % 4];
        for turn in 0..4 {
            let outline: Vec<DVec2> = (turn..turn + 4).map(corners).collect();
            let lower = exact(prism(&[&outline], [0.0, 1.0]), DVec3::ZERO);
            let upper = exact(block(DVec3::ONE), DVec3::new(0.5, 0.5, 1.5));
            assert!((lower.glued(&upper).unwrap().solid().mass().volume - 2.0).abs() < 1e-14);
        }
    }

    #[test]
    fn what_only_touches_or_overlaps_is_refused() {
        let one = exact(block(DVec3::ONE), DVec3::ZERO);
        let refused = |other: ExactSolid| one.glued(&other).err().unwrap();
        assert_eq!(refused(exact(block(DVec3::ONE), DVec3::new(1.0, 0.25, 0.0))), GlueError::NoFace);
        assert_eq!(refused(exact(block(DVec3::ONE), DVec3::X * 3.0)), GlueError::NoFace);
        // An arch over the face, of which a leg stands in the solid.
        let arch = [
            [0.5, -0.5],
            [0.5, 0.5],
            [2.0, 0.5],
            [2.0, -2.0],
            [-0.25, -2.0],
            [-0.25, 0.25],
            [0.0, 0.25],
            [0.0, -1.5],
            [1.5, -1.5],
            [1.5, -0.5],
        ];
        let arch: Vec<DVec2> = arch.map(DVec2::from_array).to_vec();
        let arch = exact(prism(&[arch], [-0.5, 0.5]), DVec3::ZERO);
        assert!(matches!(refused(arch), GlueError::Overlap { .. }));
    }
}
