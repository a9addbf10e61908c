//! Well shaped triangles: edges inside of the polygon are flipped until each is locally Delaunay.

use glam::DVec2;

use crate::numeric::predicates::in_circle;

/// No triangle at the other side: an edge of the polygon.
const NONE: u32 = u32::MAX;

/// Makes a triangulation the constrained Delaunay triangulation of the same polygon: no corner that a triangle sees lies
/// inside of its circle. The smallest angle becomes as large as it can be without new points.
///
/// - `triangles`: counter-clockwise; each inner edge belongs to two of them, each edge of the polygon to one.
///
/// # Source
/// Lawson 1977; exact signs and the strict test end the flipping whatever the input.
pub(super) fn flip(corners: &[DVec2], triangles: &mut [[u32; 3]]) {
    // Side `3 t + k` of triangle t goes from its corner k to the next.
    let mut twins = twins(triangles);
    let mut pending: Vec<u32> = (0..twins.len() as u32).filter(|&side| twins[side as usize] < side).collect();
    let mut is_pending = vec![false; twins.len()];
    pending.iter().for_each(|&side| is_pending[side as usize] = true);
    while let Some(side) = pending.pop() {
        is_pending[side as usize] = false;
        let twin = twins[side as usize];
        if twin == NONE {
            continue;
        }
        let corner = |side: u32| triangles[side as usize / 3][side as usize % 3];
        let (from, to, apex, opposite) = (corner(side), corner(next(side)), corner(last(side)), corner(last(twin)));
        let [a, b, c, d] = [from, to, apex, opposite].map(|corner| corners[corner as usize]);
        if in_circle(a, b, c, d) <= 0.0 {
            continue;
        }
        // Sides of the quadrangle a d b c: the edge a b becomes d c.
        let outer = [last(side), next(twin), last(twin), next(side)].map(|side| twins[side as usize]);
        let (left, right) = (side / 3, twin / 3);
        triangles[left as usize] = [apex, from, opposite];
        triangles[right as usize] = [opposite, to, apex];
        let sides = [3 * left, 3 * left + 1, 3 * right, 3 * right + 1];
        for (own, other) in sides.into_iter().zip(outer).chain([(3 * left + 2, 3 * right + 2)]) {
            twins[own as usize] = other;
            if other != NONE {
                twins[other as usize] = own;
            }
        }
        for (own, other) in sides.into_iter().zip(outer) {
            if other != NONE && !is_pending[own as usize] && !is_pending[other as usize] {
                is_pending[own as usize] = true;
                pending.push(own);
            }
        }
    }
}

/// The side after `side` in its triangle.
fn next(side: u32) -> u32 {
    if side % 3 == 2 { side - 2 } else { side + 1 }
}

/// The side before `side` in its triangle.
fn last(side: u32) -> u32 {
    if side.is_multiple_of(3) { side + 2 } else { side - 1 }
}

/// For each side the one that runs along it the other way.
fn twins(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut ends: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * triangles.len());
    for (triangle, &[a, b, c]) in triangles.iter().enumerate() {
        for (k, [from, to]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
            ends.push(([from.min(to), from.max(to)], (3 * triangle + k) as u32));
        }
    }
    ends.sort_unstable();
    let mut twins = vec![NONE; ends.len()];
    for pair in ends.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        (twins[pair[0].1 as usize], twins[pair[1].1 as usize]) = (pair[1].1, pair[0].1);
    }
    twins
}
