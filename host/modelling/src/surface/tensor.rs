//! Bezier patches of any degree, polynomial or rational.

use glam::{DVec2, DVec3};

use super::curvature::Curved;
use super::{BezierPatch, Surface, nearest_from};
use crate::curve::{ControlPoint, MAX_DEGREE, SplineError, bernstein, casteljau, control_net};

/// Derivatives shorter than this part of the size of the patch, or at an angle of a smaller sine, may be rounding.
const CLEAR: f64 = 1e-8;
/// Below this part of the largest, a coefficient of a Taylor series is rounding.
const ROUNDING: f64 = 1e-13;

/// S(u, v) = sum of B_i(u) B_j(v) w_ij P_ij / sum of B_i(u) B_j(v) w_ij with Bernstein's polynomials of the two degrees,
/// u and v in 0..=1.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorPatch {
    degrees: [usize; 2],
    /// Row by row; v changes within a row.
    control: Vec<ControlPoint>,
    /// The longest side of the box around the control points.
    size: f64,
}

impl TensorPatch {
    /// The patch with the control points `points[i][j]`, i along u and j along v, of degrees one less than their numbers;
    /// no `weights` at all stand for weights of 1. Its outside is where dS/du x dS/dv points.
    ///
    /// # Errors
    /// [`SplineError`] with the row and the place in it.
    pub fn new(points: &[Vec<DVec3>], weights: &[Vec<f64>]) -> Result<TensorPatch, SplineError> {
        let control = control_net(points, weights)?;
        let degrees = [points.len() - 1, points[0].len() - 1];
        if let Some(&degree) = degrees.iter().find(|degree| !(1..=MAX_DEGREE).contains(*degree)) {
            return Err(SplineError::Degree { degree, most: MAX_DEGREE });
        }
        Ok(TensorPatch::of(degrees, control))
    }

    /// The patch of control points that were checked.
    pub(super) fn of(degrees: [usize; 2], control: Vec<ControlPoint>) -> TensorPatch {
        let points = || control.iter().map(|control| control.point);
        let high = points().fold(control[0].point, DVec3::max);
        let size = (high - points().fold(control[0].point, DVec3::min)).max_element();
        TensorPatch { degrees, control, size }
    }

    /// The degrees in u and v.
    pub fn degrees(&self) -> [usize; 2] {
        self.degrees
    }

    /// The control point `i` along u and `j` along v.
    ///
    /// # Panics
    /// If the patch has no such point.
    pub fn control(&self, i: usize, j: usize) -> ControlPoint {
        self.control[i * (self.degrees[1] + 1) + j]
    }

    fn evaluated(&self, uv: DVec2) -> ControlPoint {
        let [p, q] = self.degrees;
        casteljau(p + 1, uv.x, |i| casteljau(q + 1, uv.y, |j| self.control(i, j)))
    }

    /// The derivatives by u, v, uu, uv and vv.
    fn jet(&self, uv: DVec2) -> [DVec3; 5] {
        let [p, q] = self.degrees;
        let origin = self.evaluated(uv);
        let (by_u, by_v) = (bernstein(p, uv.x), bernstein(q, uv.y));
        let orders = [(1, 0), (0, 1), (2, 0), (1, 1), (0, 2)];
        let mut points = [DVec3::ZERO; 5];
        let mut weights = [0.0; 5];
        for (index, control) in self.control.iter().enumerate() {
            let (i, j) = (index / (q + 1), index % (q + 1));
            let ratio = control.weight / origin.weight;
            let offset = (control.point - origin.point) * ratio;
            for (k, (a, b)) in orders.into_iter().enumerate() {
                let part = by_u[a][i] * by_v[b][j];
                points[k] += offset * part;
                // The parts of a derivative add up to 0: taking off the weight at uv costs nothing, keeps digits.
                weights[k] += (ratio - 1.0) * part;
            }
        }
        // With the origin in the point itself, the quotient rule loses its first terms.
        let ([u, v, uu, both, vv], [wu, wv, ..]) = (points, weights);
        [u, v, uu - u * (2.0 * wu), both - v * wu - u * wv, vv - v * (2.0 * wv)]
    }

