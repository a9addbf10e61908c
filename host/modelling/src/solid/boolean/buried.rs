//! Triangles that lie so deep in other operands that they need not even be compared with others.
//!
//! In a union of many solids most of the surface of each lies deep inside others. A triangle in the [`InteriorGrid`] of
//! operands is known to lie in these; where the expression then no longer depends on its own operand, it is buried.
//! What would cross it draws no line that matters: on both sides of that the result is the same.

use super::interior_grid::InteriorGrid;
use super::operand::Operands;
use super::partial_evaluation::PartialEvaluation;
use crate::numeric::bounds::Bounds;
use crate::octree::TriangleBvh;
use rayon::prelude::*;

/// The triangles that lie deep inside other operands.
#[derive(Default)]
pub struct BuriedTriangles {
    /// For each triangle, counted over all operands; empty if none is.
    is_buried: Vec<bool>,
    /// Of each operand with buried triangles, the others by location; empty if there is none.
    visible: Vec<Option<TriangleBvh>>,
    /// Of each operand, its cells, those marked that its buried triangles touch.
    interiors: Vec<Option<InteriorGrid>>,
}

impl BuriedTriangles {
    /// Finds buried triangles. With two operands there are none.
    ///
    /// - `evaluation`: of the expression at a point outside all operands.
    pub fn of(operands: &Operands, evaluation: &PartialEvaluation) -> BuriedTriangles {
        let count = operands.meshes().len() as u32;
        if count < 3 {
            return BuriedTriangles::default();
        }
        // What lies deep inside the only neighbour touches nothing anyway.
        let has_two: Vec<bool> = (0..count).map(|operand| operands.near(operand).nth(1).is_some()).collect();
        let is_asked =
            |operand: u32| has_two[operand as usize] || operands.near(operand).any(|other| has_two[other as usize]);
        let core = |operand: u32| is_asked(operand).then(|| InteriorGrid::of(operands, operand)).flatten();
        let mut interiors: Vec<Option<InteriorGrid>> = (0..count).into_par_iter().map(core).collect();
        let of_operand = |operand: u32| match has_two[operand as usize] {
            true => buried_of(operands, &interiors, evaluation.clone(), operand),
            false => Vec::new(),
        };
        let found: Vec<Vec<u32>> = (0..count).into_par_iter().map(of_operand).collect();
        let mut is_buried = vec![false; operands.triangle_count()];
        for (operand, found) in (0..count).zip(&found) {
            found.iter().for_each(|t| is_buried[(operands.first_triangle(operand) + t) as usize] = true);
        }
        let visible = |(operand, found): (u32, &Vec<u32>)| {
            let first = operands.first_triangle(operand);
            let is_seen = |triangle| !is_buried[(first + triangle) as usize];
            (!found.is_empty()).then(|| operands.sorted(operand).only(is_seen))
        };
        let visible = (0..count).into_par_iter().zip(&found).map(visible).collect();
        interiors.par_iter_mut().zip(found).enumerate().for_each(|(operand, (core, found))| {
            let mesh = operands.meshes()[operand];
            core.iter_mut()
                .for_each(|core| found.iter().for_each(|&t| core.mark(Bounds::of(mesh.corners(t as usize)))));
        });
        BuriedTriangles { is_buried, visible, interiors }
    }

    /// Whether a triangle, counted over all operands, is buried.
    pub fn is_buried(&self, triangle: u32) -> bool {
        self.is_buried.get(triangle as usize).is_some_and(|is_buried| *is_buried)
    }

    /// The triangles of an operand that are not buried, by location.
    pub fn visible<'a>(&'a self, operands: &'a Operands, operand: u32) -> &'a TriangleBvh {
        let visible = self.visible.get(operand as usize).and_then(|visible| visible.as_ref());
        visible.unwrap_or_else(|| operands.sorted(operand))
    }

    /// Whether a box may touch a buried triangle of an operand.
    pub fn is_beside(&self, bounds: Bounds, operand: u32) -> bool {
        let core = self.interiors.get(operand as usize).and_then(|core| core.as_ref());
        core.is_some_and(|core| core.is_marked(bounds))
    }
}

/// The buried triangles of an operand. Two that make one face are both buried, or neither.
fn buried_of(
    operands: &Operands,
    interiors: &[Option<InteriorGrid>],
    mut evaluation: PartialEvaluation,
    operand: u32,
) -> Vec<u32> {
    // Without cells of its own it could not be told who is beside them.
    if interiors[operand as usize].is_none() {
        return Vec::new();
    }
    let mesh = operands.meshes()[operand as usize];
    let sorted = operands.sorted(operand);
    evaluation.set(operand, None);
    // A triangle, and an operand that holds it.
    let mut held: Vec<(u32, u32)> = Vec::new();
    for other in operands.near(operand) {
        evaluation.set(other, None);
        let Some(core) = interiors[other as usize].as_ref().filter(|core| !core.bounds().is_empty()) else { continue };
        sorted.touching_boxes(core.bounds(), |triangle, bounds| {
            if core.contains(bounds) {
                held.push((triangle, other));
            }
        });
    }
    held.sort_unstable();
    let mut is_buried = vec![false; mesh.triangles.len()];
    for group in held.chunk_by(|a, b| a.0 == b.0) {
        group.iter().for_each(|&(_, other)| evaluation.set(other, Some(true)));
        is_buried[group[0].0 as usize] = !evaluation.depends_on(operand);
        group.iter().for_each(|&(_, other)| evaluation.set(other, None));
    }
    let first = operands.first_triangle(operand);
    let whole = |triangle: &u32| operands.halves(first + triangle).all(|half| is_buried[(half - first) as usize]);
    (0..mesh.triangles.len() as u32).filter(|&triangle| is_buried[triangle as usize]).filter(whole).collect()
}
