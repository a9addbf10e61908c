//! The exchange of elements, as a symmetric operator over the hierarchy: each link is one number for both directions.
//!
//! Light that a node sends is the mean over its leaves, and what it receives is spread evenly over them: with P the
//! matrix that takes means and G that of the links, leaves exchange M = Pᵀ G P, symmetric whatever the links are.

use super::hierarchy::{Hierarchy, Summable};

use super::node::{HierarchyNode, NONE};
use crate::color::Channels;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::ops::Range;

/// Rounds of balancing at the most, and the error of a row that ends them.
const MOST_ROUNDS: u32 = 100;
const BALANCED: f64 = 1e-9;
/// Rounds where rows only are to be no greater than 1.
const FEW_ROUNDS: u32 = 8;
/// A row is not multiplied by more, and not by less than one over it.
const MOST_FACTOR: f64 = 4.0;

/// A row of which light is lost is not made more than so many times what it is, and not less than one over it.
const MOST_CHANGE: f64 = 2.0;

/// A goal that a row can be brought to; no more than all comes from elsewhere, however much too great the row of a
/// sliver is.
fn within(goal: f64, row: f64, area: f64) -> f64 {
    goal.clamp(row / MOST_CHANGE, row * MOST_CHANGE).min(area)
}

/// Rays of a neighbourhood that together tell how much light is lost there.
const NEIGHBOURING_RAYS: u64 = 2048;

/// Leaf visibility: what leaves see in directions that are as dense as their cosine.
#[derive(Clone, Debug)]
pub(super) struct LeafVisibility {
    /// For each leaf, which of the hits are those of its rays.
    pub(super) rays: Vec<Range<usize>>,
    /// What rays in directions that are as dense as their cosine hit, leaf by leaf.
    pub(super) hits: Vec<LeafHit>,
    /// For each leaf, the part of all light in these directions that comes straight from something that exchanges light,
    /// and the part that comes by mirrors.
    pub(super) seen_part: Vec<f64>,
    pub(super) mirrored_part: Vec<f64>,
    /// Light of skies that comes to each leaf by mirrors.
    pub(super) mirrored_sky: Vec<MirroredSky>,
    /// For each leaf, the part of all that it sees from its middle that exchanges light.
    pub(super) row: Vec<f64>,
    /// Whether no light can come to it.
    pub(super) is_dark: Vec<bool>,
    /// The enclosure of each leaf, by its number; [`NONE`] of one that is dark.
    pub(super) enclosures: Vec<u32>,
    /// Leaves that see each other through openings, by their numbers.
    pub(super) through_openings: Vec<OpeningExchange>,
}

impl LeafVisibility {
    /// The part of all light around a leaf that comes from something that exchanges light, straight or by mirrors.
    pub(super) fn part(&self, leaf: usize) -> f64 {
        self.seen_part[leaf] + self.mirrored_part[leaf]
    }

    /// What the rays of a leaf hit.
    pub(super) fn hits_of(&self, leaf: usize) -> &[LeafHit] {
        &self.hits[self.rays[leaf].clone()]
    }
}

/// The leaf that a ray from a leaf hits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct LeafHit {
    /// The number of the leaf among all leaves; [`NONE`] where light escapes.
    pub(super) leaf: u32,
    /// The part of light that is let through on the way, 0..=1.
    pub(super) transmittance: f32,
    /// Whether it crosses an opening, and was not reflected.
    pub(super) through_opening: bool,
    /// Whether it was reflected by a mirror or a pane.
    pub(super) is_mirrored: bool,
}

impl LeafHit {
    /// Light escapes.
    pub(super) const NOTHING: LeafHit =
        LeafHit { leaf: NONE, transmittance: 0.0, through_opening: false, is_mirrored: false };
}

/// The irradiance of a leaf by what mirrors show it of skies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct MirroredSky {
    /// W/m².
    pub(super) irradiance: Channels,
    /// The variance of that in all lanes together.
    pub(super) variance: f64,
    /// How many rays tell of it.
    pub(super) rays: u64,
}

