//! Aggregates: fewer and larger instances that stand in for all of those in cells that are far from the eye.
//!
//! Up to a distance R from the eye, all instances of a grid are met as they are. Beyond, at a distance d, what is met
//! is enlarged by e = d / R about its place: each spans there what it would span at R, and is no more of a pixel. Cells
//! of level k are 2^k cells a side; each has as many slots as a cell has instances, and takes those of the four cells
//! of the level below in turn, beginning with one of them by chance: level k has a part of 4^-k of all, and what is on
//! a level is on those below it too. Where e is between 2^k and 2^(k+1), level k is met. Those of it that are on the
//! next level are enlarged to e; the other three quarters shrink to (4^(k+1) - e^2) / 3 of their area, that is to
//! nothing where the next level begins. So the sum of the areas is that of all instances, wherever one looks; each
//! place belongs to one level; and when the eye moves, nothing comes or goes at once. From e = 2^K on, the greatest
//! enlargement, what is met is the last level, enlarged so much.
//!
//! The enlargement is a function of the place and of the views alone, the same for all rays.
//!
//! # Source
//! Cook, Halstead, Planck and Ryu 2007, "Stochastic simplification of aggregate detail", section 3: elements that stay
//! are enlarged so that the area is kept. Levels by cells, the enlargement by distance, and the walk are ours.

use crate::numeric::sampling::mix;
use glam::{DVec2, DVec3};

/// Most levels of aggregates above all instances: what stands in is enlarged 2 to this power times at the most.
pub const MOST_AGGREGATE_LEVELS: u32 = 4;
/// Bits of the number of a cell along an axis.
const CELL_BITS: u32 = 21;
/// What is smaller than this part of itself is not met.
const LEAST: f64 = 1e-6;

/// From where instances in the cells of a grid are seen, in coordinates of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AggregateView {
    /// By an eye.
    Eye {
        /// Where it is.
        at: DVec3,
        /// Beyond this distance from it aggregates stand in for all; above 0.
        distance: f64,
    },
    /// By parallel lines of sight, for which the whole grid is equally far.
    Parallel {
        /// How many times what stands in is enlarged; up to 1, all are met as they are.
        enlargement: f64,
    },
}

impl AggregateView {
    /// How enlarged what stands at a place is, without limits.
    fn enlargement(&self, at: DVec2) -> f64 {
        match self {
            AggregateView::Eye { at: eye, distance } => eye.distance(DVec3::new(at.x, 0.0, at.y)) / distance,
            AggregateView::Parallel { enlargement } => *enlargement,
        }
    }
}

/// How instances in cells are seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aggregates<'v> {
    /// Of several, the nearest to a place counts. Without any, all are met as they are.
    pub(super) views: &'v [AggregateView],
    /// How many levels there are above all instances; 0 only without views.
    pub(super) levels: u32,
}

impl Aggregates<'_> {
    /// All instances as they are.
    pub(super) const NONE: Aggregates<'static> = Aggregates { views: &[], levels: 0 };

    /// How enlarged what stands at a place is that is there on all levels, 1 to 2^levels.
    #[inline]
    pub(super) fn enlargement(&self, at: DVec2) -> f64 {
        if self.views.is_empty() {
            return 1.0;
        }
        let least = self.views.iter().map(|view| view.enlargement(at)).fold(f64::INFINITY, f64::min);
        least.clamp(1.0, power(self.levels))
    }

    /// The zone of the places where what is on all levels is enlarged so many times.
    #[inline]
    pub(super) fn zone(&self, enlargement: f64) -> AggregateZone {
        let number = match enlargement {
            1.0 => 0,
            // The exponent of a number from 1 on is its logarithm, rounded down.
            other => (other.to_bits() >> 52) as u32 - 1022,
        };
        AggregateZone { number, levels: self.levels }
    }

    /// All zones, from the eye outwards.
    pub(super) fn zones(&self) -> impl Iterator<Item = AggregateZone> + use<> {
        let levels = self.levels;
        let last = if self.views.is_empty() { 0 } else { levels + 1 };
        (0..=last).map(move |number| AggregateZone { number, levels })
    }

    /// How much what stands at a place is enlarged or made smaller; none if something else stands in for it.
    ///
    /// - `cell`, `number`: of it, among all instances. `count`: how many there are in each cell.
    pub(super) fn size(&self, at: DVec2, cell: [u32; 2], number: u32, count: u32) -> Option<f64> {
        let enlargement = self.enlargement(at);
        let zone = self.zone(enlargement);
        let level = zone.level();
        let mut slot = CellSlot { cell, number };
        for above in 1..=level {
            slot = slot.above(above, count)?;
        }
        zone.size(enlargement, || slot.above(level + 1, count).is_some())
    }
}

