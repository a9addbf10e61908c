//! A final gathering pass: the light of other elements once more, as it differs from element to element below what a
//! link is for.
//!
//! A link brings the same light to all of the node that receives it, which shows as steps; it takes light that differs
//! over the node that sends it for the same, and knows only in the mean how much of it is hidden. Each corner of
//! elements asks all links of what it is part of again, for the form factor from there and for what can be seen. Where
//! no light is lost, what is missing is filled up: in hollows by the neighbourhood, which links pass over, elsewhere in
//! proportion. Light that is the same everywhere stays so.

use super::bound::RefinementBound;
use super::corners::{ElementCorner, ElementCorners};
use super::elements::Elements;
use super::form_factor::{from_point, kernel};
use super::hierarchy::{Hierarchy, POINTS};
use super::node::NONE;
use super::opening_views::OpeningViews;
use super::refinement::AssessedLink;
use super::visibility::VisibilityTester;
use crate::color::Channels;
use crate::numeric::ray::Ray;
use glam::DVec3;
use rayon::prelude::*;

/// Light below this part of the error of a link is sampled with one ray instead of some.
const LITTLE: f64 = 1.0;
/// Light below this part of the error of a link is sampled by chance: by no less than the least.
const NEGLIGIBLE: f64 = 1.0 / 8.0;
const LEAST_CHANCE: f64 = 1.0 / 16.0;
/// The greatest difference of what parts of a node send, as a part of it.
const UNEVEN: f64 = 0.1;

/// Gathers light.
pub(super) struct Gatherer<'g, 'a> {
    pub(super) visibility: &'g VisibilityTester<'a>,
    pub(super) elements: &'g Elements<'a>,
    /// The bound of the error of the light of a link.
    pub(super) bound: RefinementBound,
}

/// Corner views: what each corner of leaves sees of nodes.
pub(super) struct CornerViews<'g> {
    corners: &'g ElementCorners,
    /// For each corner, the nodes, and the part of all that it sees that each node is.
    of: Vec<Vec<(u32, f32)>>,
}

impl CornerViews<'_> {
    /// The part of all that each leaf may see that exchanges light.
    pub(super) fn rows(&self) -> Vec<f64> {
        let row = |nodes: &Vec<(u32, f32)>| nodes.iter().map(|(_, part)| f64::from(*part)).sum::<f64>().min(1.0);
        let rows: Vec<f64> = self.of.par_iter().map(row).collect();
        (0..self.corners.of.len()).map(|leaf| self.corners.mean(leaf, |corner| rows[corner as usize])).collect()
    }

    /// Irradiance of each corner by light of others, W/m².
    ///
    /// - `sent`: what each leaf sends, W/m². `is_closed`: of each, whether all that it sees exchanges light.
    pub(super) fn irradiance(
        &self,
        hierarchy: &Hierarchy,
        leaves: &[u32],
        sent: &[Channels],
        is_closed: &[bool],
    ) -> Vec<Channels> {
        let mut values = vec![Channels::ZERO; hierarchy.nodes.len()];
        leaves.iter().zip(sent).for_each(|(leaf, sent)| values[*leaf as usize] = *sent);
        hierarchy.pull(&mut values);
        // Of each corner, what its leaves send, if they are all closed.
        let mut own = vec![(Channels::ZERO, 0.0); self.of.len()];
        for (leaf, (sent, is_closed)) in sent.iter().zip(is_closed).enumerate() {
            for corner in self.corners.of_leaf(leaf) {
                let (sum, count) = &mut own[corner as usize];
                *sum += *sent;
                *count += if *is_closed { 1.0 } else { f64::NEG_INFINITY };
            }
        }
        let of = |corner: usize| {
            let (own, count) = own[corner];
            let (mut light, mut row) = (Channels::ZERO, 0.0);
            for (node, part) in &self.of[corner] {
                light += values[*node as usize] * f64::from(*part);
                row += f64::from(*part);
            }
            match count > 0.0 && row < 1.0 {
                true if row <= 0.0 || self.corners.all[corner].is_hollow() => light + own * ((1.0 - row) / count),
                true => light * row.recip(),
                false => light * row.max(1.0).recip(),
            }
        };
        (0..self.of.len()).into_par_iter().map(of).collect()
    }

    /// How much more than in the mean a leaf sends at a place of it: linear between its corners.
    ///
    /// - `leaf`: its number. `at`: weights of its corners. `sent`: what it sends at each of them, told their numbers.
    pub(super) fn brightness(&self, leaf: usize, at: [f64; 3], sent: impl Fn([u32; 3]) -> [f64; 3]) -> f64 {
        let sent = sent(self.corners.of[leaf]);
        let mean = sent.iter().sum::<f64>() / 3.0;
        let here: f64 = sent.iter().zip(at).map(|(sent, weight)| sent * weight).sum();
        if mean > 0.0 { (here / mean).max(0.0) } else { 1.0 }
    }

    /// The mean at each corner of what is known of its leaves.
    pub(super) fn at_corners(&self, of_leaves: &[Channels]) -> Vec<Channels> {
        let mut sums = vec![(Channels::ZERO, 0.0); self.of.len()];
        for (leaf, value) in of_leaves.iter().enumerate() {
            for corner in self.corners.of_leaf(leaf) {
                let (sum, count) = &mut sums[corner as usize];
                *sum += *value;
                *count += 1.0;
            }
        }
        sums.into_iter().map(|(sum, count)| sum * f64::recip(count)).collect()
    }

    /// The mean over each leaf of what is known at its corners.
    pub(super) fn means(&self, values: &[Channels]) -> Vec<Channels> {
        (0..self.corners.of.len()).map(|leaf| self.corners.mean(leaf, |corner| values[corner as usize])).collect()
    }
}

