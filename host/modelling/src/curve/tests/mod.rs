//! What every spline must keep, checked for one of each kind, and what sets the kinds apart.

mod bbb;
mod precise;

use glam::{DAffine3, DMat3, DVec3};

use super::*;

pub(super) fn members() -> Vec<(&'static str, Basis)> {
    let ramp =
        |count: usize, low: f64, step: f64| (0..count).map(|k| low + step * (k * 7 % 5) as f64).collect::<Vec<_>>();
    let uneven = [0.0, 0.0, 0.0, 0.0, 0.1, 0.1, 2.0, 2.5, 2.5, 2.5, 9.0, 10.0, 10.0, 10.0, 10.0];
    let mixed = [1.0, 0.0, 0.5, 2.0, 0.0, 0.0, 3.0, 0.3, 1.0, 0.0, 0.2];
    vec![
        ("Bezier", Basis::bezier(5).unwrap()),
        ("line", Basis::clamped(1, 4).unwrap()),
        ("uniform", Basis::uniform(3, 7).unwrap()),
        ("uniform of degree 4", Basis::uniform(4, 9).unwrap()),
        ("clamped of degree 2", Basis::clamped(2, 6).unwrap()),
        ("uneven", Basis::b_spline(3, &uneven).unwrap()),
        ("uneven without passing ends", Basis::b_spline(2, &[-1.0, 0.0, 0.1, 5.0, 5.0, 7.0, 8.0, 8.5]).unwrap()),
        ("closed of degree 2", Basis::closed_uniform(2, 5).unwrap()),
        ("closed uneven", Basis::closed_b_spline(3, &[0.0, 1.0, 1.5, 1.5, 4.0, 4.1, 7.0]).unwrap()),
        ("Beta", Basis::beta(6, 2.5, 7.0).unwrap()),
        ("closed Beta", Basis::closed_beta(5, 0.4, 3.0).unwrap()),
        ("BBB", Basis::bbb(&ramp(7, 0.3, 0.7), &ramp(7, 0.0, 3.0), &ramp(8, 0.2, 0.8)).unwrap()),
        ("BBB with zero intervals", Basis::bbb(&ramp(10, 0.3, 0.7), &ramp(10, 0.0, 3.0), &mixed).unwrap()),
        ("BBB that passes its ends", {
            let intervals = [0.0, 0.0, 0.5, 2.0, 1.0, 0.0, 0.0];
            Basis::bbb(&ramp(6, 1.0, 0.5), &ramp(6, 1.0, 2.0), &intervals).unwrap()
        }),
        ("closed BBB", {
            Basis::closed_bbb(&ramp(6, 0.5, 0.3), &ramp(6, 0.0, 9.0), &[1.0, 2.0, 0.0, 0.5, 0.0, 1.5]).unwrap()
        }),
        ("extreme BBB", {
            let (bias, tension) = ([1e-3, 1e3, 1.0, 1e3, 1e-3, 1.0], [0.0, 1e6, 1e6, 0.0, 1e6, 1.0]);
            Basis::bbb(&bias, &tension, &[1.0, 1e-3, 1.0, 1e3, 0.0, 1.0, 1.0]).unwrap()
        }),
    ]
}

/// Points within a few units, and weights within `spread`.
pub(super) fn control(count: usize, spread: f64) -> (Vec<DVec3>, Vec<f64>) {
    let wave = |k: usize, f: f64| (k as f64 * f).sin() * 3.0;
    let points = (0..count).map(|k| DVec3::new(wave(k, 1.3), wave(k, 2.1), wave(k, 0.7))).collect();
    (points, (0..count).map(|k| spread.powf(wave(k, 3.7) / 3.0)).collect())
}

pub(super) fn curve(basis: &Basis, spread: f64) -> SplineCurve {
    let (points, weights) = control(basis.control_count(), spread);
    SplineCurve::new(basis.clone(), &points, &weights).unwrap()
}

fn samples(basis: &Basis, count: usize) -> Vec<f64> {
    let [low, high] = basis.domain();
    (0..=count).map(|k| low + (high - low) * k as f64 / count as f64).collect()
}

fn assert_same(name: &str, a: &SplineCurve, b: &SplineCurve, within: f64) {
    for t in samples(b.basis(), 60) {
        let gap = (a.point(t) - b.point(t)).length();
        assert!(gap < within, "{name} at {t}: {gap}");
    }
}

