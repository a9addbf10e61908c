//! A triangulation of points in a plane with given edges, by exact turns of points that may be implicit.
//!
//! Points go in one by one; edges that must be there are made by exchanging diagonals. Between the given edges the
//! triangles are those of Delaunay as far as rounded places tell: shape is a matter of taste, turns are not.
//!
//! # Source
//! Lawson 1977 for the exchange of diagonals; Sloan 1993 for given edges.

use crate::numeric::implicit::{ImplicitPoint, compare, others, turn};
use glam::DVec2;
use rustc_hash::FxHashSet;
use std::cmp::Ordering;
use std::collections::VecDeque;

/// No triangle: the edge is on the border.
pub const NONE: u32 = u32::MAX;

/// A triangulation that grows.
pub struct IncrementalTriangulation<'a> {
    axis: usize,
    points: Vec<&'a ImplicitPoint>,
    /// Corners of each triangle, counter-clockwise as seen along the axis.
    pub triangles: Vec<[u32; 3]>,
    /// The triangle beyond the side from corner k to the next, or [`NONE`].
    pub beyond: Vec<[u32; 3]>,
    /// Sides of what it began with that each point is on, a bit for each.
    sides: Vec<u8>,
    /// Number of these sides.
    corners: u32,
    /// Some triangle at each point.
    at: Vec<u32>,
    fixed: FxHashSet<[u32; 2]>,
    last: u32,
    /// Triangles that a point was put into, for the while that these are looked at.
    changed: Vec<u32>,
}

/// Points that most triangulations have at most.
pub const TYPICAL_POINTS: usize = 13;

/// A list with room for more.
fn with_capacity<T: Clone>(first: &[T], room: usize) -> Vec<T> {
    let mut list = Vec::with_capacity(first.len().max(room));
    list.extend_from_slice(first);
    list
}

fn sorted(a: u32, b: u32) -> [u32; 2] {
    if a < b { [a, b] } else { [b, a] }
}

