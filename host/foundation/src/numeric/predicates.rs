//! Predicates: signs that are right whatever the rounding.

use glam::DVec2;
use robust::{Coord, incircle, orient2d};

/// Cross product of two plane vectors, p_x q_y - p_y q_x, with the exact sign.
///
/// - `p`, `q`: finite; products must neither overflow nor fall below the smallest normal number.
/// - Returns zero only if the vectors are parallel; the magnitude carries the usual rounding.
///
/// # Source
/// The filter bounds the rounding of two products and a difference; what it leaves goes to the adaptive predicate of
/// Shewchuk 1997.
#[inline]
pub fn cross_sign(p: [f64; 2], q: [f64; 2]) -> f64 {
    let left = p[0] * q[1];
    let right = p[1] * q[0];
    let cross = left - right;
    // Each product is off by half an ulp, the difference by another: below 2^-51 of the sum of magnitudes.
    const BOUND: f64 = 2.0 * f64::EPSILON;
    if cross.abs() > BOUND * (left.abs() + right.abs()) { cross } else { cross_exactly(p, q) }
}

#[cold]
fn cross_exactly(p: [f64; 2], q: [f64; 2]) -> f64 {
    let point = |c: [f64; 2]| Coord { x: c[0], y: c[1] };
    orient2d(point(p), point(q), Coord { x: 0.0, y: 0.0 })
}

/// Twice the signed area of the triangle a b c, with the exact sign: positive if it turns counter-clockwise.
///
/// - `a`, `b`, `c`: finite; products of differences must neither overflow nor fall below the smallest normal number.
/// - Returns zero only if the points lie on one line; the magnitude carries the usual rounding.
///
/// # Source
/// The filter of Ozaki et al. 2016; what it leaves goes to the adaptive predicate of Shewchuk 1997.
#[inline(always)]
pub fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let left = (a.x - c.x) * (b.y - c.y);
    let right = (a.y - c.y) * (b.x - c.x);
    let area = left - right;
    const BOUND: f64 = 3.330_669_062_177_372_2e-16;
    if area.abs() >= BOUND * (left + right).abs() { area } else { turn_exactly(a, b, c) }
}

#[cold]
fn turn_exactly(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    orient2d(coord(a), coord(b), coord(c))
}

/// Positive if `d` lies strictly inside the circle through a, b and c, which turn counter-clockwise; zero on it.
///
/// - All finite; products of four differences must neither overflow nor fall below the smallest normal number.
///
/// # Source
/// Shewchuk 1997.
pub fn in_circle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> f64 {
    incircle(coord(a), coord(b), coord(c), coord(d))
}

fn coord(point: DVec2) -> Coord<f64> {
    Coord { x: point.x, y: point.y }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sign_is_right_where_rounding_loses_it() {
        let e = f64::EPSILON;
        // (1 + e)(1 - e) - 1 = -e^2, which two rounded products do not see.
        assert!(cross_sign([1.0 + e, 1.0], [1.0, 1.0 - e]) < 0.0);
        assert!(cross_sign([1.0, 1.0 + e], [1.0 - e, 1.0]) > 0.0);
        assert_eq!(cross_sign([3.0, 7.0], [9.0, 21.0]), 0.0);
    }

    #[test]
    fn three_points_turn_by_their_exact_area() {
        let e = f64::EPSILON;
        let [a, b] = [DVec2::new(0.5, 0.5), DVec2::new(12.0, 12.0)];
        assert_eq!(turn(a, b, DVec2::new(24.0, 24.0)), 0.0);
        assert!(turn(a, b, DVec2::new(24.0, 24.0 * (1.0 + e))) > 0.0);
        assert!(turn(b, a, DVec2::new(24.0, 24.0 * (1.0 + e))) < 0.0);
    }

    #[test]
    fn swapping_the_vectors_changes_the_sign_only() {
        let mut x = 0.1_f64;
        for _ in 0..1000 {
            x = 4.0 * 0.97 * x * (1.0 - x);
            let (p, q) = ([x, x * x], [x + f64::EPSILON, x * x]);
            assert_eq!(cross_sign(p, q).signum(), -cross_sign(q, p).signum());
        }
    }
}
