//! Triangles that agree with their neighbours.

use super::sides;
use crate::mesh::Mesh;
use std::collections::HashMap;

/// Turns triangles so that they agree across edges of two; of each sheet the fewer. Returns how many were turned.
pub(super) fn turn_alike(mesh: &mut Mesh) -> usize {
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
        let mut sheet = vec![first];
        let mut next = 0;
        while let Some(&index) = sheet.get(next) {
            next += 1;
            for [a, b] in sides(mesh.triangles[index]) {
                if let [one, two] = around[&[a.min(b), a.max(b)]][..] {
                    let other = if one == index { two } else { one };
                    let is_against = sides(mesh.triangles[other]).contains(&[a, b]);
                    if turned[other].is_none() {
                        turned[other] = turned[index].map(|turned| turned ^ is_against);
                        sheet.push(other);
                    }
                }
            }
        }
        let is_turned = |index: &&usize| turned[**index] == Some(true);
        let wanted = sheet.iter().filter(is_turned).count() * 2 <= sheet.len();
        changed.extend(sheet.iter().copied().filter(|&index| turned[index] == Some(wanted)));
    }
    changed.iter().for_each(|&index| turn(mesh, index));
    changed.len()
}

/// Turns a triangle round, with all that belongs to it.
pub(super) fn turn(mesh: &mut Mesh, triangle: usize) {
    mesh.triangles[triangle].swap(1, 2);
    if let Some(normals) = mesh.corner_normals.get_mut(triangle) {
        *normals = [-normals[0], -normals[2], -normals[1]];
    }
    if let Some(parameters) = mesh.corner_parameters.get_mut(triangle) {
        parameters.swap(1, 2);
    }
}
