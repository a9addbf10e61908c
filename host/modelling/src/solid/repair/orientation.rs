//! Triangles that agree with their neighbours.

use crate::mesh::Mesh;
use crate::mesh::edges::EdgeTable;

/// Reverses triangles so that they agree across edges of two; of each sheet the fewer. Returns how many were reversed.
pub(super) fn turn_alike(mesh: &mut Mesh) -> usize {
    // By triangle and side, the other triangle of an edge of two, and whether one of them must be reversed.
    let mut beside: Vec<[Option<(usize, bool)>; 3]> = vec![[None; 3]; mesh.triangles.len()];
    let table = EdgeTable::of(mesh);
    for edge in &table.edges {
        if let [one, two] = table.uses(edge) {
            let is_against = one.forward == two.forward;
            for (from, to) in [(one, two), (two, one)] {
                beside[from.triangle as usize][usize::from(from.side)] = Some((to.triangle as usize, is_against));
            }
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
            for (other, is_against) in beside[index].into_iter().flatten() {
                if turned[other].is_none() {
                    turned[other] = turned[index].map(|turned| turned ^ is_against);
                    sheet.push(other);
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

/// Reverses a triangle, with all that belongs to it.
pub(super) fn turn(mesh: &mut Mesh, triangle: usize) {
    mesh.triangles[triangle].swap(1, 2);
    if let Some(normals) = mesh.corner_normals.get_mut(triangle) {
        *normals = [-normals[0], -normals[2], -normals[1]];
    }
    if let Some(parameters) = mesh.corner_parameters.get_mut(triangle) {
        parameters.swap(1, 2);
    }
}