#[test]
fn bezier_points_are_convex_combinations_of_neighbours() {
    for (name, basis) in members() {
        let form = basis.form();
        for row in &form.rows {
            let terms: Vec<_> = row.terms(form.control_count).collect();
            let sum: f64 = terms.iter().map(|(_, weight)| weight).sum();
            assert!(terms.iter().all(|(_, weight)| *weight >= 0.0) && (sum - 1.0).abs() < 1e-15, "{name}: {terms:?}");
            assert!(terms.len() <= form.degree + 1);
        }
        assert!(form.breaks.is_sorted_by(|a, b| a < b), "{name}");
    }
}

#[test]
fn curves_follow_affine_maps() {
    let skew = DMat3::from_cols_array(&[1.0, 0.2, 0.0, -0.3, 0.8, 0.1, 0.0, 0.5, 1.3]);
    let placement = DAffine3 { matrix3: skew, translation: DVec3::new(4.0, 5.0, 6.0) };
    for (name, basis) in members() {
        let curve = curve(&basis, 100.0);
        let moved = curve.transformed(&placement);
        for t in samples(&basis, 50) {
            let gap = moved.point(t) - placement.transform_point3(curve.point(t));
            assert!(gap.length() < 1e-14 * 20.0, "{name} at {t}: {gap}");
        }
    }
}

#[test]
fn joints_degrees_and_directions_can_be_changed_without_changing_the_curve() {
    for (name, basis) in members() {
        for spread in [1.0, 50.0] {
            let curve = curve(&basis, spread);
            let [low, high] = basis.domain();
            let mut finer = curve.clone();
            for part in [0.31, 0.77, 0.5, 0.05] {
                finer = finer.with_joint(low + part * (high - low)).unwrap();
            }
            assert_eq!(finer.control().len(), curve.control().len() + 4);
            assert_same(name, &finer, &curve, 2e-13);
            for part in [0.4, 0.01] {
                let t = low + part * (high - low);
                for part in finer.subdivided(t).unwrap() {
                    let [from, to] = part.basis().domain();
                    for t in samples(part.basis(), 40) {
                        let end = if t == to { part.point(to) } else { part.point(t) };
                        let inside = if curve.basis().is_closed() { low + (t - low).rem_euclid(high - low) } else { t };
                        let gap = (end - curve.point(inside)).length();
                        assert!(gap < 1e-12, "{name} cut at {from}..{to}, {t}: {gap}");
                    }
                }
            }
            let elevated = curve.elevated().unwrap();
            assert_eq!(elevated.basis().degree(), basis.degree() + 1);
            assert_same(name, &elevated, &curve, 1e-13);
            let turned = curve.reversed();
            for t in samples(&basis, 50) {
                let gap = (turned.point(low + (high - t)) - curve.point(t)).length();
                assert!(gap < 1e-12, "{name} turned at {t}: {gap}");
            }
        }
    }
}

#[test]
fn every_joint_takes_as_many_joints_as_the_degree() {
    for (name, basis) in members().into_iter().filter(|(name, _)| *name != "extreme BBB") {
        let start = curve(&basis, 10.0);
        for &t in basis.breaks() {
            let mut finer = start.clone();
            for _ in 0..basis.degree() + 1 {
                match finer.with_joint(t) {
                    Ok(next) => finer = next,
                    Err(error) => {
                        assert!(matches!(error, SplineError::Multiplicity { .. }), "{name}: {error}");
                        break;
                    }
                }
            }
            assert!(finer.with_joint(t).is_err(), "{name} at {t}");
            assert_same(name, &finer, &start, 1e-12);
            let touches = finer.control().iter().any(|control| (control.point - start.point(t)).length() < 1e-13);
            assert!(touches, "{name} at {t}");
        }
    }
}

#[test]
fn derivatives_agree_with_differences() {
    for (name, basis) in members().into_iter().filter(|(name, _)| *name != "extreme BBB") {
        let curve = curve(&basis, 2.0);
        for pair in basis.breaks().windows(2) {
            let (t, h) = (0.6 * pair[0] + 0.4 * pair[1], 1e-5 * (pair[1] - pair[0]));
            let [first, second] = curve.derivatives(t);
            let difference = (curve.point(t + h) - curve.point(t - h)) / (2.0 * h);
            assert!((first - difference).length() < 1e-7 * (1.0 + 1.0 / h * 1e-4), "{name}");
            let difference = (curve.derivatives(t + h)[0] - curve.derivatives(t - h)[0]) / (2.0 * h);
            assert!((second - difference).length() < 1e-5 * (1.0 + second.length()), "{name}");
        }
    }
}

