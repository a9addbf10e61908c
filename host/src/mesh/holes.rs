//! Closing the holes of a mesh.

use std::collections::BTreeMap;

use glam::DVec3;

use super::Mesh;
use super::edges::EdgeTable;

impl Mesh {
    /// The mesh with every hole closed by a fan of triangles around the mean of its border.
    ///
    /// Right for holes whose border is nearly flat and star-shaped; in others the fan may cut through the mesh, which
    /// is closed nevertheless. Vertices at the same position become one; tables per corner are dropped if anything was
    /// added. A border that cannot be followed (its triangles are turned against each other) stays open.
    pub fn with_holes_filled(&self) -> Mesh {
        let mut mesh = self.welded();
        let loops = border_loops(&mesh);
        if loops.is_empty() {
            return mesh;
        }
        mesh.corner_normals.clear();
        mesh.corner_parameters.clear();
        mesh.surfaces.clear();
        for border in loops {
            let center = mesh.vertices.len() as u32;
            let sum: DVec3 = border.iter().map(|&vertex| mesh.vertices[vertex as usize]).sum();
            mesh.vertices.push(sum / border.len() as f64);
            for (k, &from) in border.iter().enumerate() {
                mesh.triangles.push([from, border[(k + 1) % border.len()], center]);
            }
        }
        mesh
    }
}

/// The loops of edges that lack a triangle on one side, in the direction that the missing triangles have.
fn border_loops(mesh: &Mesh) -> Vec<Vec<u32>> {
    let table = EdgeTable::of(mesh);
    let mut onward: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for edge in &table.edges {
        if let [only] = table.uses(edge) {
            let [low, high] = edge.ends;
            let (from, to) = if only.forward { (high, low) } else { (low, high) };
            onward.entry(from).or_default().push(to);
        }
    }
    let mut loops = Vec::new();
    while let Some((&start, _)) = onward.first_key_value() {
        // Where a border touches itself the walk closes the loop at the vertex that it meets again.
        let mut walk = vec![start];
        while let Some(next) = walk.last().and_then(|here| take_onward(&mut onward, *here)) {
            match walk.iter().position(|&vertex| vertex == next) {
                Some(first) => {
                    loops.push(walk.drain(first..).collect());
                    walk.push(next);
                }
                None => walk.push(next),
            }
        }
    }
    loops
}

fn take_onward(onward: &mut BTreeMap<u32, Vec<u32>>, from: u32) -> Option<u32> {
    let ends = onward.get_mut(&from)?;
    let next = ends.pop();
    if ends.is_empty() {
        onward.remove(&from);
    }
    next
}

#[cfg(test)]
mod tests {
    use super::super::samples::{ball, tetrahedron};

    #[test]
    fn a_tetrahedron_without_one_side_is_closed_again() {
        let mut open = tetrahedron();
        open.triangles.remove(2);
        let closed = open.with_holes_filled();
        assert!(closed.is_closed());
        assert_eq!(closed.triangles.len(), 6);
        assert!((closed.signed_volume() - 1.0 / 6.0).abs() < 1e-15);
    }

    #[test]
    fn holes_that_touch_in_a_vertex_are_closed() {
        let mut open = ball(12, 8);
        let [a, ..] = open.triangles[open.triangles.len() / 2];
        let around: Vec<usize> = (0..open.triangles.len()).filter(|&t| open.triangles[t].contains(&a)).collect();
        open.triangles.swap_remove(around[3]);
        open.triangles.swap_remove(around[0]);
        assert!(!open.is_closed());
        let closed = open.with_holes_filled();
        assert!(closed.is_closed());
        assert_eq!(closed.edge_report().euler_characteristic(), 2);
    }
}
