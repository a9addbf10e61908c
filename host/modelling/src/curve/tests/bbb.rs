//! The BBB-spline: the splines that it contains, its joints, its locality.

use glam::DVec3;

use super::super::*;
use super::control;

/// A B-spline by the recursion of Cox and de Boor.
fn cox_de_boor(degree: usize, knots: &[f64], points: &[DVec3], t: f64) -> DVec3 {
    fn value(degree: usize, i: usize, knots: &[f64], t: f64) -> f64 {
        if degree == 0 {
            return f64::from(u8::from(knots[i] <= t && t < knots[i + 1]));
        }
        let part = |up: f64, low: f64, high: f64| if high > low { up / (high - low) } else { 0.0 };
        let (a, b) = (knots[i], knots[i + degree]);
        let (c, d) = (knots[i + 1], knots[i + degree + 1]);
        part(t - a, a, b) * value(degree - 1, i, knots, t) + part(d - t, c, d) * value(degree - 1, i + 1, knots, t)
    }
    (0..points.len()).map(|i| points[i] * value(degree, i, knots, t)).sum()
}

/// The Beta-spline's span of four control points, by Barsky's polynomials.
fn barsky(points: &[DVec3], b1: f64, b2: f64, u: f64) -> DVec3 {
    let (u2, u3) = (u * u, u * u * u);
    let (q, c) = (b1 * b1, b1 * b1 * b1);
    let delta = 2.0 * c + 4.0 * q + 4.0 * b1 + b2 + 2.0;
    let basis = [
        2.0 * c * (1.0 - u).powi(3),
        2.0 * c * u * (u2 - 3.0 * u + 3.0)
            + 2.0 * q * (u3 - 3.0 * u2 + 2.0)
            + 2.0 * b1 * (u3 - 3.0 * u + 2.0)
            + b2 * (2.0 * u3 - 3.0 * u2 + 1.0),
        2.0 * q * u2 * (3.0 - u) + 2.0 * b1 * u * (3.0 - u2) + b2 * u2 * (3.0 - 2.0 * u) + 2.0 * (1.0 - u3),
        2.0 * u3,
    ];
    (0..4).map(|k| points[k] * (basis[k] / delta)).sum()
}

fn spline(basis: Basis) -> SplineCurve {
    let (points, _) = control(basis.control_count(), 1.0);
    SplineCurve::new(basis, &points, &[]).unwrap()
}

/// The size of the control polygons.
const SIZE: f64 = 6.0;

#[test]
fn constant_parameters_give_the_beta_spline() {
    for (bias, tension) in [(1.0, 0.0), (2.0, 0.0), (1.0, 10.0), (0.1, 3.0), (30.0, 1e3), (1e3, 1e6), (1e-3, 1e6)] {
        let curve = spline(Basis::beta(9, bias, tension).unwrap());
        let (points, _) = control(9, 1.0);
        for k in 0..=60 {
            let t = f64::from(k) / 10.0;
            let span = (t.floor() as usize).min(5);
            let expected = barsky(&points[span..], bias, tension, t - span as f64);
            let gap = (curve.point(t) - expected).length();
            assert!(gap < 1e-14 * SIZE, "{bias} {tension} at {t}: {gap}");
        }
    }
}

#[test]
fn bias_one_and_tension_zero_give_the_b_spline_of_any_knots() {
    let lists: [&[f64]; 4] = [
        &[1.0; 11],
        &[0.3, 2.0, 1e-3, 1.0, 5.0, 0.01, 1e3, 1.0, 1.0, 0.5, 2.0],
        &[0.0, 0.0, 1.0, 0.0, 2.0, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0],
        &[1.0, 0.0, 0.0, 1.0, 1e-6, 1.0, 1e6, 1.0, 0.0, 1.0, 1.0],
    ];
    for intervals in lists {
        let curve = spline(Basis::bbb(&[1.0; 10], &[0.0; 10], intervals).unwrap());
        // The first two intervals lie before the domain; the knots at the far ends have no influence.
        let mut knots = vec![-intervals[0] - intervals[1]];
        intervals.iter().for_each(|interval| knots.push(knots[knots.len() - 1] + interval));
        let start = knots[2];
        let mut knots: Vec<f64> = knots.iter().map(|knot| knot - start).collect();
        knots.insert(0, knots[0]);
        knots.push(knots[knots.len() - 1]);
        let (points, _) = control(10, 1.0);
        let reference = spline(Basis::b_spline(3, &knots).unwrap());
        let [low, high] = curve.domain();
        for k in 0..300 {
            let t = low + (high - low) * f64::from(k) / 300.0;
            let expected = cox_de_boor(3, &knots, &points, t);
            for (name, found) in [("BBB", curve.point(t)), ("B-spline", reference.point(t))] {
                let gap = (found - expected).length();
                assert!(gap < 1e-14 * SIZE, "{name} of {intervals:?} at {t}: {gap}");
            }
        }
    }
}

