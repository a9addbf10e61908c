//! One pass of a vertical line from left to right, which checks the polygon and covers it with triangles.
//!
//! At each corner the edges that end there give way to those that begin there. Every edge is compared with both
//! neighbours where it ends: two edges that cross stay neighbours until one of them ends on the wrong side of the
//! other, so that no crossing is missed. Points with the same x are met from low to high; this is the order of a line
//! that leans by less than any angle, hence vertical edges need no care.
//!
//! # Source
//! Hertel and Mehlhorn 1983; the search for crossings after Shamos and Hoey 1976.

use std::cmp::Ordering;

use glam::DVec2;

use super::chain::{ReflexChain, ReflexChains};
use super::error::{PolygonEdge, PolygonError};
use super::outline::Outline;
use super::status::{OUTSIDE, Slot, Status};
use crate::numeric::predicates::turn;

/// Triangles inside of the outline by the even-odd rule, indices of its corners, counter-clockwise.
pub(super) fn triangles(outline: &Outline) -> Result<Vec<[u32; 3]>, PolygonError> {
    let count = outline.points.len();
    let mut sweep = Sweep {
        outline,
        status: Status::new(),
        chains: ReflexChains::with_capacity(count),
        slot_of: vec![OUTSIDE; count],
        ending: Vec::new(),
        beginning: Vec::new(),
    };
    let mut first = 0;
    while first < count {
        let point = outline.points[first];
        let same = outline.points[first + 1..].iter().take_while(|&&other| other == point).count();
        if same > 0 || !sweep.bend(first)? {
            sweep.visit(first, first + 1 + same)?;
        }
        first += 1 + same;
    }
    Ok(sweep.chains.triangles)
}

struct Sweep<'a> {
    outline: &'a Outline,
    status: Status,
    chains: ReflexChains,
    /// For each edge under the sweep line its slot.
    slot_of: Vec<u32>,
    /// Slots of the edges through the corner, from low to high.
    ending: Vec<u32>,
    /// The edges that go on from the corner, from low to high, with the ranks of their right ends.
    beginning: Vec<(u32, u32)>,
}

