//! The bicubic Bezier patch.

use glam::{DVec2, DVec3};

use super::{Curved, Surface, between, nearest_from};

/// Below this part of the size squared, a cross product of derivatives is rounding.
const ROUNDING: f64 = 1e-13;
/// Above this part of the size squared, a cross product of derivatives has at least twelve good digits.
const CLEAR: f64 = 1e-3;

/// S(u, v) = sum of B_i(u) B_j(v) P_ij, i and j in 0..=3, u and v in 0..=1, with Bernstein's cubic polynomials B.
#[derive(Clone, Debug, PartialEq)]
pub struct BezierPatch {
    control: [[DVec3; 4]; 4],
}

impl BezierPatch {
    /// The patch with the control points `control[i][j]`; its outside is where dS/du x dS/dv points.
    pub fn new(control: [[DVec3; 4]; 4]) -> BezierPatch {
        BezierPatch { control }
    }

    /// The control points.
    pub fn control(&self) -> &[[DVec3; 4]; 4] {
        &self.control
    }

    /// These points with u and v exchanged, and so with the other side outside.
    pub fn transposed(&self) -> BezierPatch {
        BezierPatch { control: std::array::from_fn(|i| std::array::from_fn(|j| self.control[j][i])) }
    }

    /// The longest side of the box around the control points.
    fn size(&self) -> f64 {
        let points = || self.control.iter().flatten().copied();
        let high = points().fold(self.control[0][0], DVec3::max);
        (high - points().fold(self.control[0][0], DVec3::min)).max_element()
    }

    /// The Taylor coefficients c_ij of S(u + x, v + y) = sum of c_ij x^i y^j, less the constant one.
    fn taylor(&self, uv: DVec2) -> [[DVec3; 4]; 4] {
        let (along_u, along_v) = (bernstein_taylor(uv.x), bernstein_taylor(uv.y));
        let origin = self.control[0][0];
        let mut rows = [[DVec3::ZERO; 4]; 4];
        for (i, row) in self.control.iter().enumerate() {
            for (j, weights) in along_v.iter().enumerate() {
                rows[i][j] = (0..4).map(|l| (row[l] - origin) * weights[l]).sum();
            }
        }
        along_u.map(|weights| std::array::from_fn(|j| (0..4).map(|k| rows[k][j] * weights[k]).sum()))
    }
}

impl Surface for BezierPatch {
    fn domain(&self) -> [DVec2; 2] {
        [DVec2::ZERO, DVec2::ONE]
    }

    /// De Casteljau's construction: stable, exact on control points, and on the sides a function of their own four
    /// control points alone, in either direction.
    fn point(&self, uv: DVec2) -> DVec3 {
        casteljau(self.control.map(|row| casteljau(row, uv.y)), uv.x)
    }

    fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
        let ([at_u, by_u, ..], [at_v, by_v, ..]) = (bernstein_taylor(uv.x), bernstein_taylor(uv.y));
        let sum = |weights: [f64; 4], points: [DVec3; 4]| {
            // The weights of a derivative add up to 0: taking one point as the origin costs nothing and keeps digits.
            points.iter().zip(weights).map(|(point, weight)| (*point - points[0]) * weight).sum::<DVec3>()
        };
        let along_v = self.control.map(|row| row[0] + sum(at_v, row));
        let by_v_at = self.control.map(|row| sum(by_v, row));
        [sum(by_u, along_v), by_v_at[0] + sum(at_u, by_v_at)]
    }

    fn point_and_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        let rows = self.control.map(|row| casteljau_and_derivative(row, uv.y));
        let [point, du] = casteljau_and_derivative(rows.map(|[point, _]| point), uv.x);
        let [dv, _] = casteljau_and_derivative(rows.map(|[_, dv]| dv), uv.x);
        [point, du, dv]
    }

    /// dS/du x dS/dv; where that vanishes, the first term that does not in its Taylor series towards the middle of the
    /// patch. So a side that is a point has its limit normal.
    fn normal(&self, uv: DVec2) -> DVec3 {
        let [du, dv] = self.derivatives(uv);
        let size = self.size();
        let regular = (du / size).cross(dv / size);
        if regular.length() > CLEAR {
            return regular.normalize();
        }
        let taylor = self.taylor(uv);
        let inward = DVec2::splat(0.5) - uv;
        let inward = if inward == DVec2::ZERO { DVec2::X } else { inward / inward.abs().max_element() };
        let (du, dv) = derivatives_along(&taylor, inward);
        for order in 0..du.len() + dv.len() - 1 {
            let low = order.saturating_sub(dv.len() - 1);
            let high = order.min(du.len() - 1);
            let term: DVec3 = (low..=high).map(|k| (du[k] / size).cross(dv[order - k] / size)).sum();
            if term.length() > ROUNDING {
                return term.normalize();
            }
        }
        DVec3::ZERO
    }

    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
        nearest_from(self, point, guess)
    }
}

impl Curved for BezierPatch {
    fn second_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        let taylor = self.taylor(uv);
        [taylor[2][0] * 2.0, taylor[1][1], taylor[0][2] * 2.0]
    }
}

/// A point of a cubic curve and its derivative, by the same construction.
fn casteljau_and_derivative([a, b, c, d]: [DVec3; 4], t: f64) -> [DVec3; 2] {
    let (ab, bc, cd) = (a + (b - a) * t, b + (c - b) * t, c + (d - c) * t);
    let (abc, bcd) = (ab + (bc - ab) * t, bc + (cd - bc) * t);
    [abc + (bcd - abc) * t, (bcd - abc) * 3.0]
}

