//! Triangles in the order of their locational codes, with boxes around runs of them: what is near what.
//!
//! Each triangle is filed once, under the code of the voxel that holds the middle of its box. Neighbours in that order
//! are neighbours in space, so that boxes around runs of a few, around eight such runs, and so on are small. Building
//! takes one sort; nothing is divided. It serves questions that meet each triangle seldom: which pairs of triangles of two
//! meshes may touch, and which triangles lie beside an axis-parallel ray.

use super::cube::Cube;
use super::{LocationalCode, MAX_DEPTH};
use crate::numeric::bounds::Bounds;
use glam::DVec3;
use rayon::prelude::*;
use std::cmp::Ordering;

/// Triangles in the smallest runs.
const RUN: usize = 4;
/// Boxes under a box.
const FAN: usize = 8;
/// Digits of the codes by which triangles are sorted.
const DIGITS: u32 = 10;
/// Pairs of boxes from which on the search goes on in parallel.
const TASKS: usize = 64;

/// Triangles sorted by locational code.
#[derive(Clone, Debug, Default)]
pub struct Sorted {
    /// Triangles in order.
    order: Vec<u32>,
    /// Their boxes, in that order.
    boxes: Vec<Bounds>,
    /// Boxes: around runs of triangles first, around all of them last.
    levels: Vec<Vec<Bounds>>,
}

/// A box of a [`Sorted`].
#[derive(Clone, Copy)]
struct Place {
    level: usize,
    index: usize,
}

impl Sorted {
    /// Sorts triangles; their corners must be finite.
    ///
    /// Cost: linear.
    pub fn new(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Sorted {
        if triangles.is_empty() {
            return Sorted::default();
        }
        let bounds = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [vertices[a as usize], vertices[b as usize], vertices[c as usize]];
            Bounds { min: a.min(b).min(c), max: a.max(b).max(c) }
        };
        let all = Bounds::of(vertices.iter().copied());
        let cube = Cube::around(all.min, all.max);
        let keys: Vec<u64> = triangles
            .par_iter()
            .enumerate()
            .with_min_len(4096)
            .map(|(index, triangle)| {
                let voxel = cube.voxel(bounds(triangle).center()).unwrap_or([(1 << MAX_DEPTH) - 1; 3]);
                (LocationalCode::containing(voxel, DIGITS).bits() >> (64 - 3 * DIGITS)) << 32 | index as u64
            })
            .collect();
        let order: Vec<u32> = radix_sorted(keys).into_iter().map(|key| key as u32).collect();
        let boxes: Vec<Bounds> = order.par_iter().with_min_len(4096).map(|&t| bounds(&triangles[t as usize])).collect();
        let union = |boxes: &[Bounds]| boxes.iter().fold(Bounds::EMPTY, |all, b| all.union(*b));
        let mut levels: Vec<Vec<Bounds>> = vec![boxes.par_chunks(RUN).with_min_len(1024).map(union).collect()];
        while let Some(boxes) = levels.last().filter(|boxes| boxes.len() > 1) {
            levels.push(boxes.chunks(FAN).map(union).collect());
        }
        Sorted { order, boxes, levels }
    }

    /// The box around all triangles; empty without any.
    pub fn bounds(&self) -> Bounds {
        self.top().map_or(Bounds::EMPTY, |top| self.at(top))
    }

    /// Pairs of triangles, one of this set and one of another, whose boxes have a point in common, in a fixed order.
    pub fn pairs(&self, other: &Sorted) -> Vec<[u32; 2]> {
        let (Some(one), Some(two)) = (self.top(), other.top()) else { return Vec::new() };
        let descend = |task: (Place, Place), found: &mut Vec<(Place, Place)>| self.descend(other, task, found);
        let search = |(one, two): (Place, Place), pairs: &mut Vec<[u32; 2]>| {
            let near = other.at(two);
            for i in self.run(one).filter(|&i| self.boxes[i].touches(near)) {
                let touching = other.run(two).filter(|&j| self.boxes[i].touches(other.boxes[j]));
                pairs.extend(touching.map(|j| [self.order[i], other.order[j]]));
            }
        };
        searched((one, two), descend, search)
    }