/// 2 to a power.
fn power(exponent: u32) -> f64 {
    f64::from(1_u32 << exponent)
}

/// Places where instances of one level are met: about the eye those without aggregates, then one zone for each level
/// that becomes the next one, then those of the last level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct AggregateZone {
    number: u32,
    levels: u32,
}

impl AggregateZone {
    /// The level.
    pub(super) fn level(self) -> u32 {
        self.number.saturating_sub(1)
    }

    /// Between which enlargements it is, if there were no greatest one.
    pub(super) fn enlargements(self) -> [f64; 2] {
        let from = if self.number == 0 { 0.0 } else { power(self.level()) };
        let to = if self.number > self.levels { f64::INFINITY } else { power(self.number) };
        [from, to]
    }

    /// How much anything in it is enlarged at the most.
    pub(super) fn greatest(self) -> f64 {
        power(self.number.min(self.levels))
    }

    /// How much one of its level is enlarged or made smaller; none if it is gone.
    ///
    /// - `enlargement`: where it stands. `stays`: whether it is on the next level too.
    #[inline]
    pub(super) fn size(self, enlargement: f64, stays: impl FnOnce() -> bool) -> Option<f64> {
        if self.number == 0 || self.number > self.levels || stays() {
            return Some(enlargement);
        }
        let area = (power(2 * self.number) - enlargement * enlargement) / 3.0;
        (area > LEAST * LEAST).then(|| area.sqrt())
    }
}

/// A slot of a cell of some level, in which one of the instances is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CellSlot {
    /// The number of the cell along x and z, among those of its level.
    pub(super) cell: [u32; 2],
    pub(super) number: u32,
}

impl CellSlot {
    /// The slot of the level below from which a slot of a level takes its instance.
    #[inline]
    pub(super) fn below(self, level: u32) -> CellSlot {
        let CellSlot { cell: [x, z], number } = self;
        let quarter = number.wrapping_add(first_quarter(self.cell, level)) & 3;
        CellSlot { cell: [2 * x + (quarter & 1), 2 * z + (quarter >> 1)], number: number >> 2 }
    }

    /// The slot of a level that takes its instance from this one of the level below; none if it does not stay.
    ///
    /// - `count`: of the slots of each cell.
    #[inline]
    pub(super) fn above(self, level: u32, count: u32) -> Option<CellSlot> {
        let CellSlot { cell: [x, z], number } = self;
        let cell = [x >> 1, z >> 1];
        let quarter = (x & 1) | (z & 1) << 1;
        let turn = quarter.wrapping_sub(first_quarter(cell, level)) & 3;
        let number = number.checked_mul(4)? + turn;
        (number < count).then_some(CellSlot { cell, number })
    }

    /// The instance, by its cell and its number, that is in a slot of a level.
    #[inline]
    pub(super) fn instance(self, level: u32) -> CellSlot {
        (1..=level).rev().fold(self, CellSlot::below)
    }
}

