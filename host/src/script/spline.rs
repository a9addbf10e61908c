//! Kinds of splines as values of scripts: what control points mean in one direction of a surface, or along a curve.

use crate::curve::{Basis, SplineCurve, SplineError};
use crate::surface::SurfaceSide;

/// How control points become a curve; for how many of them is seen when they are there.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ControlMeaning {
    /// One curve of a degree below the number of points.
    Bezier,
    /// A B-spline.
    BSpline {
        degree: usize,
        is_closed: bool,
        /// Whether an open one passes through its first and last point.
        is_clamped: bool,
        /// The knots; none for equal spans.
        knots: Vec<f64>,
    },
    /// A BBB-spline; one number stands for all joints or intervals.
    Bbb { bias: Vec<f64>, tension: Vec<f64>, intervals: Vec<f64>, is_closed: bool, is_clamped: bool },
}

impl ControlMeaning {
    /// What holds if nothing is said: the cubic B-spline, of a lower degree where there are too few points for that.
    pub(super) fn usual(count: usize) -> ControlMeaning {
        let degree = count.saturating_sub(1).clamp(1, 3);
        ControlMeaning::BSpline { degree, is_closed: false, is_clamped: true, knots: Vec::new() }
    }

    /// The basis for `count` control points.
    pub(super) fn basis(&self, count: usize) -> Result<Basis, SplineError> {
        match self {
            ControlMeaning::Bezier => Basis::bezier(count.saturating_sub(1)),
            ControlMeaning::BSpline { degree, is_closed, is_clamped, knots } => {
                match (&knots[..], is_closed, is_clamped) {
                    ([], true, _) => Basis::closed_uniform(*degree, count),
                    ([], false, true) => Basis::clamped(*degree, count),
                    ([], false, false) => Basis::uniform(*degree, count),
                    (knots, true, _) => Basis::closed_b_spline(*degree, knots),
                    (knots, false, _) => Basis::b_spline(*degree, knots),
                }
            }
            ControlMeaning::Bbb { bias, tension, intervals, is_closed, is_clamped } => {
                let each = |given: &[f64]| if let [one] = given { vec![*one; count] } else { given.to_vec() };
                let intervals = match (&intervals[..], is_closed) {
                    ([one], true) => vec![*one; count],
                    ([one], false) => {
                        let is_end = |k: usize| *is_clamped && (k < 2 || k + 1 >= count);
                        (0..=count).map(|k| if is_end(k) { 0.0 } else { *one }).collect()
                    }
                    (given, _) => given.to_vec(),
                };
                let make = if *is_closed { Basis::closed_bbb } else { Basis::bbb };
                make(&each(bias), &each(tension), &intervals)
            }
        }
    }

    /// The curve of some control points; no `weights` at all stand for weights of 1.
    pub(super) fn curve(&self, points: &[glam::DVec3], weights: &[f64]) -> Result<SplineCurve, SplineError> {
        SplineCurve::new(self.basis(points.len())?, points, weights)
    }
}

/// The sides of a surface as scripts name them.
pub(super) const SIDES: [(&str, SurfaceSide); 4] = [
    ("low u", SurfaceSide::LowU),
    ("high u", SurfaceSide::HighU),
    ("low v", SurfaceSide::LowV),
    ("high v", SurfaceSide::HighV),
];

/// The side of this name.
pub(super) fn side(name: &str) -> Option<SurfaceSide> {
    SIDES.iter().find(|(known, _)| *known == name).map(|(_, side)| *side)
}
