//! The flat faces of a solid as polygons, and the edges between them.

use std::collections::HashMap;

use glam::DVec3;

use super::error::RoundingError;
use crate::mesh::Mesh;
use crate::solid::union_find::UnionFind;

/// The sine of the angle below which triangles lie in one plane: what is left of a plane after rounding.
const FLAT: f64 = 1e-9;

/// A face.
pub struct PolygonFace {
    /// Outwards, unit length.
    pub normal: DVec3,
    /// Whether it is a part of a curved surface.
    pub is_curved: bool,
    /// Its borders: edges, each followed from its corner to the next, with the face on the left.
    pub loops: Vec<Vec<HalfEdge>>,
}

/// An edge as a part of the border of a face.
#[derive(Clone, Copy, Debug)]
pub struct HalfEdge {
    pub edge: usize,
    /// The vertices where it begins and ends.
    pub ends: [u32; 2],
}

/// An edge between two faces.
pub struct SolidEdge {
    /// Its vertices, in the direction in which the first face has it.
    pub ends: [u32; 2],
    pub faces: [usize; 2],
}

/// Faces and edges.
pub struct PolygonFaces {
    pub faces: Vec<PolygonFace>,
    pub edges: Vec<SolidEdge>,
}

impl PolygonFaces {
    /// Finds those of a closed mesh whose triangles have normals at their corners.
    pub fn of(mesh: &Mesh) -> Result<PolygonFaces, RoundingError> {
        let count = mesh.triangles.len();
        let flat = |t: usize| {
            let [a, b, c] = mesh.corner_normals[t];
            (a.distance(b).max(a.distance(c)) < FLAT).then_some(a)
        };
        let sides = |t: usize| [0, 1, 2].map(|k| [mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]]);
        let of_side: HashMap<[u32; 2], usize> = (0..count).flat_map(|t| sides(t).map(|side| (side, t))).collect();
        let mut joined = UnionFind::new(count);
        for t in 0..count {
            for [from, to] in sides(t) {
                let Some(&other) = of_side.get(&[to, from]) else { continue };
                if let (Some(one), Some(two)) = (flat(t), flat(other))
                    && one.distance(two) < FLAT
                {
                    joined.join(t as u32, other as u32);
                }
            }
        }
        let mut number = HashMap::new();
        let mut faces = Vec::new();
        let mut next: Vec<HashMap<u32, u32>> = Vec::new();
        let face_of: Vec<usize> = (0..count)
            .map(|t| {
                *number.entry(joined.root(t as u32)).or_insert_with(|| {
                    let normal = flat(t).or(mesh.face_normal(t)).unwrap_or(DVec3::ZERO);
                    faces.push(PolygonFace { normal, is_curved: flat(t).is_none(), loops: Vec::new() });
                    next.push(HashMap::new());
                    faces.len() - 1
                })
            })
            .collect();
        // Which faces are around a vertex.
        let mut around: HashMap<u32, Vec<usize>> = HashMap::new();
        for (t, face) in face_of.iter().enumerate() {
            for side in sides(t) {
                let beyond = of_side.get(&[side[1], side[0]]).map(|&other| face_of[other]);
                if beyond == Some(*face) {
                    continue;
                }
                if next[*face].insert(side[0], side[1]).is_some() {
                    return Err(RoundingError::Touching { at: mesh.vertices[side[0] as usize] });
                }
                around.entry(side[0]).or_default().push(*face);
            }
        }
        // A vertex of two faces lies within an edge.
        let is_corner = |vertex: u32| around[&vertex].len() > 2;
        let mut result = PolygonFaces { faces, edges: Vec::new() };
        let mut known: HashMap<[u32; 2], usize> = HashMap::new();
        for (face, next) in next.iter().enumerate() {
            for run in loops(next) {
                let corners: Vec<u32> = run.into_iter().filter(|vertex| is_corner(*vertex)).collect();
                if corners.len() < 2 {
                    return Err(RoundingError::Touching { at: DVec3::ZERO });
                }
                let ends = (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]);
                let sides = ends.map(|ends| HalfEdge { edge: result.edge(face, ends, &mut known), ends }).collect();
                result.faces[face].loops.push(sides);
            }
        }
        Ok(result)
    }

    fn edge(&mut self, face: usize, ends: [u32; 2], known: &mut HashMap<[u32; 2], usize>) -> usize {
        if let Some(&edge) = known.get(&[ends[1], ends[0]]) {
            self.edges[edge].faces[1] = face;
            return edge;
        }
        known.insert(ends, self.edges.len());
        self.edges.push(SolidEdge { ends, faces: [face; 2] });
        self.edges.len() - 1
    }

    /// By how much an edge turns, radians, positive where the solid is convex.
    pub fn dihedral_turn(&self, edge: usize, points: &[DVec3]) -> f64 {
        let SolidEdge { ends, faces } = &self.edges[edge];
        let [n, m] = faces.map(|face| self.faces[face].normal);
        let along = points[ends[1] as usize] - points[ends[0] as usize];
        n.cross(m).dot(along).signum() * n.angle_between(m)
    }
}

/// Closed runs of vertices, each from its lowest.
fn loops(next: &HashMap<u32, u32>) -> Vec<Vec<u32>> {
    let mut starts: Vec<u32> = next.keys().copied().collect();
    starts.sort_unstable();
    let mut seen = std::collections::HashSet::new();
    let mut loops = Vec::new();
    for start in starts {
        let mut run = Vec::new();
        let mut here = start;
        while seen.insert(here) {
            run.push(here);
            here = next.get(&here).copied().unwrap_or(start);
        }
        if !run.is_empty() {
            loops.push(run);
        }
    }
    loops
}

/// The distance of a point from a line between two others.
pub fn to_segment([from, to]: [DVec3; 2], at: DVec3) -> f64 {
    let along = to - from;
    let part = ((at - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    at.distance(from + along * part)
}
