//! Boolean operations on solids, exact in every decision.
//!
//! # Method
//! Two triangles that make a convex quadrilateral in one plane count as one. Those of different operands that may touch
//! are found by their locational codes. What they have in common is decided by signs of determinants that are never wrong;
//! points where edges pierce faces are kept as what defines them and not as rounded numbers. Touched faces are divided
//! along all that crosses them. The surfaces fall into parts that nothing crosses; a ray from each part tells which
//! operands are in front of it and behind it, and a part is kept if the result is on one side only. Where divided faces
//! lie beside each other in one plane, points that bound nothing are left out again. Only then are the points rounded.
//! Where that makes the surface cross itself, it is made simple again (`simple`) or the operation is refused. Of the
//! rounded points, those that bound nothing but for a few roundings are left out too (`collapse`).
//!
//! All operands of an expression are worked on at once: no intermediate result is made or rounded. Where there are many,
//! what lies deep inside others is found by cells first, and left out.
//!
//! # Numbers
//! Exact is what lies within 2^-203 of the largest coordinate of all operands, whatever that is; smaller coordinates are
//! rounded to 2^-256 of it. Models of any size are worked on as ones of about the size of 1.
//!
//! # Semantics
//! Results are regularised: the closure of the interior of the set. Where surfaces coincide, what counts is whether the
//! result lies on one side of them only; so two cubes with a common face unite without it, and a solid less itself is empty.
//!
//! # Cost
//! n log n in the triangles near other operands, linear in the others.

mod arrangement;
mod burial;
mod collapse;
mod contact;
mod core;
mod faces;
mod facets;
mod fan;
mod filling;
mod lattice;
mod merge;
mod nudging;
mod operand;
mod overlap;
mod overlaps;
mod parts;
mod quads;
mod relevance;
mod result;
mod rounding;
mod sides;
mod simple;
mod snapping;
mod standing;
mod triangulation;
mod union_find;
mod winding;

pub use arrangement::Counts;
pub(crate) use contact::{Contact, Face, Key};
pub(super) use filling::filled;
pub(super) use lattice::Lattice;
pub(super) use operand::Operand;
pub(super) use overlap::{Tile, overlap};
pub(super) use overlaps::overlapping_up_to;
pub(super) use quads::mates;
pub use result::Outcome;
pub(super) use simple::{Resolution, resolve};
pub(super) use union_find::UnionFind;
pub(super) use winding::passes;

use super::SolidError;
use arrangement::Arrangement;
use collapse::{all_made, collapse};
use operand::Operands;
use parts::Parts;
use rounding::Made;

/// A set made of operands.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// An operand, by its place.
    Operand(usize),
    /// What is in any of these; nothing if there are none.
    Union(Vec<Expression>),
    /// What is in all of these; everything if there are none.
    Intersection(Vec<Expression>),
    /// What is in the first and not in the second.
    Difference(Box<[Expression; 2]>),
    /// What is in an odd number of these.
    SymmetricDifference(Vec<Expression>),
}

impl Expression {
    /// The first operand less the second.
    pub fn difference(one: Expression, two: Expression) -> Expression {
        Expression::Difference(Box::new([one, two]))
    }

    /// Whether a point is in the set.
    ///
    /// - `inside`: whether it is in each operand; an operand that is not there has no points.
    pub fn contains(&self, inside: &[bool]) -> bool {
        match self {
            Expression::Operand(index) => inside.get(*index).copied().unwrap_or(false),
            Expression::Union(all) => all.iter().any(|e| e.contains(inside)),
            Expression::Intersection(all) => all.iter().all(|e| e.contains(inside)),
            Expression::Difference(both) => both[0].contains(inside) && !both[1].contains(inside),
            Expression::SymmetricDifference(all) => all.iter().filter(|e| e.contains(inside)).count() % 2 == 1,
        }
    }
}

/// Evaluates an expression over meshes that bound solids simply.
///
/// # Errors
/// [`SolidError::Unsettled`].
pub(super) fn evaluate(solids: Vec<Operand<'_>>, expression: &Expression) -> Result<Outcome, SolidError> {
    match Lattice::of(solids.iter().map(|solid| solid.mesh)) {
        Some(lattice) => lattice.evaluate(&solids, expression),
        None => evaluate_on_lattice(solids, expression),
    }
}

/// Evaluates an expression over meshes with coordinates that predicates can be exact with.
fn evaluate_on_lattice(solids: Vec<Operand<'_>>, expression: &Expression) -> Result<Outcome, SolidError> {
    let operands = Operands::new(solids, true);
    let Work { outcome, made, must_settle, .. } = work(&operands, expression);
    let (mut outcome, made) = if must_settle {
        let outcome = simple::settled(outcome)?;
        let made = all_made(&operands, &outcome);
        (outcome, made)
    } else {
        (outcome, made)
    };
    collapse(&operands, &mut outcome, &made);
    Ok(outcome)
}

/// What is known when an expression was evaluated once.
struct Work {
    outcome: Outcome,
    /// What of it was made.
    made: Made,
    /// Whether rounding made the result cross itself, as far as could be seen.
    must_settle: bool,
    /// Whether all parts of the surfaces are borders of the result.
    is_all_kept: bool,
    /// Where an operand that is not simple winds oddly, and how often.
    odd: Option<(i32, glam::DVec3)>,
}

/// Evaluates an expression once.
fn work(operands: &Operands, expression: &Expression) -> Work {
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
    let is_all_kept = parts.are_all_kept() && facets.iter().all(|facet| facet.others.is_empty());
    Work { outcome, made, must_settle, is_all_kept, odd: parts.odd }
}
