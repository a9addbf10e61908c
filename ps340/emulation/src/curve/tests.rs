//! Curves against closed forms, invariants and an exact evaluation.

use super::{CurveFault, Expanded, MAX_CHORDS, MAX_ORDER, MAX_VERTICES, bspline, polynomial};
use proptest::prelude::*;
use protocol::command::{Bspline, Polynomial};

/// The greatest common divisor; `b` is not zero.
fn divisor(a: i128, b: i128) -> i128 {
    let (mut a, mut b) = (a.abs(), b.abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// A fraction in lowest terms, for the exact evaluation.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Fraction(i128, i128);

impl Fraction {
    fn new(above: i128, below: i128) -> Fraction {
        let common = divisor(above, below) * below.signum();
        Fraction(above / common, below / common)
    }

    fn plus(self, other: Fraction) -> Fraction {
        let common = divisor(self.1, other.1);
        Fraction::new(self.0 * (other.1 / common) + other.0 * (self.1 / common), self.1 / common * other.1)
    }

    fn times(self, other: Fraction) -> Fraction {
        let (a, b) = (Fraction::new(self.0, other.1), Fraction::new(other.0, self.1));
        Fraction::new(a.0 * b.0, a.1 * b.1)
    }

    fn value(self) -> f64 {
        self.0 as f64 / self.1 as f64
    }
}

/// The basis function of a vertex at `t`, by the recursion of Cox and de Boor, exactly.
fn basis(knots: &[i128], index: usize, order: usize, t: Fraction) -> Fraction {
    let at = |knot: usize| Fraction(knots[knot], 1);
    let (low, high) = (at(index), at(index + order));
    let inside = |a: Fraction, b: Fraction| a.0 * t.1 <= t.0 && t.0 < b.0 * t.1;
    if order == 1 {
        return Fraction(i128::from(inside(low, high)), 1);
    }
    let ramp = |from: Fraction, to: Fraction, way: i128| match to.0 - from.0 {
        0 => Fraction(0, 1),
        width => Fraction::new(way * t.0 - way * from.0 * t.1, t.1).times(Fraction::new(way, width)),
    };
    let rise = ramp(low, at(index + order - 1), 1).times(basis(knots, index, order - 1, t));
    let fall = match high.0 - at(index + 1).0 {
        0 => Fraction(0, 1),
        width => Fraction::new(high.0 * t.1 - t.0, t.1 * width).times(basis(knots, index + 1, order - 1, t)),
    };
    rise.plus(fall)
}

fn spline(order: u8, vertices: &[[f64; 2]], chords: u32) -> Bspline {
    let vertices = vertices.iter().map(|[x, y]| [*x, *y, 0.0, 1.0]).collect();
    let (rational, closed, periodic, dimension) = (false, false, false, 2);
    Bspline { rational, order, closed, periodic, dimension, estimate: None, vertices, knots: None, chords }
}

fn power(coefficients: &[[f64; 4]], rational: bool, chords: u32) -> Polynomial {
    Polynomial { rational, order: None, dimension: 3, coefficients: coefficients.to_vec(), chords }
}

fn points(curve: &Bspline) -> Vec<[f32; 4]> {
    bspline(curve).expect("a curve").points
}

/// A zigzag that no simple formula hides in.
fn zigzag(count: usize) -> Vec<[f64; 2]> {
    let digit = |i: usize, of: usize| (((i * 31 + 17 * of) as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) % 13;
    (0..count).map(|i| [digit(i, 1) as f64 - 6.0, digit(i, 5) as f64 - 6.0]).collect()
}

fn assert_close(found: &[[f32; 4]], expected: &[[f32; 4]], tolerance: f32) {
    assert_eq!(found.len(), expected.len());
    for (index, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance), "point {index}: {a:?} {b:?}");
    }
}

/// All four combinations of closure and period.
const FORMS: [[bool; 2]; 4] = [[false, false], [false, true], [true, false], [true, true]];

#[test]
fn order_two_is_the_polyline_of_its_vertices() {
    let expanded = bspline(&spline(2, &[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0]], 4)).expect("a curve");
    let expected = [[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [4.0, 1.0], [4.0, 2.0]].map(|[x, y]| [x, y, 0.0, 1.0]);
    assert_eq!(expanded, Expanded { points: expected.to_vec(), parameters: [0.0, 2.0] });
}

#[test]
fn closed_order_two_comes_back_to_its_first_point() {
    let mut curve = spline(2, &[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0]], 3);
    curve.closed = true;
    let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 0.0]].map(|[x, y]| [x, y, 0.0, 1.0]);
    for periodic in [false, true] {
        curve.periodic = periodic;
        assert_eq!(points(&curve), corners, "periodic {periodic}");
    }
}

