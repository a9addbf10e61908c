//! The selected lines of a mesh, one by one.

use glam::DVec3;

use super::Mesh;
use super::edges::{EdgeSelection, EdgeTable};
use super::smooth_outline::SmoothOutline;

/// The selected lines of `mesh` as vectors, each once.
pub fn wire(mesh: &Mesh, selection: &EdgeSelection) -> Vec<[DVec3; 2]> {
    let table = EdgeTable::of(mesh);
    let edges = table.select(mesh, selection).map(|edge| edge.ends.map(|vertex| mesh.vertices[vertex as usize]));
    let SmoothOutline { points, lines } = table.smooth_outline(mesh, selection);
    edges.chain(lines.iter().map(|(ends, _)| ends.map(|point| points[point as usize]))).collect()
}