    /// Pairs of triangles of this set, the lower first, whose boxes have a point in common and that `keep` accepts, in a
    /// fixed order.
    pub fn pairs_within(&self, keep: impl Fn(u32, u32) -> bool + Sync) -> Vec<[u32; 2]> {
        let Some(top) = self.top() else { return Vec::new() };
        let descend = |task: (Place, Place), found: &mut Vec<(Place, Place)>| self.descend_both(task, found);
        let search = |(one, two): (Place, Place), pairs: &mut Vec<[u32; 2]>| {
            let near = self.at(two);
            for i in self.run(one).filter(|&i| self.boxes[i].touches(near)) {
                let later = self.run(two).filter(|&j| j > i && self.boxes[i].touches(self.boxes[j]));
                let pair = later.map(|j| [self.order[i].min(self.order[j]), self.order[i].max(self.order[j])]);
                pairs.extend(pair.filter(|&[a, b]| keep(a, b)));
            }
        };
        searched((top, top), descend, search)
    }

    /// Adds the pairs under two boxes of one level, the second not before the first, that touch.
    fn descend_both(&self, (one, two): (Place, Place), found: &mut Vec<(Place, Place)>) {
        for a in self.under(one).filter(|&a| self.at(a).touches(self.at(two))) {
            let later = self.under(two).filter(|b| b.index >= a.index && self.at(*b).touches(self.at(a)));
            found.extend(later.map(|b| (a, b)));
        }
    }

    /// Calls for every triangle whose box touches another.
    pub fn touching(&self, near: Bounds, mut visit: impl FnMut(u32)) {
        let mut stack: Vec<Place> = self.top().into_iter().collect();
        while let Some(place) = stack.pop() {
            if !self.at(place).touches(near) {
                continue;
            }
            if place.level == 0 {
                self.run(place).filter(|&i| self.boxes[i].touches(near)).for_each(|i| visit(self.order[i]));
            } else {
                stack.extend(self.under(place));
            }
        }
    }

    /// Visits triangles, those in near boxes first, and leaves out boxes that are farther than what a visit returned last.
    ///
    /// - `distance`: of a box.
    pub(super) fn search(&self, distance: impl Fn(Bounds) -> f64, mut visit: impl FnMut(u32) -> f64) {
        let mut limit = f64::INFINITY;
        let mut stack: Vec<(f64, Place)> = self.top().into_iter().map(|top| (0.0, top)).collect();
        while let Some((near, place)) = stack.pop() {
            if near > limit {
                continue;
            }
            if place.level == 0 {
                self.run(place).for_each(|i| limit = visit(self.order[i]));
                continue;
            }
            let first = stack.len();
            stack.extend(self.under(place).map(|place| (distance(self.at(place)), place)));
            stack[first..].sort_by(|(a, _), (b, _)| b.total_cmp(a));
        }
    }

    fn top(&self) -> Option<Place> {
        self.levels.len().checked_sub(1).map(|level| Place { level, index: 0 })
    }

    fn at(&self, place: Place) -> Bounds {
        self.levels[place.level][place.index]
    }

    /// Places in the order of the triangles of a run.
    fn run(&self, place: Place) -> std::ops::Range<usize> {
        place.index * RUN..self.order.len().min((place.index + 1) * RUN)
    }

    fn under(&self, place: Place) -> impl Iterator<Item = Place> {
        let level = place.level - 1;
        let first = place.index * FAN;
        (first..self.levels[level].len().min(first + FAN)).map(move |index| Place { level, index })
    }

    /// Adds the pairs under a pair of boxes, of which the one of the higher level is opened, or both, that touch.
    fn descend(&self, other: &Sorted, (one, two): (Place, Place), found: &mut Vec<(Place, Place)>) {
        let (a, b) = (self.at(one), other.at(two));
        match one.level.cmp(&two.level) {
            Ordering::Greater => {
                found.extend(self.under(one).filter(|&one| self.at(one).touches(b)).map(|one| (one, two)));
            }
            Ordering::Less => {
                found.extend(other.under(two).filter(|&two| other.at(two).touches(a)).map(|two| (one, two)));
            }
            Ordering::Equal => {
                for one in self.under(one).filter(|&one| self.at(one).touches(b)) {
                    let a = self.at(one);
                    found.extend(other.under(two).filter(|&two| other.at(two).touches(a)).map(|two| (one, two)));
                }
            }
        }
    }
}