impl Gatherer<'_, '_> {
    /// Corner views of all corners, divided the more the more what is seen differs.
    ///
    /// - `leaves`: whose corners they are.
    pub(super) fn views<'g>(
        &self,
        links: &[AssessedLink],
        corners: &'g ElementCorners,
        leaves: &[u32],
    ) -> CornerViews<'g> {
        let Elements { hierarchy, sent, least, importance, .. } = self.elements;
        let nodes = &hierarchy.nodes;
        let mut parent = vec![NONE; nodes.len()];
        for (place, node) in (0..).zip(nodes) {
            node.children().for_each(|child| parent[child] = place);
        }
        let (rows, entries) = by_node(nodes.len(), links);
        let apart = self.apart(sent);
        let opening_views = OpeningViews::new(self.visibility, hierarchy, sent);
        let importance = corners.most_of(leaves.iter().map(|leaf| importance[*leaf as usize]));
        // What sends little now may send as much as the mean once all light is known.
        let mean_sent = sent[0].max();
        let of = |number: usize, corner: &ElementCorner| {
            let from = corner.view();
            let least = least[corner.leaf as usize];
            let error = self.bound.of(least, importance[number]);
            let (mut found, mut pending) = (opening_views.seen(from, least), Vec::new());
            let mut at = corner.leaf;
            while at != NONE {
                pending.extend(&entries[rows[at as usize]..rows[at as usize + 1]]);
                while let Some((other, is_clear)) = pending.pop() {
                    let partner = &nodes[other as usize];
                    let factor = self.factor(from, other);
                    let is_uneven = || factor * apart[other as usize] > UNEVEN * error;
                    // Points do not stand for a node that reaches below the horizon.
                    let sinks = || {
                        let points = hierarchy.points(other);
                        factor * sent[other as usize].max() > UNEVEN * error
                            && !is_clear
                            && points.iter().any(|[at, _]| (*at - from[0]).dot(from[1]) <= 0.0)
                    };
                    if !partner.is_leaf() && (is_uneven() || sinks()) {
                        let lit = partner.children().filter(|child| !nodes[*child].is_dark);
                        pending.extend(lit.map(|child| (child as u32, is_clear)));
                        continue;
                    }
                    if factor <= 0.0 {
                        continue;
                    }
                    if is_clear && self.visibility.openings.0.is_empty() {
                        found.push((other, factor as f32));
                        continue;
                    }
                    let sent = sent[other as usize].max();
                    // What is next to nothing is asked now and then only, and counts the more.
                    let chance = (factor * sent.max(mean_sent) / (NEGLIGIBLE * error)).clamp(LEAST_CHANCE, 1.0);
                    if chance < 1.0 && pair_number(number as u32, other) >= chance {
                        continue;
                    }
                    let is_little = factor * sent < LITTLE * error;
                    let seen = self.visible_part(number as u32, from, other, is_clear, is_little);
                    if seen > 0.0 {
                        found.push((other, (factor * seen / chance) as f32));
                    }
                }
                at = parent[at as usize];
            }
            found.shrink_to_fit();
            found
        };
        let of = self.visibility.map(&corners.all, of);
        CornerViews { corners, of }
    }

    /// How far what parts of each node send is from what all of it does in the mean, W/m² at the most.
    fn apart(&self, values: &[Channels]) -> Vec<f64> {
        let nodes = &self.elements.hierarchy.nodes;
        let mut apart = vec![0.0f64; nodes.len()];
        for place in (0..nodes.len()).rev().filter(|place| !nodes[*place].is_dark) {
            let of = |child: usize| (values[child] - values[place]).map(f64::abs).max() + apart[child];
            let lit = nodes[place].children().filter(|child| !nodes[*child].is_dark);
            apart[place] = lit.map(of).fold(0.0, f64::max);
        }
        apart
    }

    /// The form factor from a point with its normal to a node, as if nothing was between them.
    fn factor(&self, from: [DVec3; 2], other: u32) -> f64 {
        let partner = &self.elements.hierarchy.nodes[other as usize];
        if partner.is_cluster() {
            let points = self.elements.hierarchy.points(other);
            let sum: f64 = points.iter().map(|point| kernel(from, *point)).sum();
            (sum * partner.area / POINTS as f64).min(1.0)
        } else if (from[0] - partner.corners[0]).dot(partner.normal) > 0.0 {
            from_point(from[0], from[1], &partner.polygon())
        } else {
            0.0
        }
    }

    /// The part of a node that is seen from a corner, but through openings.
    fn visible_part(&self, number: u32, from: [DVec3; 2], other: u32, is_clear: bool, is_little: bool) -> f64 {
        let transmittance = |to: [DVec3; 2]| {
            let ray = Ray { origin: from[0], direction: to[0] - from[0] };
            match self.visibility.openings.are_crossed(&ray, 1.0) {
                true => 0.0,
                false if is_clear => 1.0,
                false => self.visibility.transmittance(from, to),
            }
        };
        let points = self.elements.hierarchy.points(other);
        let (mut seen, mut all) = (0.0, 0.0);
        // The point of it that is tested differs from pair to pair.
        let shift = pair_hash(number, other) as usize >> 7;
        for i in 0..POINTS {
            let to = points[(i + shift) % POINTS];
            let weight = kernel(from, to);
            if weight > 0.0 && weight.is_finite() {
                seen += weight * transmittance(to);
                all += weight;
                if is_little {
                    break;
                }
            }
        }
        // What is in sight of an element at the horizon is next to nothing, and near.
        if all > 0.0 { seen / all } else { 1.0 }
    }
}