pub(super) fn casteljau(points: [DVec3; 4], t: f64) -> DVec3 {
    let blend = |a: DVec3, b: DVec3| DVec3::from_array([0, 1, 2].map(|k| between(a[k], b[k], t)));
    let [a, b, c, d] = points;
    let (ab, bc, cd) = (blend(a, b), blend(b, c), blend(c, d));
    blend(blend(ab, bc), blend(bc, cd))
}

/// Row i holds, for each of Bernstein's cubic polynomials, the coefficient of x^i in B(t + x).
fn bernstein_taylor(t: f64) -> [[f64; 4]; 4] {
    let s = 1.0 - t;
    [
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t],
        [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t],
        [3.0 * s, 3.0 * t - 6.0 * s, 3.0 * s - 6.0 * t, 3.0 * t],
        [-1.0, 3.0, -3.0, 1.0],
    ]
}

/// The coefficients of dS/du and dS/dv as polynomials in the way along `direction`.
fn derivatives_along(taylor: &[[DVec3; 4]; 4], direction: DVec2) -> ([DVec3; 6], [DVec3; 6]) {
    let (mut du, mut dv) = ([DVec3::ZERO; 6], [DVec3::ZERO; 6]);
    for (i, row) in taylor.iter().enumerate() {
        for (j, term) in row.iter().enumerate() {
            let power = |base: f64, exponent: usize| base.powi(exponent as i32);
            if i > 0 {
                du[i - 1 + j] += *term * (i as f64 * power(direction.x, i - 1) * power(direction.y, j));
            }
            if j > 0 {
                dv[i + j - 1] += *term * (j as f64 * power(direction.x, i) * power(direction.y, j - 1));
            }
        }
    }
    (du, dv)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A patch over the unit square that is the graph of x^2 y + x - y^3 (exact as bicubic).
    fn graph() -> BezierPatch {
        // Bernstein coefficients of 1, t, t^2, t^3.
        let power = [[1.0; 4], [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0], [0.0, 0.0, 1.0 / 3.0, 1.0], [0.0, 0.0, 0.0, 1.0]];
        let height = |i: usize, j: usize| power[2][i] * power[1][j] + power[1][i] - power[3][j];
        BezierPatch::new(std::array::from_fn(|i| {
            std::array::from_fn(|j| DVec3::new(power[1][i], power[1][j], height(i, j)))
        }))
    }

    #[test]
    fn a_polynomial_graph_is_reproduced_with_its_derivatives_and_normal() {
        for (x, y) in [(0.0, 0.0), (0.3, 0.7), (1.0, 0.2), (0.5, 0.5), (1.0, 1.0)] {
            let uv = DVec2::new(x, y);
            let patch = graph();
            assert!((patch.point(uv) - DVec3::new(x, y, x * x * y + x - y * y * y)).length() < 1e-15);
            let [du, dv] = patch.derivatives(uv);
            let (fx, fy) = (2.0 * x * y + 1.0, x * x - 3.0 * y * y);
            assert!(
                (du - DVec3::new(1.0, 0.0, fx)).length() < 1e-14 && (dv - DVec3::new(0.0, 1.0, fy)).length() < 1e-14
            );
            assert!((patch.normal(uv) - DVec3::new(-fx, -fy, 1.0).normalize()).length() < 1e-14);
            let second = [2.0 * y, 2.0 * x, -6.0 * y].map(|f| DVec3::Z * f);
            assert!(patch.second_derivatives(uv).iter().zip(second).all(|(a, b)| (*a - b).length() < 1e-13));
        }
    }

    #[test]
    fn sides_are_the_same_bits_from_either_end() {
        let patch = graph();
        let mut turned = patch.control;
        turned.reverse();
        let turned = BezierPatch::new(turned);
        for t in [0.0, 0.25, 0.5, 0.75, 1.0] {
            assert_eq!(patch.point(DVec2::new(t, 0.0)), turned.point(DVec2::new(1.0 - t, 0.0)));
        }
    }

    #[test]
    fn collapsed_sides_corners_and_folded_sides_have_limit_normals() {
        // A cone with its tip up: the tip is the whole side u = 0, and every point of it has another limit.
        let ring = [[1.0, 0.0], [1.0, 0.55], [0.55, 1.0], [0.0, 1.0]];
        let tip = DVec3::new(0.0, 0.0, 1.0);
        let row = |k: usize| std::array::from_fn(|j| tip.lerp(DVec3::new(ring[j][0], ring[j][1], 0.0), k as f64 / 3.0));
        let cone = BezierPatch::new(std::array::from_fn(row));
        assert!((cone.normal(DVec2::ZERO) - cone.normal(DVec2::new(1e-6, 0.0))).length() < 1e-6);
        assert!(cone.normal(DVec2::ZERO).dot(DVec3::new(1.0, 0.0, 1.0).normalize()) > 0.99999);
        // A derivative that vanishes in a corner of a flat patch.
        let mut control = *graph().control();
        control.iter_mut().flatten().for_each(|point| point.z = 0.0);
        control[0][1] = control[0][0];
        control[1][0] = control[0][0];
        assert_eq!(BezierPatch::new(control).normal(DVec2::ZERO), DVec3::Z);
    }
}