    /// The first term that does not vanish of the normal's Taylor series from `uv` towards the middle of the patch.
    fn limit_normal(&self, uv: DVec2) -> DVec3 {
        let inward = DVec2::splat(0.5) - uv;
        let inward = if inward == DVec2::ZERO { DVec2::X } else { inward / inward.abs().max_element() };
        let [p, q] = self.degrees;
        let origin = self.evaluated(uv);
        let along_u = [bernstein_along(p, uv.x, inward.x), derivative_along(p, uv.x, inward.x)];
        let along_v = [bernstein_along(q, uv.y, inward.y), derivative_along(q, uv.y, inward.y)];
        // Homogeneous coordinates, their derivatives by u and by v, each as a polynomial in the way.
        let mut series = [(); 3].map(|()| (vec![DVec3::ZERO; p + q + 1], vec![0.0; p + q + 1]));
        for (index, control) in self.control.iter().enumerate() {
            let (i, j) = (index / (q + 1), index % (q + 1));
            let ratio = control.weight / origin.weight;
            let offset = (control.point - origin.point) * ratio;
            for ((points, weights), (a, b)) in series.iter_mut().zip([(0, 0), (1, 0), (0, 1)]) {
                for (k, x) in along_u[a][i].iter().enumerate() {
                    for (l, y) in along_v[b][j].iter().enumerate() {
                        points[k + l] += offset * (x * y);
                        weights[k + l] += ratio * (x * y);
                    }
                }
            }
        }
        let [value, by_u, by_v] = &series;
        let numerator = |by: &(Vec<DVec3>, Vec<f64>)| -> Vec<DVec3> {
            let term = |k: usize| (0..=k).map(|l| by.0[l] * value.1[k - l] - value.0[l] * by.1[k - l]).sum();
            (0..=p + q).map(term).collect()
        };
        first_cross(&numerator(by_u), &numerator(by_v))
    }
}

/// The direction of the first coefficient of the cross product of two polynomials that is more than rounding; zero if
/// there is none.
fn first_cross(a: &[DVec3], b: &[DVec3]) -> DVec3 {
    let largest = |list: &[DVec3]| list.iter().map(|x| x.abs().max_element()).fold(f64::MIN_POSITIVE, f64::max);
    let (in_a, in_b) = (largest(a), largest(b));
    let term = |k: usize| (0..=k).map(|l| (a[l] / in_a).cross(b[k - l] / in_b)).sum::<DVec3>();
    (0..a.len()).map(term).find(|term| term.length() > ROUNDING).map_or(DVec3::ZERO, DVec3::normalize)
}

/// Bernstein's polynomials of `degree` at `t` + `slope` x, as coefficients of the powers of x.
fn bernstein_along(degree: usize, t: f64, slope: f64) -> Vec<Vec<f64>> {
    let mut rows = vec![vec![1.0]];
    for n in 1..=degree {
        let next = |k: usize| {
            let mut row = vec![0.0; n + 1];
            // (1 - u) B_k + u B_{k-1}, of the degree below.
            for (old, constant, linear) in [(Some(k), 1.0 - t, -slope), (k.checked_sub(1), t, slope)] {
                for (power, x) in old.and_then(|old| rows.get(old)).into_iter().flatten().enumerate() {
                    row[power] += constant * x;
                    row[power + 1] += linear * x;
                }
            }
            row
        };
        rows = (0..=n).map(next).collect();
    }
    rows
}

/// The derivatives of the same by t.
fn derivative_along(degree: usize, t: f64, slope: f64) -> Vec<Vec<f64>> {
    let lower = bernstein_along(degree - 1, t, slope);
    let at = |k: Option<usize>, power: usize| k.and_then(|k| lower.get(k)).map_or(0.0, |row| row[power]);
    let row = |k: usize| (0..degree).map(|m| degree as f64 * (at(k.checked_sub(1), m) - at(Some(k), m))).collect();
    (0..=degree).map(row).collect()
}

impl From<&BezierPatch> for TensorPatch {
    fn from(patch: &BezierPatch) -> TensorPatch {
        TensorPatch::of([3, 3], patch.control().iter().flatten().map(|point| ControlPoint::new(*point)).collect())
    }
}