impl<'a> IncrementalTriangulation<'a> {
    /// Begins with a triangle or a convex quadrilateral that turns counter-clockwise as seen along `axis`.
    pub fn new(axis: usize, corners: &[&'a ImplicitPoint]) -> IncrementalTriangulation<'a> {
        let is_quad = corners.len() == 4;
        IncrementalTriangulation {
            axis,
            points: with_capacity(corners, TYPICAL_POINTS),
            sides: with_capacity(
                if is_quad { &[0b1001, 0b0011, 0b0110, 0b1100] } else { &[0b101, 0b011, 0b110] },
                TYPICAL_POINTS,
            ),
            corners: corners.len() as u32,
            triangles: with_capacity(if is_quad { &[[0, 1, 2], [2, 3, 0]] } else { &[[0, 1, 2]] }, 2 * TYPICAL_POINTS),
            beyond: with_capacity(
                if is_quad { &[[NONE, NONE, 1], [NONE, NONE, 0]] } else { &[[NONE; 3]] },
                2 * TYPICAL_POINTS,
            ),
            at: with_capacity(&[0, 0, 0, 1][..corners.len()], TYPICAL_POINTS),
            fixed: FxHashSet::default(),
            last: 0,
            changed: Vec::with_capacity(TYPICAL_POINTS),
        }
    }

    fn turn(&self, a: u32, b: u32, c: u32) -> f64 {
        if self.sides[a as usize] & self.sides[b as usize] & self.sides[c as usize] != 0 {
            return 0.0;
        }
        turn(self.axis, self.points[a as usize], self.points[b as usize], self.points[c as usize])
    }

    /// Whether an edge was given.
    pub fn is_fixed(&self, a: u32, b: u32) -> bool {
        self.fixed.contains(&sorted(a, b))
    }

    /// Adds a point inside what it began with; returns its number, that of an earlier one at the same place if there is one.
    pub fn insert(&mut self, point: &'a ImplicitPoint) -> u32 {
        let p = self.push(point, 0);
        let (triangle, turns) = self.locate(p);
        let on = |k: usize| turns[k] == 0.0;
        if let Some(k) = (0..3).find(|&k| on(k) && on((k + 2) % 3)) {
            self.points.pop();
            self.sides.pop();
            self.at.pop();
            return self.triangles[triangle as usize][k];
        }
        match (0..3).find(|&k| on(k)) {
            Some(k) => self.split_side(triangle, k, p),
            None => self.split_inside(triangle, p),
        }
        self.last = self.at[p as usize];
        p
    }

    /// Adds points on side `k` of what it began with, in order from corner `k` to the next, before all others.
    pub fn insert_on_side(&mut self, k: u8, points: impl IntoIterator<Item = &'a ImplicitPoint>) {
        let (mut from, to) = (u32::from(k), (u32::from(k) + 1) % self.corners);
        for point in points {
            let p = self.push(point, 1 << k);
            if let Some((triangle, side)) = self.along(from, to) {
                self.split_side(triangle, side, p);
            }
            from = p;
        }
    }

    fn push(&mut self, point: &'a ImplicitPoint, sides: u8) -> u32 {
        self.points.push(point);
        self.sides.push(sides);
        self.at.push(NONE);
        self.points.len() as u32 - 1
    }

    /// The triangle that a point is in, and how the point turns from each side.
    fn locate(&self, p: u32) -> (u32, [f64; 3]) {
        let turns_in = |triangle: u32| {
            let [a, b, c] = self.triangles[triangle as usize];
            [self.turn(a, b, p), self.turn(b, c, p), self.turn(c, a, p)]
        };
        let mut triangle = self.last;
        // A walk may go in circles where the triangles are not those of Delaunay.
        for step in 0..self.triangles.len() + 3 {
            let turns = turns_in(triangle);
            let Some(k) = (0..3).map(|k| (k + step) % 3).find(|&k| turns[k] < 0.0) else { return (triangle, turns) };
            let next = self.beyond[triangle as usize][k];
            if next == NONE {
                break;
            }
            triangle = next;
        }
        let all = 0..self.triangles.len() as u32;
        let found = all.map(|t| (t, turns_in(t))).find(|(_, turns)| turns.iter().all(|t| *t >= 0.0));
        found.unwrap_or((0, turns_in(0)))
    }

    /// Writes a triangle, and makes its neighbours and corners know it.
    fn put(&mut self, triangle: u32, corners: [u32; 3], beyond: [u32; 3]) {
        self.triangles[triangle as usize] = corners;
        self.beyond[triangle as usize] = beyond;
        for k in 0..3 {
            self.at[corners[k] as usize] = triangle;
            if beyond[k] != NONE {
                let side = self.side(beyond[k], corners[(k + 1) % 3]);
                self.beyond[beyond[k] as usize][side] = triangle;
            }
        }
    }

    fn new_slot(&mut self) -> u32 {
        self.triangles.push([0; 3]);
        self.beyond.push([NONE; 3]);
        self.triangles.len() as u32 - 1
    }

    /// The side of a triangle that begins at a point.
    fn side(&self, triangle: u32, from: u32) -> usize {
        self.triangles[triangle as usize].iter().position(|&corner| corner == from).unwrap_or(0)
    }

    fn split_inside(&mut self, triangle: u32, p: u32) {
        let [a, b, c] = self.triangles[triangle as usize];
        let [ab, bc, ca] = self.beyond[triangle as usize];
        let (second, third) = (self.new_slot(), self.new_slot());
        self.put(triangle, [a, b, p], [ab, second, third]);
        self.put(second, [b, c, p], [bc, third, triangle]);
        self.put(third, [c, a, p], [ca, triangle, second]);
        self.changed.extend([triangle, second, third]);
        self.legalize(p);
    }

    fn split_side(&mut self, triangle: u32, k: usize, p: u32) {
        let corners = self.triangles[triangle as usize];
        let beyond = self.beyond[triangle as usize];
        let [a, b, c] = [corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]];
        let [across, bc, ca] = [beyond[k], beyond[(k + 1) % 3], beyond[(k + 2) % 3]];
        if self.fixed.remove(&sorted(a, b)) {
            self.fixed.extend([sorted(a, p), sorted(p, b)]);
        }
        let second = self.new_slot();
        self.changed.extend([triangle, second]);
        if across == NONE {
            self.put(triangle, [a, p, c], [NONE, second, ca]);
            self.put(second, [p, b, c], [NONE, bc, triangle]);
        } else {
            let j = self.side(across, b);
            let d = self.triangles[across as usize][(j + 2) % 3];
            let [ad, db] = [self.beyond[across as usize][(j + 1) % 3], self.beyond[across as usize][(j + 2) % 3]];
            let fourth = self.new_slot();
            self.put(triangle, [a, p, c], [across, second, ca]);
            self.put(second, [p, b, c], [fourth, bc, triangle]);
            self.put(across, [p, a, d], [triangle, ad, fourth]);
            self.put(fourth, [b, p, d], [second, across, db]);
            self.changed.extend([across, fourth]);
        }
        self.legalize(p);
    }

    /// Exchanges diagonals opposite to a new point until all are as Delaunay wants them.
    fn legalize(&mut self, p: u32) {
        // Rounded places may disagree with each other; a bound makes that harmless.
        let mut steps_left = 16 * self.changed.len() + 4 * self.triangles.len();
        while let Some(triangle) = self.changed.pop() {
            let k = self.side(triangle, p);
            let (opposite, across) = ((k + 1) % 3, self.beyond[triangle as usize][(k + 1) % 3]);
            let [_, a, b] = [0, 1, 2].map(|i| self.triangles[triangle as usize][(k + i) % 3]);
            if across == NONE || self.is_fixed(a, b) || steps_left == 0 {
                continue;
            }
            let j = self.side(across, b);
            let d = self.triangles[across as usize][(j + 2) % 3];
            if self.is_in_circle([p, a, b], d) && self.turn(p, a, d) > 0.0 && self.turn(p, d, b) > 0.0 {
                self.exchange(triangle, opposite);
                self.changed.extend([triangle, across]);
                steps_left -= 1;
            }
        }
    }

    fn is_in_circle(&self, triangle: [u32; 3], d: u32) -> bool {
        let [x, y] = others(self.axis);
        let at = |p: u32| {
            let near = self.points[p as usize].near();
            DVec2::new(near[x], near[y])
        };
        let d = at(d);
        let [a, b, c] = triangle.map(|p| at(p) - d);
        let terms = [
            a.length_squared() * b.perp_dot(c),
            b.length_squared() * c.perp_dot(a),
            c.length_squared() * a.perp_dot(b),
        ];
        // Four points of a grid are on one circle; either diagonal will do.
        terms[0] + terms[1] + terms[2] > terms.into_iter().map(f64::abs).sum::<f64>() * 4e-15
    }

    /// Exchanges the diagonal at side `k` of a triangle; the two triangles keep their numbers.
    fn exchange(&mut self, triangle: u32, k: usize) {
        let across = self.beyond[triangle as usize][k];
        let [a, b, c] = [0, 1, 2].map(|i| self.triangles[triangle as usize][(k + i) % 3]);
        let [bc, ca] = [1, 2].map(|i| self.beyond[triangle as usize][(k + i) % 3]);
        let j = self.side(across, b);
        let d = self.triangles[across as usize][(j + 2) % 3];
        let [ad, db] = [1, 2].map(|i| self.beyond[across as usize][(j + i) % 3]);
        self.put(triangle, [a, d, c], [ad, across, ca]);
        self.put(across, [d, b, c], [db, bc, triangle]);
    }

    /// All triangles at a point, with the place of the point among their corners.
    pub fn around(&self, p: u32) -> impl Iterator<Item = (u32, usize)> {
        let first = self.at[p as usize];
        let mut triangle = first;
        // To the left until it comes round or to the border, and then to the right from the first.
        let mut step = 2;
        std::iter::from_fn(move || {
            if triangle == NONE && step == 2 {
                step = 0;
                triangle = self.beyond[first as usize][self.side(first, p)];
            }
            if triangle == NONE {
                return None;
            }
            let (here, k) = (triangle, self.side(triangle, p));
            triangle = self.beyond[here as usize][(k + step) % 3];
            if step == 2 && triangle == first {
                (step, triangle) = (0, NONE);
            }
            Some((here, k))
        })
    }

    /// The triangle with a side from `a` to `b`, and that side.
    pub fn along(&self, a: u32, b: u32) -> Option<(u32, usize)> {
        self.around(a).find(|&(triangle, k)| self.triangles[triangle as usize][(k + 1) % 3] == b)
    }

    /// Makes the straight line between two points consist of edges that stay.
    pub fn fix(&mut self, from: u32, to: u32) {
        let mut from = from;
        // Points on the line divide it.
        while from != to {
            // Mostly the edge is there; turns of points on one line are the dearest.
            if self.along(from, to).is_some() || self.along(to, from).is_some() {
                self.fixed.insert(sorted(from, to));
                return;
            }
            let (crossed, reached) = self.crossed(from, to);
            self.uncross(from, reached, crossed);
            self.fixed.insert(sorted(from, reached));
            from = reached;
        }
    }

    /// Whether `a` lies from `from` in the direction of `to`, all on one line.
    fn is_ahead(&self, from: u32, a: u32, to: u32) -> bool {
        let order = |p: u32, q: u32| {
            let [x, y] = others(self.axis);
            let [p, q] = [p, q].map(|p| self.points[p as usize]);
            compare(x, p, q).then_with(|| compare(y, p, q))
        };
        order(from, a) == order(from, to) && order(from, a) != Ordering::Equal
    }

    /// The edges that the line from one point towards another crosses up to the next point on it, and that point.
    fn crossed(&self, from: u32, to: u32) -> (VecDeque<[u32; 2]>, u32) {
        let mut crossed = VecDeque::new();
        let mut entry = None;
        for (triangle, k) in self.around(from) {
            let [a, b] = [1, 2].map(|i| self.triangles[triangle as usize][(k + i) % 3]);
            let [left, right] = [self.turn(from, to, b), self.turn(from, to, a)];
            for (corner, turn) in [(a, right), (b, left)] {
                if turn == 0.0 && self.is_ahead(from, corner, to) {
                    return (crossed, corner);
                }
            }
            if right < 0.0 && left > 0.0 {
                entry = Some((triangle, (k + 1) % 3));
            }
        }
        // The line leaves through the side opposite to where it came in; `side` goes from its right to its left.
        while let Some((triangle, side)) = entry {
            let [a, b] = [0, 1].map(|i| self.triangles[triangle as usize][(side + i) % 3]);
            crossed.push_back([a, b]);
            let next = self.beyond[triangle as usize][side];
            if next == NONE {
                break;
            }
            let j = self.side(next, b);
            let apex = self.triangles[next as usize][(j + 2) % 3];
            let turn = if apex == to { 0.0 } else { self.turn(from, to, apex) };
            if turn == 0.0 {
                return (crossed, apex);
            }
            // The sides of `next` go b to a, a to apex, apex to b; a is on the right, b on the left.
            entry = Some((next, if turn > 0.0 { (j + 1) % 3 } else { (j + 2) % 3 }));
        }
        (VecDeque::new(), to)
    }

    /// Exchanges diagonals until none crosses the line.
    fn uncross(&mut self, from: u32, to: u32, mut crossed: VecDeque<[u32; 2]>) {
        // Each turn through the queue removes a crossing at least; the square bounds all.
        let mut steps_left = 4 * (crossed.len() + 2) * (crossed.len() + 2);
        while let Some([a, b]) = crossed.pop_front() {
            let Some((triangle, k)) = self.along(a, b) else { continue };
            let c = self.triangles[triangle as usize][(k + 2) % 3];
            let across = self.beyond[triangle as usize][k];
            if across == NONE || steps_left == 0 {
                continue;
            }
            steps_left -= 1;
            let j = self.side(across, b);
            let d = self.triangles[across as usize][(j + 2) % 3];
            // The diagonal becomes d c: both new triangles must turn the right way.
            if self.turn(a, d, c) <= 0.0 || self.turn(d, b, c) <= 0.0 {
                crossed.push_back([a, b]);
                continue;
            }
            self.exchange(triangle, k);
            let is_end = |p: u32| p == from || p == to;
            if !is_end(c) && !is_end(d) && self.turn(from, to, c) * self.turn(from, to, d) < 0.0 {
                crossed.push_back([d, c]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::implicit::PointDefinition;
    use glam::DVec3;
    use rand::{RngExt, SeedableRng};

    fn given(x: f64, y: f64) -> ImplicitPoint {
        ImplicitPoint::new(PointDefinition::Given(DVec3::new(x, y, 0.0)))
    }

    fn check(t: &IncrementalTriangulation, area: f64) {
        let mut sum = 0.0;
        for (index, corners) in t.triangles.iter().enumerate() {
            let [a, b, c] = *corners;
            assert!(t.turn(a, b, c) > 0.0);
            let [p, q, r] = corners.map(|p| t.points[p as usize].near());
            sum += (q - p).cross(r - p).z / 2.0;
            for k in 0..3 {
                let next = t.beyond[index][k];
                if next != NONE {
                    let side = t.side(next, corners[(k + 1) % 3]);
                    assert_eq!(
                        (t.beyond[next as usize][side], t.triangles[next as usize][(side + 1) % 3]),
                        (index as u32, corners[k])
                    );
                }
            }
        }
        assert!((sum - area).abs() < 1e-9 * area);
    }

    #[test]
    fn points_and_lines_on_a_grid_are_all_there() {
        // A grid is full of points on one line and on one circle.
        let corners = [given(0.0, 0.0), given(16.0, 0.0), given(0.0, 16.0)];
        let grid: Vec<ImplicitPoint> =
            (0..=16).flat_map(|x| (0..=16 - x).map(move |y| given(f64::from(x), f64::from(y)))).collect();
        let mut t = IncrementalTriangulation::new(2, &corners.each_ref());
        let numbers: Vec<u32> = grid.iter().map(|p| t.insert(p)).collect();
        assert_eq!(t.points.len(), 17 * 18 / 2);
        assert_eq!(t.triangles.len(), 256);
        check(&t, 128.0);
        let number = |x: u32, y: u32| {
            numbers[grid.iter().position(|p| p.near() == DVec3::new(x.into(), y.into(), 0.0)).unwrap()]
        };
        for (from, to) in [((0, 0), (8, 5)), ((1, 2), (1, 15)), ((4, 2), (11, 3)), ((2, 3), (10, 6)), ((2, 14), (5, 5))]
        {
            t.fix(number(from.0, from.1), number(to.0, to.1));
            check(&t, 128.0);
        }
        for (a, b) in [((0, 0), (8, 5)), ((1, 6), (1, 7)), ((4, 2), (11, 3)), ((2, 3), (10, 6))] {
            let [a, b] = [number(a.0, a.1), number(b.0, b.1)];
            assert!(t.is_fixed(a, b) && t.along(a, b).is_some());
        }
    }

    #[test]
    fn random_points_and_lines_from_a_star_are_all_there() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(5);
        let corners = [given(-4.0, -2.0), given(4.0, -2.0), given(0.0, 4.0)];
        let points: Vec<ImplicitPoint> =
            (0..300).map(|_| given(random.random_range(-0.9..0.9), random.random_range(-0.9..0.9))).collect();
        let mut t = IncrementalTriangulation::new(2, &corners.each_ref());
        let numbers: Vec<u32> = points.iter().map(|p| t.insert(p)).collect();
        for &to in &numbers[1..40] {
            t.fix(numbers[0], to);
            check(&t, 24.0);
        }
        assert!(numbers[1..40].iter().all(|&to| t.is_fixed(numbers[0], to) && t.along(numbers[0], to).is_some()));
    }
}
