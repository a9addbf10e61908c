//! Bezier curves of any degree, polynomial or rational.

use glam::DVec3;

use super::control::{ControlPoint, control_row};
use super::{Curve, SplineError};

/// The highest degree of a curve or surface: the largest numbers of its formulas stay far from overflow.
pub const MAX_DEGREE: usize = 32;

/// As many numbers as a curve of the highest degree has control points.
pub(crate) type Values = [f64; MAX_DEGREE + 1];

/// C(t) = sum of B_i(t) w_i P_i / sum of B_i(t) w_i, t in 0..=1, with Bernstein's polynomials B of the degree.
#[derive(Clone, Debug, PartialEq)]
pub struct BezierCurve {
    control: Vec<ControlPoint>,
}

impl BezierCurve {
    /// The curve of degree `points.len()` - 1; no `weights` at all stand for weights of 1.
    ///
    /// # Errors
    /// [`SplineError`] if the degree is not within 1..=[`MAX_DEGREE`], or a point or weight is out of range.
    pub fn new(points: &[DVec3], weights: &[f64]) -> Result<BezierCurve, SplineError> {
        check_degree(points.len().saturating_sub(1))?;
        Ok(BezierCurve { control: control_row(0, points, weights)? })
    }

    /// The curve of control points that were checked.
    pub(super) fn of(control: Vec<ControlPoint>) -> BezierCurve {
        BezierCurve { control }
    }

    /// The control points.
    pub fn control(&self) -> &[ControlPoint] {
        &self.control
    }

    /// The degree.
    pub fn degree(&self) -> usize {
        self.control.len() - 1
    }

    /// The curves before and after `t`, each with parameters 0..=1.
    pub fn subdivided(&self, t: f64) -> [BezierCurve; 2] {
        let mut work = self.control.clone();
        let (mut left, mut right) = (vec![work[0]], vec![work[work.len() - 1]]);
        while work.len() > 1 {
            work = work.windows(2).map(|pair| ControlPoint::mix(pair[0], pair[1], t)).collect();
            left.push(work[0]);
            right.push(work[work.len() - 1]);
        }
        right.reverse();
        [BezierCurve::of(left), BezierCurve::of(right)]
    }

    /// This curve with a degree higher by one.
    ///
    /// # Errors
    /// [`SplineError::Degree`] if it is too high.
    pub fn elevated(&self) -> Result<BezierCurve, SplineError> {
        let degree = self.degree() + 1;
        check_degree(degree)?;
        let at = |k: usize| self.control[k.min(degree - 1)];
        let between = |k: usize| ControlPoint::mix(at(k), at(k.saturating_sub(1)), k as f64 / degree as f64);
        Ok(BezierCurve::of((0..=degree).map(between).collect()))
    }
}

