//! Control points with weights.

use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};

use super::SplineError;

/// The farthest coordinate, so that no product of a few of them overflows.
const FARTHEST: f64 = 1e100;
/// The range of weights.
const WEIGHTS: std::ops::RangeInclusive<f64> = 1e-12..=1e12;

/// A control point and its weight: the homogeneous coordinates (w x, w y, w z, w), kept as the point and w.
///
/// All sums are formed around one of the points. So points that coincide stay one point to the bit, and equal weights
/// stay equal, whatever rounding does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControlPoint {
    /// The point, model units.
    pub point: DVec3,
    /// Its weight, positive; 1 for all points makes the spline polynomial.
    pub weight: f64,
}

impl ControlPoint {
    /// A point of weight 1.
    pub fn new(point: DVec3) -> ControlPoint {
        ControlPoint { point, weight: 1.0 }
    }

    /// The point moved by `placement`.
    pub fn transformed(self, placement: &DAffine3) -> ControlPoint {
        ControlPoint { point: placement.transform_point3(self.point), weight: self.weight }
    }

    /// The way from `a` to `b` in homogeneous coordinates: `a` at `t` = 0, `b` at 1; the same from either end.
    pub(crate) fn mix(a: ControlPoint, b: ControlPoint, t: f64) -> ControlPoint {
        let s = 1.0 - t;
        if a.weight == b.weight {
            return ControlPoint { point: blend(a.point, b.point, s, t), weight: a.weight };
        }
        let weight = a.weight * s + b.weight * t;
        ControlPoint { point: blend(a.point, b.point, s * (a.weight / weight), t * (b.weight / weight)), weight }
    }
}

/// a s + b t for s + t = 1, where coordinates that are equal stay what they are.
fn blend(a: DVec3, b: DVec3, s: f64, t: f64) -> DVec3 {
    let coordinate = |k: usize| if a[k] == b[k] { a[k] } else { a[k] * s + b[k] * t };
    DVec3::new(coordinate(0), coordinate(1), coordinate(2))
}

/// Checks a row of control points and joins them with their weights; no weights at all stand for weights of 1.
///
/// # Errors
/// [`SplineError`] with the row `row` and the place in it.
pub(crate) fn control_row(row: usize, points: &[DVec3], weights: &[f64]) -> Result<Vec<ControlPoint>, SplineError> {
    if !weights.is_empty() && weights.len() != points.len() {
        return Err(SplineError::Row { what: "weights", row, found: weights.len(), needed: points.len() });
    }
    let control = points.iter().enumerate().map(|(column, &point)| {
        let weight = weights.get(column).copied().unwrap_or(1.0);
        if !(point.abs().max_element() <= FARTHEST && point.is_finite()) {
            return Err(SplineError::Point { row, column, point });
        }
        if !WEIGHTS.contains(&weight) {
            return Err(SplineError::Weight { row, column, weight });
        }
        Ok(ControlPoint { point, weight })
    });
    control.collect()
}

/// Checks control points that come from elsewhere.
///
/// # Errors
/// [`SplineError`] with the place in the list.
pub(crate) fn check_control(control: &[ControlPoint]) -> Result<(), SplineError> {
    let points: Vec<DVec3> = control.iter().map(|control| control.point).collect();
    let weights: Vec<f64> = control.iter().map(|control| control.weight).collect();
    control_row(0, &points, &weights).map(|_| ())
}

/// Checks a rectangular mesh of control points and joins them with their weights, row by row; no weights at all stand
/// for weights of 1.
///
/// # Errors
/// [`SplineError`] with the row and the place in it.
pub(crate) fn control_net(points: &[Vec<DVec3>], weights: &[Vec<f64>]) -> Result<Vec<ControlPoint>, SplineError> {
    let Some(needed) = points.first().map(Vec::len).filter(|length| *length > 0) else {
        return Err(SplineError::TooFew { what: "rows of control points", found: 0, least: 1 });
    };
    if !weights.is_empty() && weights.len() != points.len() {
        return Err(SplineError::Count { what: "rows of weights", found: weights.len(), needed: points.len() });
    }
    let mut control = Vec::with_capacity(points.len() * needed);
    for (row, line) in points.iter().enumerate() {
        if line.len() != needed {
            return Err(SplineError::Row { what: "control points", row, found: line.len(), needed });
        }
        control.extend(control_row(row, line, weights.get(row).map_or(&[], Vec::as_slice))?);
    }
    Ok(control)
}