/// Searches from a pair of boxes on, in a fixed order.
///
/// - `descend`: adds the pairs under a pair.
/// - `search`: adds what is found in a pair of runs.
fn searched(
    top: (Place, Place),
    descend: impl Fn((Place, Place), &mut Vec<(Place, Place)>) + Sync,
    search: impl Fn((Place, Place), &mut Vec<[u32; 2]>) + Sync,
) -> Vec<[u32; 2]> {
    let is_open = |(one, two): &(Place, Place)| one.level + two.level > 0;
    // Breadth first, until there is work for many threads.
    let mut tasks = vec![top];
    while !tasks.is_empty() && tasks.len() < TASKS && tasks.iter().any(is_open) {
        let mut next = Vec::new();
        tasks.into_iter().for_each(|task| if is_open(&task) { descend(task, &mut next) } else { next.push(task) });
        tasks = next;
    }
    let below = |task: (Place, Place)| {
        let mut pairs = Vec::new();
        let mut stack = Vec::with_capacity(256);
        stack.push(task);
        while let Some(task) = stack.pop() {
            if is_open(&task) { descend(task, &mut stack) } else { search(task, &mut pairs) }
        }
        pairs
    };
    let found: Vec<Vec<[u32; 2]>> = tasks.into_par_iter().map(below).collect();
    found.concat()
}

/// Keys sorted by their upper halves, by three passes over digits of 10 bits; the lower halves are in order already.
fn radix_sorted(mut keys: Vec<u64>) -> Vec<u64> {
    const BITS: u32 = DIGITS;
    let mut sorted = vec![0; keys.len()];
    for pass in 0..3 {
        let digit = |key: u64| (key >> (32 + pass * BITS)) as usize & ((1 << BITS) - 1);
        let mut starts = vec![0_u32; (1 << BITS) + 1];
        keys.iter().for_each(|&key| starts[digit(key) + 1] += 1);
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        for &key in &keys {
            let start = &mut starts[digit(key)];
            sorted[*start as usize] = key;
            *start += 1;
        }
        std::mem::swap(&mut keys, &mut sorted);
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    fn soup(count: u32, size: f64, seed: u64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
        let mut point = || DVec3::from([0; 3].map(|_| random.random_range(-1.0..1.0)));
        let vertices = (0..count)
            .flat_map(|_| {
                let a = point();
                [a, a + point() * size, a + point() * size]
            })
            .collect();
        (vertices, (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect())
    }

    #[test]
    fn pairs_are_those_that_a_search_of_all_finds() {
        for (one, two, size) in [(1, 1, 3.0), (5, 300, 0.3), (700, 500, 0.05), (200, 0, 0.1), (90, 80, 0.0)] {
            let (a, b) = (soup(one, size, 1), soup(two, size, 2));
            let corners = |soup: &(Vec<DVec3>, Vec<[u32; 3]>), t: u32| soup.1[t as usize].map(|v| soup.0[v as usize]);
            let (first, second) = (Sorted::new(&a.0, &a.1), Sorted::new(&b.0, &b.1));
            let mut found = first.pairs(&second);
            found.sort_unstable();
            let touch = |i, j| Bounds::of(corners(&a, i)).touches(Bounds::of(corners(&b, j)));
            let all = (0..one).flat_map(|i| (0..two).map(move |j| [i, j])).filter(|&[i, j]| touch(i, j));
            assert!(found.iter().copied().eq(all), "{one} {two}");
        }
    }

    #[test]
    fn pairs_within_a_set_are_those_that_a_search_of_all_finds() {
        for (count, size) in [(1, 3.0), (7, 1.0), (300, 0.3), (900, 0.05), (200, 0.0)] {
            let set = soup(count, size, 5);
            let corners = |t: u32| set.1[t as usize].map(|v| set.0[v as usize]);
            let mut found = Sorted::new(&set.0, &set.1).pairs_within(|a, b| (a + b) % 3 != 0);
            found.sort_unstable();
            let touch = |a, b| Bounds::of(corners(a)).touches(Bounds::of(corners(b))) && (a + b) % 3 != 0;
            let all = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b])).filter(|&[a, b]| touch(a, b));
            assert!(found.iter().copied().eq(all), "{count}");
        }
    }

    #[test]
    fn a_box_finds_all_that_touch_it() {
        let (vertices, triangles) = soup(1000, 0.1, 3);
        let sorted = Sorted::new(&vertices, &triangles);
        let near = Bounds::of([DVec3::splat(-0.1), DVec3::new(0.2, 0.1, 0.3)]);
        let mut found = Vec::new();
        sorted.touching(near, |t| found.push(t));
        let touches = |t: &u32| Bounds::of(triangles[*t as usize].map(|v| vertices[v as usize])).touches(near);
        found.sort_unstable();
        assert_eq!(found, (0..1000).filter(touches).collect::<Vec<u32>>());
        assert!(found.len() > 5 && sorted.bounds() == Bounds::of(vertices));
    }
}