#[test]
fn order_one_stays_at_a_vertex_for_each_span() {
    let found: Vec<f32> = points(&spline(1, &[[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]], 6)).iter().map(|p| p[0]).collect();
    assert_eq!(found, [1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 3.0]);
}

#[test]
fn as_many_vertices_as_the_order_make_the_curve_of_bezier() {
    for order in 1..=MAX_ORDER {
        let vertices = zigzag(usize::from(order));
        let degree = i32::from(order) - 1;
        let found = points(&spline(order, &vertices, 32));
        for (step, point) in found.iter().enumerate() {
            let t = step as f64 / 32.0;
            let mut binomial = 1.0;
            let mut sum = [0.0; 2];
            for (i, vertex) in (0..=degree).zip(&vertices) {
                let weight = binomial * t.powi(i) * (1.0 - t).powi(degree - i);
                sum = [sum[0] + weight * vertex[0], sum[1] + weight * vertex[1]];
                binomial *= f64::from(degree - i) / f64::from(i + 1);
            }
            let error = (f64::from(point[0]) - sum[0]).abs().max((f64::from(point[1]) - sum[1]).abs());
            assert!(error < 1e-6, "order {order}, t = {t}: {error}");
        }
    }
}

#[test]
fn rational_quadratic_of_nine_vertices_is_a_circle() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let corners = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]];
    let mut curve = spline(3, &corners.map(|c| c.map(f64::from)), 360);
    curve.rational = true;
    curve.vertices.iter_mut().skip(1).step_by(2).for_each(|vertex| vertex[3] = half);
    curve.knots = Some([0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4].map(f64::from).to_vec());
    let found = points(&curve);
    for point in &found {
        let radius = f64::from(point[0]).hypot(f64::from(point[1]));
        assert!((radius - 1.0).abs() < 1e-7, "{radius}");
    }
    assert_eq!(found[90][..2], [0.0, 1.0]);
    assert_eq!(found[0], found[360]);
}

#[test]
fn rational_polynomial_of_a_quarter_circle_keeps_the_radius() {
    // ((1 - t^2) / (1 + t^2), 2 t / (1 + t^2)).
    let rows = [[-1.0, 0.0, 0.0, 1.0], [0.0, 2.0, 0.0, 0.0], [1.0, 0.0, 0.0, 1.0]];
    let found = polynomial(&power(&rows, true, 100)).expect("a curve");
    assert_eq!((found.points[0][..2].to_vec(), found.points[100][..2].to_vec()), (vec![1.0, 0.0], vec![0.0, 1.0]));
    for point in &found.points {
        assert!((f64::from(point[0]).hypot(f64::from(point[1])) - 1.0).abs() < 1e-7);
    }
    assert_eq!(found.parameters, [0.0, 1.0]);
}

#[test]
fn basis_functions_add_up_to_one_and_are_not_negative() {
    for (order, [closed, periodic]) in (1..=MAX_ORDER).flat_map(|order| FORMS.map(|form| (order, form))) {
        let count = usize::from(order) + 3;
        let mut sum = vec![0.0_f64; 65];
        for one in 0..count {
            let vertices: Vec<[f64; 2]> = (0..count).map(|i| [f64::from(u8::from(i == one)), 0.0]).collect();
            let found = points(&Bspline { closed, periodic, ..spline(order, &vertices, 64) });
            for (sum, point) in sum.iter_mut().zip(&found) {
                assert!((0.0..=1.0).contains(&point[0]));
                *sum += f64::from(point[0]);
            }
        }
        assert!(sum.iter().all(|sum| (sum - 1.0).abs() < 1e-6), "order {order}, {closed} {periodic}: {sum:?}");
    }
}

