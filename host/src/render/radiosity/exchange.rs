//! What elements exchange, as a symmetric operator over the hierarchy: each link is one number for both directions.
//!
//! Light that a node sends is the mean over its leaves, and what it receives is spread evenly over them: with P the matrix
//! that takes means and G that of the links, leaves exchange M = Pᵀ G P, symmetric whatever the links are.

use super::hierarchy::{Hierarchy, NONE, Node};
use crate::color::Channels;
use rayon::prelude::*;

/// Rounds of balancing at the most, and the error of a row that ends them.
const MOST_ROUNDS: u32 = 200;
const BALANCED: f64 = 1e-12;
/// A row is not multiplied by more, and not by less than one over it.
const MOST_FACTOR: f64 = 4.0;

/// Two nodes that exchange light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Link {
    pub(super) a: u32,
    /// The same for light that a node exchanges with itself.
    pub(super) b: u32,
    /// A F, square units.
    pub(super) exchange: f64,
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
}

impl<'a> Exchange<'a> {
    pub(super) fn new(hierarchy: &'a Hierarchy, links: &[Link]) -> Exchange<'a> {
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
        Exchange { hierarchy, leaves, rows, entries, factor: vec![1.0; count], own: vec![0.0; count] }
    }

    pub(super) fn nodes(&self) -> &[Node] {
        &self.hierarchy.nodes
    }

    /// The areas of the leaves.
    pub(super) fn areas(&self) -> Vec<f64> {
        self.leaves.iter().map(|leaf| self.hierarchy.nodes[*leaf as usize].area).collect()
    }

    /// Flux that comes to each leaf from radiosities of all leaves, M b.
    pub(super) fn apply(&self, radiosity: &[Channels]) -> Vec<Channels> {
        let nodes = &self.hierarchy.nodes;
        let mut values = vec![Channels::ZERO; nodes.len()];
        for ((leaf, value), factor) in self.leaves.iter().zip(radiosity).zip(&self.factor) {
            values[*leaf as usize] = *value * *factor;
        }
        self.hierarchy.pull(&mut values);
        let row = |node: usize| {
            let entries = &self.entries[self.rows[node]..self.rows[node + 1]];
            entries.iter().fold(Channels::ZERO, |sum, (other, exchange)| sum + values[*other as usize] * *exchange)
        };
        let mut flux: Vec<Channels> = (0..nodes.len()).into_par_iter().map(row).collect();
        for place in 0..nodes.len() {
            let node = &nodes[place];
            if !node.is_leaf() {
                let density = flux[place] * node.area.recip();
                node.children().for_each(|child| flux[child] += density * nodes[child].area);
            }
        }
        let of = |(i, leaf): (usize, &u32)| flux[*leaf as usize] * self.factor[i] + radiosity[i] * self.own[i];
        self.leaves.iter().enumerate().map(of).collect()
    }

    /// Makes the rows add up to what they should, and stay symmetric.
    ///
    /// Each row and its column are multiplied by the root of what is missing, again and again. What remains in the end the
    /// leaf exchanges with itself.
    ///
    /// - `seen`: for each leaf, the least and the greatest part of what it sees that exchanges light. A leaf that sees
    ///   none exchanges nothing.
    /// - Returns what leaves exchange with themselves, as a part of all area.
    ///
    /// # Source
    /// Sinkhorn and Knopp 1967, symmetric; ours as to what remains.
    pub(super) fn balance(&mut self, seen: &[[f64; 2]]) -> f64 {
        let areas = self.areas();
        let ones = vec![Channels::ONE; areas.len()];
        let sums = |exchange: &Self| -> Vec<f64> { exchange.apply(&ones).iter().map(|sum| sum.0[0]).collect() };
        for (factor, [_, most]) in self.factor.iter_mut().zip(seen) {
            *factor = if *most > 0.0 { 1.0 } else { 0.0 };
        }
        let first = sums(self);
        let goal: Vec<f64> = (0..areas.len())
            .map(|i| areas[i] * (first[i] / areas[i]).max(seen[i][0]).min(seen[i][1]).max(0.0))
            .collect();
        for _ in 0..MOST_ROUNDS {
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
        let all: f64 = areas.iter().sum();
        self.own.iter().map(|own| own.abs()).sum::<f64>() / all.max(f64::MIN_POSITIVE)
    }
}