impl Surface for TensorPatch {
    fn domain(&self) -> [DVec2; 2] {
        [DVec2::ZERO, DVec2::ONE]
    }

    /// De Casteljau's construction: stable, exact on corners, and on the sides a function of their own control points
    /// alone, in either direction.
    fn point(&self, uv: DVec2) -> DVec3 {
        self.evaluated(uv).point
    }

    fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
        let [u, v, ..] = self.jet(uv);
        [u, v]
    }

    /// dS/du x dS/dv; where that vanishes, its limit from the middle of the patch.
    fn normal(&self, uv: DVec2) -> DVec3 {
        let [du, dv] = self.derivatives(uv);
        let (a, b) = (du.length(), dv.length());
        if a.min(b) > CLEAR * self.size {
            let cross = (du / a).cross(dv / b);
            if cross.length() > CLEAR {
                return cross.normalize();
            }
        }
        self.limit_normal(uv)
    }

    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
        nearest_from(self, point, guess)
    }
}

impl Curved for TensorPatch {
    fn second_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        let [.., uu, both, vv] = self.jet(uv);
        [uu, both, vv]
    }
}

#[cfg(test)]
mod tests {
    use super::super::teapot;
    use super::*;

    #[test]
    fn a_bicubic_patch_is_the_bezier_patch() {
        for patch in teapot() {
            let tensor = TensorPatch::from(&patch);
            for k in 0..36 {
                let uv = DVec2::new((k % 6) as f64, (k / 6) as f64) / 5.0;
                assert!((tensor.point(uv) - patch.point(uv)).length() < 1e-15);
                let gaps = tensor.derivatives(uv).into_iter().zip(patch.derivatives(uv)).map(|(a, b)| (a - b).length());
                assert!(gaps.fold(0.0, f64::max) < 1e-13);
                assert!((tensor.normal(uv) - patch.normal(uv)).length() < 1e-9, "{uv}");
            }
        }
    }

    #[test]
    fn second_derivatives_agree_with_differences() {
        let at = |i: usize, j: usize| DVec3::new(i as f64, j as f64, (i * j % 3) as f64);
        let points: Vec<Vec<DVec3>> = (0..4).map(|i| (0..3).map(|j| at(i, j)).collect()).collect();
        let weights: Vec<Vec<f64>> = (0..4).map(|i| (0..3).map(|j| 1.0 + ((i + 2 * j) % 4) as f64).collect()).collect();
        let patch = TensorPatch::new(&points, &weights).unwrap();
        for k in 0..16 {
            let uv = DVec2::new((k % 4) as f64, (k / 4) as f64) / 4.0 + 0.1;
            let h = 1e-5;
            let slope = |axis: DVec2, of: usize| {
                (patch.derivatives(uv + axis * h)[of] - patch.derivatives(uv - axis * h)[of]) / (2.0 * h)
            };
            let [uu, both, vv] = patch.second_derivatives(uv);
            for (found, expected) in [(uu, slope(DVec2::X, 0)), (both, slope(DVec2::X, 1)), (vv, slope(DVec2::Y, 1))] {
                assert!((found - expected).length() < 1e-7, "{found} {expected}");
            }
        }
    }

    #[test]
    fn faults_name_row_and_place() {
        let fault = |points: &[Vec<DVec3>], weights: &[Vec<f64>]| TensorPatch::new(points, weights).unwrap_err();
        let square = vec![vec![DVec3::ZERO; 2]; 2];
        let ragged = [square[0].clone(), vec![DVec3::ZERO; 3]];
        assert_eq!(fault(&ragged, &[]).to_string(), "row 1 has 3 control points, row 0 has 2");
        let weights = [vec![1.0, 1.0], vec![1.0, -1.0]];
        assert!(fault(&square, &weights).to_string().starts_with("weight 1 of row 1 is -1"));
        assert!(fault(&[], &[]).to_string().starts_with("0 rows of control points were given"));
        assert!(fault(&square, &weights[..1]).to_string().starts_with("1 rows of weights were given, 2"));
        assert_eq!(fault(&square[..1], &[]).to_string(), "degree 0 is outside 1..=32");
    }
}