/// A weighted sum of consecutive control points: what one step from control points to others needs for each of them.
///
/// The weights add up to 1. In a closed spline the last control point is followed by the first.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ControlCombination {
    first: usize,
    weights: Vec<f64>,
    /// The place of the largest weight: the sum is formed around its point.
    largest: usize,
}

impl ControlCombination {
    /// The sum of the points from `first` on with `weights`; zeros at either end are left out.
    pub fn new(first: usize, weights: &[f64]) -> ControlCombination {
        let from = weights.iter().position(|weight| *weight != 0.0).unwrap_or(0);
        let to = weights.iter().rposition(|weight| *weight != 0.0).map_or(weights.len(), |last| last + 1);
        let weights = weights[from..to].to_vec();
        let largest =
            (0..weights.len()).fold(0, |best, k| if weights[k].abs() > weights[best].abs() { k } else { best });
        ControlCombination { first: first + from, weights, largest }
    }

    /// The point `index` itself.
    pub fn one(index: usize) -> ControlCombination {
        ControlCombination { first: index, weights: vec![1.0], largest: 0 }
    }

    /// The sum over `count` control points, of which `at` gives each.
    pub fn apply(&self, count: usize, at: impl Fn(usize) -> ControlPoint) -> ControlPoint {
        let around = at((self.first + self.largest) % count);
        if self.weights.len() == 1 {
            return around;
        }
        let terms = || self.weights.iter().enumerate().map(|(k, part)| (*part, at((self.first + k) % count)));
        let weight = around.weight + terms().map(|(part, b)| part * (b.weight - around.weight)).sum::<f64>();
        let offset: DVec3 = terms().map(|(part, b)| (b.point - around.point) * (part * (b.weight / weight))).sum();
        ControlPoint { point: around.point + offset, weight }
    }

    /// Whether the same points have weights that differ by no more than `within`.
    pub fn is_close(&self, other: &ControlCombination, within: f64) -> bool {
        let mut pairs = self.weights.iter().zip(&other.weights);
        let has_same_points = self.first == other.first && self.weights.len() == other.weights.len();
        has_same_points && pairs.all(|(a, b)| (a - b).abs() <= within)
    }

    /// The weights with the index of the point that each belongs to.
    pub fn terms(&self, count: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.weights.iter().enumerate().map(move |(k, weight)| ((self.first + k) % count, *weight))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coinciding_points_stay_one_point_to_the_bit() {
        let point = DVec3::new(0.1, -0.7, 1e6 / 3.0);
        let control = [1.0, 0.3, 1e-6, 1e6].map(|weight| ControlPoint { point, weight });
        let row = ControlCombination::new(0, &[0.2, 0.3, 0.4, 0.1]);
        assert_eq!(row.apply(4, |k| control[k]).point, point);
        assert_eq!(ControlPoint::mix(control[2], control[3], 0.3).point, point);
    }

    #[test]
    fn faults_name_row_and_place() {
        let fault = |points: &[DVec3], weights: &[f64]| control_row(3, points, weights).unwrap_err().to_string();
        let far = [DVec3::ZERO, DVec3::new(1.0, f64::NAN, 0.0)];
        assert!(fault(&far, &[]).starts_with("control point 1 of row 3 is [1, NaN, 0]"));
        assert_eq!(fault(&[DVec3::ZERO; 2], &[1.0]), "row 3 has 1 weights, row 0 has 2");
        assert_eq!(fault(&[DVec3::ZERO; 2], &[1.0, 0.0]), "weight 1 of row 3 is 0, it must be within 1e-12..=1e12");
    }
}
