//! An expression that is evaluated once, whether or not its result crosses itself when it is rounded.

use super::arrangement::Arrangement;
use super::expression::Expression;
use super::operand::Operands;
use super::parts::Parts;
use super::result::Outcome;
use super::rounding::NewTriangles;
use super::{facets, result};

/// What is known when an expression was evaluated once.
pub struct Evaluation {
    /// What comes out, before it is freed of self-intersections.
    pub outcome: Outcome,
    /// Its new triangles.
    pub new: NewTriangles,
    /// Whether rounding made the result cross itself, as far as could be seen.
    pub self_intersects: bool,
    /// Whether all parts of the surfaces are borders of the result.
    pub is_unchanged: bool,
    /// An improper winding number of an operand that is not simple, and where it is.
    pub improper_winding: Option<(i32, glam::DVec3)>,
}

/// Evaluates an expression once.
pub fn evaluate_once(operands: &Operands, expression: &Expression) -> Evaluation {
    let mut arrangement = Arrangement::new(operands, expression);
    let facets = facets::divide(&arrangement);
    // Triangles that stay whole, if they stay.
    let mut is_whole = std::mem::take(&mut arrangement.is_relevant);
    for triangle in arrangement.touched().flat_map(|face| operands.halves(arrangement.triangles[face as usize])) {
        is_whole[triangle as usize] = false;
    }
    let parts = Parts::new(operands, &arrangement, &facets, &is_whole, |inside| expression.contains(inside));
    let mut counts = arrangement.counts;
    counts.divided = arrangement.touched().count() as u64;
    counts.facets = facets.len() as u64;
    (counts.parts, counts.rays) = (parts.count, parts.rays);
    let (outcome, made, must_settle) = result::assemble(operands, &arrangement, &facets, &is_whole, &parts, counts);
    // Of those that lie on each other, one is kept.
    let is_all_kept = parts.keep_everything() && facets.iter().all(|facet| facet.others.is_empty());
    Evaluation {
        outcome,
        new: made,
        self_intersects: must_settle,
        is_unchanged: is_all_kept,
        improper_winding: parts.improper_winding,
    }
}
