//! The boundary of a mesh: loops of edges that lack a triangle.

use super::Mesh;
use super::edges::EdgeTable;
use glam::DVec3;
use std::collections::BTreeMap;

/// A closed loop of edges through vertices that are all different, in the direction in which triangles that are missing
/// there would traverse them. A vertex is the lowest of those at its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoundaryLoop(pub Vec<u32>);

impl BoundaryLoop {
    /// Its edges, from vertex to vertex.
    pub fn edges(&self) -> impl Iterator<Item = [u32; 2]> {
        let BoundaryLoop(vertices) = self;
        (0..vertices.len()).map(|k| [vertices[k], vertices[(k + 1) % vertices.len()]])
    }

    /// The sum of the lengths of its edges, units.
    ///
    /// - `positions`: of the vertices of the mesh.
    pub fn length(&self, positions: &[DVec3]) -> f64 {
        self.edges().map(|[from, to]| positions[from as usize].distance(positions[to as usize])).sum()
    }
}

impl Mesh {
    /// The loops of edges that more triangles traverse one way than the other; an edge belongs to as many as it lacks
    /// triangles. Vertices at one place count as one, and triangles that use a place twice have no part in it.
    ///
    /// Loops that touch in a vertex are parted there. Triangles that are oriented against their neighbours bring loops
    /// too.
    pub fn boundary_loops(&self) -> Vec<BoundaryLoop> {
        let table = EdgeTable::of(self);
        let mut following: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for edge in &table.edges {
            let [low, high] = edge.ends;
            let forward = table.uses(edge).iter().filter(|side| side.forward).count();
            let backward = table.uses(edge).len() - forward;
            for _ in backward..forward {
                following.entry(high).or_default().push(low);
            }
            for _ in forward..backward {
                following.entry(low).or_default().push(high);
            }
        }
        let mut loops = Vec::new();
        while let Some((&start, _)) = following.first_key_value() {
            // The walk closes a loop at each vertex that it meets again. It cannot end elsewhere: as many edges leave a
            // vertex as arrive there.
            let mut walk = vec![start];
            let mut place_of = BTreeMap::from([(start, 0)]);
            while let Some(next) = walk.last().and_then(|here| take_following(&mut following, *here)) {
                if let Some(first) = place_of.get(&next).copied() {
                    let closed: Vec<u32> = walk.drain(first..).collect();
                    closed.iter().for_each(|vertex| _ = place_of.remove(vertex));
                    loops.push(BoundaryLoop(closed));
                }
                place_of.insert(next, walk.len());
                walk.push(next);
            }
        }
        loops
    }
}

fn take_following(following: &mut BTreeMap<u32, Vec<u32>>, from: u32) -> Option<u32> {
    let ends = following.get_mut(&from)?;
    let next = ends.pop();
    if ends.is_empty() {
        following.remove(&from);
    }
    next
}

#[cfg(test)]
mod tests {
    use super::super::samples::{ball, tetrahedron};
    use super::*;

    #[test]
    fn a_closed_mesh_has_no_boundary_and_one_without_a_triangle_that_triangle_turned() {
        let mut mesh = tetrahedron();
        assert!(mesh.boundary_loops().is_empty());
        let [a, b, c] = mesh.triangles.remove(2);
        let [BoundaryLoop(found)] = &mesh.boundary_loops()[..] else { panic!("one loop") };
        let first = found.iter().position(|&vertex| vertex == a).expect("it is on the loop");
        let turned = [0, 1, 2].map(|k| found[(first + k) % 3]);
        assert_eq!(turned, [a, b, c], "the missing triangle runs this way");
    }

    #[test]
    fn holes_that_touch_in_a_vertex_are_two_loops() {
        let mut open = ball(12, 8);
        let [a, ..] = open.triangles[open.triangles.len() / 2];
        let around: Vec<[u32; 3]> = open.triangles.iter().copied().filter(|corners| corners.contains(&a)).collect();
        let is_apart = |other: &&[u32; 3]| other.iter().filter(|corner| around[0].contains(corner)).count() == 1;
        let other = *around.iter().find(is_apart).expect("six are around a vertex");
        open.triangles.retain(|corners| *corners != around[0] && *corners != other);
        let loops = open.boundary_loops();
        assert_eq!(loops.iter().map(|BoundaryLoop(vertices)| vertices.len()).collect::<Vec<_>>(), [3, 3]);
        assert!(loops.iter().all(|found| found.length(&open.vertices) > 0.1));
    }

    #[test]
    fn an_edge_of_three_triangles_belongs_to_the_loop_of_a_fin() {
        let mut mesh = tetrahedron();
        let tip = mesh.vertices.len() as u32;
        mesh.vertices.push(DVec3::splat(3.0));
        let [a, b, _] = mesh.triangles[0];
        mesh.triangles.push([a, b, tip]);
        let [BoundaryLoop(found)] = &mesh.boundary_loops()[..] else { panic!("one loop") };
        assert!(found.len() == 3 && [a, b, tip].iter().all(|vertex| found.contains(vertex)));
    }
}
