//! A bounding volume hierarchy over triangles in the order of their locational codes: what is near what.
//!
//! Each triangle is in it once, under the code of the voxel that holds the middle of its box. Neighbours in that order
//! are neighbours in space, so that boxes around groups of a few, around groups of these, and so on are small. Building
//! takes one sort; nothing is divided. It serves questions that reach each triangle seldom: which pairs of triangles of
//! two meshes may touch, and which triangles lie beside an axis-parallel ray.

use super::cube::Cube;
use super::{LocationalCode, MAX_DEPTH};
use crate::numeric::bounds::Bounds;
use glam::DVec3;
use rayon::prelude::*;
use wide::f64x4;

/// Boxes under a box.
const FAN: usize = 4;
/// The lanes of all of them, a bit for each.
const ALL: u8 = (1 << FAN) - 1;
/// Digits of the codes by which triangles are sorted.
pub(super) const DIGITS: u32 = 10;
/// Pairs of boxes from which on the search continues in parallel.
const TASKS: usize = 64;

/// A four-wide BVH over triangles that are sorted by locational code.
#[derive(Clone, Debug, Default)]
pub struct TriangleBvh {
    /// Triangles in order.
    order: Vec<u32>,
    /// Boxes by level, some at a time: those of triangles, in order, then those around each group of the level before.
    levels: Vec<Vec<Group>>,
}

/// Some of the triangles that were sorted.
#[derive(Clone, Debug)]
pub struct BvhSubset<'a> {
    sorted: &'a TriangleBvh,
    /// By level, of each group of boxes, the lanes that hold some of them, a bit for each; empty for all.
    lanes: Vec<Vec<u8>>,
}

impl BvhSubset<'_> {
    /// The lanes under a box.
    #[inline]
    fn lanes(&self, place: Place) -> u8 {
        self.lanes.get(place.level as usize - 1).map_or(ALL, |level| level[place.index as usize])
    }
}

/// A group of boxes, as many as are under a box, coordinate by coordinate, to be compared at once. Where there are
/// fewer, the last are empty.
#[derive(Clone, Debug)]
struct Group {
    min: [f64x4; 3],
    max: [f64x4; 3],
}

impl Group {
    fn of(boxes: &[Bounds]) -> Group {
        let lane = |lane: usize| boxes.get(lane).copied().unwrap_or(Bounds::EMPTY);
        let lanes: [Bounds; FAN] = std::array::from_fn(lane);
        let coordinates = |pick: fn(&Bounds) -> DVec3| {
            std::array::from_fn(|axis| f64x4::new(lanes.each_ref().map(|bounds| pick(bounds)[axis])))
        };
        Group { min: coordinates(|bounds| bounds.min), max: coordinates(|bounds| bounds.max) }
    }

    #[inline(always)]
    fn at(&self, lane: usize) -> Bounds {
        let coordinate = |of: &[f64x4; 3]| DVec3::from([0, 1, 2].map(|axis| of[axis].as_array()[lane]));
        Bounds { min: coordinate(&self.min), max: coordinate(&self.max) }
    }

    /// The box around all.
    fn union(&self) -> Bounds {
        (0..FAN).fold(Bounds::EMPTY, |all, lane| all.union(self.at(lane)))
    }

    /// The boxes of some lanes, a bit for each, that have a point in common with another, the last first.
    #[inline(always)]
    fn touching(&self, other: Bounds, lanes: u8) -> impl Iterator<Item = usize> + use<> {
        let apart = |axis: usize| {
            self.min[axis].simd_gt(f64x4::splat(other.max[axis]))
                | self.max[axis].simd_lt(f64x4::splat(other.min[axis]))
        };
        let mut left = !(apart(0) | apart(1) | apart(2)).to_bitmask() & u32::from(lanes);
        std::iter::from_fn(move || {
            let lane = left.checked_ilog2()?;
            left ^= 1 << lane;
            Some(lane as usize)
        })
    }
}

/// A box of a [`TriangleBvh`]: on level 0 that of a triangle.
#[derive(Clone, Copy)]
struct Place {
    level: u32,
    index: u32,
}

impl Place {
    /// The place under it in a lane.
    #[inline]
    fn under(self, lane: usize) -> Place {
        Place { level: self.level - 1, index: self.index * FAN as u32 + lane as u32 }
    }
}

/// Two boxes.
type Pair = (Place, Place);