impl Sweep<'_> {
    /// Handles a corner where one edge ends and one begins, which is most of them; says whether it was one.
    #[inline]
    fn bend(&mut self, rank: usize) -> Result<bool, PolygonError> {
        let (before, after) = (self.outline.before[rank], self.outline.after[rank]);
        let here = rank as u32;
        let (old, new, end) = match (before < here, after < here) {
            (true, false) => (before, here, after),
            (false, true) => (here, before, before),
            _ => return Ok(false),
        };
        let slot = self.slot_of[old as usize];
        let point = self.outline.points[rank];
        let Slot { below, above, chain, .. } = self.status[slot];
        if below != OUTSIDE && self.status[below].side(point) <= 0.0
            || above != OUTSIDE && self.status[above].side(point) >= 0.0
        {
            return Ok(false);
        }
        let corner = (self.outline.originals[rank], point);
        if let Some(chain) = chain {
            self.status[slot].chain = Some(self.chains.extend_low(chain, corner));
        } else if let Some(chain) = self.status[below].chain {
            self.status[below].chain = Some(self.chains.extend_high(chain, corner));
        }
        let changed = &mut self.status[slot];
        (changed.left, changed.right, changed.edge) = (point, self.outline.points[end as usize], new);
        self.slot_of[new as usize] = slot;
        Ok(true)
    }

    /// Handles the corners `first..end`, which lie at one point, with any number of edges.
    fn visit(&mut self, first: usize, end: usize) -> Result<(), PolygonError> {
        let point = self.outline.points[first];
        let corner = (self.outline.originals[first], point);
        self.gather(first, end);
        let below = self.find_ending(point)?;
        self.sort_beginning(point)?;
        let old_below = self.status[below].chain;
        let is_inside = old_below.is_some();
        let (lower, upper) = match self.ending.last() {
            None => old_below.map(|chain| self.chains.split(chain, corner)).unzip(),
            Some(&last) => {
                for &slot in &self.ending[..self.ending.len() - 1] {
                    if let Some(chain) = self.status[slot].chain {
                        self.chains.close(chain, corner);
                    }
                }
                let lower = old_below.map(|chain| self.chains.extend_high(chain, corner));
                (lower, self.status[last].chain.map(|chain| self.chains.extend_low(chain, corner)))
            }
        };
        self.status[below].chain = match (lower, upper) {
            (Some(lower), Some(upper)) if self.beginning.is_empty() => Some(self.chains.join(lower, upper)),
            _ => lower,
        };
        let last = self.beginning.len().wrapping_sub(1);
        let mut under = below;
        for index in 0..self.beginning.len() {
            let chain = match (index == last, is_inside ^ (index % 2 == 0)) {
                (true, _) => upper,
                (false, true) => Some(self.chains.start(corner)),
                (false, false) => None,
            };
            under = self.begin(index, point, under, chain);
        }
        for index in self.beginning.len()..self.ending.len() {
            self.status.remove(self.ending[index]);
        }
        Ok(())
    }

    /// Puts edge `index` of those that begin into the slot of one that ends, or into a new one above `under`.
    fn begin(&mut self, index: usize, point: DVec2, under: u32, chain: Option<ReflexChain>) -> u32 {
        let (edge, end) = self.beginning[index];
        let new = Slot::new(point, self.outline.points[end as usize], edge, chain);
        let slot = match self.ending.get(index) {
            Some(&slot) => {
                self.status[slot].take(new);
                slot
            }
            None => self.status.insert(under, new),
        };
        self.slot_of[edge as usize] = slot;
        slot
    }

    /// Collects the edges that end and begin at the corners `first..end`.
    fn gather(&mut self, first: usize, end: usize) {
        self.ending.clear();
        self.beginning.clear();
        for rank in first..end {
            let (before, after) = (self.outline.before[rank], self.outline.after[rank]);
            for (edge, other) in [(before, before), (rank as u32, after)] {
                if (other as usize) < rank {
                    self.ending.push(self.slot_of[edge as usize]);
                } else {
                    self.beginning.push((edge, other));
                }
            }
        }
    }

    /// Puts the slots of all edges through `point` in order, also of those that only pass through it, which end and
    /// begin again. Returns the slot below them.
    fn find_ending(&mut self, point: DVec2) -> Result<u32, PolygonError> {
        let known = self.ending.len();
        let (mut below, mut above) = match self.ending.first() {
            Some(&slot) => (self.status[slot].below, self.status[slot].above),
            None => {
                let below = self.status.below(point);
                (below, self.status[below].above)
            }
        };
        while below != OUTSIDE && self.status[below].side(point) == 0.0 {
            below = self.status[below].below;
        }
        while above != OUTSIDE && self.status[above].side(point) == 0.0 {
            above = self.status[above].above;
        }
        if below != OUTSIDE && self.status[below].side(point) < 0.0
            || above != OUTSIDE && self.status[above].side(point) > 0.0
        {
            return Err(self.crossing(point));
        }
        self.ending.clear();
        let mut passing = 0;
        let mut slot = self.status[below].above;
        while slot != above {
            let Slot { right, edge, above: next, .. } = self.status[slot];
            if right != point {
                self.beginning.push((edge, edge.max(self.outline.after[edge as usize])));
                passing += 1;
            }
            self.ending.push(slot);
            slot = next;
        }
        // Another edge that ends here is kept from this place by one that crosses it.
        if self.ending.len() - passing == known { Ok(below) } else { Err(self.crossing(point)) }
    }

    /// Sorts the edges that begin at `point`.
    fn sort_beginning(&mut self, point: DVec2) -> Result<(), PolygonError> {
        let points = &self.outline.points;
        let direction =
            |edge: &(u32, u32), other: &(u32, u32)| turn(point, points[edge.1 as usize], points[other.1 as usize]);
        self.beginning.sort_unstable_by(|a, b| 0.0.partial_cmp(&direction(a, b)).unwrap_or(Ordering::Equal));
        match self.beginning.windows(2).find(|pair| direction(&pair[0], &pair[1]) <= 0.0) {
            None => Ok(()),
            Some(pair) => {
                let (first, second) = ordered(self.outline.edge(pair[0].0), self.outline.edge(pair[1].0));
                Err(PolygonError::Overlap { first, second })
            }
        }
    }

    /// Two edges that cross before the sweep line has come to `point`: neighbours of which the lower one lies higher,
    /// seen from the point, than the upper one.
    #[cold]
    fn crossing(&self, point: DVec2) -> PolygonError {
        let side = |slot: u32| self.status[slot].side(point);
        let mut lower = self.status[OUTSIDE].above;
        let mut upper = self.status[lower].above;
        while upper != OUTSIDE && (side(upper) < 0.0 || side(lower) > 0.0 || side(upper) == side(lower)) {
            (lower, upper) = (upper, self.status[upper].above);
        }
        let [lower, upper] = [lower, upper].map(|slot| self.outline.edge(self.status[slot].edge));
        let (first, second) = ordered(lower, upper);
        PolygonError::Crossing { first, second }
    }
}

fn ordered(a: PolygonEdge, b: PolygonEdge) -> (PolygonEdge, PolygonEdge) {
    (a.min(b), a.max(b))
}