#[test]
fn exact_evaluation_of_every_order_agrees() {
    for order in 1..=usize::from(MAX_ORDER) {
        let (count, rational) = (order + 6, order % 2 == 0);
        // End knots k times; inner knots twice and three times where the order allows it.
        let inner: [i128; 6] = match order {
            1 => [1, 2, 3, 4, 5, 7],
            2..4 => [1, 2, 2, 3, 5, 7],
            _ => [1, 2, 2, 5, 5, 5],
        };
        let knots: Vec<i128> = [vec![0; order], inner.to_vec(), vec![8; order]].concat();
        let mut curve = spline(order as u8, &zigzag(count), 64);
        curve.rational = rational;
        curve.knots = Some(knots.iter().map(|knot| *knot as f64).collect());
        for (index, vertex) in curve.vertices.iter_mut().enumerate() {
            vertex[3] = if rational { (index % 4 + 1) as f64 } else { 1.0 };
        }
        for (step, point) in points(&curve).iter().enumerate().take(64) {
            let t = Fraction::new(step as i128, 8);
            let mut sum = [Fraction(0, 1); 3];
            for (index, vertex) in curve.vertices.iter().enumerate() {
                let weight = basis(&knots, index, order, t).times(Fraction(vertex[3] as i128, 1));
                for (sum, part) in sum.iter_mut().zip([vertex[0], vertex[1], 1.0]) {
                    *sum = sum.plus(weight.times(Fraction(part as i128, 1)));
                }
            }
            let [x, y, w] = sum.map(Fraction::value);
            let error = (f64::from(point[0]) - x / w).abs().max((f64::from(point[1]) - y / w).abs());
            assert!(error < 4e-7, "order {order}, t = {}/8: {error}", step);
        }
    }
}

#[test]
fn closed_forms_are_open_ones_with_vertices_repeated() {
    for order in 2..=MAX_ORDER {
        let vertices = zigzag(12);
        let closed = |periodic| Bspline { closed: true, periodic, ..spline(order, &vertices, 60) };
        let around = |more: usize| -> Vec<[f64; 2]> { vertices.iter().chain(&vertices[..more]).copied().collect() };
        assert_close(&points(&closed(false)), &points(&spline(order, &around(1), 60)), 0.0);
        let open = Bspline { periodic: true, ..spline(order, &around(usize::from(order) - 1), 60) };
        assert_close(&points(&closed(true)), &points(&open), 2e-6);
    }
}

#[test]
fn closed_curves_end_where_they_begin() {
    for (order, periodic) in (2..=MAX_ORDER).flat_map(|order| [(order, false), (order, true)]) {
        for count in usize::from(order)..12 {
            let found = points(&Bspline { closed: true, periodic, ..spline(order, &zigzag(count), 37) });
            assert_eq!(found[0], found[37], "order {order}, {count} vertices, periodic {periodic}");
        }
    }
}

#[test]
fn a_closed_periodic_curve_of_fewer_vertices_than_its_order_goes_around_them() {
    // The basis repeats every two spans, so the curve of two vertices is a stroke there and back.
    let found = points(&Bspline { closed: true, periodic: true, ..spline(4, &[[0.0, 0.0], [6.0, 0.0]], 4) });
    let x: Vec<f32> = found.iter().map(|p| p[0]).collect();
    assert_close(&[[x[0], x[1], x[2], x[3]]], &[[4.0, 3.0, 2.0, 3.0]], 1e-6);
    let one = points(&Bspline { closed: true, periodic: true, ..spline(4, &[[2.0, 3.0]], 5) });
    assert_close(&one, &[[2.0, 3.0, 0.0, 1.0]; 6], 1e-6);
}

