//! Pairs of triangles that make a convex quadrilateral in one plane.
//!
//! The sides of blocks and prisms are such. Taken as one face each, they need a quarter of the comparisons, and no line
//! is drawn where they were only divided.

use super::contact::ConvexFace;
use super::half_edges::HalfEdges;
use crate::mesh::Mesh;
use rayon::prelude::*;

/// No triangle.
pub const NONE: u32 = u32::MAX;

/// For each triangle its quad partner, the other half of a convex quadrilateral in one plane and of one surface, or
/// [`NONE`]; empty if there are none.
///
/// Two triangles make one only across a side that is the longest of both.
pub fn quad_partners(mesh: &Mesh) -> Vec<u32> {
    // The longest side of each triangle.
    let longest = |triangle: usize| {
        let corners = mesh.corners(triangle);
        let length = |k: usize| corners[k].distance_squared(corners[(k + 1) % 3]);
        let k = if length(0) >= length(1) { 0 } else { 1 };
        let k = if length(k) >= length(2) { k } else { 2 };
        [k, (k + 1) % 3].map(|k| mesh.triangles[triangle][k])
    };
    let longest: Vec<[u32; 2]> = (0..mesh.triangles.len()).into_par_iter().with_min_len(4096).map(longest).collect();
    let sides = HalfEdges::new(mesh.vertices.len(), longest.iter().copied().zip(0..));
    let mut partners = Vec::new();
    for (_, beside) in sides.edges() {
        if let &[(_, one), (_, two)] = beside
            && is_face(mesh, one, two)
        {
            partners.resize(mesh.triangles.len(), NONE);
            (partners[one as usize], partners[two as usize]) = (two, one);
        }
    }
    partners
}

/// Whether the triangles on both sides of an edge make a convex face of one plane and one surface.
fn is_face(mesh: &Mesh, one: u32, two: u32) -> bool {
    let is_one = mesh.surfaces.is_empty() || mesh.surfaces[one as usize] == mesh.surfaces[two as usize];
    let Some([a, b, c, d]) = ring(mesh, one, two).filter(|_| is_one) else { return false };
    let at = |vertex: u32| mesh.vertices[vertex as usize];
    ConvexFace::new(0, [a, b, c], [a, b, c].map(at)).is_some_and(|face| face.is_convex_with(at(d)))
}

/// The vertices around two triangles with a common side, the first of them first; `None` if they are oriented against
/// each other.
pub fn ring(mesh: &Mesh, one: u32, two: u32) -> Option<[u32; 4]> {
    let [first, second] = [one, two].map(|triangle| mesh.triangles[triangle as usize]);
    let lone = (0..3).find(|&k| !second.contains(&first[k]))?;
    let [a, b, c] = [2, 0, 1].map(|step| first[(lone + step) % 3]);
    // The second traverses the common side the other way.
    let side = (0..3).find(|&k| [second[k], second[(k + 1) % 3]] == [a, c])?;
    Some([a, b, c, second[(side + 2) % 3]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn mesh(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Mesh {
        let vertices = vertices.iter().map(|&v| DVec3::from(v)).collect();
        Mesh { vertices, triangles: triangles.to_vec(), ..Mesh::default() }
    }

    #[test]
    fn halves_of_a_square_are_partners() {
        let square = [[0.0, 0.0, 0.1], [1.0, 0.0, 0.1], [1.0, 1.0, 0.1], [0.0, 1.0, 0.1]];
        for triangles in [[[0, 1, 2], [0, 2, 3]], [[2, 0, 1], [3, 0, 2]], [[1, 2, 0], [2, 3, 0]]] {
            let square = mesh(&square, &triangles);
            assert_eq!(quad_partners(&square), [1, 0]);
            let mut vertices = ring(&square, 0, 1).unwrap();
            let first = vertices.iter().position(|v| *v == 0).unwrap();
            vertices.rotate_left(first);
            assert_eq!(vertices, [0, 1, 2, 3]);
        }
    }

    #[test]
    fn what_is_bent_folded_concave_or_of_two_surfaces_stays_two() {
        let alone = |points: &[[f64; 3]; 4], triangles: [[u32; 3]; 2]| {
            let mesh = mesh(points, &triangles);
            assert!(quad_partners(&mesh).is_empty(), "{points:?}");
        };
        let ring = [[0, 1, 2], [0, 2, 3]];
        alone(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1e-17]], ring);
        alone(&[[0.0, 0.0, 0.0], [0.5, 0.1, 0.0], [1.0, 1.0, 0.0], [0.6, 0.5, 0.0]], ring);
        // Three corners on one line.
        alone(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 2.0, 0.0], [-1.0, 0.0, 0.0]], ring);
        alone(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]], [[0, 1, 2], [0, 3, 2]]);
        let mut two = mesh(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]], &ring);
        two.surfaces = vec![0, 1];
        assert!(quad_partners(&two).is_empty());
    }
}
