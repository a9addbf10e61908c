//! Normals at the corners of faces, for smooth shading.

use super::Facets;
use glam::DVec3;

/// The normal of each corner, of length 1, towards the front of its face.
///
/// A normal that was given stands, turned to the front. Else it is the mean of the normals of the faces that can be
/// reached around the point across soft edges, each weighted by its angle there. Faces that run the same way along
/// their common edge have their fronts on different sides; there is no smoothing between them.
///
/// # Source
/// Weights: Thürmer and Wüthrich 1998, Computing vertex normals from polygonal facets.
pub fn corner_normals(facets: &Facets) -> Vec<DVec3> {
    let mut groups = Groups((0..facets.corners.len() as u32).collect());
    for edge in facets.edges.iter().filter(|edge| edge.soft && edge.uses == [1, 1]) {
        let [first, second] = edge.corners;
        groups.join(first[0], second[0]);
        groups.join(first[1], second[1]);
    }
    let mut sums = vec![DVec3::ZERO; facets.corners.len()];
    for face in &facets.faces {
        for contour in face.contours.clone() {
            let range = facets.contours[contour].clone();
            let place = |corner: usize| facets.points[facets.corners[corner].point as usize].eye;
            for corner in range.clone() {
                let before = if corner == range.start { range.end - 1 } else { corner - 1 };
                let after = if corner + 1 == range.end { range.start } else { corner + 1 };
                let (a, b) = (place(before) - place(corner), place(after) - place(corner));
                let angle = a.cross(b).length().atan2(a.dot(b));
                sums[groups.root(corner as u32) as usize] += face.normal * angle;
            }
        }
    }
    let faces = facets.faces.iter().flat_map(|face| face.corners.clone().map(move |corner| (corner, face)));
    let normals = faces.map(|(corner, face)| match facets.corners[corner].normal {
        Some(given) if given.dot(face.normal) < 0.0 => -given,
        Some(given) => given,
        None => sums[groups.root(corner as u32) as usize].normalize_or(face.normal),
    });
    normals.collect()
}

/// The corners that share a normal: a forest in which each tree is a group.
struct Groups(Vec<u32>);

impl Groups {
    fn root(&mut self, corner: u32) -> u32 {
        let mut at = corner;
        while self.0[at as usize] != at {
            let above = self.0[self.0[at as usize] as usize];
            self.0[at as usize] = above;
            at = above;
        }
        at
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