impl MirroredSky {
    /// - `radiance`: from directions that are as dense as their cosine, W/(m² sr).
    pub(super) fn of(radiance: &[Channels]) -> MirroredSky {
        let count = radiance.len() as f64;
        let mean = radiance.iter().fold(Channels::ZERO, |sum, one| sum + *one) * count.recip();
        let total = |channels: Channels| PI * channels.0.iter().sum::<f64>();
        let squares: f64 = radiance.iter().map(|one| total(*one).powi(2)).sum();
        let variance = (squares / count - total(mean).powi(2)).max(0.0) / count;
        let rays = radiance.iter().filter(|one| **one != Channels::ZERO).count() as u64;
        MirroredSky { irradiance: mean * PI, variance, rays }
    }
}

/// Two nodes that exchange light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct ExchangeLink {
    /// One node.
    pub(super) a: u32,
    /// Its partner, or `a` again for light that a node exchanges with itself.
    pub(super) b: u32,
    /// A F, square units.
    pub(super) exchange: f64,
}

/// What two leaves exchange through an opening along a ray.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct OpeningExchange {
    /// The numbers of the leaves, and A F.
    pub(super) link: ExchangeLink,
    /// Where the ray ends on each of them: weights of its corners.
    pub(super) at: [[f64; 3]; 2],
}

impl OpeningExchange {
    /// So many times as much.
    pub(super) fn times(self, factor: f64) -> OpeningExchange {
        OpeningExchange { link: ExchangeLink { exchange: self.link.exchange * factor, ..self.link }, ..self }
    }
}

/// The operator.
pub(super) struct Exchange<'a> {
    hierarchy: &'a Hierarchy,
    pub(super) leaves: Vec<u32>,
    /// For each node, its partners and what it exchanges with them; the rows of G one after the other.
    rows: Vec<usize>,
    entries: Vec<(u32, f64)>,
    /// For each leaf, the factor that balances it, and what it exchanges with itself so that its row is right.
    factor: Vec<f64>,
    own: Vec<f64>,
    /// For each leaf, whether no ray of many around it is lost.
    pub(super) is_closed: Vec<bool>,
}

