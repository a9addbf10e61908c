//! Triangles that fill loops in a plane.

use super::contact::planar_orientation;
use super::facets::around;
use super::triangulation::{IncrementalTriangulation, NONE};
use crate::numeric::implicit::{ImplicitPoint, PointDefinition, others};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Triangles whose boundary is that of some loops, seen along an axis: where the loops wind around a place, as many
/// times and in that direction. So a loop that turns the other way within another leaves a hole. `None` where sides of
/// the loops, seen so, have more in common than the corners between them: then there are none without further points.
///
/// - `axis`: 0, 1 or 2, along which the loops are seen.
/// - `loops`: closed loops of points, by their numbers in `places`.
///
/// Cost: n log n, where few sides have others beside them.
pub fn filled(axis: usize, places: &[DVec3], loops: &[&[u32]]) -> Option<Vec<[u32; 3]>> {
    let sides: Vec<[u32; 2]> = loops.iter().flat_map(|points| sides_of(points)).collect();
    if !are_apart(axis, places, &sides) {
        return None;
    }
    let used: Vec<u32> = loops.iter().flat_map(|points| points.iter().copied()).collect();
    let helpers = around(axis, used.iter().map(|&point| places[point as usize]));
    let points: Vec<ImplicitPoint> =
        used.iter().map(|&point| ImplicitPoint::new(PointDefinition::Given(places[point as usize]))).collect();
    let mut triangulation = IncrementalTriangulation::new(axis, &helpers.each_ref());
    // Number inside by point, and point by number inside.
    let mut inside: FxHashMap<u32, u32> = FxHashMap::default();
    let mut outside = vec![NONE; 3];
    for (&point, place) in used.iter().zip(&points) {
        if inside.contains_key(&point) {
            continue;
        }
        let number = triangulation.insert(place);
        if number as usize != outside.len() {
            return None;
        }
        outside.push(point);
        inside.insert(point, number);
    }
    // How often the loops run along each edge in its direction, less how often the other way.
    let mut runs: FxHashMap<(u32, u32), i32> = FxHashMap::default();
    for [from, to] in sides {
        let (from, to) = (inside[&from], inside[&to]);
        triangulation.fix(from, to);
        *runs.entry((from, to)).or_default() += 1;
        *runs.entry((to, from)).or_default() -= 1;
    }
    let windings = windings(&triangulation, &runs)?;
    let mut filling = Vec::new();
    for (corners, winding) in triangulation.triangles.iter().zip(windings) {
        let [a, b, c] = corners.map(|corner| outside[corner as usize]);
        let turned = if winding > 0 { [a, b, c] } else { [a, c, b] };
        filling.extend(std::iter::repeat_n(turned, winding.unsigned_abs() as usize));
    }
    Some(filling)
}

/// From each point of a closed loop to the next.
fn sides_of(points: &[u32]) -> impl Iterator<Item = [u32; 2]> {
    (0..points.len()).map(|k| [points[k], points[(k + 1) % points.len()]])
}

/// Whether sides, seen along an axis, have only corners in common.
fn are_apart(axis: usize, places: &[DVec3], sides: &[[u32; 2]]) -> bool {
    let [x, y] = others(axis);
    let ends = |side: [u32; 2]| side.map(|point| places[point as usize]);
    let range = |side: [u32; 2], along: usize| {
        let [p, q] = ends(side);
        [p[along].min(q[along]), p[along].max(q[along])]
    };
    let mut order: Vec<usize> = (0..sides.len()).collect();
    order.sort_by(|&one, &two| range(sides[one], x)[0].total_cmp(&range(sides[two], x)[0]));
    for (place, &one) in order.iter().enumerate() {
        let [[_, end], [low, high]] = [range(sides[one], x), range(sides[one], y)];
        let after = order[place + 1..].iter().take_while(|&&two| range(sides[two], x)[0] <= end);
        for &two in after {
            let [from, to] = range(sides[two], y);
            if from <= high && low <= to && meet(axis, places, sides[one], sides[two]) {
                return false;
            }
        }
    }
    true
}