impl TriangleBvh {
    /// Sorts triangles; their corners must be finite.
    ///
    /// Cost: linear.
    pub fn new(vertices: &[DVec3], triangles: &[[u32; 3]]) -> TriangleBvh {
        if triangles.is_empty() {
            return TriangleBvh::default();
        }
        let bounds = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [vertices[a as usize], vertices[b as usize], vertices[c as usize]];
            Bounds { min: a.min(b).min(c), max: a.max(b).max(c) }
        };
        let bounds: Vec<Bounds> = triangles.par_iter().with_min_len(4096).map(bounds).collect();
        let all = bounds.iter().copied().fold(Bounds::EMPTY, Bounds::union);
        let cube = Cube::around(all.min, all.max);
        let keys: Vec<u64> = bounds
            .par_iter()
            .enumerate()
            .with_min_len(4096)
            .map(|(index, bounds)| {
                let voxel = cube.voxel(bounds.center()).unwrap_or([(1 << MAX_DEPTH) - 1; 3]);
                (LocationalCode::containing(voxel, DIGITS).bits() >> (64 - 3 * DIGITS)) << 32 | index as u64
            })
            .collect();
        let order: Vec<u32> = radix_sorted(keys).into_iter().map(|key| key as u32).collect();
        let boxes = order.par_iter().with_min_len(4096).map(|&triangle| bounds[triangle as usize]).collect();
        TriangleBvh::filed(order, boxes)
    }

    /// A BVH over those of the triangles that `is_kept` accepts.
    pub fn only(&self, is_kept: impl Fn(u32) -> bool) -> TriangleBvh {
        let kept = |place: &usize| is_kept(self.order[*place]);
        let places: Vec<usize> = (0..self.order.len()).filter(kept).collect();
        let boxes = places.iter().map(|&place| self.levels[0][place / FAN].at(place % FAN)).collect();
        TriangleBvh::filed(places.into_iter().map(|place| self.order[place]).collect(), boxes)
    }

    /// Triangles in order with their boxes.
    fn filed(order: Vec<u32>, boxes: Vec<Bounds>) -> TriangleBvh {
        if order.is_empty() {
            return TriangleBvh::default();
        }
        let mut levels: Vec<Vec<Group>> = vec![boxes.par_chunks(FAN).with_min_len(1024).map(Group::of).collect()];
        while let Some(groups) = levels.last().filter(|groups| groups.len() > 1) {
            let around = |some: &[Group]| {
                let mut boxes = [Bounds::EMPTY; FAN];
                boxes.iter_mut().zip(some).for_each(|(slot, group)| *slot = group.union());
                Group::of(&boxes)
            };
            levels.push(groups.par_chunks(FAN).with_min_len(1024).map(around).collect());
        }
        TriangleBvh { order, levels }
    }

    /// How many triangles there are.
    pub fn count(&self) -> usize {
        self.order.len()
    }

    /// The box around all triangles; empty without any.
    pub fn bounds(&self) -> Bounds {
        self.levels.last().map_or(Bounds::EMPTY, |top| top[0].union())
    }

    /// The subset of all triangles.
    pub fn all(&self) -> BvhSubset<'_> {
        BvhSubset { sorted: self, lanes: Vec::new() }
    }

    /// The subset of the triangles that `is_in` accepts, to be found among all.
    pub fn part(&self, is_in: impl Fn(u32) -> bool) -> BvhSubset<'_> {
        let lanes = |all: &[bool]| all.iter().rev().fold(0, |lanes, is_in| lanes << 1 | u8::from(*is_in));
        let mut of_level: Vec<bool> = self.order.iter().map(|&triangle| is_in(triangle)).collect();
        let mut levels = Vec::new();
        for _ in &self.levels {
            let level: Vec<u8> = of_level.chunks(FAN).map(lanes).collect();
            of_level = level.iter().map(|lanes| *lanes != 0).collect();
            levels.push(level);
        }
        BvhSubset { sorted: self, lanes: levels }
    }

    /// Pairs of triangles, one of this set and one of another, whose boxes have a point in common, in a fixed order.
    pub fn pairs(&self, other: &TriangleBvh) -> Vec<[u32; 2]> {
        self.pairs_if(&other.all(), |_, _| true)
    }

    /// Pairs as of [`TriangleBvh::pairs`], with triangles of a part of another set that `keep` accepts.
    pub fn pairs_if(&self, part: &BvhSubset, keep: impl Fn(u32, u32) -> bool + Sync) -> Vec<[u32; 2]> {
        let (Some(one), Some(two)) = (self.top(), part.sorted.top()) else { return Vec::new() };
        let open = |pair: Pair, found: &mut Vec<_>| {
            self.open(part, pair, part.sorted.at(pair.1), |pair, _| found.push(pair));
        };
        searched((one, two), open, |pair, found| {
            self.descend(part, pair, part.sorted.at(pair.1), &mut |(one, two)| {
                let (a, b) = (self.order[one.index as usize], part.sorted.order[two.index as usize]);
                if keep(a, b) {
                    found.push([a, b]);
                }
            });
        })
    }

    /// Pairs of triangles of this set, the lower first, whose boxes have a point in common and that `keep` accepts, in
    /// a fixed order.
    pub fn pairs_within(&self, keep: impl Fn(u32, u32) -> bool + Sync) -> Vec<[u32; 2]> {
        self.pairs_within_until(|| false, keep)
    }

    /// Pairs of triangles of this set as [`TriangleBvh::pairs_within`] gives them; some of them where `is_enough`
    /// becomes true before all are found.
    pub fn pairs_within_until(
        &self,
        is_enough: impl Fn() -> bool + Sync,
        keep: impl Fn(u32, u32) -> bool + Sync,
    ) -> Vec<[u32; 2]> {
        let Some(top) = self.top() else { return Vec::new() };
        let open = |pair: Pair, found: &mut Vec<_>| {
            self.open_own(pair, self.at(pair.1), |pair, _| found.push(pair));
        };
        searched((top, top), open, |pair, found| {
            self.descend_own(pair, self.at(pair.1), &is_enough, &mut |(one, two)| {
                let (a, b) = (self.order[one.index as usize], self.order[two.index as usize]);
                if one.index != two.index && keep(a.min(b), a.max(b)) {
                    found.push([a.min(b), a.max(b)]);
                }
            });
        })
    }

    /// Calls for every triangle whose box touches another.
    pub fn touching(&self, near: Bounds, mut visit: impl FnMut(u32)) {
        self.touching_boxes(near, |triangle, _| visit(triangle));
    }

    /// Calls for every triangle whose box touches another, with that box.
    pub fn touching_boxes(&self, near: Bounds, mut visit: impl FnMut(u32, Bounds)) {
        if let Some(top) = self.top() {
            self.descend_touching(top, near, &mut visit);
        }
    }

    /// - `place`: above the boxes of triangles.
    fn descend_touching(&self, place: Place, near: Bounds, visit: &mut impl FnMut(u32, Bounds)) {
        let group = self.under(place);
        for lane in group.touching(near, ALL) {
            let below = place.under(lane);
            if below.level == 0 {
                visit(self.order[below.index as usize], group.at(lane));
            } else {
                self.descend_touching(below, near, visit);
            }
        }
    }

    /// Visits triangles, those in near boxes first, and leaves out boxes that are farther than what a visit returned
    /// last.
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
                limit = visit(self.order[place.index as usize]);
                continue;
            }
            let first = stack.len();
            let below = self.touching_under(place, self.at(place));
            stack.extend(below.map(|place| (distance(self.at(place)), place)));
            stack[first..].reverse();
            stack[first..].sort_by(|(a, _), (b, _)| b.total_cmp(a));
        }
    }

    /// The box around all, above the last level.
    fn top(&self) -> Option<Place> {
        (!self.levels.is_empty()).then_some(Place { level: self.levels.len() as u32, index: 0 })
    }

    #[inline]
    fn at(&self, place: Place) -> Bounds {
        let index = place.index as usize;
        match self.levels.get(place.level as usize) {
            Some(level) => level[index / FAN].at(index % FAN),
            None => self.bounds(),
        }
    }

    /// The boxes under a box that touch another, the last first.
    #[inline]
    fn touching_under(&self, place: Place, near: Bounds) -> impl Iterator<Item = Place> + use<> {
        self.under(place).touching(near, ALL).map(move |lane| place.under(lane))
    }

    /// The boxes under a box.
    #[inline]
    fn under(&self, place: Place) -> &Group {
        &self.levels[place.level as usize - 1][place.index as usize]
    }

    /// Visits the pairs under a pair of boxes, of which the one of the higher level is opened, or both, that touch; the
    /// last first.
    ///
    /// - `beside`: the second box.
    #[inline(always)]
    fn open(&self, other: &BvhSubset, (one, two): Pair, beside: Bounds, mut visit: impl FnMut(Pair, Bounds)) {
        if one.level < two.level {
            let group = other.sorted.under(two);
            for b in group.touching(self.at(one), other.lanes(two)) {
                visit((one, two.under(b)), group.at(b));
            }
            return;
        }
        let group = self.under(one);
        if one.level > two.level {
            group.touching(beside, ALL).for_each(|a| visit((one.under(a), two), beside));
            return;
        }
        let (others, lanes) = (other.sorted.under(two), other.lanes(two));
        for a in group.touching(beside, ALL) {
            others.touching(group.at(a), lanes).for_each(|b| visit((one.under(a), two.under(b)), others.at(b)));
        }
    }

    /// Visits the pairs under two boxes of one level, the second not before the first, that touch, the last first; the
    /// second never before the first.
    ///
    /// - `beside`: the second box.
    #[inline(always)]
    fn open_own(&self, (one, two): Pair, beside: Bounds, mut visit: impl FnMut(Pair, Bounds)) {
        let (group, others) = (self.under(one), self.under(two));
        for a in group.touching(beside, ALL) {
            let lanes = if one.index == two.index { ALL << a & ALL } else { ALL };
            others.touching(group.at(a), lanes).for_each(|b| visit((one.under(a), two.under(b)), others.at(b)));
        }
    }

    /// Visits the pairs of triangles under a pair of boxes, of which the second is given.
    fn descend(&self, other: &BvhSubset, pair: Pair, beside: Bounds, visit: &mut impl FnMut(Pair)) {
        match is_open(&pair) {
            true => self.open(other, pair, beside, |pair, beside| self.descend(other, pair, beside, visit)),
            false => visit(pair),
        }
    }

    /// Visits the pairs of triangles under two boxes of one level, the second not before the first, and given.
    fn descend_own(&self, pair: Pair, beside: Bounds, is_enough: &impl Fn() -> bool, visit: &mut impl FnMut(Pair)) {
        match is_open(&pair) {
            true if is_enough() => {}
            true => self.open_own(pair, beside, |pair, beside| self.descend_own(pair, beside, is_enough, visit)),
            false => visit(pair),
        }
    }
}

