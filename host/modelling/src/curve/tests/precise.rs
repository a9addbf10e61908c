//! Rational splines against the same formulas with twice the digits.

use glam::DVec3;

use super::super::*;
use super::{curve, members};

/// A number as the sum of two, about 32 digits (Dekker 1971).
#[derive(Clone, Copy)]
struct Double(f64, f64);

impl Double {
    fn of(x: f64) -> Double {
        Double(x, 0.0)
    }

    fn plus(self, b: Double) -> Double {
        let sum = self.0 + b.0;
        let back = sum - self.0;
        let error = (self.0 - (sum - back)) + (b.0 - back) + self.1 + b.1;
        Double(sum + error, error - ((sum + error) - sum))
    }

    fn times(self, b: Double) -> Double {
        let product = self.0 * b.0;
        let error = self.0.mul_add(b.0, -product) + self.0 * b.1 + self.1 * b.0;
        Double(product + error, error - ((product + error) - product))
    }

    fn over(self, b: Double) -> f64 {
        let quotient = self.0 / b.0;
        let rest = self.plus(b.times(Double::of(-quotient)));
        quotient + rest.0 / b.0
    }
}

/// The rational Bezier curve by de Casteljau's construction in homogeneous coordinates.
fn precise(piece: &BezierCurve, t: f64) -> DVec3 {
    let (s, t) = (Double::of(1.0).plus(Double::of(-t)), Double::of(t));
    let homogeneous = |control: &ControlPoint| {
        let weight = Double::of(control.weight);
        let [x, y, z] = control.point.to_array().map(|x| Double::of(x).times(weight));
        [x, y, z, weight]
    };
    let mut work: Vec<[Double; 4]> = piece.control().iter().map(homogeneous).collect();
    while work.len() > 1 {
        let mix = |pair: &[[Double; 4]]| [0, 1, 2, 3].map(|k| pair[0][k].times(s).plus(pair[1][k].times(t)));
        work = work.windows(2).map(mix).collect();
    }
    let [x, y, z, weight] = work[0];
    DVec3::new(x.over(weight), y.over(weight), z.over(weight))
}

#[test]
fn rational_curves_are_right_to_rounding_for_weights_from_a_millionth_to_a_million() {
    for (name, basis) in members() {
        let curve = curve(&basis, 1e6);
        for (span, piece) in curve.pieces().iter().enumerate() {
            for k in 0..=20 {
                let t = f64::from(k) / 20.0;
                let gap = (piece.point(t) - precise(piece, t)).length();
                assert!(gap < 1e-14 * 6.0, "{name}, span {span} at {t}: {gap}");
                assert!(piece.derivatives(t).iter().all(|d| d.is_finite()));
            }
        }
    }
}
