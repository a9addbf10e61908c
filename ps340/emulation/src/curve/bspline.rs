//! B-spline curves and their rational form.

use super::{CurveFault, Expanded, MAX_CHORDS, MAX_ORDER, MAX_VERTICES, Projection, finite, parameter};
use protocol::command::Bspline;

/// Evaluates a B-spline at equal steps over the range of its knots.
///
/// Each point is found by the scheme of de Boor: order - 1 rounds of means of neighbours, whose weights lie in
/// 0..=1. It never leaves the hull of the vertices and loses about one rounding a round, at any order.
///
/// | | vertices of the spline | knots, and those that hold without KNOTS | range |
/// |---|---|---|---|
/// | OPEN NONPERIODIC | n, at least k | n + k: 0 k times, 1, 2 ..., n - k + 1 k times | knot k to knot n + 1 |
/// | OPEN PERIODIC | n, at least k | n + k: 0, 1, 2 ... | knot k to knot n + 1 |
/// | CLOSED NONPERIODIC | n and the first again, at least k | n + 1 + k, as above with n + 1 | knot k to knot n + 2 |
/// | CLOSED PERIODIC | n, again and again | n + 1: 0, 1 ... n; the distances repeat | all |
///
/// The first span of a closed periodic curve is that of the vertices 1 to k. A vertex of a rational curve is its
/// place and its weight: C(t) = sum w p N(t) / sum w N(t). Weights may be zero (the vertex does not pull) or
/// negative, as long as the sum of w N(t) keeps its sign from point to point.
///
/// # Errors
/// Wrong counts, values that are not finite, knots that decrease or are repeated more than k times, a zero or a
/// change of sign of the denominator, points that are too large for a vector.
///
/// # Source
/// De Boor 1972, "On calculating with B-splines"; the combinations of closure and period are ours where the
/// command reference is silent.
pub fn bspline(curve: &Bspline) -> Result<Expanded, CurveFault> {
    if !(1..=MAX_ORDER).contains(&curve.order) {
        return Err(CurveFault::Order(curve.order));
    }
    let order = usize::from(curve.order);
    let (given, cyclic) = (curve.vertices.len(), curve.closed && curve.periodic);
    let joined = given + usize::from(curve.closed && !curve.periodic);
    let least = if cyclic { 1 } else { (order + given - joined).max(1) };
    if !(least..=MAX_VERTICES).contains(&given) {
        return Err(CurveFault::Vertices { least, found: given });
    }
    finite(&curve.vertices)?;
    let knots = if cyclic { cyclic_knots(curve, order)? } else { knots(curve, order, joined)? };
    check_multiplicity(&knots, order, curve.knots.is_some() && cyclic)?;
    let range = [knots[order - 1], knots[knots.len() - order]];
    let reach = knots[0].abs().max(knots[knots.len() - 1].abs()) * 2.0 * f64::from(MAX_CHORDS);
    if !(range[1] > range[0] && reach.is_finite()) {
        return Err(CurveFault::NoRange);
    }
    let mut projection = Projection::new(curve.rational, curve.dimension, curve.chords)?;
    let mut span = order - 1;
    for index in 0..=curve.chords {
        let t = parameter(range, index, curve.chords);
        // The last span that is not empty and begins at or before t; the last of all holds its end too.
        while span + order < knots.len() - 1 && knots[span + 1] <= t {
            span += 1;
        }
        while knots[span] == knots[span + 1] {
            span -= 1;
        }
        projection.push(de_boor(curve, &knots, order, span, t))?;
    }
    let mut points = projection.points;
    // The seam is the same place twice; two spans may have rounded it differently.
    let seam = knots.iter().filter(|knot| **knot == range[0]).count();
    if cyclic
        && seam < order
        && let (Some(first), Some(last)) = (points.first().copied(), points.last_mut())
    {
        *last = first;
    }
    Ok(Expanded { points, parameters: range })
}

