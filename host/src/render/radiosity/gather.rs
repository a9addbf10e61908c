//! The light of other elements once more, as it differs from element to element below what a link is for.
//!
//! A link brings the same light to all of the node that receives it, which shows as steps. Each element asks all links
//! of what it is part of again, for the form factor from its own middle. What comes of it is scaled so that the part of
//! what it sees stays what it was: light that is the same everywhere stays so.

use super::exchange::Exchange;
use super::form_factor::{from_point, kernel};
use super::hierarchy::{Hierarchy, NONE, POINTS};
use super::links::Judged;
use crate::color::Channels;
use rayon::prelude::*;

/// Irradiance of each leaf by light of others, W/m².
///
/// - `sent`: what each leaf sends, W/m². `balanced`: of which the factors are taken, and what rows add up to.
pub(super) fn gathered(
    hierarchy: &Hierarchy,
    links: &[Judged],
    balanced: &Exchange<'_>,
    sent: &[Channels],
) -> Vec<Channels> {
    let nodes = &hierarchy.nodes;
    let mut parent = vec![NONE; nodes.len()];
    for (place, node) in (0..).zip(nodes) {
        node.children().for_each(|child| parent[child] = place);
    }
    let (rows, entries) = by_node(nodes.len(), links);
    let ones = vec![Channels::ONE; sent.len()];
    let (values, weights) = (balanced.means(sent), balanced.means(&ones));
    let goals = balanced.apply(&ones);
    let of = |(i, leaf): (usize, &u32)| {
        let node = &nodes[*leaf as usize];
        let (mut light, mut row) = (Channels::ZERO, 0.0);
        let mut at = *leaf;
        while at != NONE {
            for (other, seen) in &entries[rows[at as usize]..rows[at as usize + 1]] {
                let partner = &nodes[*other as usize];
                let factor = if partner.is_cluster() {
                    let points = hierarchy.points(*other);
                    let sum: f64 = points.iter().map(|point| kernel([node.middle, node.normal], *point)).sum();
                    sum * partner.area / POINTS as f64
                } else if (node.middle - partner.corners[0]).dot(partner.normal) > 0.0 {
                    from_point(node.middle, node.normal, &partner.polygon())
                } else {
                    0.0
                };
                let part = factor.min(1.0) * seen;
                light += values[*other as usize] * part;
                row += weights[*other as usize].0[0] * part;
            }
            at = parent[at as usize];
        }
        let goal = goals[i].0[0] / node.area;
        if row > 0.0 { light * (goal / row) } else { Channels::ZERO }
    };
    balanced.leaves.par_iter().enumerate().map(of).collect()
}

/// For each node its partners, and the part of light that comes through.
fn by_node(nodes: usize, links: &[Judged]) -> (Vec<usize>, Vec<(u32, f64)>) {
    let seen = || links.iter().filter(|judged| judged.seen > 0.0);
    let mut rows = vec![0usize; nodes + 1];
    for Judged { link, .. } in seen() {
        rows[link.a as usize] += 1;
        rows[link.b as usize] += 1;
    }
    let mut below = 0;
    for row in &mut rows {
        below += std::mem::replace(row, below);
    }
    let mut next = rows.clone();
    let mut entries = vec![(NONE, 0.0); below];
    for Judged { link, seen, .. } in seen() {
        for (at, other) in [(link.a, link.b), (link.b, link.a)] {
            entries[next[at as usize]] = (other, *seen);
            next[at as usize] += 1;
        }
    }
    (rows, entries)
}
