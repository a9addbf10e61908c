//! Holes in nets of bicubic patches, filled smoothly: by one patch of N sides, or by N patches that meet at a vertex.
//!
//! Both take the curves around the hole and the derivatives across them, and share tangent planes with what is outside,
//! and with each other, exactly. [`n_sided_patch`] is one function over a regular polygon; [`patches_around_vertex`]
//! makes four-sided patches, two sides of the hole to each.

mod around_vertex;
mod jet;
mod n_sided;
mod ribbon;
#[cfg(test)]
mod tests;

pub use around_vertex::{FourSidedPatch, patches_around_vertex};
pub use n_sided::{NSidedPatch, n_sided_patch};

use glam::{DAffine3, DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::{BezierPatch, SurfaceSide};

/// Most sides of a hole: the cost of a point grows with the sides.
pub const MAX_SIDES: usize = 256;

/// By how much tangents at a corner may leave their common plane, as a part of their length.
const COPLANAR: f64 = 1e-9;

/// A side of a hole: a cubic curve, traversed with the hole on the left seen from outside, and what is beyond it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HoleSide {
    curve: [DVec3; 4],
    /// Bezier points of the derivative across the curve, into the hole.
    across: [DVec3; 4],
}

impl HoleSide {
    /// The side of a hole where a patch ends.
    pub fn of(patch: &BezierPatch, side: SurfaceSide) -> HoleSide {
        let c = patch.control();
        let row = |i: usize| c[i];
        let column = |j: usize| [0, 1, 2, 3].map(|i| c[i][j]);
        let [mut curve, mut inner] = match side {
            SurfaceSide::LowV => [column(0), column(1)],
            SurfaceSide::HighV => [column(3), column(2)],
            SurfaceSide::LowU => [row(0), row(1)],
            SurfaceSide::HighU => [row(3), row(2)],
        };
        if matches!(side, SurfaceSide::LowV | SurfaceSide::HighU) {
            curve.reverse();
            inner.reverse();
        }
        HoleSide { curve, across: [0, 1, 2, 3].map(|k| (curve[k] - inner[k]) * 3.0) }
    }

    /// The sides of a hole moved by `placement`. A reflection reverses their order and directions, so that outside
    /// stays outside.
    pub fn transformed(sides: &[HoleSide], placement: &DAffine3) -> Vec<HoleSide> {
        let moved = |side: &HoleSide| HoleSide {
            curve: side.curve.map(|point| placement.transform_point3(point)),
            across: side.across.map(|vector| placement.transform_vector3(vector)),
        };
        let mut sides: Vec<HoleSide> = sides.iter().map(moved).collect();
        if placement.matrix3.determinant() < 0.0 {
            sides.reverse();
            for side in &mut sides {
                side.curve.reverse();
                side.across.reverse();
            }
        }
        sides
    }

    /// The four control points of the curve.
    pub fn curve(&self) -> &[DVec3; 4] {
        &self.curve
    }
}

/// A fault that keeps a hole from being filled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HoleError {
    /// Too few sides, too many, or an odd number where two belong to each patch.
    #[error("{count} sides: expected {expected}")]
    Count {
        /// Sides given.
        count: usize,
        /// What can be filled.
        expected: &'static str,
    },
    /// A control point that is infinite or not a number.
    #[error("side {side} has a control point that is not finite")]
    NonFinite {
        /// The side, from 0.
        side: usize,
    },
    /// A side that does not begin where the one before it ends.
    #[error("side {side} begins {gap:e} away from the end of the side before it")]
    Open {
        /// The side.
        side: usize,
        /// The distance, model units.
        gap: f64,
    },
    /// A corner without a common tangent plane, or where a side or a patch has no direction.
    #[error("the surfaces at the beginning of side {side} have no common tangent plane")]
    Corner {
        /// The side that begins at the corner.
        side: usize,
    },
    /// A corner at which the hole does not open to the inside.
    #[error("the hole is folded at the beginning of side {side}")]
    Folded {
        /// The side that begins at the corner.
        side: usize,
    },
    /// Sides that leave the middle of the hole without a tangent plane.
    #[error("the sides span no area around their middle")]
    Flat,
}

impl HoleError {
    /// This error with the corner behind the last side named as the first.
    fn among(self, count: usize) -> HoleError {
        match self {
            HoleError::Corner { side } => HoleError::Corner { side: side % count },
            HoleError::Folded { side } => HoleError::Folded { side: side % count },
            other => other,
        }
    }
}

/// Checks that sides follow one another; the first is behind the last.
fn check(sides: &[HoleSide]) -> Result<(), HoleError> {
    for (side, current) in sides.iter().enumerate() {
        if !current.curve.iter().chain(&current.across).all(|point| point.is_finite()) {
            return Err(HoleError::NonFinite { side });
        }
        let before = &sides[(side + sides.len() - 1) % sides.len()];
        let gap = before.curve[3].distance(current.curve[0]);
        if gap > 0.0 {
            return Err(HoleError::Open { side, gap });
        }
    }
    Ok(())
}

/// The parts of two vectors that add up to a third in their plane; `None` if they do not span it, or it leaves the
/// plane.
fn parts_of(sum: DVec3, [a, b]: [DVec3; 2]) -> Option<DVec2> {
    let (a_length, b_length, length) = (a.length(), b.length(), sum.length());
    let (x, y, z) = (a / a_length, b / b_length, sum / length);
    let normal = x.cross(y);
    let area = normal.length_squared();
    let is_sound = area > 1e-12 && normal.normalize().dot(z).abs() <= COPLANAR;
    let parts = DVec2::new(z.cross(y).dot(normal) / a_length, x.cross(z).dot(normal) / b_length) * (length / area);
    (is_sound && parts.is_finite()).then_some(parts)
}
