//! The solids of an operation, with their vertices and triangles counted through.

use super::contact::overlap;
use crate::mesh::Mesh;
use crate::octree::Sorted;
use glam::DVec3;
use rayon::prelude::*;

/// The operands.
pub struct Operands<'a> {
    /// Whether their surfaces bound them simply: they wind once or not at all around any point off them. If not, contacts
    /// within each are looked for too.
    pub are_simple: bool,
    meshes: Vec<&'a Mesh>,
    sorted: Vec<&'a Sorted>,
    first_vertex: Vec<u32>,
    first_triangle: Vec<u32>,
}

impl<'a> Operands<'a> {
    /// Counts through the vertices and triangles of some meshes.
    ///
    /// - `meshes`: with the triangles of each by place.
    /// - `are_simple`: whether their surfaces are known to bound them simply.
    pub fn new(meshes: Vec<(&'a Mesh, &'a Sorted)>, are_simple: bool) -> Operands<'a> {
        let (meshes, sorted): (Vec<&Mesh>, Vec<&Sorted>) = meshes.into_iter().unzip();
        let starts = |count: fn(&Mesh) -> usize| {
            let mut sum = 0;
            let mut starts = vec![0];
            for mesh in &meshes {
                sum += count(mesh) as u32;
                starts.push(sum);
            }
            starts
        };
        let first_vertex = starts(|mesh| mesh.vertices.len());
        let first_triangle = starts(|mesh| mesh.triangles.len());
        Operands { are_simple, meshes, sorted, first_vertex, first_triangle }
    }

    /// The meshes.
    pub fn meshes(&self) -> &[&'a Mesh] {
        &self.meshes
    }

    /// The triangles of an operand by place.
    pub fn sorted(&self, operand: u32) -> &Sorted {
        self.sorted[operand as usize]
    }

    /// Number of all vertices.
    pub fn vertex_count(&self) -> usize {
        self.first_vertex.last().map_or(0, |&n| n as usize)
    }

    /// Number of all triangles.
    pub fn triangle_count(&self) -> usize {
        self.first_triangle.last().map_or(0, |&n| n as usize)
    }

    /// Number of the first vertex of an operand.
    pub fn first_vertex(&self, operand: u32) -> u32 {
        self.first_vertex[operand as usize]
    }

    /// Number of the first triangle of an operand.
    pub fn first_triangle(&self, operand: u32) -> u32 {
        self.first_triangle[operand as usize]
    }

    /// The operand of a triangle.
    pub fn of_triangle(&self, triangle: u32) -> u32 {
        self.first_triangle.partition_point(|&first| first <= triangle) as u32 - 1
    }

    /// Vertices and corners of a triangle.
    pub fn corners(&self, triangle: u32) -> ([u32; 3], [DVec3; 3]) {
        let operand = self.of_triangle(triangle);
        let mesh = self.meshes[operand as usize];
        let local = mesh.triangles[(triangle - self.first_triangle(operand)) as usize];
        (local.map(|v| v + self.first_vertex(operand)), local.map(|v| mesh.vertices[v as usize]))
    }

    /// Pairs of triangles of different operands whose boxes touch.
    pub fn pairs(&self) -> Vec<[u32; 2]> {
        let count = self.meshes.len() as u32;
        let touching = |&(i, j): &(u32, u32)| self.sorted(i).bounds().touches(self.sorted(j).bounds());
        let tasks: Vec<(u32, u32)> =
            (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j))).filter(touching).collect();
        let found: Vec<Vec<[u32; 2]>> = tasks
            .into_par_iter()
            .map(|(i, j)| {
                let mut pairs = self.sorted(i).pairs(self.sorted(j));
                let first = [self.first_triangle(i), self.first_triangle(j)];
                pairs.iter_mut().for_each(|pair| *pair = [pair[0] + first[0], pair[1] + first[1]]);
                pairs
            })
            .collect();
        found.concat()
    }

    /// Pairs of triangles of one operand, the lower first, that have more in common than corners and the edges between.
    pub fn overlaps(&self, operand: u32) -> Vec<[u32; 2]> {
        let first = self.first_triangle(operand);
        let pairs = overlaps(self.meshes[operand as usize], self.sorted(operand));
        pairs.into_iter().map(|pair| pair.map(|t| t + first)).collect()
    }
}

/// Pairs of triangles of a mesh, the lower first, that have more in common than corners and the edges between.
///
/// - `sorted`: the triangles by place.
pub fn overlaps(mesh: &Mesh, sorted: &Sorted) -> Vec<[u32; 2]> {
    let corners = |triangle: u32| mesh.corners(triangle as usize);
    sorted.pairs_within(|a, b| overlap(corners(a), corners(b)))
}