/// Whether a pair is not of two triangles.
fn is_open((one, two): &Pair) -> bool {
    one.level + two.level > 0
}

/// Searches from a pair of boxes on, in a fixed order.
///
/// - `open`: finds the pairs under a pair, the last first.
/// - `below`: finds what to keep of the pairs of triangles under a pair.
fn searched(
    top: Pair,
    open: impl Fn(Pair, &mut Vec<Pair>) + Sync,
    below: impl Fn(Pair, &mut Vec<[u32; 2]>) + Sync,
) -> Vec<[u32; 2]> {
    // Breadth first, until there is work for many threads.
    let mut tasks = vec![top];
    while !tasks.is_empty() && tasks.len() < TASKS && tasks.iter().any(is_open) {
        let mut next = Vec::with_capacity(4 * tasks.len());
        for task in tasks {
            let first = next.len();
            if is_open(&task) {
                open(task, &mut next)
            } else {
                next.push(task)
            }
            next[first..].reverse();
        }
        tasks = next;
    }
    let found = |task: Pair| {
        let mut pairs = Vec::new();
        below(task, &mut pairs);
        pairs
    };
    let found: Vec<Vec<[u32; 2]>> = tasks.into_par_iter().map(found).collect();
    found.concat()
}

/// Keys sorted by their upper halves, by three passes over digits of 10 bits; the lower halves are in order already.
pub(super) fn radix_sorted(mut keys: Vec<u64>) -> Vec<u64> {
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
            let (first, second) = (TriangleBvh::new(&a.0, &a.1), TriangleBvh::new(&b.0, &b.1));
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
            let mut found = TriangleBvh::new(&set.0, &set.1).pairs_within(|a, b| (a + b) % 3 != 0);
            found.sort_unstable();
            let touch = |a, b| Bounds::of(corners(a)).touches(Bounds::of(corners(b))) && (a + b) % 3 != 0;
            let all = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b])).filter(|&[a, b]| touch(a, b));
            assert!(found.iter().copied().eq(all), "{count}");
        }
    }

    #[test]
    fn a_box_finds_all_that_touch_it() {
        let (vertices, triangles) = soup(1000, 0.1, 3);
        let sorted = TriangleBvh::new(&vertices, &triangles);
        let near = Bounds::of([DVec3::splat(-0.1), DVec3::new(0.2, 0.1, 0.3)]);
        let mut found = Vec::new();
        sorted.touching(near, |t| found.push(t));
        let touches = |t: &u32| Bounds::of(triangles[*t as usize].map(|v| vertices[v as usize])).touches(near);
        found.sort_unstable();
        assert_eq!(found, (0..1000).filter(touches).collect::<Vec<u32>>());
        assert!(found.len() > 5 && sorted.bounds() == Bounds::of(vertices));
        let probe = TriangleBvh::new(&[near.min, near.max], &[[0, 1, 1]]);
        let odd = sorted.part(|triangle| triangle % 7 == 1);
        let mut some = probe.pairs_if(&odd, |_, triangle| triangle % 2 == 0);
        some.sort_unstable();
        assert!(some.into_iter().map(|[_, t]| t).eq(found.into_iter().filter(|t| t % 14 == 8)));
    }
}
