//! Vertices at boundaries that are one but for roundings to single precision.

use super::super::union_find::UnionFind;
use crate::mesh::Mesh;

/// Part of the largest coordinate within which vertices at boundaries are taken for one: two units in the last place of
/// numbers in single precision, as files have them.
const NEAR: f64 = 2.0 * f32::EPSILON as f64;

/// Joins vertices of boundary loops that are near each other; returns how many became others. Triangles that use a vertex
/// twice then stay.
///
/// Cost: n log n.
pub(super) fn join_near(mesh: &mut Mesh) -> usize {
    let mut boundary: Vec<u32> = mesh.boundary_loops().into_iter().flat_map(|found| found.0).collect();
    let place = |vertex: u32| mesh.vertices[vertex as usize];
    boundary.sort_by(|&one, &two| place(one).x.total_cmp(&place(two).x).then(one.cmp(&two)));
    boundary.dedup();
    let near = NEAR * mesh.vertices.iter().map(|vertex| vertex.abs().max_element()).fold(0.0, f64::max);
    let mut joined = UnionFind::new(mesh.vertices.len());
    for (index, &one) in boundary.iter().enumerate() {
        let beside = boundary[index + 1..].iter().take_while(|&&two| place(two).x - place(one).x <= near);
        beside.filter(|&&two| place(two).distance(place(one)) <= near).for_each(|&two| joined.join(one, two));
    }
    let changed = boundary.iter().filter(|&&vertex| joined.find(vertex) != vertex).count();
    if changed > 0 {
        for triangle in &mut mesh.triangles {
            *triangle = triangle.map(|vertex| joined.find(vertex));
        }
    }
    changed
}