impl<'a> Exchange<'a> {
    pub(super) fn new(hierarchy: &'a Hierarchy, links: &[ExchangeLink]) -> Exchange<'a> {
        let mut counts = vec![0usize; hierarchy.nodes.len() + 1];
        for link in links {
            counts[link.a as usize] += 1;
            counts[link.b as usize] += usize::from(link.a != link.b);
        }
        let mut below = 0;
        for count in &mut counts {
            below += std::mem::replace(count, below);
        }
        let rows = counts.clone();
        let mut entries = vec![(NONE, 0.0); below];
        let mut put = |at: u32, other: u32, exchange: f64| {
            entries[counts[at as usize]] = (other, exchange);
            counts[at as usize] += 1;
        };
        for link in links {
            put(link.a, link.b, link.exchange);
            if link.a != link.b {
                put(link.b, link.a, link.exchange);
            }
        }
        let leaves = hierarchy.leaves();
        let count = leaves.len();
        let (factor, own, is_closed) = (vec![1.0; count], vec![0.0; count], vec![false; count]);
        Exchange { hierarchy, leaves, rows, entries, factor, own, is_closed }
    }

    pub(super) fn nodes(&self) -> &[HierarchyNode] {
        &self.hierarchy.nodes
    }

    /// The areas of the leaves.
    pub(super) fn areas(&self) -> Vec<f64> {
        self.leaves.iter().map(|leaf| self.hierarchy.nodes[*leaf as usize].area).collect()
    }

    /// The means of what leaves send over each node, with the factors that balance them.
    fn means<V: Summable>(&self, radiosity: &[V]) -> Vec<V> {
        let mut values = vec![V::default(); self.hierarchy.nodes.len()];
        for ((leaf, value), factor) in self.leaves.iter().zip(radiosity).zip(&self.factor) {
            values[*leaf as usize] = *value * *factor;
        }
        self.hierarchy.pull(&mut values);
        values
    }

    /// Flux that comes to each leaf from radiosities of all leaves, M b.
    pub(super) fn apply<V: Summable>(&self, radiosity: &[V]) -> Vec<V> {
        let nodes = &self.hierarchy.nodes;
        let values = self.means(radiosity);
        let row = |node: usize| {
            let entries = &self.entries[self.rows[node]..self.rows[node + 1]];
            entries.iter().fold(V::default(), |sum, (other, exchange)| sum + values[*other as usize] * *exchange)
        };
        let mut flux: Vec<V> = (0..nodes.len()).into_par_iter().map(row).collect();
        for place in 0..nodes.len() {
            let node = &nodes[place];
            if !node.is_leaf() && !node.is_dark {
                let density = flux[place] * node.area.recip();
                let lit = node.children().filter(|child| !nodes[*child].is_dark);
                lit.for_each(|child| flux[child] = flux[child] + density * nodes[child].area);
            }
        }
        let of = |(i, leaf): (usize, &u32)| flux[*leaf as usize] * self.factor[i] + radiosity[i] * self.own[i];
        self.leaves.iter().enumerate().map(of).collect()
    }

    /// Makes the rows add up to what they should, and stay symmetric.
    ///
    /// Each row and its column are multiplied by the root of what is missing, again and again. What remains in the end
    /// the leaf exchanges with itself.
    ///
    /// - `leaf_visibility`: what leaves see; without it rows are made no greater than 1.
    /// - Returns what leaves exchange with themselves, as a part of their areas.
    ///
    /// # Source
    /// Sinkhorn and Knopp 1967, symmetric; ours as to what remains.
    pub(super) fn balance(&mut self, leaf_visibility: Option<&LeafVisibility>) -> Vec<f64> {
        let areas = self.areas();
        let ones = vec![1.0; areas.len()];
        let sums = |exchange: &Self| exchange.apply(&ones);
        if let Some(leaf_visibility) = leaf_visibility {
            let factor = |is_dark: &bool| if *is_dark { 0.0 } else { 1.0 };
            self.factor = leaf_visibility.is_dark.iter().map(factor).collect();
        }
        let goal: Vec<f64> = match leaf_visibility {
            Some(leaf_visibility) => {
                let rows = sums(self);
                let goals = self.goals(leaf_visibility).into_iter().zip(&areas).zip(rows);
                goals
                    .map(|((goal, area), row)| if goal < 1.0 { within(goal * area, row, *area) } else { goal * area })
                    .collect()
            }
            None => sums(self).iter().zip(&areas).map(|(sum, area)| sum.min(*area)).collect(),
        };
        for _ in 0..if leaf_visibility.is_some() { MOST_ROUNDS } else { FEW_ROUNDS } {
            let mut worst = 0.0f64;
            for (i, sum) in sums(self).into_iter().enumerate().filter(|(_, sum)| *sum > 0.0) {
                let ratio = goal[i] / sum;
                let next = (self.factor[i] * ratio.sqrt()).clamp(MOST_FACTOR.recip(), MOST_FACTOR);
                if next != self.factor[i] && goal[i] > 0.0 {
                    worst = worst.max((ratio - 1.0).abs());
                    self.factor[i] = next;
                }
            }
            if worst < BALANCED {
                break;
            }
        }
        let last = sums(self);
        self.own = (0..areas.len()).map(|i| goal[i] - last[i]).collect();
        self.own.iter().zip(&areas).map(|(own, area)| own.abs() / area).collect()
    }

    /// The goals of the rows: 1 where no ray of many in the neighbourhood is lost, else what leaves see.
    fn goals(&mut self, leaf_visibility: &LeafVisibility) -> Vec<f64> {
        // Of each node: rays, and whether one is lost.
        let mut sums = vec![(0u64, false); self.nodes().len()];
        for (i, leaf) in self.leaves.iter().enumerate().filter(|(i, _)| !leaf_visibility.is_dark[*i]) {
            sums[*leaf as usize] = (leaf_visibility.rays[i].len() as u64, leaf_visibility.seen_part[i] < 1.0);
        }
        self.hierarchy.add_up(&mut sums, |a, b| (a.0 + b.0, a.1 | b.1));
        let around = self.hierarchy.neighbourhoods(|node| sums[node].0 >= NEIGHBOURING_RAYS);
        self.is_closed = self.leaves.iter().map(|leaf| !sums[around[*leaf as usize]].1).collect();
        let goal = |i: usize| match (leaf_visibility.is_dark[i], self.is_closed[i]) {
            (true, _) => 0.0,
            (_, true) => 1.0,
            _ => leaf_visibility.row[i].min(1.0),
        };
        (0..self.leaves.len()).map(goal).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_brought_near_their_goals_but_to_no_more_than_all_light() {
        assert_eq!(within(0.9, 1.0, 1.0), 0.9);
        assert_eq!((within(0.1, 1.0, 1.0), within(0.9, 0.1, 1.0)), (0.5, 0.2));
        // The row of a sliver may be many times too great.
        assert_eq!(within(0.9, 8.0, 1.0), 1.0);
    }
}
