//! What sees what: which patches light can come to, and how much of what elements see exchanges light.

use super::contact::Contacts;
use super::elements::{Elements, Exitance};
use super::exchange::Looks;
use super::hierarchy::{Hierarchy, NONE, Node, Patch};
use super::sight::{Seen, Sight};
use crate::color::Channels;
use glam::DVec3;
use rayon::prelude::*;

/// Directions in which a patch looks around for each of its parts, and at the most.
const LOOKS: u32 = 16;
const MOST_LOOKS: u32 = 1024;
/// So many are asked at once whether they are lit.
const ASKED: usize = 1024;

/// Sets of what is joined.
struct Joined(Vec<u32>);

impl Joined {
    fn new(count: usize) -> Joined {
        Joined((0..count as u32).collect())
    }

    fn root(&mut self, mut at: u32) -> u32 {
        while self.0[at as usize] != at {
            let next = self.0[self.0[at as usize] as usize];
            self.0[at as usize] = next;
            at = next;
        }
        at
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.0[high as usize] = low;
    }

    /// Whether each is joined to one that is lit.
    ///
    /// - `are_lit`: tells of some whether they are lit. It is asked no more than needs be.
    fn alight(&mut self, are_lit: impl Fn(&[u32]) -> Vec<bool>) -> Vec<bool> {
        let mut root_lit = vec![false; self.0.len()];
        let mut next = 0;
        while next < self.0.len() {
            let mut asked = Vec::with_capacity(ASKED);
            while next < self.0.len() && asked.len() < ASKED {
                if !root_lit[self.root(next as u32) as usize] {
                    asked.push(next as u32);
                }
                next += 1;
            }
            for (at, _) in asked.iter().zip(are_lit(&asked)).filter(|(_, is_lit)| *is_lit) {
                root_lit[self.root(*at) as usize] = true;
            }
        }
        (0..self.0.len() as u32).map(|at| root_lit[self.root(at) as usize]).collect()
    }
}