/// Whether two sides, seen along an axis, have more in common than a corner with one name.
fn meet(axis: usize, places: &[DVec3], one: [u32; 2], two: [u32; 2]) -> bool {
    let at = |point: u32| places[point as usize];
    let turn = |side: [u32; 2], point: u32| planar_orientation(axis, at(side[0]), at(side[1]), at(point));
    let is_common = |point: u32| one.contains(&point) && two.contains(&point);
    let (own, other) = (one.map(|point| turn(two, point)), two.map(|point| turn(one, point)));
    if one.iter().any(|&point| is_common(point)) {
        // On one line they run apart or along each other.
        let [Some(common), Some(p), Some(q)] = [
            one.into_iter().find(|&point| is_common(point)),
            one.into_iter().find(|&point| !is_common(point)),
            two.into_iter().find(|&point| !is_common(point)),
        ] else {
            // The same side, there or back.
            return false;
        };
        let way = |point: u32| at(point) - at(common);
        let mut along = way(p) * way(q);
        along[axis] = 0.0;
        return own == [0.0; 2] && other == [0.0; 2] && along.element_sum() > 0.0;
    }
    if own == [0.0; 2] {
        // On one line; their boxes touch.
        return true;
    }
    own[0] * own[1] <= 0.0 && other[0] * other[1] <= 0.0
}

/// The winding number of loops at each triangle; `None` if they are not closed.
fn windings(triangulation: &IncrementalTriangulation, runs: &FxHashMap<(u32, u32), i32>) -> Option<Vec<i32>> {
    let mut windings: Vec<Option<i32>> = vec![None; triangulation.triangles.len()];
    // Nothing winds around a triangle with a corner that helps.
    let first = triangulation.triangles.iter().position(|corners| corners.contains(&0))?;
    windings[first] = Some(0);
    let mut stack = vec![first];
    while let Some(triangle) = stack.pop() {
        let winding = windings[triangle]?;
        let corners = triangulation.triangles[triangle];
        for k in 0..3 {
            let next = triangulation.beyond[triangle][k];
            if next == NONE {
                continue;
            }
            // To the left of an edge they wind once more than to the right.
            let here = runs.get(&(corners[k], corners[(k + 1) % 3])).copied().unwrap_or(0);
            let there = winding - here;
            match windings[next as usize] {
                None => {
                    windings[next as usize] = Some(there);
                    stack.push(next as usize);
                }
                Some(known) if known != there => return None,
                Some(_) => {}
            }
        }
    }
    windings.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(places: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
        let twice = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| places[corner as usize]);
            (b - a).cross(c - a).z
        };
        triangles.iter().map(twice).sum::<f64>() / 2.0
    }

    fn square(places: &mut Vec<DVec3>, half: f64, center: f64) -> Vec<u32> {
        let first = places.len() as u32;
        places.extend(
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| DVec3::new(center + half * x, half * y, x * y)),
        );
        (first..first + 4).collect()
    }

    #[test]
    fn a_loop_that_turns_back_within_another_leaves_a_hole() {
        let mut places = Vec::new();
        let (outer, inner, beside) =
            (square(&mut places, 2.0, 0.0), square(&mut places, 1.0, 0.0), square(&mut places, 0.5, 9.0));
        let back: Vec<u32> = inner.iter().rev().copied().collect();
        let found = filled(2, &places, &[&outer, &back, &beside]).expect("they are apart");
        assert_eq!(area(&places, &found), 16.0 - 4.0 + 1.0);
        assert_eq!(found.len(), 8 + 2);
        let twice = filled(2, &places, &[&outer, &inner]).expect("they are apart");
        assert_eq!(area(&places, &twice), 16.0 + 4.0);
    }

    #[test]
    fn loops_that_cross_or_touch_are_not_filled() {
        let mut places = Vec::new();
        let (one, two) = (square(&mut places, 1.0, 0.0), square(&mut places, 1.0, 1.5));
        assert_eq!(filled(2, &places, &[&one, &two]), None);
        let beside = square(&mut places, 1.0, 2.0);
        assert_eq!(filled(2, &places, &[&one, &beside]), None);
        let bow = [one[0], one[1], one[3], one[2]];
        assert_eq!(filled(2, &places, &[&bow]), None);
        // There and back along one line.
        places.push(DVec3::new(3.0, -1.0, 0.0));
        let spike = [one[0], 12, one[1], one[2], one[3]];
        assert_eq!(filled(2, &places, &[&spike]), None);
    }

    #[test]
    fn a_long_comb_is_filled_without_a_triangle_outside() {
        let mut places = Vec::new();
        for k in 0..1000 {
            places.push(DVec3::new(f64::from(k), if k % 2 == 0 { 1.0 } else { 90.0 }, 0.0));
        }
        places.extend([DVec3::new(999.0, 0.0, 0.0), DVec3::ZERO]);
        let comb: Vec<u32> = (0..1002).collect();
        let found = filled(2, &places, &[&comb]).expect("it does not cross itself");
        assert_eq!(found.len(), 1000);
        let shoelace = |[p, q]: [u32; 2]| places[p as usize].truncate().perp_dot(places[q as usize].truncate());
        let expected = sides_of(&comb).map(shoelace).sum::<f64>() / 2.0;
        assert!((area(&places, &found) - expected).abs() < 1e-9);
    }
}