#[test]
fn the_cubic_of_the_manual_has_the_places_of_uniform_splines_at_its_knots() {
    let corners = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let found = points(&Bspline { closed: true, periodic: true, ..spline(4, &corners, 40) });
    // (P1 + 4 P2 + P3) / 6 at the first knot, and so on around.
    let thirds = [[0.0, 2.0], [-2.0, 0.0], [0.0, -2.0], [2.0, 0.0], [0.0, 2.0]];
    let knots: Vec<[f32; 4]> = found.iter().step_by(10).copied().collect();
    assert_close(&knots, &thirds.map(|[x, y]: [f32; 2]| [x / 3.0, y / 3.0, 0.0, 1.0]), 1e-7);
}

/// First to third derivative of a cubic at `at[0]`, from four values at distance `step`.
fn derivatives(at: [f32; 4], step: f64) -> [f64; 3] {
    let [a, b, c, d] = at.map(f64::from);
    let (one, two, three) = (b - a, c - 2.0 * b + a, d - 3.0 * c + 3.0 * b - a);
    [(one - two / 2.0 + three / 3.0) / step, (two - three) / (step * step), three / (step * step * step)]
}

#[test]
fn derivatives_are_continuous_up_to_the_degree_less_the_multiplicity() {
    for (knots, continuous) in [([1.0, 2.0, 3.0, 4.0], 2), ([1.0, 2.0, 2.0, 3.0], 1), ([1.0, 2.0, 2.0, 2.0], 0)] {
        let last = knots[3] + 1.0;
        let mut curve = spline(4, &zigzag(8), 3 * last as u32);
        curve.knots = Some([&[0.0; 4][..], &knots, &[last; 4]].concat());
        let y: Vec<f32> = points(&curve).iter().map(|p| p[1]).collect();
        let right = derivatives([y[6], y[7], y[8], y[9]], 1.0 / 3.0);
        let left = derivatives([y[6], y[5], y[4], y[3]], -1.0 / 3.0);
        for order in 0..3 {
            let jump = (right[order] - left[order]).abs();
            assert_eq!(jump < 1e-3, order < continuous, "derivative {} jumps by {jump} at {knots:?}", order + 1);
        }
    }
}

#[test]
fn an_affine_map_of_the_vertices_is_that_of_the_curve() {
    let map = |[x, y]: [f64; 2]| [0.6 * x - 1.5 * y + 3.0, 0.25 * x + y - 7.0];
    for (order, [closed, periodic]) in (1..=MAX_ORDER).flat_map(|order| FORMS.map(|form| (order, form))) {
        let make = |vertices: Vec<[f64; 2]>| points(&Bspline { closed, periodic, ..spline(order, &vertices, 50) });
        let mapped = make(zigzag(11).into_iter().map(map).collect());
        let expected: Vec<[f32; 4]> = make(zigzag(11))
            .into_iter()
            .map(|p| map([f64::from(p[0]), f64::from(p[1])]))
            .map(|[x, y]| [x as f32, y as f32, 0.0, 1.0])
            .collect();
        assert_close(&mapped, &expected, 4e-6);
    }
}

#[test]
fn default_knots_may_be_given() {
    for order in 2..=MAX_ORDER {
        let k = usize::from(order);
        for [closed, periodic] in FORMS {
            let curve = Bspline { closed, periodic, ..spline(order, &zigzag(12), 30) };
            let joined = 12 + usize::from(closed);
            let knots: Vec<f64> = match (closed, periodic) {
                (true, true) => (0..=12).map(f64::from).collect(),
                (false, true) => (0..12 + k).map(|i| i as f64).collect(),
                _ => (0..joined + k).map(|i| (i.max(k - 1).min(joined) - (k - 1)) as f64).collect(),
            };
            assert_eq!(bspline(&Bspline { knots: Some(knots), ..curve.clone() }), bspline(&curve));
        }
    }
}

