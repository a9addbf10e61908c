//! Moving rounded points by a few units in the last place until triangles no longer overlap.
//!
//! A point that two sheets have in common is rounded to where it is on the wrong side of a third one, by less than a
//! rounding. Of the places around it some are on the right sides of all. They are tried in turn; one is taken if no
//! more triangles overlap with those at the point than before. What no place is right for stays, for others to be moved
//! or for [`snapped`](super::snapping::snapped) to snap.
//!
//! # Source
//! The sequence of places: Roberts 2018, the additive recurrence of the generalised golden ratio in three dimensions.

use super::overlap::{NamedTriangle, overlap};
use crate::mesh::Mesh;
use crate::numeric::bounds::Bounds;
use crate::octree::TriangleBvh;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Rounds over the points of all triangles that overlap.
const ROUNDS: usize = 3;
/// Places that are tried for a point in a round.
const CANDIDATES: usize = 6;
/// 1/g, 1/g² and 1/g³ of the real root g of g⁴ = g + 1.
const STEPS: DVec3 = DVec3::new(0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_9);

/// Moves points of triangles that overlap.
///
/// - `pairs`: the triangles.
/// - `most`: how far, in units in the last place of the largest coordinate of the point.
///
/// Cost: in proportion to the triangles at points that are moved, and those near them.
pub fn nudge(mesh: &mut Mesh, pairs: &[[u32; 2]], most: f64) {
    let mut search = Search::new(mesh, most * f64::EPSILON);
    let mut left = pairs.to_vec();
    for round in 0..ROUNDS {
        let mut vertices: Vec<u32> = left.iter().flatten().flat_map(|t| search.mesh.triangles[*t as usize]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices.into_iter().for_each(|vertex| search.place_vertex(vertex, round));
        left.retain(|[one, two]| search.is_overlap(*one, *two));
        if left.is_empty() {
            return;
        }
    }
}

struct Search<'a> {
    mesh: &'a mut Mesh,
    /// The triangles by the places that they had first.
    sorted: TriangleBvh,
    /// The triangles at each vertex.
    triangles_at: FxHashMap<u32, Vec<u32>>,
    /// The triangles near some.
    triangles_near: FxHashMap<u32, Vec<u32>>,
    /// Where vertices were first.
    original: FxHashMap<u32, DVec3>,
    /// How far vertices move, as a part of their largest coordinate.
    most: f64,
}

impl<'a> Search<'a> {
    fn new(mesh: &'a mut Mesh, most: f64) -> Search<'a> {
        let sorted = TriangleBvh::new(&mesh.vertices, &mesh.triangles);
        let mut at: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
        for (corners, triangle) in mesh.triangles.iter().zip(0..) {
            corners.iter().for_each(|&vertex| at.entry(vertex).or_default().push(triangle));
        }
        Search {
            mesh,
            sorted,
            triangles_at: at,
            triangles_near: FxHashMap::default(),
            original: FxHashMap::default(),
            most,
        }
    }

    fn named_triangle(&self, triangle: u32) -> NamedTriangle {
        NamedTriangle { names: self.mesh.triangles[triangle as usize], corners: self.mesh.corners(triangle as usize) }
    }

    fn is_overlap(&self, one: u32, two: u32) -> bool {
        let [one, two] = [one, two].map(|triangle| self.named_triangle(triangle));
        overlap(&one.with_plane(), &two, || two.with_plane())
    }

    /// Tries places for a vertex, and leaves it at the best.
    fn place_vertex(&mut self, vertex: u32, round: usize) {
        let home = *self.original.entry(vertex).or_insert(self.mesh.vertices[vertex as usize]);
        let size = 2.0 * self.most * home.abs().max_element();
        let mut least = self.overlaps(vertex, usize::MAX);
        for place in 0..CANDIDATES {
            if least == 0 {
                return;
            }
            let number = (vertex as usize * ROUNDS + round) * CANDIDATES + place;
            let before = self.mesh.vertices[vertex as usize];
            self.mesh.vertices[vertex as usize] = home + ((STEPS * number as f64).fract() - 0.5) * size;
            let count = self.overlaps(vertex, least);
            if count <= least {
                least = count;
            } else {
                self.mesh.vertices[vertex as usize] = before;
            }
        }
    }

    /// How many triangles overlap with those at a vertex, up to more than `limit`; as many as there can be if one of
    /// these has no area.
    fn overlaps(&mut self, vertex: u32, limit: usize) -> usize {
        let mut count = 0;
        for place in 0..self.triangles_at[&vertex].len() {
            let triangle = self.triangles_at[&vertex][place];
            self.find_near(triangle);
            let one = self.named_triangle(triangle).with_plane();
            if one.is_flat() {
                return usize::MAX;
            }
            let bounds = Bounds::of(one.triangle().corners);
            // Two at the vertex are counted once.
            let is_counted = |other: u32| other < triangle && self.mesh.triangles[other as usize].contains(&vertex);
            for other in self.triangles_near[&triangle].iter().filter(|other| !is_counted(**other)) {
                let two = self.named_triangle(*other);
                if Bounds::of(two.corners).touches(bounds) && overlap(&one, &two, || two.with_plane()) {
                    count += 1;
                    if count > limit {
                        return count;
                    }
                }
            }
        }
        count
    }

    /// Finds the triangles that may touch one, wherever the points of both are moved.
    fn find_near(&mut self, triangle: u32) {
        let Search { mesh, sorted, triangles_near: near, most, .. } = self;
        near.entry(triangle).or_insert_with(|| {
            let Bounds { min, max } = Bounds::of(mesh.corners(triangle as usize));
            let margin = 4.0 * *most * min.abs().max(max.abs()).max_element();
            let mut found = Vec::new();
            sorted.touching(Bounds { min: min - margin, max: max + margin }, |other| found.push(other));
            found.retain(|other| *other != triangle);
            found
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::overlaps::overlapping;
    use super::*;

    #[test]
    fn a_point_on_the_wrong_side_of_a_face_goes_to_the_right_one() {
        // The tip of a tetrahedron under a lid, a rounding above it.
        let under = |x: f64, y: f64, depth: f64| DVec3::new(x, y, 0.3 * x + 0.7 * y - depth);
        let lid = [under(0.1, 0.1, 0.0), under(0.9, 0.2, 0.0), under(0.3, 0.8, 0.0)];
        let base = [under(0.2, 0.2, 0.5), under(0.6, 0.3, 0.5), under(0.4, 0.6, 0.5)];
        let vertices = [lid.as_slice(), &base, &[under(0.37, 0.41, -f64::EPSILON)]].concat();
        let triangles = vec![[0, 1, 2], [3, 4, 6], [4, 5, 6], [5, 3, 6], [3, 5, 4]];
        let mut mesh = Mesh { vertices, triangles, ..Mesh::default() };
        let (pairs, first) = (overlapping(&mesh), mesh.vertices.clone());
        assert_eq!(pairs.len(), 3);
        nudge(&mut mesh, &pairs, 4.0);
        assert!(overlapping(&mesh).is_empty());
        let moved = mesh.vertices.iter().zip(&first).map(|(a, b)| (*a - *b).abs().max_element());
        let farthest = moved.fold(0.0, f64::max);
        assert!(farthest > 0.0 && farthest <= 4.0 * f64::EPSILON, "{farthest}");
    }
}
