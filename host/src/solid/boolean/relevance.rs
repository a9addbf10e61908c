//! Which triangles cannot be part of a result, whatever crosses them.
//!
//! Most of the surface of a sphere in a union of many lies deep inside others. Where a triangle is known to lie in one
//! operand or outside another, and the expression then no longer depends on the operand of the triangle, neither the
//! triangle nor what it crosses need be looked at: on both sides of a line that it would draw the result is the same.

use super::Expression;
use super::operand::Operands;
use super::union_find::UnionFind;
use super::winding::winding;
use crate::numeric::implicit::{Definition, Point};
use rayon::prelude::*;

impl Expression {
    /// Whether the set may still depend on an operand.
    ///
    /// - `known`: whether a point is in each operand, as far as that is known.
    pub fn depends_on(&self, operand: usize, known: &[Option<bool>]) -> bool {
        // A child decides if no other child has the value that settles all.
        let among = |all: &[Expression], settled: bool| {
            let mut settling = all.iter().filter(|e| e.value(known) == Some(settled));
            match (settling.next(), settling.next()) {
                (None, _) => all.iter().any(|e| e.depends_on(operand, known)),
                (Some(only), None) => only.depends_on(operand, known),
                _ => false,
            }
        };
        match self {
            Expression::Operand(index) => *index == operand,
            Expression::Union(all) => among(all, true),
            Expression::Intersection(all) => among(all, false),
            Expression::Difference(both) => {
                both[1].value(known) != Some(true) && both[0].depends_on(operand, known)
                    || both[0].value(known) != Some(false) && both[1].depends_on(operand, known)
            }
            Expression::SymmetricDifference(all) => all.iter().any(|e| e.depends_on(operand, known)),
        }
    }

    /// Whether the point is in the set, if that is known.
    fn value(&self, known: &[Option<bool>]) -> Option<bool> {
        let among = |all: &[Expression], settled: bool| {
            let mut value = Some(!settled);
            for e in all {
                match e.value(known) {
                    Some(v) if v == settled => return Some(settled),
                    None => value = None,
                    _ => {}
                }
            }
            value
        };
        match self {
            Expression::Operand(index) => known.get(*index).copied().unwrap_or(Some(false)),
            Expression::Union(all) => among(all, true),
            Expression::Intersection(all) => among(all, false),
            Expression::Difference(both) => match (both[0].value(known), both[1].value(known)) {
                (Some(false), _) | (_, Some(true)) => Some(false),
                (Some(true), Some(false)) => Some(true),
                _ => None,
            },
            Expression::SymmetricDifference(all) => {
                all.iter().try_fold(false, |odd, e| e.value(known).map(|value| odd ^ value))
            }
        }
    }
}

/// For each triangle, counted over all operands, whether it may matter.
///
/// - `touching`: pairs of triangles of different operands that have a point in common.
pub fn relevant(operands: &Operands, expression: &Expression, touching: &[[u32; 2]]) -> Vec<bool> {
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
        relevant_of(operands, expression, operand, &touched[begin..end])
    };
    let found: Vec<Vec<bool>> = (0..count as u32).into_par_iter().map(of_operand).collect();
    found.concat()
}

/// A triangle, an operand, and whether the triangle lies in it, if that is known.
type Place = (u32, u32, Option<bool>);

fn relevant_of(operands: &Operands, expression: &Expression, operand: u32, touched: &[(u32, u32, u32)]) -> Vec<bool> {
    let mesh = operands.meshes()[operand as usize];
    let bounds = operands.sorted(operand).bounds();
    let near = |other: &u32| *other != operand && operands.sorted(*other).bounds().touches(bounds);
    // By triangle, the partners that it may lie in; it is outside of all others.
    let mut places: Vec<Place> = Vec::new();
    for partner in (0..operands.meshes().len() as u32).filter(near) {
        let begin = touched.partition_point(|t| t.1 < partner);
        let end = touched.partition_point(|t| t.1 <= partner);
        let touched = touched[begin..end].iter().map(|t| t.2);
        known_places(operands, operand, partner, touched, |triangle, place| places.push((triangle, partner, place)));
    }
    places.par_sort_unstable_by_key(|&(triangle, partner, _)| (triangle, partner));
    let mut known = vec![Some(false); operands.meshes().len()];
    known[operand as usize] = None;
    let mut answers = vec![expression.depends_on(operand as usize, &known); mesh.triangles.len()];
    let mut last: (&[Place], bool) = (&[], answers.first().copied().unwrap_or(true));
    for group in places.chunk_by(|a, b| a.0 == b.0) {
        // Neighbours are mostly alike.
        if !group.iter().map(|&(_, partner, place)| (partner, place)).eq(last.0.iter().map(|t| (t.1, t.2))) {
            group.iter().for_each(|&(_, partner, place)| known[partner as usize] = place);
            last = (group, expression.depends_on(operand as usize, &known));
            group.iter().for_each(|&(_, partner, _)| known[partner as usize] = Some(false));
        }
        answers[group[0].0 as usize] = last.1;
    }
    answers
}

/// Tells of the triangles of an operand near another whether they lie in that; it is not known of those that it touches.
fn known_places(
    operands: &Operands,
    operand: u32,
    other: u32,
    touched: impl Iterator<Item = u32>,
    mut tell: impl FnMut(u32, Option<bool>),
) {
    let mesh = operands.meshes()[operand as usize];
    let mut near = Vec::new();
    operands.sorted(operand).touching(operands.sorted(other).bounds(), |triangle| near.push(triangle));
    let mut is_touched = vec![false; mesh.triangles.len()];
    touched.for_each(|triangle| is_touched[triangle as usize] = true);
    let mut parts = UnionFind::new(mesh.vertices.len());
    for &triangle in near.iter().filter(|&&triangle| !is_touched[triangle as usize]) {
        let corners = mesh.triangles[triangle as usize];
        parts.join(corners[0], corners[1]);
        parts.join(corners[1], corners[2]);
    }
    let mut inside: Vec<Option<bool>> = vec![None; mesh.vertices.len()];
    for triangle in near {
        if is_touched[triangle as usize] {
            tell(triangle, None);
            continue;
        }
        let root = parts.find(mesh.triangles[triangle as usize][0]);
        let is_inside = *inside[root as usize].get_or_insert_with(|| {
            let point = Point::new(Definition::Given(mesh.vertices[root as usize]));
            winding(operands, other, &point, &mut 0) > 0
        });
        if is_inside {
            tell(triangle, Some(true));
        }
    }
}