#[test]
fn knots_act_by_their_distances_only() {
    let curve = spline(4, &zigzag(6), 20);
    let knots = |scale: f64, by: f64| {
        let knots = [0, 0, 0, 0, 1, 3, 4, 4, 4, 4].map(|knot| f64::from(knot) * scale + by);
        bspline(&Bspline { knots: Some(knots.to_vec()), ..curve.clone() }).expect("a curve")
    };
    assert_eq!(knots(8.0, -16.0).points, knots(1.0, 0.0).points);
    assert_eq!(knots(8.0, -16.0).parameters, [-16.0, 16.0]);
    assert_eq!(knots(2.0_f64.powi(-900), 0.0).points, knots(1.0, 0.0).points);
}

#[test]
fn a_seam_with_a_repeated_knot_closes_too() {
    let mut curve = Bspline { closed: true, periodic: true, ..spline(4, &zigzag(7), 40) };
    curve.knots = Some([0.1, 0.1, 0.4, 0.5, 0.8, 1.2, 1.7, 1.9].to_vec());
    let found = points(&curve);
    assert_eq!(found[0], found[40]);
    curve.knots = Some([0.1, 0.1, 0.1, 0.5, 0.8, 1.2, 1.9, 1.9].to_vec());
    assert!(bspline(&curve).is_ok(), "four times in all");
    curve.knots = Some([0.1, 0.1, 0.1, 0.5, 0.8, 1.9, 1.9, 1.9].to_vec());
    assert!(matches!(bspline(&curve), Err(CurveFault::KnotMultiplicity(_))), "five times in all");
}

#[test]
fn coordinates_of_any_size_scale_exactly() {
    for exponent in [-100, 100] {
        let scale = 2.0_f64.powi(exponent);
        let curve = spline(10, &zigzag(14), 40);
        let mut scaled = curve.clone();
        scaled.vertices.iter_mut().for_each(|v| v[..2].iter_mut().for_each(|c| *c *= scale));
        for (a, b) in points(&scaled).iter().zip(points(&curve)) {
            assert_eq!((f64::from(a[0]), f64::from(a[1])), (f64::from(b[0]) * scale, f64::from(b[1]) * scale));
        }
    }
}

#[test]
fn equal_weights_of_any_size_do_not_matter() {
    let plain = spline(10, &zigzag(14), 40);
    for weight in [1e-30, 0.3, 1e30, -2.0] {
        let mut curve = Bspline { rational: true, ..plain.clone() };
        curve.vertices.iter_mut().for_each(|vertex| vertex[3] = weight);
        assert_close(&points(&curve), &points(&plain), 1e-6);
    }
}

#[test]
fn a_vertex_of_weight_zero_does_not_pull_and_a_heavy_one_pulls_all_the_way() {
    let mut curve = Bspline { rational: true, ..spline(3, &[[0.0, 0.0], [1.0, 5.0], [2.0, 0.0]], 8) };
    curve.vertices[1][3] = 0.0;
    assert!(points(&curve).iter().all(|point| point[1] == 0.0));
    curve.vertices[1][3] = 1e12;
    assert!(points(&curve)[1..8].iter().all(|point| (point[1] - 5.0).abs() < 1e-6));
    // Negative, but the sum stays positive: the curve bends away. 1/4, -1/2 0.5, 1/4 of the weights at t = 1/2.
    curve.vertices[1][3] = -0.5;
    assert_eq!(points(&curve)[4][1], -5.0);
}

#[test]
fn a_denominator_that_vanishes_or_changes_sign_is_refused() {
    let mut curve = Bspline { rational: true, ..spline(2, &[[0.0, 0.0], [1.0, 1.0]], 2) };
    curve.vertices[1][3] = -1.0;
    assert_eq!(bspline(&curve), Err(CurveFault::Infinity(2)), "0 in the middle");
    curve.chords = 3;
    assert_eq!(bspline(&curve), Err(CurveFault::Infinity(3)), "the sign has changed");
    curve.vertices.iter_mut().for_each(|vertex| vertex[3] = 0.0);
    assert_eq!(bspline(&curve), Err(CurveFault::Infinity(1)));
    let rows = [[0.0, 0.0, 0.0, 1.0], [1.0, 1.0, 1.0, -0.25]];
    assert_eq!(polynomial(&power(&rows, true, 4)), Err(CurveFault::Infinity(2)));
    assert_eq!(polynomial(&power(&rows, false, 4)).map(|curve| curve.points[3]), Ok([1.0; 4]));
}

