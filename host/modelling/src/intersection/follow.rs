//! Following exact curves step by step.

use glam::DVec3;

use super::critical::CriticalPoint;
use super::newton::{NewtonPoint, NewtonSolver};

/// Steps at most.
const MOST_STEPS: usize = 20_000;
/// The cosine of the most that a curve may turn in a step.
const SHARP: f64 = 0.97;
/// The cosine of a turn after which steps grow.
const STRAIGHT: f64 = 0.995;
/// The shortest step, as a part of the longest.
const SHORTEST: f64 = 1e-6;

/// How following a curve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// At its beginning.
    Closed,
    /// At the end that was given.
    Left,
    /// At a point from which no step was possible any more.
    Lost,
}

/// Follows the curve from a point in a direction.
///
/// - `longest`: the longest step from a point on, model units.
/// - `goes_on`: whether to continue from a point.
/// - Returns the points behind the first, and how it ended.
pub fn follow(
    solver: &NewtonSolver<'_>,
    start: &NewtonPoint,
    direction: DVec3,
    longest: impl Fn(DVec3) -> f64,
    mut goes_on: impl FnMut(&NewtonPoint) -> bool,
) -> (Vec<NewtonPoint>, End) {
    let mut points = Vec::new();
    let (mut last, mut heading, mut step) = (*start, direction, 0.25 * longest(start.at));
    while points.len() < MOST_STEPS {
        let most = longest(last.at);
        step = step.min(most);
        let newton_point = solver.solve(last.coordinates, last.at + heading * step, Some(heading), step);
        let tangent = newton_point.tangent();
        let tangent = if tangent.dot(heading) < 0.0 { -tangent } else { tangent };
        if newton_point.inaccuracy.is_some() || tangent.dot(heading) < SHARP {
            step *= 0.5;
            if step < SHORTEST * most {
                return (points, End::Lost);
            }
            continue;
        }
        let ahead = |at: DVec3| (at - start.at).dot(direction);
        if points.len() > 2
            && ahead(last.at) < 0.0
            && ahead(newton_point.at) >= 0.0
            && newton_point.at.distance(start.at) < 2.0 * step
        {
            return (points, End::Closed);
        }
        if !goes_on(&newton_point) {
            return (points, End::Left);
        }
        points.push(newton_point);
        if tangent.dot(heading) > STRAIGHT {
            step *= 1.5;
        }
        (last, heading) = (newton_point, tangent);
    }
    (points, End::Lost)
}

/// Follows the curve along which two surfaces are at a level distance, in both directions from one of its points.
///
/// - `step`: from point to point, model units.
/// - Returns the points in order, and whether the last is joined to the first.
pub fn along_valley(solver: &NewtonSolver<'_>, start: &CriticalPoint, step: f64) -> (Vec<CriticalPoint>, bool) {
    let ahead = one_way(solver, start, start.directions[1], step);
    if let (points, true) = ahead {
        return (points, true);
    }
    let (mut points, _) = one_way(solver, start, -start.directions[1], step);
    points.reverse();
    points.extend(ahead.0.into_iter().skip(1));
    (points, false)
}

fn one_way(
    solver: &NewtonSolver<'_>,
    start: &CriticalPoint,
    direction: DVec3,
    step: f64,
) -> (Vec<CriticalPoint>, bool) {
    let (mut points, mut heading) = (vec![*start], direction);
    while points.len() < MOST_STEPS {
        let last = points[points.len() - 1];
        let Some(next) = solver.critical(last.coordinates, last.at + heading * step, step) else { break };
        let way = next.at - last.at;
        if !next.is_flat() || way.dot(heading) < 0.5 * step {
            break;
        }
        let ahead = |at: DVec3| (at - start.at).dot(direction);
        if points.len() > 2 && ahead(last.at) < 0.0 && ahead(next.at) >= 0.0 && next.at.distance(start.at) < 2.0 * step
        {
            return (points, true);
        }
        heading = if next.directions[1].dot(way) < 0.0 { -next.directions[1] } else { next.directions[1] };
        points.push(next);
    }
    (points, false)
}
