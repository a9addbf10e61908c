//! Boolean operations on solids, exact in every decision.
//!
//! # Method
//! Two triangles that make a convex quadrilateral in one plane count as one. Those of different operands that may touch
//! are found by their locational codes. What they have in common is decided by signs of determinants that are never
//! wrong; points where edges pierce faces are kept as what defines them and not as rounded numbers. Touched faces are
//! divided along all that crosses them. The surfaces fall into parts that nothing crosses; a ray from each part tells
//! which operands are in front of it and behind it, and a part is kept if the result is on one side only. Where divided
//! faces lie beside each other in one plane, points that bound nothing are left out again. Only then are the points
//! rounded. Where that makes the surface cross itself, it is freed of self-intersections (`simple`) or the operation is
//! refused. Of the rounded points, those that bound nothing but for a few roundings are left out too (`collapse`).
//!
//! All operands of an expression are worked on at once: no intermediate result is made or rounded. Where there are
//! many, triangles that are buried deep inside others are found by interior grids first, and left out.
//!
//! # Numbers
//! Exact is what lies within 2^-203 of the largest coordinate of all operands, whatever that is; smaller coordinates
//! are rounded to 2^-256 of it. Models of any size are worked on as ones of about the size of 1.
//!
//! # Semantics
//! Results are regularised: the closure of the interior of the set. Where surfaces coincide, what counts is whether the
//! result lies on one side of them only; so two cubes with a common face unite without it, and a solid less itself is
//! empty.
//!
//! # Cost
//! n log n in the triangles near other operands, linear in the others.

mod expression;
mod contact;
mod overlap;
mod overlaps;
mod nudging;
mod half_edges;
mod quads;
mod operand;
mod faces;
mod triangulation;
mod winding;
mod partial_evaluation;
mod interior_grid;
mod buried;
mod relevance;
mod arrangement;
mod facets;
mod filling;
mod parts;
mod merge;
mod rounding;
mod result;
mod fan;
mod collapse;
mod snapping;
mod single_evaluation;
mod simple;
mod lattice;
mod evaluation;

pub use arrangement::Counts;
pub(crate) use contact::{Contact, ConvexFace, PointKey};
pub(super) use evaluation::evaluate;
pub use expression::Expression;
pub(super) use filling::filled;
pub(super) use lattice::Lattice;
pub(super) use operand::Operand;
pub(super) use overlap::{NamedTriangle, overlap};
pub(super) use overlaps::overlapping_up_to;
pub(super) use quads::quad_partners;
pub use result::Outcome;
pub(super) use simple::{Resolution, resolve};
pub(super) use winding::passes;
