//! Relevance: the triangles that cannot be part of a result, whatever crosses them, are found.
//!
//! Most of the surface of a sphere in a union of many lies deep inside others. Where a triangle is known to lie in one
//! operand or outside another, and the expression then no longer depends on the operand of the triangle, neither the
//! triangle nor what it crosses need be looked at: on both sides of a line that it would draw the result is the same.

use super::buried::BuriedTriangles;
use super::operand::Operands;
use super::partial_evaluation::PartialEvaluation;
use super::winding::winding;
use crate::numeric::implicit::{ImplicitPoint, PointDefinition};
use crate::solid::union_find::UnionFind;
use rayon::prelude::*;

/// For each triangle, counted over all operands, whether it may matter.
///
/// - `evaluation`: of the expression at a point outside all operands.
/// - `touching`: pairs of triangles of different operands that have a point in common, none of them buried.
pub fn relevant(
    operands: &Operands,
    evaluation: &PartialEvaluation,
    buried: &BuriedTriangles,
    touching: &[[u32; 2]],
) -> Vec<bool> {
    let count = operands.meshes().len();
    if count < 3 {
        return vec![true; operands.triangle_count()];
    }
    // Of each operand, by partner: its triangles that the partner touches.
    let mut touched: Vec<(u32, u32, u32)> = Vec::with_capacity(2 * touching.len());
    for &[a, b] in touching {
        let (i, j) = (operands.of_triangle(a), operands.of_triangle(b));
        touched.push((i, j, a - operands.first_triangle(i)));
        touched.push((j, i, b - operands.first_triangle(j)));
    }
    touched.par_sort_unstable();
    touched.dedup();
    let of_operand = |operand: u32| {
        let begin = touched.partition_point(|t| t.0 < operand);
        let end = touched.partition_point(|t| t.0 <= operand);
        relevant_of(operands, evaluation.clone(), buried, operand, &touched[begin..end])
    };
    let found: Vec<Vec<bool>> = (0..count as u32).into_par_iter().map(of_operand).collect();
    found.concat()
}

/// A triangle, an operand, and whether the triangle lies in it, if that is known.
type Classification = (u32, u32, Option<bool>);

fn relevant_of(
    operands: &Operands,
    mut evaluation: PartialEvaluation,
    buried: &BuriedTriangles,
    operand: u32,
    touched: &[(u32, u32, u32)],
) -> Vec<bool> {
    let mesh = operands.meshes()[operand as usize];
    // By triangle, the partners that it may lie in; it is outside of all others.
    let mut classifications: Vec<Classification> = Vec::new();
    for partner in operands.near(operand) {
        let begin = touched.partition_point(|t| t.1 < partner);
        let end = touched.partition_point(|t| t.1 <= partner);
        let touched = touched[begin..end].iter().map(|t| t.2);
        let emit = |triangle, place| classifications.push((triangle, partner, place));
        known_classifications(operands, buried, operand, partner, touched, emit);
    }
    classifications.par_sort_unstable_by_key(|&(triangle, partner, _)| (triangle, partner));
    evaluation.set(operand, None);
    let first = operands.first_triangle(operand);
    let is_visible = |triangle: u32| !buried.is_buried(first + triangle);
    let depends = evaluation.depends_on(operand);
    let mut answers: Vec<bool> = (0..mesh.triangles.len() as u32).map(|t| depends && is_visible(t)).collect();
    for group in classifications.chunk_by(|a, b| a.0 == b.0) {
        group.iter().for_each(|&(_, partner, place)| evaluation.set(partner, place));
        answers[group[0].0 as usize] = evaluation.depends_on(operand);
        group.iter().for_each(|&(_, partner, _)| evaluation.set(partner, Some(false)));
    }
    answers
}

/// Tells of the triangles of an operand near another that are not buried whether they lie in that; it is not known of
/// those that it touches, or that may touch what is buried of it.
fn known_classifications(
    operands: &Operands,
    buried: &BuriedTriangles,
    operand: u32,
    other: u32,
    touched: impl Iterator<Item = u32>,
    mut emit: impl FnMut(u32, Option<bool>),
) {
    let mesh = operands.meshes()[operand as usize];
    let mut near = Vec::new();
    let mut is_touched = vec![false; mesh.triangles.len()];
    touched.for_each(|triangle| is_touched[triangle as usize] = true);
    buried.visible(operands, operand).touching_boxes(operands.bounds(other), |triangle, bounds| {
        near.push(triangle);
        let is_touched = &mut is_touched[triangle as usize];
        *is_touched = *is_touched || buried.is_beside(bounds, other);
    });
    let mut parts = UnionFind::new(mesh.vertices.len());
    for &triangle in near.iter().filter(|&&triangle| !is_touched[triangle as usize]) {
        let corners = mesh.triangles[triangle as usize];
        parts.join(corners[0], corners[1]);
        parts.join(corners[1], corners[2]);
    }
    let mut inside: Vec<Option<bool>> = vec![None; mesh.vertices.len()];
    for triangle in near {
        if is_touched[triangle as usize] {
            emit(triangle, None);
            continue;
        }
        let root = parts.find(mesh.triangles[triangle as usize][0]);
        let is_inside = *inside[root as usize].get_or_insert_with(|| {
            let point = ImplicitPoint::new(PointDefinition::Given(mesh.vertices[root as usize]));
            winding(operands, other, &point, &mut 0) > 0
        });
        if is_inside {
            emit(triangle, Some(true));
        }
    }
}