/// A number for a corner and a node.
fn pair_hash(corner: u32, node: u32) -> u32 {
    corner.wrapping_mul(0x9e37_79b9) ^ node.wrapping_mul(0x85eb_ca6b)
}

/// A number in 0..1 for a corner and a node.
fn pair_number(corner: u32, node: u32) -> f64 {
    let mixed = (u64::from(pair_hash(corner, node)) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (mixed >> 11) as f64 / (1u64 << 53) as f64
}

/// For each node its partners, and whether it is sure that nothing is between.
fn by_node(nodes: usize, links: &[AssessedLink]) -> (Vec<usize>, Vec<(u32, bool)>) {
    let mut rows = vec![0usize; nodes + 1];
    let links = || links.iter().filter(|assessed| assessed.link.a != assessed.link.b);
    for AssessedLink { link, .. } in links() {
        rows[link.a as usize] += 1;
        rows[link.b as usize] += 1;
    }
    let mut below = 0;
    for row in &mut rows {
        below += std::mem::replace(row, below);
    }
    let mut next = rows.clone();
    let mut entries = vec![(NONE, false); below];
    for AssessedLink { link, is_clear, .. } in links() {
        for (at, other) in [(link.a, link.b), (link.b, link.a)] {
            entries[next[at as usize]] = (other, *is_clear);
            next[at as usize] += 1;
        }
    }
    (rows, entries)
}
