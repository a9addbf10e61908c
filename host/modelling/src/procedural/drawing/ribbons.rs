//! Blades: strokes without thickness, as triangles.

use super::plant_drawing::StrokeNode;
use super::tubes::push;
use crate::mesh::Mesh;
use glam::{DVec2, DVec3};

/// How many triangles a blade has at the most.
pub(super) fn ribbon_triangles(nodes: &[StrokeNode]) -> usize {
    2 * (nodes.len() - 1)
}

/// Appends a blade: two triangles from node to node, one where it ends in a point. Parameters are the part of the way
/// across and the length from the first node.
///
/// - `across`: unit vector along its width.
pub(super) fn append_ribbon(mesh: &mut Mesh, nodes: &[StrokeNode], across: DVec3) {
    let first = mesh.vertices.len() as u32;
    let side = |node: &StrokeNode| [node.position - across * node.radius, node.position + across * node.radius];
    mesh.vertices.extend(nodes.iter().flat_map(side));
    let normal_at = |node: usize| {
        let [before, after] = [node.saturating_sub(1), (node + 1).min(nodes.len() - 1)];
        across.cross(nodes[after].position - nodes[before].position).normalize_or(across.any_orthonormal_vector())
    };
    let mut length = 0.0;
    for (number, pair) in nodes.windows(2).enumerate() {
        let end = length + pair[0].position.distance(pair[1].position);
        let normals = [number, number + 1].map(normal_at);
        // Corners by node and side.
        for corners in [[(0, 0), (0, 1), (1, 1)], [(0, 0), (1, 1), (1, 0)]] {
            let places = corners.map(|(node, side): (usize, u32)| first + 2 * (number + node) as u32 + side);
            let [a, b, c] = places.map(|place| mesh.vertices[place as usize]);
            if (b - a).cross(c - a).length_squared() == 0.0 {
                continue;
            }
            let parameters = corners.map(|(node, side)| DVec2::new(f64::from(side), [length, end][node]));
            push(mesh, places, corners.map(|(node, _)| normals[node]), parameters, pair[1].colour);
        }
        length = end;
    }
}