#[test]
fn closed_curves_end_where_they_begin_to_the_bit() {
    for (name, basis) in members().into_iter().filter(|(_, basis)| basis.is_closed()) {
        let curve = curve(&basis, 30.0);
        let [low, high] = basis.domain();
        assert_eq!(curve.point(low), curve.point(high), "{name}");
    }
}

#[test]
fn bad_bases_are_refused_with_the_place() {
    let fault = |result: Result<Basis, SplineError>| result.unwrap_err().to_string();
    assert_eq!(fault(Basis::bezier(0)), "degree 0 is outside 1..=32");
    assert_eq!(fault(Basis::bezier(usize::MAX)), format!("degree {} is outside 1..=32", usize::MAX));
    assert_eq!(fault(Basis::uniform(3, 1 << 40)), "1099511627776 control points were given, the limit is 1048576");
    assert_eq!(fault(Basis::uniform(3, 3)), "3 control points were given, at least 4 are needed");
    assert_eq!(fault(Basis::b_spline(1, &[0.0, 1.0])), "2 knots were given, at least 4 are needed");
    let knots = [0.0, 0.0, 1.0, 0.5, 2.0, 2.0];
    assert_eq!(fault(Basis::b_spline(1, &knots)), "knot 3 is 0.5, below the knot before it");
    let knots = [0.0, 0.0, 1.0, 1.0, 2.0, 2.0];
    assert_eq!(fault(Basis::b_spline(1, &knots)), "knot 2, 1, occurs 2 times; at most 1 are possible there");
    assert_eq!(fault(Basis::b_spline(1, &[0.0; 4])), "no span has a length above zero");
    let knots = [0.0, f64::NAN, 1.0, 1.0];
    assert_eq!(fault(Basis::b_spline(1, &knots)), "knot 1 is NaN, it must be a number within 1e100");
    assert_eq!(fault(Basis::bbb(&[1.0; 3], &[0.0; 3], &[1.0; 4])), "3 joints were given, at least 4 are needed");
    assert_eq!(fault(Basis::bbb(&[1.0; 4], &[0.0; 3], &[1.0; 5])), "3 tensions were given, 4 are needed");
    assert_eq!(fault(Basis::bbb(&[1.0; 4], &[0.0; 4], &[1.0; 4])), "4 intervals were given, 5 are needed");
    let bias = [1.0, 1.0, 0.0, 1.0];
    assert_eq!(fault(Basis::bbb(&bias, &[0.0; 4], &[1.0; 5])), "bias 2 is 0, it must be within 1e-9..=1e9");
    let tension = [0.0, -1.0, 0.0, 0.0];
    assert_eq!(fault(Basis::bbb(&[1.0; 4], &tension, &[1.0; 5])), "tension 1 is -1, it must be within 0..=1e12");
    let fault_of = |intervals: &[f64]| fault(Basis::bbb(&[1.0; 4], &[0.0; 4], intervals));
    assert!(fault_of(&[1.0, 1.0, 0.0, 0.0, 0.0]).starts_with("the intervals 2 and the two that follow it"));
    assert_eq!(fault_of(&[1.0, 1.0, 0.0, 1.0, 1.0]), "no span has a length above zero");
    let fault_of = |intervals: &[f64]| fault(Basis::bbb(&[1.0; 5], &[0.0; 5], intervals));
    assert!(fault_of(&[1.0, 1.0, 1e12, 1e-12, 1.0, 1.0]).starts_with("span 1 is 0 long"));
    let curve = curve(&Basis::uniform(2, 4).unwrap(), 1.0);
    assert!(matches!(curve.with_joint(1.0 + 1e-15), Err(SplineError::Short { .. })));
    assert_eq!(curve.with_joint(7.0).unwrap_err().to_string(), "parameter 7 is not inside 0..2");
    assert!(curve.subdivided(0.0).is_err() && curve.with_joint(f64::NAN).is_err());
}
