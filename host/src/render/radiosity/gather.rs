//! The light of other elements once more, as it differs from element to element below what a link is for.
//!
//! A link brings the same light to all of the node that receives it, which shows as steps, and it knows only in the mean how
//! much of it is hidden. Each element asks all links of what it is part of again, for the form factor from its own middle
//! and for what can be seen from there. Where no light is lost, what comes of it is scaled so that all that is seen adds up
//! to 1: light that is the same everywhere stays so.

use super::form_factor::{from_point, kernel};
use super::hierarchy::{Hierarchy, NONE, Node, POINTS};
use super::links::Judged;
use super::sight::Sight;
use crate::color::Channels;
use rayon::prelude::*;

/// Light below this part of the error of a link is asked for with one ray instead of some.
const LITTLE: f64 = 0.5;
/// What parts of a node send may differ by so much of it.
const UNEVEN: f64 = 0.2;

/// Gathers light.
pub(super) struct Gatherer<'g, 'a> {
    pub(super) sight: &'g Sight<'a>,
    pub(super) hierarchy: &'g Hierarchy,
    /// The error of the light of a link, W/m².
    pub(super) error: f64,
}

/// What each leaf sees of nodes from its middle.
pub(super) struct Views<'g> {
    hierarchy: &'g Hierarchy,
    /// For each leaf, the nodes and the part of all that is seen that each is.
    of: Vec<Vec<(u32, f32)>>,
}

impl Views<'_> {
    /// The part of all that each leaf may see that exchanges light.
    pub(super) fn rows(&self) -> Vec<f64> {
        self.of.iter().map(|nodes| nodes.iter().map(|(_, part)| f64::from(*part)).sum()).collect()
    }

    /// Irradiance of each leaf by light of others, W/m².
    ///
    /// - `sent`: what each leaf sends, W/m². `is_closed`: of each, whether all that it sees exchanges light.
    pub(super) fn irradiance(&self, leaves: &[u32], sent: &[Channels], is_closed: &[bool]) -> Vec<Channels> {
        let mut values = vec![Channels::ZERO; self.hierarchy.nodes.len()];
        leaves.iter().zip(sent).for_each(|(leaf, sent)| values[*leaf as usize] = *sent);
        self.hierarchy.pull(&mut values);
        let of = |(nodes, is_closed): (&Vec<(u32, f32)>, &bool)| {
            let (mut light, mut row) = (Channels::ZERO, 0.0);
            for (node, part) in nodes {
                light += values[*node as usize] * f64::from(*part);
                row += f64::from(*part);
            }
            match is_closed {
                true if row > 0.0 => light * row.recip(),
                _ => light * row.max(1.0).recip(),
            }
        };
        self.of.par_iter().zip(is_closed).map(of).collect()
    }
}

impl<'g> Gatherer<'g, '_> {
    /// What each leaf sees, divided the more the more what is seen differs.
    ///
    /// - `sent`: about what each node sends, W/m².
    pub(super) fn views(&self, links: &[Judged], leaves: &[u32], sent: &[Channels]) -> Views<'g> {
        let nodes = &self.hierarchy.nodes;
        let mut parent = vec![NONE; nodes.len()];
        for (place, node) in (0..).zip(nodes) {
            node.children().for_each(|child| parent[child] = place);
        }
        let (rows, entries) = by_node(nodes.len(), links);
        let apart = self.apart(sent);
        let of = |leaf: &u32| {
            let node = &nodes[*leaf as usize];
            let (mut found, mut pending) = (Vec::new(), Vec::new());
            let mut at = *leaf;
            while at != NONE {
                pending.extend(&entries[rows[at as usize]..rows[at as usize + 1]]);
                while let Some((other, is_clear)) = pending.pop() {
                    let partner = &nodes[other as usize];
                    let factor = self.factor(node, other);
                    if !partner.is_leaf() && factor * apart[other as usize] > UNEVEN * self.error {
                        let lit = partner.children().filter(|child| !nodes[*child].is_dark);
                        pending.extend(lit.map(|child| (child as u32, is_clear)));
                        continue;
                    }
                    if factor <= 0.0 {
                        continue;
                    }
                    let is_little = factor * sent[other as usize].max() < LITTLE * self.error;
                    let seen = if is_clear { 1.0 } else { self.seen((*leaf, node), other, is_little) };
                    if seen > 0.0 {
                        found.push((other, (factor * seen) as f32));
                    }
                }
                at = parent[at as usize];
            }
            found.shrink_to_fit();
            found
        };
        Views { hierarchy: self.hierarchy, of: leaves.par_iter().map(of).collect() }
    }

    /// How far what parts of each node send is from what all of it does in the mean, W/m² at the most.
    fn apart(&self, values: &[Channels]) -> Vec<f64> {
        let nodes = &self.hierarchy.nodes;
        let mut apart = vec![0.0f64; nodes.len()];
        for place in (0..nodes.len()).rev().filter(|place| !nodes[*place].is_dark) {
            let of = |child: usize| (values[child] - values[place]).map(f64::abs).max() + apart[child];
            let lit = nodes[place].children().filter(|child| !nodes[*child].is_dark);
            apart[place] = lit.map(of).fold(0.0, f64::max);
        }
        apart
    }

    /// The form factor from the middle of an element to a node, as if nothing was between them.
    fn factor(&self, node: &Node, other: u32) -> f64 {
        let partner = &self.hierarchy.nodes[other as usize];
        if partner.is_cluster() {
            let points = self.hierarchy.points(other);
            let sum: f64 = points.iter().map(|point| kernel([node.middle, node.normal], *point)).sum();
            (sum * partner.area / POINTS as f64).min(1.0)
        } else if (node.middle - partner.corners[0]).dot(partner.normal) > 0.0 {
            from_point(node.middle, node.normal, &partner.polygon())
        } else {
            0.0
        }
    }

    /// The part of a node that is seen from the middle of an element.
    fn seen(&self, (leaf, node): (u32, &Node), other: u32, is_little: bool) -> f64 {
        let from = [node.middle, node.normal];
        let points = self.hierarchy.points(other);
        let (mut seen, mut all) = (0.0, 0.0);
        // Which of them is asked differs from pair to pair.
        let shift = (leaf.wrapping_mul(0x9e37_79b9) ^ other.wrapping_mul(0x85eb_ca6b)) as usize >> 7;
        for i in 0..POINTS {
            let to = points[(i + shift) % POINTS];
            let weight = kernel(from, to);
            if weight > 0.0 && weight.is_finite() {
                seen += weight * self.sight.between(from, to);
                all += weight;
                if is_little {
                    break;
                }
            }
        }
        if all > 0.0 { seen / all } else { 0.0 }
    }
}

/// For each node its partners, and whether it is sure that nothing is between.
fn by_node(nodes: usize, links: &[Judged]) -> (Vec<usize>, Vec<(u32, bool)>) {
    let mut rows = vec![0usize; nodes + 1];
    for Judged { link, .. } in links {
        rows[link.a as usize] += 1;
        rows[link.b as usize] += 1;
    }
    let mut below = 0;
    for row in &mut rows {
        below += std::mem::replace(row, below);
    }
    let mut next = rows.clone();
    let mut entries = vec![(NONE, false); below];
    for Judged { link, is_clear, .. } in links {
        for (at, other) in [(link.a, link.b), (link.b, link.a)] {
            entries[next[at as usize]] = (other, *is_clear);
            next[at as usize] += 1;
        }
    }
    (rows, entries)
}
