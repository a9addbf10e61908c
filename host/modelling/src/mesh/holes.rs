//! Closing the holes of a mesh by fans, for tests of what surfaces enclose.

use super::{BoundaryLoop, Mesh};
use glam::DVec3;

impl Mesh {
    /// The mesh with every hole closed by a fan of triangles around the mean of its border.
    ///
    /// Right for holes whose border is nearly flat and star-shaped; in others the fan may cut through the mesh, which
    /// is closed nevertheless. Vertices at the same position become one; tables per corner are dropped if anything was
    /// added. A border that cannot be followed (its triangles are oriented against each other) stays open.
    pub fn with_holes_filled(&self) -> Mesh {
        let mut mesh = self.welded();
        let loops = mesh.boundary_loops();
        if loops.is_empty() {
            return mesh;
        }
        mesh.corner_normals.clear();
        mesh.corner_parameters.clear();
        mesh.surfaces.clear();
        for BoundaryLoop(border) in loops {
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