/// The hierarchy of the patches to which light comes, straight or from others; elements of them to which none comes are dark.
///
/// - `finest`, `coarsest`: lengths; patches are looked at in parts of the second.
pub(super) fn lit(
    sight: &Sight<'_>,
    patches: Vec<Patch>,
    contacts: &Contacts,
    (exitance, shadows): (Option<Exitance<'_>>, bool),
    [finest, coarsest]: [f64; 2],
) -> Hierarchy {
    let mut all = Hierarchy::new(patches);
    all.cut(contacts, finest);
    let is_dark = dark(sight, &all, (exitance, shadows), coarsest);
    all.darken(&is_dark);
    let is_lit = |patch: usize| !all.nodes[all.node_of[patch] as usize].is_dark;
    if (0..all.patches.len()).all(is_lit) {
        return all;
    }
    let lit: Vec<usize> = (0..all.patches.len()).filter(|patch| is_lit(*patch)).collect();
    let mut hierarchy = Hierarchy::new(lit.iter().map(|patch| all.patches[*patch]).collect());
    hierarchy.cut(contacts, finest);
    // Patches are divided as they were before.
    let mut is_dark = vec![false; hierarchy.nodes.len()];
    let mut pairs: Vec<[u32; 2]> =
        lit.iter().zip(&hierarchy.node_of).map(|(patch, node)| [all.node_of[*patch], *node]).collect();
    while let Some([before, now]) = pairs.pop() {
        let (before, node) = (&all.nodes[before as usize], &hierarchy.nodes[now as usize]);
        is_dark[now as usize] = before.is_dark;
        pairs.extend(before.children().zip(node.children()).map(|(a, b)| [a as u32, b as u32]));
    }
    hierarchy.darken(&is_dark);
    hierarchy
}

/// Of each node that is a leaf, whether no light comes to it.
fn dark(
    sight: &Sight<'_>,
    hierarchy: &Hierarchy,
    (exitance, shadows): (Option<Exitance<'_>>, bool),
    coarsest: f64,
) -> Vec<bool> {
    let nodes = &hierarchy.nodes;
    let is_lit = |node: &Node| {
        let at = |point: DVec3| {
            let patch = &hierarchy.patches[node.patch as usize];
            let extra = exitance.map_or(Channels::ZERO, |of| of(patch.triangle, patch.outside, point));
            extra.max() > 0.0 || sight.light_at(point, node.normal, shadows).max() > 0.0
        };
        node.is_leaf() && is_any_lit(node.corners, coarsest, &at)
    };
    let patch_of = numbers(sight, &hierarchy.patches);
    let looked = |(number, node): (usize, &Node)| {
        if !node.is_leaf() {
            return Vec::new();
        }
        let parts = (node.area / (coarsest * coarsest)).ceil().max(1.0);
        let count = (f64::from(LOOKS) * parts).min(f64::from(MOST_LOOKS)) as u32;
        let of = |seen: Seen| element(hierarchy, &patch_of, seen);
        let seen = sight.around(node.corners, node.normal, number as u64, count);
        let mut seen: Vec<u32> = seen.into_iter().map(of).filter(|node| *node != NONE).collect();
        seen.sort_unstable();
        seen.dedup();
        seen
    };
    let seen: Vec<Vec<u32>> = nodes.par_iter().enumerate().map(looked).collect();
    let mut joined = Joined::new(nodes.len());
    for (number, seen) in (0..).zip(&seen) {
        seen.iter().for_each(|other| joined.join(number, *other));
    }
    joined
        .alight(|some| some.par_iter().map(|node| is_lit(&nodes[*node as usize])).collect())
        .iter()
        .map(|alight| !alight)
        .collect()
}

fn is_any_lit(corners: [DVec3; 3], coarsest: f64, at: &impl Fn(DVec3) -> bool) -> bool {
    let [a, b, c] = corners;
    let middle = (a + b + c) / 3.0;
    if at(middle) || corners.iter().any(|corner| at(*corner * 0.8 + middle * 0.2)) {
        return true;
    }
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let [ab, bc, ca] = [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
    longest > coarsest
        && [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]].iter().any(|part| is_any_lit(*part, coarsest, at))
}

/// The patch of each side of each triangle, outer and inner.
fn numbers(sight: &Sight<'_>, patches: &[Patch]) -> Vec<[u32; 2]> {
    let mut numbers = vec![[NONE; 2]; sight.world.appearance.prepared.triangles.len()];
    for (number, patch) in (0..).zip(patches) {
        numbers[patch.triangle as usize][usize::from(!patch.outside)] = number;
    }
    numbers
}

/// The element that is seen.
fn element(hierarchy: &Hierarchy, patch_of: &[[u32; 2]], seen: Seen) -> u32 {
    let Seen::Side { triangle, outside, weights } = seen else { return NONE };
    match patch_of[triangle as usize][usize::from(!outside)] {
        NONE => NONE,
        patch => hierarchy.leaf_at(patch, hierarchy.patches[patch as usize].weights(weights)).0,
    }
}

/// What leaves see.
///
/// - `row`: for each leaf, the part of all that it sees that exchanges light.
pub(super) fn seen(
    sight: &Sight<'_>,
    elements: &Elements<'_>,
    (leaves, row): (&[u32], Vec<f64>),
    directions: u32,
) -> Looks {
    let directions = directions.max(1);
    let hierarchy: &Hierarchy = &elements.hierarchy;
    let patch_of = numbers(sight, &hierarchy.patches);
    let mut place = vec![NONE; hierarchy.nodes.len()];
    (0..).zip(leaves).for_each(|(number, leaf)| place[*leaf as usize] = number);
    let looked = |(number, leaf): (usize, &u32)| {
        let node = &hierarchy.nodes[*leaf as usize];
        // Beyond the numbers of all patches.
        let own = (1 << 40) + number as u64;
        let of = |seen: Seen| match element(hierarchy, &patch_of, seen) {
            NONE => NONE,
            leaf => place[leaf as usize],
        };
        sight.around(node.corners, node.normal, own, directions).into_iter().map(of).collect::<Vec<u32>>()
    };
    let seen: Vec<Vec<u32>> = leaves.par_iter().enumerate().map(looked).collect();
    let mut joined = Joined::new(leaves.len());
    for (number, seen) in (0..).zip(&seen) {
        seen.iter().filter(|other| **other != NONE).for_each(|other| joined.join(number, *other));
    }
    let sends = |leaf: u32| (elements.direct[leaf as usize] + elements.extra[leaf as usize]).max() > 0.0;
    let alight = joined.alight(|some| some.iter().map(|number| sends(leaves[*number as usize])).collect());
    let part = |seen: &Vec<u32>| seen.iter().filter(|other| **other != NONE).count() as f64 / f64::from(directions);
    let (part, is_dark) = (seen.iter().map(part).collect(), alight.iter().map(|alight| !alight).collect());
    Looks { directions, part, row, is_dark }
}
