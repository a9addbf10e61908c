//! Solids from meshes that are none.

use super::import::{certain_volume, check_edges, without_collapsed};
use super::{Solid, SolidError};
use crate::mesh::Mesh;
use std::collections::{HashMap, HashSet};

/// What was done to a mesh to make it a solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repair {
    /// Triangles left out because corners of them coincide.
    pub collapsed: usize,
    /// Triangles left out because another has the same corners.
    pub duplicates: usize,
    /// Triangles turned round.
    pub turned: usize,
    /// Triangles added to fill holes.
    pub filled: usize,
    /// Whether the surface was divided where it crossed itself, and what is not its border left out.
    pub is_resolved: bool,
}

impl Solid {
    /// Makes a solid of a mesh: joins vertices at one place, leaves out double triangles, turns triangles so that
    /// neighbours agree and the whole faces outwards, fills holes, and makes the surface simple. A part of a mesh whose
    /// triangles agreed already, such as the wall of a cavity, keeps its side.
    ///
    /// # Errors
    /// [`SolidError`] if numbers are wrong, or the mesh is not closed even then: edges of three triangles, or a surface
    /// with one side only.
    pub fn repaired(mesh: Mesh) -> Result<(Solid, Repair), SolidError> {
        mesh.validate()?;
        let mut repair = Repair::default();
        let before = mesh.triangles.len();
        let mut mesh = without_collapsed(mesh);
        repair.collapsed = before - mesh.triangles.len();
        repair.duplicates = leave_out_duplicates(&mut mesh);
        repair.turned = turn_alike(&mut mesh);
        let before = mesh.triangles.len();
        let mut mesh = mesh.with_holes_filled();
        repair.filled = mesh.triangles.len() - before;
        check_edges(&mesh)?;
        if certain_volume(&mesh) < 0.0 {
            repair.turned += mesh.triangles.len();
            mesh = mesh.reversed();
        }
        let (solid, crossing) = Solid::resolved(mesh)?;
        repair.is_resolved = crossing.is_some();
        Ok((solid, repair))
    }
}

/// Leaves out triangles that have the corners of an earlier one, whichever way they turn; returns how many.
fn leave_out_duplicates(mesh: &mut Mesh) -> usize {
    let mut known = HashSet::new();
    let keep: Vec<bool> = mesh
        .triangles
        .iter()
        .map(|corners| {
            let mut corners = *corners;
            corners.sort_unstable();
            known.insert(corners)
        })
        .collect();
    let left_out = keep.iter().filter(|keep| !**keep).count();
    super::import::retain(mesh, &keep);
    left_out
}

/// Turns triangles so that they agree across edges of two; of each part the fewer. Returns how many were turned.
fn turn_alike(mesh: &mut Mesh) -> usize {
    let sides = |t: [u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let mut around: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for (index, &t) in mesh.triangles.iter().enumerate() {
        for [a, b] in sides(t) {
            around.entry([a.min(b), a.max(b)]).or_default().push(index);
        }
    }
    let mut turned: Vec<Option<bool>> = vec![None; mesh.triangles.len()];
    let mut changed = Vec::new();
    for first in 0..mesh.triangles.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let mut part = vec![first];
        let mut next = 0;
        while let Some(&index) = part.get(next) {
            next += 1;
            for [a, b] in sides(mesh.triangles[index]) {
                if let [one, two] = around[&[a.min(b), a.max(b)]][..] {
                    let other = if one == index { two } else { one };
                    let is_against = sides(mesh.triangles[other]).contains(&[a, b]);
                    if turned[other].is_none() {
                        turned[other] = turned[index].map(|turned| turned ^ is_against);
                        part.push(other);
                    }
                }
            }
        }
        let is_turned = |index: &&usize| turned[**index] == Some(true);
        let wanted = part.iter().filter(is_turned).count() * 2 <= part.len();
        changed.extend(part.iter().copied().filter(|&index| turned[index] == Some(wanted)));
    }
    for &index in &changed {
        mesh.triangles[index].swap(1, 2);
        if let Some(normals) = mesh.corner_normals.get_mut(index) {
            *normals = [-normals[0], -normals[2], -normals[1]];
        }
        if let Some(parameters) = mesh.corner_parameters.get_mut(index) {
            parameters.swap(1, 2);
        }
    }
    changed.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Sphere, Tolerance, box_faces, tessellate};
    use glam::DVec3;

    #[test]
    fn holes_turned_and_double_triangles_are_put_right() {
        let ball = tessellate(&[Sphere::new(DVec3::ZERO, 1.0)], Tolerance::new(0.01, 90.0)).unwrap();
        let volume = ball.signed_volume();
        let mut broken = ball.clone();
        broken.corner_normals.clear();
        broken.corner_parameters.clear();
        broken.surfaces.clear();
        for index in (3..90).step_by(7) {
            broken.triangles[index].swap(0, 1);
        }
        broken.triangles.swap_remove(40);
        broken.triangles.push(broken.triangles[5]);
        let (solid, repair) = Solid::repaired(broken).unwrap();
        assert!((solid.mesh().signed_volume() - volume).abs() < 1e-14);
        assert_eq!((repair.duplicates, repair.turned, repair.filled, repair.is_resolved), (1, 13, 3, false));
        let (solid, repair) = Solid::repaired(ball.clone().reversed()).unwrap();
        assert_eq!((solid.mesh().signed_volume(), repair.turned), (volume, ball.triangles.len()));
    }

    #[test]
    fn crossing_parts_become_one_and_a_strip_with_one_side_is_refused() {
        let cube = |low: f64| {
            tessellate(&box_faces(DVec3::splat(low), DVec3::splat(low + 1.0)), Tolerance::new(1.0, 90.0)).unwrap()
        };
        let mut two = cube(0.0);
        two.append(&cube(0.5), 6);
        let (solid, repair) = Solid::repaired(two).unwrap();
        assert!(repair.is_resolved && (solid.mesh().signed_volume() - 1.875).abs() < 1e-15);
        // Five triangles in a ring, each sharing an edge with the next: a Moebius strip.
        let vertices =
            (0..5).map(|k| DVec3::new(f64::from(k).cos(), f64::from(k).sin(), f64::from(k * k % 3))).collect();
        let triangles = (0..5).map(|k| [k, (k + 1) % 5, (k + 2) % 5]).collect();
        let strip = Mesh { vertices, triangles, ..Mesh::default() };
        assert!(matches!(Solid::repaired(strip), Err(SolidError::NotClosed { .. })));
    }
}
