//! Accurate curves in which two surfaces meet.
//!
//! # Method
//! The triangles of both sides meet in polylines, found exactly. Each of their points begins a Newton iteration on both
//! exact surfaces: the planes that touch the two surfaces at the foot points of a point, and a plane across the curve,
//! meet in the next point. Where the curve goes over the border between two surfaces of one side, the third plane
//! touches the third surface instead.
//!
//! Where the surfaces touch, these planes do not determine a point. Such a place is a critical point of the distance
//! between the surfaces, and is found as such: as the root of the gradient of the distance, which is regular there. The
//! second derivatives of the distance tell what it is. If they have one sign, the surfaces touch in a point, or part
//! from it, or cross in a small loop around it; if they differ, two curves cross there, or pass each other closely; if
//! one is 0, the surfaces touch along a curve. Triangles tell nothing about this where the surfaces are less apart than
//! the triangles are from them. Their polylines are cut off around such places, and the exact curves are followed
//! through.
//!
//! # Accuracy
//! Residuals are below [`CurvePrecision::newton`] times the size of the bodies, but not below a few roundings of the
//! coordinates. Across the curve, the error of a position is the residual over the sine of the angle of the surfaces.
//!
//! # Cost
//! Linear in the triangles and in the points, but for the search of pairs of triangles, which is n log n.
//!
//! # Source
//! The classification is that of Markot and Magedson 1989 and Hoschek and Lasser 1993, chapter 12; the rest is ours.

mod critical;
mod file;
mod follow;
mod join;
mod newton;
mod point;
mod polyline;
mod refine;
mod sheet;
mod zone;

pub use file::{csv, obj};
pub use point::{
    Branch, CurvePoint, CurvePrecision, Inaccuracy, Intersection, IntersectionCounts, Mark, SheetCoordinates,
};
pub use sheet::ExactSheet;

use newton::NewtonSolver;
use sheet::PreparedSheet;

/// Finds the curves in which two sheets meet.
///
/// The result has one sequence of bytes for any number of threads.
pub fn intersect(one: ExactSheet<'_>, two: ExactSheet<'_>, precision: &CurvePrecision) -> Intersection {
    let sheets = [PreparedSheet::new(one), PreparedSheet::new(two)];
    let solver = NewtonSolver::new(&sheets, precision);
    let raw = polyline::find(&sheets);
    let zones = zone::find(&solver, &raw);
    let mut result = join::branches(&solver, &raw, &zones);
    refine::refine(&solver, precision, &mut result);
    result
}

#[cfg(test)]
mod tests;