#[test]
fn coefficients_that_cancel_keep_their_precision() {
    let scale = 2.0_f64.powi(100);
    // (t - 1)^10, and 2^60 times as small at t = 63/64 as at 0.
    let row =
        [1, -10, 45, -120, 210, -252, 210, -120, 45, -10, 1].map(|c| [f64::from(c), scale * f64::from(c), 0.0, 1.0]);
    let found = polynomial(&power(&row, false, 64)).expect("a curve");
    for (step, point) in found.points.iter().enumerate() {
        let exact = (1.0 - step as f64 / 64.0).powi(10);
        assert!((f64::from(point[0]) - exact).abs() <= 1e-7 * exact, "{step}: {} {exact}", point[0]);
        assert!((f64::from(point[1]) / scale - exact).abs() <= 1e-7 * exact, "{step}: {} {exact}", point[1]);
    }
}

#[test]
fn polynomials_of_every_degree_begin_and_end_at_their_sums() {
    for degree in 0..=10_usize {
        let rows: Vec<[f64; 4]> = (0..=degree).map(|i| [i as f64 + 1.0, -(i as f64), 2.0, 1.0]).collect();
        let found = polynomial(&power(&rows, false, 7)).expect("a curve");
        let sum = |axis: usize| rows.iter().map(|row| row[axis]).sum::<f64>() as f32;
        assert_eq!(found.points[7], [sum(0), sum(1), sum(2), 1.0]);
        assert_eq!(found.points[0], [degree as f32 + 1.0, -(degree as f32), 2.0, 1.0]);
        assert_eq!(found.points.len(), 8);
    }
}

#[test]
fn two_dimensions_have_no_depth() {
    let mut curve = spline(2, &[[0.0, 0.0], [1.0, 1.0]], 1);
    curve.vertices[1][2] = 9.0;
    assert_eq!(points(&curve)[1], [1.0, 1.0, 0.0, 1.0]);
    curve.dimension = 3;
    assert_eq!(points(&curve)[1], [1.0, 1.0, 9.0, 1.0]);
}

