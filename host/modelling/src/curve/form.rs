//! The Bezier form of a spline: how the Bezier points of its spans come from its control points.

use super::SplineError;
use super::control::{ControlCombination, ControlPoint};

/// The shortest span, as a part of the domain: below it, parameters are mostly rounding.
const SHORTEST: f64 = 1e-13;

/// The spans between breaks, each a Bezier curve of the degree; neighbours share the Bezier point of their joint.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BezierForm {
    pub degree: usize,
    /// Control points of the spline.
    pub control_count: usize,
    /// The parameters of the joints that bound the spans, increasing; one more than spans.
    pub breaks: Vec<f64>,
    /// The Bezier points in their order. In a closed spline the last span ends in the first of them.
    pub rows: Vec<ControlCombination>,
}

impl BezierForm {
    /// The number of spans.
    pub fn spans(&self) -> usize {
        self.breaks.len() - 1
    }

    /// # Errors
    /// [`SplineError::Short`] if a span is too short for the parameters in it to have digits.
    pub fn check_spans(&self) -> Result<(), SplineError> {
        let least = SHORTEST * (self.breaks[self.spans()] - self.breaks[0]);
        let lengths = self.breaks.windows(2).map(|pair| pair[1] - pair[0]);
        match lengths.enumerate().find(|(_, length)| !(*length >= least && *length > 1e-100)) {
            Some((span, length)) => Err(SplineError::Short { span, length }),
            None => Ok(()),
        }
    }

    /// The Bezier point `k`, 0..=degree, of a span.
    pub fn index(&self, span: usize, k: usize) -> usize {
        (span * self.degree + k) % self.rows.len()
    }

    /// The span of a parameter, and the parameter in it, 0..=1. Parameters outside the domain are taken for its ends.
    pub fn locate(&self, t: f64) -> (usize, f64) {
        let span = self.breaks.partition_point(|at| *at <= t).clamp(1, self.spans()) - 1;
        let (low, high) = (self.breaks[span], self.breaks[span + 1]);
        (span, ((t - low) / (high - low)).clamp(0.0, 1.0))
    }
}

/// All points that `rows` make of `control`.
pub(crate) fn apply(rows: &[ControlCombination], control: &[ControlPoint]) -> Vec<ControlPoint> {
    rows.iter().map(|row| row.apply(control.len(), |k| control[k])).collect()
}
