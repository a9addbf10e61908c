//! One step of a polyhedron with creases, sharp vertices or borders.

use std::collections::HashMap;

use glam::DVec3;

use super::creases::{CornerSets, Creases};
use super::error::SubdivisionError;
use super::face_cuts;
use super::polyhedron::Polyhedron;

/// A step of sharp rules: cuts corners and edges except where they are sharp, and leaves strips at both sides of
/// creases, which it uses up by one.
///
/// # Errors
/// Corners meet that should not: only where faces of the polyhedron touch each other twice.
pub(super) fn refined(mesh: &Polyhedron) -> Result<Polyhedron, SubdivisionError> {
    let mut refined = face_cuts::divided(ground(mesh)?)?;
    let sharpness = refined.edge_sharpness.iter_mut().chain(&mut refined.vertex_sharpness);
    sharpness.for_each(|sharpness| *sharpness -= sharpness.min(1.0));
    Ok(refined)
}

/// Cuts corners and edges, except where they are sharp. Creases keep their sharpness.
fn ground(mesh: &Polyhedron) -> Result<Polyhedron, SubdivisionError> {
    let creases = Creases::of(mesh);
    let mut joined = CornerSets::new(mesh.corners.len());
    creases.join(&mut joined);
    let (names, count) = joined.names(&creases.cut);
    let mut points = vec![DVec3::ZERO; count];
    // The lowest of joined corners gives the position.
    for (corner, position) in creases.moved().into_iter().enumerate().rev().filter(|(corner, _)| !creases.cut[*corner])
    {
        points[names[corner] as usize] = position;
    }
    let mut corners = Vec::with_capacity(4 * mesh.corners.len());
    let mut starts = vec![0];
    creases.each_face(|face, _| push_face(face, &names, &mut corners, &mut starts));
    let mut refined = Polyhedron::linked(points, corners, starts)?;
    inherit(&creases, &names, &mut refined);
    Ok(refined)
}

/// Adds a face of joined corners, unless fewer than three are left.
fn push_face(face: &[u32], names: &[u32], corners: &mut Vec<u32>, starts: &mut Vec<u32>) {
    let begin = corners.len();
    for &corner in face {
        let name = names[corner as usize];
        if corners.len() == begin || corners[corners.len() - 1] != name {
            corners.push(name);
        }
    }
    while corners.len() > begin + 1 && corners[begin] == corners[corners.len() - 1] {
        corners.pop();
    }
    if corners.len() < begin + 3 {
        corners.truncate(begin);
    } else {
        starts.push(corners.len() as u32);
    }
}

/// Hands the sharpness of creases on.
fn inherit(creases: &Creases<'_>, names: &[u32], refined: &mut Polyhedron) {
    let mesh = creases.mesh;
    if mesh.vertex_sharpness.iter().any(|&sharpness| sharpness >= 1.0) {
        refined.vertex_sharpness = vec![0.0; refined.points.len()];
        for (corner, &vertex) in mesh.corners.iter().enumerate().filter(|(corner, _)| !creases.cut[*corner]) {
            let sharpness = mesh.vertex_sharpness[vertex as usize];
            let is_held = sharpness >= 1.0;
            refined.vertex_sharpness[names[corner] as usize] = if is_held { sharpness } else { 0.0 };
        }
    }
    let mut sharp: HashMap<[u32; 2], f64> = HashMap::new();
    for (ends, sharpness) in creases.child_creases() {
        let [a, b] = ends.map(|corner| names[corner as usize]);
        if a != b {
            sharp.insert([a.min(b), a.max(b)], sharpness);
        }
    }
    if sharp.is_empty() {
        return;
    }
    let mut is_end = vec![false; refined.points.len()];
    sharp.keys().flatten().for_each(|&vertex| is_end[vertex as usize] = true);
    let sharpness = |h: usize| {
        let [a, b] = [refined.corners[h], refined.corners[refined.next[h] as usize]];
        if !(is_end[a as usize] && is_end[b as usize]) {
            return 0.0;
        }
        sharp.get(&[a.min(b), a.max(b)]).copied().unwrap_or(0.0)
    };
    refined.edge_sharpness = (0..refined.corners.len()).map(sharpness).collect();
}