#[test]
fn wrong_counts_and_values_are_refused_with_their_place() {
    let good = spline(3, &zigzag(5), 10);
    let fault = |change: &dyn Fn(&mut Bspline)| {
        let mut curve = good.clone();
        change(&mut curve);
        bspline(&curve).expect_err("a fault")
    };
    let knots = |knots: &[f64]| fault(&|c| c.knots = Some(knots.to_vec()));
    assert_eq!(fault(&|c| c.order = 0), CurveFault::Order(0));
    assert_eq!(fault(&|c| c.order = 11), CurveFault::Order(11));
    assert_eq!(fault(&|c| c.order = 6), CurveFault::Vertices { least: 6, found: 5 });
    assert_eq!(fault(&|c| c.vertices.clear()), CurveFault::Vertices { least: 3, found: 0 });
    let many = fault(&|c| c.vertices = vec![[0.0; 4]; MAX_VERTICES + 1]);
    assert_eq!(many, CurveFault::Vertices { least: 3, found: MAX_VERTICES + 1 });
    assert_eq!(fault(&|c| c.chords = 0), CurveFault::Chords(0));
    assert_eq!(fault(&|c| c.chords = MAX_CHORDS + 1), CurveFault::Chords(MAX_CHORDS + 1));
    assert_eq!(fault(&|c| c.vertices[3][1] = f64::NAN), CurveFault::NotFinite(4));
    assert_eq!(fault(&|c| c.vertices[0][0] = 1e39), CurveFault::TooLarge(1));
    assert_eq!(knots(&[0.0; 7]), CurveFault::KnotCount { needed: 8, found: 7 });
    assert_eq!(knots(&[0.0, 0.0, 0.0, 2.0, 1.0, 3.0, 3.0, 3.0]), CurveFault::KnotOrder(5));
    assert_eq!(knots(&[0.0, 0.0, 0.0, f64::INFINITY, 1.0, 3.0, 3.0, 3.0]), CurveFault::KnotOrder(4));
    assert_eq!(knots(&[0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 3.0, 3.0]), CurveFault::KnotMultiplicity(3));
    assert_eq!(knots(&[0.0; 8]), CurveFault::KnotMultiplicity(1));
    assert_eq!(knots(&[-1e308, -1e308, -1e308, 0.0, 1.0, 1e308, 1e308, 1e308]), CurveFault::NoRange);
    let closed = fault(&|c| (c.closed, c.periodic, c.knots) = (true, true, Some(vec![1.0; 6])));
    assert!(matches!(closed, CurveFault::KnotMultiplicity(_)));
    let count = fault(&|c| (c.closed, c.periodic, c.knots) = (true, true, Some(vec![1.0; 8])));
    assert_eq!(count, CurveFault::KnotCount { needed: 6, found: 8 });
    let count = fault(&|c| (c.closed, c.knots) = (true, Some(vec![1.0; 8])));
    assert_eq!(count, CurveFault::KnotCount { needed: 9, found: 8 });
    let rows = |count: usize| polynomial(&power(&vec![[1.0; 4]; count], false, 1)).map(|curve| curve.points.len());
    assert_eq!((rows(0), rows(1), rows(11)), (Err(CurveFault::Coefficients(0)), Ok(2), Ok(2)));
    assert_eq!(rows(12), Err(CurveFault::Coefficients(12)));
    let ordered = |order| polynomial(&Polynomial { order: Some(order), ..power(&[[1.0; 4]; 4], false, 1) });
    assert_eq!((ordered(3).is_ok(), ordered(4)), (true, Err(CurveFault::Rows { order: 4, found: 4 })));
}

#[test]
fn the_most_vertices_and_chords_are_done_in_a_moment() {
    let curve = spline(10, &zigzag(1 << 16), MAX_CHORDS);
    assert_eq!(points(&curve).len(), MAX_CHORDS as usize + 1);
}

proptest! {
    /// Whatever is given, a curve has all its points inside the box of its vertices, or a fault.
    #[test]
    fn points_lie_in_the_box_of_the_vertices(
        order in 0_u8..12,
        [closed, periodic] in proptest::sample::select(FORMS.to_vec()),
        vertices in prop::collection::vec([-9.0..9.0, -9.0..9.0, -1e30..1e30, 0.1..5.0], 0..16),
        steps in prop::collection::vec(prop_oneof![Just(0.0), 1e-12..1e3], 32),
        own in any::<bool>(),
        chords in 0_u32..50,
    ) {
        let needed = match (closed, periodic) {
            (true, true) => vertices.len() + 1,
            _ => vertices.len() + usize::from(order) + usize::from(closed),
        };
        let knots = steps.iter().scan(0.0, |sum, step| { *sum += step; Some(*sum) }).take(needed).collect();
        let knots = own.then_some(knots);
        let curve = Bspline { rational: true, order, closed, periodic, dimension: 3, estimate: None, vertices, knots, chords };
        if let Ok(expanded) = bspline(&curve) {
            prop_assert_eq!(expanded.points.len(), chords as usize + 1);
            prop_assert!(expanded.parameters[0] < expanded.parameters[1]);
            for axis in 0..3 {
                let of = |pick: fn(f64, f64) -> f64, start| curve.vertices.iter().map(|v| v[axis]).fold(start, pick);
                let (low, high) = (of(f64::min, f64::INFINITY), of(f64::max, f64::NEG_INFINITY));
                let slack = 1e-6 * low.abs().max(high.abs());
                prop_assert!(expanded.points.iter().all(|p| (low - slack..=high + slack).contains(&f64::from(p[axis]))));
            }
        }
    }
}
