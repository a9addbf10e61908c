//! Points in order and as many as a tolerance asks for.

use glam::DVec3;
use rayon::prelude::*;

use super::newton::NewtonSolver;
use super::point::{Branch, CurvePoint, CurvePrecision, Inaccuracy, Intersection, Mark};

/// How often a gap is halved at most.
const MOST_HALVINGS: u32 = 16;
/// The sagitta of an arc is its chord times its turn over 8; a curve that bends unevenly has somewhat more.
const SAGITTA: f64 = 1.5 / 8.0;

/// Takes out points that lie behind their followers, turns tangents along the branches, and adds points.
pub fn refine(solver: &NewtonSolver<'_>, precision: &CurvePrecision, intersection: &mut Intersection) {
    let branches = std::mem::take(&mut intersection.branches);
    let filled = |branch: Branch| {
        let branch = directed(settled(branch));
        match precision.chord.filter(|chord| *chord > 0.0) {
            Some(chord) => fill(solver, chord, branch),
            None => (branch, [0; 2]),
        }
    };
    let all: Vec<(Branch, [usize; 2])> = branches.into_par_iter().map(filled).collect();
    for (branch, [added, unfilled]) in all {
        intersection.branches.push(branch);
        intersection.counts.added += added;
        intersection.counts.unfilled += unfilled;
    }
}

/// Points of triangles that lie close together need not be in order on the exact curve: one from which the next leads
/// back along the tangent is not needed.
fn settled(branch: Branch) -> Branch {
    let is_needed = |last: &CurvePoint, point: &CurvePoint, next: &CurvePoint| {
        let before = (point.position - last.position).dot(point.tangent);
        let behind = (next.position - point.position).dot(point.tangent);
        // Behind a corner the surface has ended: what is looked for there stands before the corner.
        let is_superseded =
            point.inaccuracy == Some(Inaccuracy::Beyond) && [last, next].iter().any(|other| other.mark == Mark::Corner);
        let is_kept = point.mark != Mark::Regular || point.inaccuracy.is_some() && !is_superseded;
        is_kept || before * behind > 0.0
    };
    let points = branch.points;
    let count = points.len();
    let mut kept: Vec<CurvePoint> = Vec::with_capacity(count);
    for (index, point) in points.iter().enumerate() {
        let last = kept.last().or(if branch.is_closed { points.last() } else { None });
        let next = points.get(index + 1).or(if branch.is_closed { points.first() } else { None });
        let (Some(last), Some(next)) = (last, next) else {
            kept.push(*point);
            continue;
        };
        if count < 4 || is_needed(last, point, next) {
            kept.push(*point);
        }
    }
    Branch { points: kept, is_closed: branch.is_closed }
}

/// Turns tangents along the branch; where the surfaces do not tell the tangent, the points do.
fn directed(mut branch: Branch) -> Branch {
    let count = branch.points.len();
    let positions: Vec<DVec3> = branch.points.iter().map(|point| point.position).collect();
    let is_closed = branch.is_closed;
    let way = |index: usize, ahead: bool| {
        let at = |steps: usize| {
            let other = if ahead { index + steps } else { index + count - steps };
            let within = if ahead { other < count } else { other >= count };
            (within || is_closed).then(|| positions[other % count])
        };
        // Over copies of the point.
        let other = (1..count.min(4)).filter_map(at).find(|other| *other != positions[index])?;
        let way = (other - positions[index]).normalize_or_zero();
        Some(if ahead { way } else { -way })
    };
    for index in 0..count {
        let is_copy = |other: Option<usize>| other.is_some_and(|other| positions[other % count] == positions[index]);
        let before = way(index, false).filter(|_| !is_copy(index.checked_sub(1)));
        let behind = way(index, true).filter(|_| !is_copy(Some(index + 1).filter(|next| *next < count)));
        let chord = (before.unwrap_or_default() + behind.unwrap_or_default()).normalize_or_zero();
        let point = &mut branch.points[index];
        point.tangent = match point.tangent {
            tangent if point.inaccuracy.is_some() || tangent == DVec3::ZERO => chord,
            tangent if tangent.dot(chord) < 0.0 => -tangent,
            tangent => tangent,
        };
    }
    branch
}

/// Adds points until lines are near to the curve; how many, and how many gaps got none.
fn fill(solver: &NewtonSolver<'_>, chord: f64, branch: Branch) -> (Branch, [usize; 2]) {
    let Branch { points, is_closed } = branch;
    let gaps = if is_closed { points.len() } else { points.len().saturating_sub(1) };
    let inner = |index: usize| {
        let mut inner = Vec::new();
        let ends = [&points[index], &points[(index + 1) % points.len()]];
        let unfilled = divide(solver, chord, ends, MOST_HALVINGS, &mut inner);
        (inner, unfilled)
    };
    let inner: Vec<(Vec<CurvePoint>, usize)> = (0..gaps).into_par_iter().map(inner).collect();
    let (mut all, mut counts) = (Vec::new(), [0; 2]);
    for (index, point) in points.iter().enumerate() {
        all.push(*point);
        if let Some((inner, unfilled)) = inner.get(index) {
            counts[0] += inner.len();
            counts[1] += unfilled;
            all.extend(inner);
        }
    }
    (Branch { points: all, is_closed }, counts)
}

/// The points between two of which the tangents may point in either direction.
pub fn between(solver: &NewtonSolver<'_>, chord: f64, ends: [&CurvePoint; 2]) -> Vec<CurvePoint> {
    let way = ends[1].position - ends[0].position;
    let [from, to] = ends.map(|point| {
        let tangent = if point.tangent.dot(way) < 0.0 { -point.tangent } else { point.tangent };
        CurvePoint { tangent, ..*point }
    });
    let mut inner = Vec::new();
    divide(solver, chord, [&from, &to], MOST_HALVINGS, &mut inner);
    inner
}

/// Adds the points between two; how many gaps got none.
fn divide(
    solver: &NewtonSolver<'_>,
    chord: f64,
    [from, to]: [&CurvePoint; 2],
    halvings: u32,
    all: &mut Vec<CurvePoint>,
) -> usize {
    let way = to.position - from.position;
    let length = way.length();
    let turn = from.tangent.angle_between(to.tangent);
    // Curves along which surfaces touch are found otherwise.
    let is_tangent = from.mark == Mark::Tangent || to.mark == Mark::Tangent;
    if halvings == 0 || length == 0.0 || is_tangent || SAGITTA * length * turn <= chord {
        return 0;
    }
    let along = way / length;
    let places = if from.mark == Mark::Branching { to.coordinates } else { from.coordinates };
    let newton_point = solver.solve(places, from.position.midpoint(to.position), Some(along), length);
    if newton_point.inaccuracy.is_some() {
        return 1;
    }
    let mut middle = newton_point.point(Mark::Regular);
    if middle.tangent.dot(along) < 0.0 {
        middle.tangent = -middle.tangent;
    }
    let mut unfilled = divide(solver, chord, [from, &middle], halvings - 1, all);
    all.push(middle);
    unfilled += divide(solver, chord, [&middle, to], halvings - 1, all);
    unfilled
}