impl Curve for BezierCurve {
    fn domain(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    fn point(&self, t: f64) -> DVec3 {
        casteljau(self.control.len(), t, |k| self.control[k]).point
    }

    fn derivatives(&self, t: f64) -> [DVec3; 2] {
        let origin = casteljau(self.control.len(), t, |k| self.control[k]);
        // Most degrees are low: short lists cost less to fill.
        match self.degree() {
            degree @ ..=7 => self.derivatives_by(&origin, &bernstein_in::<8>(degree, t)),
            degree => self.derivatives_by(&origin, &bernstein(degree, t)),
        }
    }
}

impl BezierCurve {
    /// - `origin`: the point.
    /// - `basis`: Bernstein's polynomials and their derivatives.
    fn derivatives_by<const MOST: usize>(&self, origin: &ControlPoint, basis: &[[f64; MOST]; 3]) -> [DVec3; 2] {
        let sum = |order: usize| {
            let terms = self.control.iter().zip(&basis[order]);
            let (mut point, mut weight) = (DVec3::ZERO, 0.0);
            for (control, part) in terms {
                // The parts of a derivative add up to 0: the weight at t as their origin keeps digits.
                point += (control.point - origin.point) * (control.weight / origin.weight * part);
                weight += (control.weight / origin.weight - 1.0) * part;
            }
            (point, weight)
        };
        // With the origin in the point itself, the quotient rule loses its first term.
        let ((first, by_weight), (second, _)) = (sum(1), sum(2));
        [first, second - first * (2.0 * by_weight)]
    }
}

/// # Errors
/// [`SplineError::Degree`] unless `degree` is within 1..=[`MAX_DEGREE`].
pub(crate) fn check_degree(degree: usize) -> Result<(), SplineError> {
    let is_possible = (1..=MAX_DEGREE).contains(&degree);
    if is_possible { Ok(()) } else { Err(SplineError::Degree { degree, most: MAX_DEGREE }) }
}

/// De Casteljau's construction over `count` control points, of which `at` gives each: stable, exact at the ends, and the
/// same from either end.
pub(crate) fn casteljau(count: usize, t: f64, at: impl Fn(usize) -> ControlPoint) -> ControlPoint {
    if t == 0.0 || t == 1.0 {
        return at(if t == 0.0 { 0 } else { count - 1 });
    }
    // Most degrees are low: a short list costs less to fill.
    if count <= 8 { mixed::<8>(count, t, at) } else { mixed::<{ MAX_DEGREE + 1 }>(count, t, at) }
}

fn mixed<const MOST: usize>(count: usize, t: f64, at: impl Fn(usize) -> ControlPoint) -> ControlPoint {
    let mut work = [ControlPoint::new(DVec3::ZERO); MOST];
    for (k, point) in work[..count].iter_mut().enumerate() {
        *point = at(k);
    }
    for last in (1..count).rev() {
        for k in 0..last {
            work[k] = ControlPoint::mix(work[k], work[k + 1], t);
        }
    }
    work[0]
}

/// Bernstein's polynomials of `degree` at `t`, their first and their second derivatives.
pub(crate) fn bernstein(degree: usize, t: f64) -> [Values; 3] {
    bernstein_in::<{ MAX_DEGREE + 1 }>(degree, t)
}

/// Bernstein's polynomials of a `degree` below `MOST` at `t`, their first and their second derivatives.
fn bernstein_in<const MOST: usize>(degree: usize, t: f64) -> [[f64; MOST]; 3] {
    let mut values = [[0.0; MOST]; 3];
    let mut current = [0.0; MOST];
    current[0] = 1.0;
    for n in 0..=degree {
        // `current` holds the polynomials of degree n. Derivatives are differences of those of a lower degree.
        let (first, second) = (degree as f64, (degree * degree.saturating_sub(1)) as f64);
        let at = |k: usize, back: usize| if k >= back && k - back <= n { current[k - back] } else { 0.0 };
        for k in 0..=degree {
            if n + 2 == degree {
                values[2][k] = second * (at(k, 2) - 2.0 * at(k, 1) + at(k, 0));
            } else if n + 1 == degree {
                values[1][k] = first * (at(k, 1) - at(k, 0));
            } else if n == degree {
                values[0][k] = current[k];
            }
        }
        for k in (0..=(n + 1).min(MOST - 1)).rev() {
            current[k] = current[k] * (1.0 - t) + if k > 0 { current[k - 1] * t } else { 0.0 };
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of the unit circle.
    fn quarter() -> BezierCurve {
        let points = [DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
        BezierCurve::new(&points, &[1.0, 0.5f64.sqrt(), 1.0]).unwrap()
    }

    fn wild(degree: usize) -> BezierCurve {
        let at = |k: usize| DVec3::new((k * k % 7) as f64, (k * 5 % 11) as f64, k as f64);
        let weights: Vec<f64> = (0..=degree).map(|k| 10f64.powi([0, 3, -2, 5, -6, 6][k % 6])).collect();
        BezierCurve::new(&(0..=degree).map(at).collect::<Vec<_>>(), &weights).unwrap()
    }

    #[test]
    fn bernsteins_polynomials_are_binomials_with_their_derivatives() {
        for (degree, t) in [(1, 0.3), (2, 0.0), (3, 0.7), (5, 1.0), (9, 0.41), (32, 0.5)] {
            let values = bernstein(degree, t);
            let mut binomial = 1.0;
            for (k, found) in (0..=degree).map(|k| (k, [0, 1, 2].map(|order| values[order][k]))) {
                let power = |base: f64, exponent: isize| if exponent < 0 { 0.0 } else { base.powi(exponent as i32) };
                let (i, j) = (k as isize, (degree - k) as isize);
                let (fi, fj) = (k as f64, (degree - k) as f64);
                let term = |a: isize, b: isize| power(t, a) * power(1.0 - t, b);
                let value = binomial * term(i, j);
                let first = binomial * (fi * term(i - 1, j) - fj * term(i, j - 1));
                let second = binomial
                    * (fi * (fi - 1.0) * term(i - 2, j) - 2.0 * fi * fj * term(i - 1, j - 1)
                        + fj * (fj - 1.0) * term(i, j - 2));
                let scale = (degree * degree) as f64;
                assert!((found[0] - value).abs() < 1e-15, "{degree} {k}");
                assert!((found[1] - first).abs() < 1e-14 * scale, "{degree} {k}");
                assert!((found[2] - second).abs() < 1e-14 * scale, "{degree} {k}: {} {second}", found[2]);
                binomial *= (degree - k) as f64 / (k + 1) as f64;
            }
        }
    }

    #[test]
    fn a_quarter_circle_is_exact_with_its_tangent_and_curvature() {
        for k in 0..=64 {
            let t = f64::from(k) / 64.0;
            let (point, [first, second]) = (quarter().point(t), quarter().derivatives(t));
            assert!((point.length() - 1.0).abs() < 4e-16);
            assert!(first.dot(point).abs() < 1e-15 * first.length());
            let curvature = first.cross(second).length() / first.length().powi(3);
            assert!((curvature - 1.0).abs() < 1e-13, "{curvature} at {t}");
        }
    }

    #[test]
    fn subdivision_and_elevation_keep_the_curve_for_wild_weights() {
        for degree in [1, 2, 3, 7, 15] {
            let curve = wild(degree);
            let size = 20.0;
            for split in [0.5, 0.1, 0.937] {
                let [left, right] = curve.subdivided(split);
                for k in 0..=20 {
                    let s = f64::from(k) / 20.0;
                    assert!((left.point(s) - curve.point(s * split)).length() < 1e-13 * size);
                    let t = split + (1.0 - split) * s;
                    assert!((right.point(s) - curve.point(t)).length() < 1e-13 * size, "{degree} {split} {s}");
                }
            }
            let elevated = curve.elevated().unwrap();
            assert_eq!(elevated.degree(), degree + 1);
            for k in 0..=20 {
                let t = f64::from(k) / 20.0;
                assert!((elevated.point(t) - curve.point(t)).length() < 1e-14 * size);
            }
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for degree in [1, 2, 3, 6] {
            let curve = BezierCurve::new(
                &wild(degree).control.iter().map(|c| c.point).collect::<Vec<_>>(),
                &(0..=degree).map(|k| 1.0 + 0.5 * (k % 3) as f64).collect::<Vec<_>>(),
            )
            .unwrap();
            for t in [0.1, 0.5, 0.83] {
                let h = 1e-5;
                let [first, second] = curve.derivatives(t);
                let difference = (curve.point(t + h) - curve.point(t - h)) / (2.0 * h);
                assert!((first - difference).length() < 1e-6);
                let difference = (curve.derivatives(t + h)[0] - curve.derivatives(t - h)[0]) / (2.0 * h);
                assert!((second - difference).length() < 1e-5);
            }
        }
    }

    #[test]
    fn degrees_out_of_range_are_refused() {
        let fault = |count| BezierCurve::new(&vec![DVec3::ZERO; count], &[]).unwrap_err().to_string();
        assert_eq!(fault(0), "degree 0 is outside 1..=32");
        assert_eq!(fault(34), "degree 33 is outside 1..=32");
    }
}
