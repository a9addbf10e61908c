//! Pairs of triangles that have more in common than corners and the edges between.
//!
//! What two triangles have in common is convex, and its corners are corners of one that lie in the other, or points
//! where an edge of one passes through the other. If all of these are corners of both, it is at most an edge of both.

use super::predicates::Points;
use glam::DVec3;

/// The pairs, in the order of their lower numbers.
pub fn pairs(points: &Points, triangles: &[[u32; 3]]) -> Vec<[usize; 2]> {
    let boxes: Vec<[DVec3; 2]> = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|point| points.at[point as usize]);
            [a.min(b).min(c), a.max(b).max(c)]
        })
        .collect();
    // A plane sweeps along the axis on which the corners are spread widest.
    let (low, high) = boxes
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), [from, to]| (low.min(*from), high.max(*to)));
    let size = high - low;
    let axis = if size.x >= size.y.max(size.z) { 0 } else { if size.y >= size.z { 1 } else { 2 } };
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|&one, &two| boxes[one][0][axis].total_cmp(&boxes[two][0][axis]));
    let (mut found, mut open): (Vec<[usize; 2]>, Vec<usize>) = (Vec::new(), Vec::new());
    for one in order {
        let [low, high] = boxes[one];
        open.retain(|&two| boxes[two][1][axis] >= low[axis]);
        for &two in &open {
            let apart = boxes[two][0].cmpgt(high) | boxes[two][1].cmplt(low);
            if !apart.any() && meet(points, triangles[one], triangles[two]) {
                found.push([one.min(two), one.max(two)]);
            }
        }
        open.push(one);
    }
    found.sort_unstable();
    found
}

/// Whether two triangles with an area have more in common than corners and the edges between.
pub fn meet(points: &Points, one: [u32; 3], two: [u32; 3]) -> bool {
    let common = one.iter().filter(|corner| two.contains(corner)).count();
    if common == 3 {
        return true;
    }
    let [sides_one, sides_two] = [(two, one), (one, two)]
        .map(|(plane, of)| of.map(|corner| if plane.contains(&corner) { 0 } else { points.side(plane, corner) }));
    let are_beyond = |sides: [i32; 3]| sides.iter().all(|s| *s > 0) || sides.iter().all(|s| *s < 0);
    if are_beyond(sides_one) || are_beyond(sides_two) {
        return false;
    }
    if sides_one == [0; 3] {
        return meet_in_plane(points, one, two);
    }
    pierces(points, one, sides_one, two) || pierces(points, two, sides_two, one)
}

/// Whether a corner or an edge of a triangle is in another, but for corners of both.
///
/// - `sides`: on which side of the other's plane the corners are.
fn pierces(points: &Points, one: [u32; 3], sides: [i32; 3], two: [u32; 3]) -> bool {
    let axis = axis_of(points, two);
    (0..3).any(|k| sides[k] == 0 && !two.contains(&one[k]) && is_in(points, axis, two, one[k]))
        || [(0, 1), (1, 2), (2, 0)].into_iter().any(|(p, q)| {
            sides[p] * sides[q] < 0 && {
                // The line of the edge passes all edges of the other on one side, or meets them.
                let turns = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| points.side([one[p], one[q], two[a]], two[b]));
                turns.iter().all(|turn| *turn >= 0) || turns.iter().all(|turn| *turn <= 0)
            }
        })
}

/// Whether two triangles in one plane have more in common than corners and the edges between.
fn meet_in_plane(points: &Points, one: [u32; 3], two: [u32; 3]) -> bool {
    let axis = axis_of(points, one);
    let has_corner_of =
        |one: [u32; 3], two: [u32; 3]| two.iter().any(|c| !one.contains(c) && is_in(points, axis, one, *c));
    let edges = |t: [u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let cross = |[a, b]: [u32; 2], [p, q]: [u32; 2]| {
        points.turn(axis, [a, b, p]) * points.turn(axis, [a, b, q]) < 0
            && points.turn(axis, [p, q, a]) * points.turn(axis, [p, q, b]) < 0
    };
    has_corner_of(one, two)
        || has_corner_of(two, one)
        || edges(one).into_iter().any(|edge| edges(two).into_iter().any(|other| cross(edge, other)))
}

/// An axis along which a triangle has an area.
fn axis_of(points: &Points, triangle: [u32; 3]) -> usize {
    (0..3).find(|&axis| points.turn(axis, triangle) != 0).unwrap_or(0)
}

/// Whether a point in the plane of a triangle is in it or on its border, both seen against an axis.
fn is_in(points: &Points, axis: usize, [a, b, c]: [u32; 3], point: u32) -> bool {
    let facing = points.turn(axis, [a, b, c]);
    [[a, b], [b, c], [c, a]].into_iter().all(|[p, q]| points.turn(axis, [p, q, point]) * facing >= 0)
}