#[test]
fn zero_intervals_give_bezier_curves() {
    let intervals = [0.0, 0.0, 2.0, 0.0, 0.0, 0.5, 0.0, 0.0];
    let (bias, tension) = ([3.0, 0.2, 1.0, 7.0, 1.0, 2.0, 0.3], [1.0, 5.0, 0.0, 1e3, 2.0, 0.0, 1.0]);
    let curve = spline(Basis::bbb(&bias, &tension, &intervals).unwrap());
    let (points, _) = control(7, 1.0);
    for (piece, from) in curve.pieces().iter().zip([0, 3]) {
        let found: Vec<DVec3> = piece.control().iter().map(|control| control.point).collect();
        assert_eq!(found, points[from..from + 4]);
    }
    assert_eq!(curve.pieces().len(), 2);
}

#[test]
fn the_conditions_hold_at_every_joint_whatever_the_parameters() {
    let mut random = {
        let mut state = 7u64;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    };
    for round in 0..200 {
        let count = 6 + round % 5;
        let closed = round % 2 == 0;
        let mut list = |low: f64, high: f64, count: usize| -> Vec<f64> {
            (0..count).map(|_| low * (high / low).powf(random())).collect()
        };
        let bias = list(1e-3, 1e3, count);
        let tension = list(1e-6, 1e6, count);
        let intervals = list(1e-2, 1e2, count + usize::from(!closed));
        let make = if closed { Basis::closed_bbb } else { Basis::bbb };
        let curve = spline(make(&bias, &tension, &intervals).unwrap());
        let pieces = curve.pieces();
        let joints = if closed { pieces.len() } else { pieces.len() - 1 };
        for k in 0..joints {
            let (b, c) = (&pieces[k], &pieces[(k + 1) % pieces.len()]);
            let joint = (if closed { k + 1 } else { k + 2 }) % count;
            let [before, after] = [joint, joint + 1].map(|i| intervals[i % intervals.len()]);
            let points = |piece: &BezierCurve| [0, 1, 2, 3].map(|k| piece.control()[k].point);
            let (p, q) = (points(b), points(c));
            assert_eq!(p[3], q[0]);
            let (b1, c1) = ((p[3] - p[2]) * (3.0 / before), (q[1] - q[0]) * (3.0 / after));
            let b2 = ((p[3] - p[2]) - (p[2] - p[1])) * (6.0 / before / before);
            let c2 = ((q[2] - q[1]) - (q[1] - q[0])) * (6.0 / after / after);
            let (bias, tension) = (bias[joint], tension[joint]);
            // Rounding of the Bezier points, carried through the differences.
            let scale = SIZE * (3.0 / after + bias * 3.0 / before);
            assert!((c1 - b1 * bias).length() < 1e-14 * scale);
            let scale = SIZE * (6.0 / after / after + bias * bias * 6.0 / before / before + tension * 3.0 / before);
            let residual = (c2 - b2 * (bias * bias) - b1 * tension).length() / scale;
            assert!(residual < 1e-14, "{residual} in round {round}");
        }
    }
}

#[test]
fn parameters_change_the_spline_near_their_joint_and_nowhere_else() {
    let count = 12;
    for closed in [false, true] {
        let make = |bias: &[f64], tension: &[f64], intervals: &[f64]| {
            spline(if closed { Basis::closed_bbb } else { Basis::bbb }(bias, tension, intervals).unwrap())
        };
        let bias: Vec<f64> = (0..count).map(|k| 0.5 + 0.3 * (k % 4) as f64).collect();
        let tension: Vec<f64> = (0..count).map(|k| (k % 3) as f64).collect();
        let intervals: Vec<f64> = (0..count + usize::from(!closed)).map(|k| 1.0 + 0.25 * (k % 5) as f64).collect();
        let before = make(&bias, &tension, &intervals);
        let spans = before.pieces().len() as isize;
        let changed = |after: &SplineCurve| -> Vec<isize> {
            (0..spans).filter(|&k| before.pieces()[k as usize] != after.pieces()[k as usize]).collect()
        };
        // The span that begins in joint j has the number j in a closed spline, j - 1 in an open one.
        let expect = |spans_from: isize, number: isize| -> Vec<isize> {
            let all = (spans_from..spans_from + number).map(|k| if closed { k } else { k - 1 });
            let mut all: Vec<isize> = if closed {
                all.map(|k| k.rem_euclid(spans)).collect()
            } else {
                all.filter(|k| (0..spans).contains(k)).collect()
            };
            all.sort_unstable();
            all
        };
        for joint in 0..count {
            let mut other = bias.clone();
            other[joint] *= 1.7;
            assert_eq!(changed(&make(&other, &tension, &intervals)), expect(joint as isize - 2, 4), "bias {joint}");
            let mut other = tension.clone();
            other[joint] += 1.7;
            let found = changed(&make(&bias, &other, &intervals));
            assert_eq!(found, expect(joint as isize - 2, 4), "tension {joint}");
            let mut other = intervals.clone();
            other[joint] *= 1.7;
            let found = changed(&make(&bias, &tension, &other));
            assert_eq!(found, expect(joint as isize - 3, 5), "interval {joint}");
        }
    }
}

#[test]
fn tension_draws_the_spline_to_its_polygon() {
    let (points, _) = control(8, 1.0);
    for (tension, within) in [(1e2, 0.5), (1e4, 5e-3), (1e6, 5e-5)] {
        let curve = spline(Basis::beta(8, 1.0, tension).unwrap());
        for (k, point) in points[1..7].iter().enumerate() {
            let gap = (curve.point(k as f64) - *point).length();
            assert!(gap < within, "{gap} at tension {tension}");
        }
    }
}