/// The knots of a curve that is not cyclic and has `joined` vertices.
fn knots(curve: &Bspline, order: usize, joined: usize) -> Result<Vec<f64>, CurveFault> {
    let needed = joined + order;
    if let Some(given) = &curve.knots {
        check_order(given, needed)?;
        return Ok(given.clone());
    }
    let spans = joined + 1 - order;
    let even = |index: usize| if curve.periodic { index } else { (index + 1).saturating_sub(order).min(spans) };
    Ok((0..needed).map(|index| even(index) as f64).collect())
}

/// The knots of a closed periodic curve: the n + 1 of one round, with k - 1 of the neighbouring rounds on either
/// side.
fn cyclic_knots(curve: &Bspline, order: usize) -> Result<Vec<f64>, CurveFault> {
    let n = curve.vertices.len();
    let round: Vec<f64> = match &curve.knots {
        Some(given) => {
            check_order(given, n + 1)?;
            given.clone()
        }
        None => (0..=n).map(|index| index as f64).collect(),
    };
    let period = round[n] - round[0];
    let before = (1..order).rev().map(|back| {
        let rounds = back.div_ceil(n);
        // From the seam, so that knots that are equal there stay equal.
        round[0] - ((rounds - 1) as f64 * period + (round[n] - round[rounds * n - back]))
    });
    let after = (1..order).map(|on| round[n] + ((on / n) as f64 * period + (round[on % n] - round[0])));
    let all: Vec<f64> = before.chain(round.iter().copied()).chain(after).collect();
    // Far from zero a rounding of the period may put a knot of another round on the wrong side.
    let mut highest = f64::NEG_INFINITY;
    Ok(all
        .into_iter()
        .map(|knot| {
            highest = highest.max(knot);
            highest
        })
        .collect())
}

/// Checks the number of the knots that were given, and that they are finite and do not decrease.
fn check_order(given: &[f64], needed: usize) -> Result<(), CurveFault> {
    if given.len() != needed {
        return Err(CurveFault::KnotCount { needed, found: given.len() });
    }
    let bad = |index: &usize| !given[*index].is_finite() || *index > 0 && given[*index] < given[*index - 1];
    match (0..given.len()).find(bad) {
        Some(index) => Err(CurveFault::KnotOrder(index + 1)),
        None => Ok(()),
    }
}

/// Checks that no knot is there more than `order` times. `extended`: order - 1 knots before the given ones.
fn check_multiplicity(knots: &[f64], order: usize, extended: bool) -> Result<(), CurveFault> {
    let repeated = knots.windows(order + 1).position(|window| window[0] == window[order]);
    match repeated {
        None => Ok(()),
        Some(index) if extended => Err(CurveFault::KnotMultiplicity((index + 2).saturating_sub(order).max(1))),
        Some(index) => Err(CurveFault::KnotMultiplicity(index + 1)),
    }
}

/// The homogeneous point at `t` in the span from knot `span` to the next, which is not empty.
fn de_boor(curve: &Bspline, knots: &[f64], order: usize, span: usize, t: f64) -> [f64; 4] {
    let first = span + 1 - order;
    let mut points = [[0.0_f64; 4]; MAX_ORDER as usize];
    for (offset, point) in points[..order].iter_mut().enumerate() {
        let [x, y, z, w] = curve.vertices[(first + offset) % curve.vertices.len()];
        *point = if curve.rational { [x * w, y * w, z * w, w] } else { [x, y, z, 1.0] };
    }
    for round in 1..order {
        for offset in (round..order).rev() {
            let (low, high) = (knots[first + offset], knots[first + offset + order - round]);
            let (before, after) = (high - t, t - low);
            let (keep, take) = (before / (high - low), after / (high - low));
            let left = points[offset - 1];
            let right = &mut points[offset];
            for axis in 0..4 {
                right[axis] = keep * left[axis] + take * right[axis];
            }
        }
    }
    points[order - 1]
}