/// Which of its quarters the first slot of a cell of a level takes its instance from, in the lowest two bits.
#[inline]
fn first_quarter([x, z]: [u32; 2], level: u32) -> u32 {
    mix((u64::from(level) << CELL_BITS | u64::from(x)) << CELL_BITS | u64::from(z)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    const LEVELS: u32 = MOST_AGGREGATE_LEVELS;

    fn eye(distance: f64) -> [AggregateView; 1] {
        [AggregateView::Eye { at: DVec3::new(5.0, 3.0, -2.0), distance }]
    }

    #[test]
    fn a_quarter_of_each_level_is_on_the_next_one_and_each_only_once() {
        for count in [1, 3, 4, 50] {
            let mut level: HashSet<[u32; 3]> = HashSet::new();
            for above in 0..=LEVELS {
                let cells = 32 >> above;
                let slots = (0..cells).flat_map(|x| (0..cells).flat_map(move |z| (0..count).map(move |n| [x, z, n])));
                let mut all = HashSet::new();
                for [x, z, number] in slots {
                    let slot = CellSlot { cell: [x, z], number };
                    let CellSlot { cell: [a, b], number: own } = slot.instance(above);
                    assert!(a < 32 && b < 32 && own < count && a >> above == x && b >> above == z);
                    assert!(all.insert([a, b, own]), "none is in two slots");
                    if above > 0 {
                        assert_eq!(slot.below(above).above(above, count), Some(slot));
                    }
                }
                assert_eq!(all.len() as u32, cells * cells * count);
                assert!(above == 0 || all.is_subset(&level), "{count} {above}");
                level = all;
            }
        }
    }

    #[test]
    fn zones_follow_each_other_and_what_stays_spans_the_same_from_where_they_begin() {
        let views = eye(10.0);
        let seen = Aggregates { views: &views, levels: LEVELS };
        let zones: Vec<AggregateZone> = seen.zones().collect();
        assert_eq!(zones.len() as u32, LEVELS + 2);
        assert!(zones.windows(2).all(|pair| pair[0].enlargements()[1] == pair[1].enlargements()[0]));
        for step in 0..4000 {
            let at = DVec2::new(5.0 + 0.1 * f64::from(step), -2.0);
            let far = 3.0_f64.hypot(0.1 * f64::from(step));
            let enlargement = seen.enlargement(at);
            let expected = (far / 10.0).clamp(1.0, 16.0);
            assert!((enlargement - expected).abs() < 1e-12, "{far}");
            let zone = seen.zone(enlargement);
            let [from, to] = zone.enlargements();
            assert!(
                zones.contains(&zone) && from <= enlargement && enlargement <= to && enlargement <= zone.greatest()
            );
            assert!(zone.size(enlargement, || true) == Some(enlargement));
            assert!(zone.size(enlargement, || false).unwrap_or(0.0) <= zone.greatest());
            assert!(far > 10.0 || zone.number == 0);
        }
        assert_eq!(seen.zone(1.0).number, 0);
        assert_eq!([1.5, 2.0, 3.99, 4.0, 15.9, 16.0].map(|e| seen.zone(e).number), [1, 2, 2, 3, 4, 5]);
        assert_eq!([1.5, 2.0, 3.99, 4.0, 15.9, 16.0].map(|e| seen.zone(e).level()), [0, 1, 1, 2, 3, 4]);
    }

    #[test]
    fn areas_add_up_to_those_of_all_instances_wherever_they_are() {
        // In cells of one zone each: what is at a place may be of any cell.
        for count in [1, 4, 7] {
            for enlargement in [1.0, 1.3, 1.99, 2.0, 3.1, 4.0, 7.7, 12.0, 16.0, 500.0] {
                let views = [AggregateView::Parallel { enlargement }];
                let seen = Aggregates { views: &views, levels: LEVELS };
                let all = (0..32_u32).flat_map(|x| (0..32).flat_map(move |z| (0..count).map(move |n| ([x, z], n))));
                let size = |(cell, number)| seen.size(DVec2::ZERO, cell, number, count).unwrap_or(0.0);
                let area = all.map(size).map(|size| size * size).sum::<f64>();
                assert!((area / f64::from(32 * 32 * count) - 1.0).abs() < 1e-9, "{count} {enlargement}: {area}");
            }
        }
    }

    #[test]
    fn nothing_comes_or_goes_at_once_when_the_eye_moves() {
        let mut before: Vec<f64> = Vec::new();
        for step in 0..6000 {
            let views = eye(5.0).map(|view| match view {
                AggregateView::Eye { at, distance } => {
                    AggregateView::Eye { at: at + DVec3::X * (0.02 * f64::from(step)), distance }
                }
                other => other,
            });
            let seen = Aggregates { views: &views, levels: LEVELS };
            let size = |number: u32| {
                let at = DVec2::new(f64::from(number % 7), f64::from(number % 5));
                seen.size(at, [number % 32, number / 32], number % 3, 3).unwrap_or(0.0)
            };
            // By areas: of what goes, the length falls ever faster.
            let now: Vec<f64> = (0..640).map(|number| size(number).powi(2)).collect();
            let jump = now.iter().zip(&before).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
            assert!(jump < 2.0 * 16.0 * 0.02 / 5.0 + 1e-9, "{step}: {jump}");
            before = now;
        }
        assert!(before.contains(&0.0) && before.contains(&256.0));
    }
}
