//! The solids of an operation, with their vertices and triangles numbered consecutively.

use super::contact::ConvexFace;
use super::quads::{NONE, ring};
use crate::mesh::Mesh;
use crate::numeric::bounds::Bounds;
use crate::octree::TriangleBvh;
use glam::DVec3;
use rayon::prelude::*;

/// An operand.
#[derive(Clone, Copy)]
pub struct Operand<'a> {
    /// Its surface.
    pub mesh: &'a Mesh,
    /// The triangles of it by location.
    pub sorted: &'a TriangleBvh,
    /// For each triangle its quad partner, with which it makes one face, or [`NONE`]; empty if all are on their own.
    pub quad_partners: &'a [u32],
    /// Pairs of its triangles that overlap, the lower first; none if its surface is simple.
    pub overlaps: &'a [[u32; 2]],
}

impl Operand<'_> {
    /// The quad partner of a triangle, with which it makes one face.
    fn quad_partner(&self, triangle: u32) -> Option<u32> {
        self.quad_partners.get(triangle as usize).copied().filter(|partner| *partner != NONE)
    }

    /// The lower triangle of the face that a triangle belongs to.
    fn first_half(&self, triangle: u32) -> u32 {
        self.quad_partner(triangle).map_or(triangle, |partner| partner.min(triangle))
    }
}

/// The operands.
pub struct Operands<'a> {
    /// Whether their surfaces bound them simply: their winding number is 1 or 0 at any point off them. If not, contacts
    /// within each are looked for too.
    pub are_simple: bool,
    meshes: Vec<&'a Mesh>,
    operands: Vec<Operand<'a>>,
    bounds: Vec<Bounds>,
    first_vertex: Vec<u32>,
    first_triangle: Vec<u32>,
}

impl<'a> Operands<'a> {
    /// Numbers the vertices and triangles of some meshes consecutively.
    ///
    /// - `are_simple`: whether their surfaces are known to bound them simply.
    pub fn new(operands: Vec<Operand<'a>>, are_simple: bool) -> Operands<'a> {
        let meshes: Vec<&Mesh> = operands.iter().map(|operand| operand.mesh).collect();
        let bounds = operands.iter().map(|operand| operand.sorted.bounds()).collect();
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
        Operands { are_simple, meshes, operands, bounds, first_vertex, first_triangle }
    }

    /// The meshes.
    pub fn meshes(&self) -> &[&'a Mesh] {
        &self.meshes
    }

    /// The triangles of an operand by location.
    pub fn sorted(&self, operand: u32) -> &TriangleBvh {
        self.operands[operand as usize].sorted
    }

    /// The box of an operand.
    #[inline]
    pub fn bounds(&self, operand: u32) -> Bounds {
        self.bounds[operand as usize]
    }

    /// The largest coordinate of all operands.
    pub fn largest(&self) -> f64 {
        let sizes = self.bounds.iter().map(|b| b.min.abs().max(b.max.abs()).max_element());
        sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
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

    /// The face that a triangle is, or is one half of.
    pub fn face(&self, id: u32, triangle: u32) -> Option<ConvexFace> {
        let operand = self.of_triangle(triangle);
        let mesh = self.meshes[operand as usize];
        let triangle = triangle - self.first_triangle(operand);
        let numbered = |vertex: u32| vertex + self.first_vertex(operand);
        let at = |vertex: u32| mesh.vertices[vertex as usize];
        let partner = self.operands[operand as usize].quad_partner(triangle);
        if let Some([a, b, c, d]) = partner.and_then(|partner| ring(mesh, triangle, partner)) {
            let face = ConvexFace::new(id, [a, b, c].map(numbered), [a, b, c].map(at))?;
            return Some(face.with(numbered(d), at(d)));
        }
        ConvexFace::new(id, mesh.triangles[triangle as usize].map(numbered), mesh.corners(triangle as usize))
    }

    /// The triangles of the face that a triangle belongs to, the lower first.
    #[inline]
    pub fn halves(&self, triangle: u32) -> impl Iterator<Item = u32> + use<> {
        let operand = self.of_triangle(triangle);
        let first = self.first_triangle(operand);
        let partner = self.operands[operand as usize].quad_partner(triangle - first).map(|partner| partner + first);
        let (low, high) = match partner {
            Some(partner) if partner < triangle => (partner, Some(triangle)),
            _ => (triangle, partner),
        };
        std::iter::once(low).chain(high)
    }

    /// The other operands whose boxes touch that of an operand, in order.
    pub fn near(&self, operand: u32) -> impl Iterator<Item = u32> {
        let bounds = self.bounds(operand);
        let others = (0..self.meshes.len() as u32).filter(move |other| *other != operand);
        others.filter(move |other| self.bounds(*other).touches(bounds))
    }

    /// Pairs of faces of different operands, by their lower triangles, of which the boxes of triangles touch.
    ///
    /// - `sorted`: the triangles of an operand that are looked at.
    pub fn pairs<'b>(&self, sorted: impl Fn(u32) -> &'b TriangleBvh + Sync) -> Vec<[u32; 2]> {
        let count = self.meshes.len() as u32;
        let pairs_of = |i: u32| self.near(i).filter(move |j| *j > i).map(move |j| (i, j));
        let tasks: Vec<(u32, u32)> = (0..count).flat_map(pairs_of).collect();
        let found: Vec<Vec<[u32; 2]>> = tasks
            .into_par_iter()
            .map(|(i, j)| {
                let mut pairs = sorted(i).pairs(sorted(j));
                let [one, two] = [i, j].map(|k| &self.operands[k as usize]);
                if !(one.quad_partners.is_empty() && two.quad_partners.is_empty()) {
                    pairs.iter_mut().for_each(|pair| *pair = [one.first_half(pair[0]), two.first_half(pair[1])]);
                    pairs.sort_unstable();
                    pairs.dedup();
                }
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
        self.operands[operand as usize].overlaps.iter().map(|pair| pair.map(|t| t + first)).collect()
    }
}
