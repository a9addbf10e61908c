//! The mesh of a result.

use super::arrangement::{Arrangement, Counts};
use super::facets::Facet;
use super::operand::Operands;
use super::parts::{Fate, Parts};
use crate::mesh::Mesh;
use std::collections::HashMap;

/// What an operation gives.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Its border.
    pub mesh: Mesh,
    /// For each triangle the operand and the triangle of that operand that it is part of.
    pub sources: Vec<[u32; 2]>,
    /// Work done.
    pub counts: Counts,
}

/// Collects what is kept; points are rounded here.
pub fn assemble(
    operands: &Operands,
    arrangement: &Arrangement,
    facets: &[Facet],
    is_divided: &[bool],
    parts: &Parts,
    counts: Counts,
) -> Outcome {
    let mut outcome = Outcome { counts, ..Outcome::default() };
    let mut of_vertex = vec![u32::MAX; operands.vertex_count()];
    for (operand, mesh) in operands.meshes().iter().enumerate() {
        let operand = operand as u32;
        let [first_vertex, first] = [operands.first_vertex(operand), operands.first_triangle(operand)];
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            if is_divided[first as usize + index] {
                continue;
            }
            let fate = parts.of_vertex(triangle[0] + first_vertex);
            if fate == Fate::Dropped {
                continue;
            }
            let corners = triangle.map(|vertex| {
                let number = &mut of_vertex[(vertex + first_vertex) as usize];
                if *number == u32::MAX {
                    *number = outcome.mesh.vertices.len() as u32;
                    outcome.mesh.vertices.push(mesh.vertices[vertex as usize]);
                }
                *number
            });
            outcome.push(corners, fate, [operand, index as u32]);
        }
    }
    let mut of_point: HashMap<u32, u32> = HashMap::new();
    for (index, facet) in facets.iter().enumerate() {
        let fate = parts.of_facet(index);
        if fate == Fate::Dropped {
            continue;
        }
        let corners = facet.corners.map(|point| {
            let number = match arrangement.vertices[point as usize] {
                Some(vertex) => &mut of_vertex[vertex as usize],
                None => of_point.entry(point).or_insert(u32::MAX),
            };
            if *number == u32::MAX {
                *number = outcome.mesh.vertices.len() as u32;
                outcome.mesh.vertices.push(arrangement.points[point as usize].near());
            }
            *number
        });
        // Of faces that coincide the first that looks the right way gives its surface.
        let wanted = fate == Fate::Kept;
        let cover = facet.cover.iter().find(|c| c.is_along == wanted).or(facet.cover.first());
        let triangle = cover.map_or(0, |c| arrangement.triangles[c.face as usize]);
        let operand = operands.of_triangle(triangle);
        outcome.push(corners, fate, [operand, triangle - operands.first_triangle(operand)]);
    }
    outcome
}

impl Outcome {
    fn push(&mut self, [a, b, c]: [u32; 3], fate: Fate, source: [u32; 2]) {
        self.mesh.triangles.push(if fate == Fate::Turned { [a, c, b] } else { [a, b, c] });
        self.sources.push(source);
    }
}
