//! Visibility between patches: which of them light can come to, and how much of what elements see exchanges light.

use super::contact::Contacts;
use super::direct::Exitance;
use super::disjoint_sets::DisjointSets;
use super::elements::{COARSEST, Elements};
use super::enclosures::enclosures;
use super::exchange::{LeafHit, LeafVisibility, MirroredSky, OpeningExchange};
use super::hierarchy::{Hierarchy, POINTS};
use super::mirrors::MirroredTarget;
use super::node::{NONE, RadiosityPatch};
use super::shortest_edges::ShortestEdges;
use super::side_elements::SideElements;
use super::through_openings::LightThroughOpening;
use super::visibility::{RayTarget, VisibilityTester};
use crate::color::Channels;
use crate::memory::{self, MemoryExceeded};
use crate::numeric::ray::Ray;
use glam::DVec3;

/// Directions that are traced from a patch for each of its parts, and at the most.
const DIRECTIONS: u32 = 16;
const MOST_DIRECTIONS: u32 = 1024;
/// The standard error of the irradiance of all elements by each other, as a part of all their irradiance, that rays are
/// enough for.
const MOST_ERROR: f64 = 0.0004;
/// Rays of all leaves at the most, unless the scene asks for more.
const MOST_RAYS: usize = 1 << 22;
/// A leaf has so many rays more for what it sends, or a multiple: by rounding errors, none has one more or less.
const BY_POWER: f64 = 16.0;
/// Rays of one leaf that are its for what it sends, at the most.
const MOST_OF_BRIGHT: u32 = 1 << 16;

/// The hierarchy of the patches to which light comes, straight or from others; elements of them to which none comes are
/// dark.
///
/// - `through`: light that comes through openings.
/// - `edges`: of elements.
pub(super) fn lit_hierarchy(
    visibility: &VisibilityTester<'_>,
    patches: Vec<RadiosityPatch>,
    contacts: &Contacts,
    exitance: Option<Exitance<'_>>,
    through: &[LightThroughOpening],
    shadows: bool,
    edges: &ShortestEdges,
) -> Hierarchy {
    // What a line leads through is partly inside of something: it is cut, and parts what is on either side.
    let mut all = Hierarchy::new(patches, edges, |patch| contacts.cross(patch));
    all.cut(contacts, edges);
    let is_dark = dark(visibility, &all, exitance, through, shadows, COARSEST * edges.everywhere);
    all.darken(&is_dark);
    let is_lit = |patch: usize| !all.nodes[all.node_of[patch] as usize].is_dark;
    if (0..all.patches.len()).all(is_lit) {
        return all;
    }
    let lit: Vec<usize> = (0..all.patches.len()).filter(|patch| is_lit(*patch)).collect();
    let mut number_of = vec![NONE; all.patches.len()];
    lit.iter().zip(0..).for_each(|(patch, number)| number_of[*patch] = number);
    // A face cluster is lit or dark.
    let mut faces = all.faces();
    faces.iter_mut().for_each(|face| face.iter_mut().for_each(|patch| *patch = number_of[*patch as usize]));
    faces.retain(|face| face[0] != NONE);
    let mut hierarchy = Hierarchy::of_faces(lit.iter().map(|patch| all.patches[*patch]).collect(), &faces);
    hierarchy.cut(contacts, edges);
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

/// Whether each node that is a leaf gets no light.
///
/// - `coarsest`: a length; patches are tested in parts no longer than that.
fn dark(
    visibility: &VisibilityTester<'_>,
    hierarchy: &Hierarchy,
    exitance: Option<Exitance<'_>>,
    through: &[LightThroughOpening],
    shadows: bool,
    coarsest: f64,
) -> Vec<bool> {
    let nodes = &hierarchy.nodes;
    let elements_of_sides = SideElements::new(visibility, hierarchy);
    let mut is_lit_through_opening = vec![false; nodes.len()];
    for node in through.iter().map(|light| elements_of_sides.find(light.at)).filter(|node| *node != NONE) {
        is_lit_through_opening[node as usize] = true;
    }
    let is_lit = |number: u32| {
        let node = &nodes[number as usize];
        let sends = |patch: u32, point: DVec3| {
            let patch = &hierarchy.patches[patch as usize];
            exitance.is_some_and(|of| of(patch.triangle, patch.outside, point).max() > 0.0)
        };
        let takes = |place: [DVec3; 2]| visibility.is_lit_at(place, shadows);
        if !node.is_leaf() {
            false
        } else if is_lit_through_opening[number as usize] {
            true
        } else if node.is_cluster() {
            let middle = |patch: u32| hierarchy.patches[patch as usize].middle();
            let mut members = hierarchy.members(number).iter();
            hierarchy.points(number).into_iter().any(takes) || members.any(|patch| sends(*patch, middle(*patch)))
        } else {
            is_any_lit(node.corners, coarsest, &|point| sends(node.patch, point) || takes([point, node.normal]))
        }
    };
    let looked = |number: u32| {
        let node = &nodes[number as usize];
        let parts = (node.area / (coarsest * coarsest)).ceil().max(1.0);
        let count = (f64::from(DIRECTIONS) * parts).min(f64::from(MOST_DIRECTIONS)) as u32;
        let of = |seen: RayTarget| elements_of_sides.find(seen);
        let seen = visibility.trace_hemisphere(
            |index, uniform| hierarchy.place(number, index, uniform),
            u64::from(number),
            count,
            |ray, _| visibility.trace(ray),
        );
        let mut seen: Vec<u32> = seen.into_iter().map(of).filter(|node| *node != NONE).collect();
        seen.sort_unstable();
        seen.dedup();
        seen
    };
    let leaves: Vec<u32> = (0..nodes.len() as u32).filter(|node| nodes[*node as usize].is_leaf()).collect();
    let middle = |_, leaf: &u32| visibility.is_lit_at(hierarchy.points(*leaf)[POINTS - 1], shadows);
    let is_middle_lit = visibility.map(&leaves, middle);
    let mut joined = DisjointSets::new(nodes.len());
    let join = |joined: &mut DisjointSets, some: Vec<u32>| {
        let seen: Vec<Vec<u32>> = visibility.map(&some, |_, number| looked(*number));
        for (number, seen) in some.into_iter().zip(seen) {
            seen.into_iter().for_each(|other| joined.join(number, other));
        }
    };
    // Most are lit in the middle, or see what is: others are asked only if that does not tell of all.
    let mut is_known_lit = vec![false; nodes.len()];
    leaves.iter().zip(&is_middle_lit).for_each(|(leaf, is_lit)| is_known_lit[*leaf as usize] = *is_lit);
    let of = |lit: bool| -> Vec<u32> {
        leaves.iter().zip(&is_middle_lit).filter(|(_, is_lit)| **is_lit == lit).map(|(leaf, _)| *leaf).collect()
    };
    join(&mut joined, of(false));
    let known = |some: &[u32]| some.iter().map(|number| is_known_lit[*number as usize]).collect();
    let is_alight = joined.joined_to_lit(known);
    if leaves.iter().all(|leaf| is_alight[*leaf as usize]) {
        return is_alight.iter().map(|alight| !alight).collect();
    }
    join(&mut joined, of(true));
    joined.joined_to_lit(|some| visibility.map(some, |_, node| is_lit(*node))).iter().map(|alight| !alight).collect()
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

/// Leaf visibility, by rays: so many that chance is a small part of what leaves receive. Half of them are from all leaves
/// alike, as far as they are important, half the more from a leaf the more it sends: rays to a small bright spot seldom
/// hit it.
///
/// - `row`: for each leaf, the part of all that it sees that exchanges light.
/// - `directions`: rays of each leaf, at the least. `stopped`: whether these will do.
///
/// # Errors
/// [`MemoryExceeded`].
pub(super) fn leaf_visibility(
    visibility: &VisibilityTester<'_>,
    elements: &Elements<'_>,
    leaves: &[u32],
    row: &[f64],
    directions: u32,
    stopped: &dyn Fn() -> bool,
) -> Result<LeafVisibility, MemoryExceeded> {
    // What rays hit is known leaf by leaf first, then all together.
    let reserve = |counts: &[u32]| {
        let rays: u64 = counts.iter().map(|count| u64::from(*count)).sum();
        memory::reserve(2 * rays * size_of::<LeafHit>() as u64, || {
            format!("radiosity: {rays} rays of {} elements", leaves.len())
        })
    };
    let directions = directions.max(1);
    let few = vec![directions; leaves.len()];
    reserve(&few)?;
    let through_openings = through_openings(visibility, elements, leaves, stopped)?;
    let pilot = traced(visibility, elements, leaves, row, &few, through_openings);
    let error = elements.error_by_chance(leaves, &pilot);
    let most = (MOST_RAYS / leaves.len().max(1)).clamp(1, MOST_DIRECTIONS as usize) as f64;
    let needed = f64::from(directions) * (error / MOST_ERROR).powi(2);
    let more = needed.min(most).ceil() as u32;
    if more <= directions || stopped() {
        return Ok(pilot);
    }
    let through_openings = pilot.through_openings;
    drop(pilot.hits);
    let sent: Vec<f64> = leaves.iter().zip(row).map(|(leaf, row)| elements.power(*leaf) * row).collect();
    let all: f64 = sent.iter().sum();
    let importance: f64 = leaves.iter().map(|leaf| elements.importance_to_rays(*leaf)).sum();
    let rays = 0.5 * f64::from(more) * importance;
    let count = |(leaf, sent): (&u32, &f64)| {
        let alike = (0.5 * f64::from(more) * elements.importance_to_rays(*leaf)).ceil() as u32;
        let by_power = if all > 0.0 { (rays * sent / (all * BY_POWER)) as u32 * BY_POWER as u32 } else { 0 };
        alike.max(directions) + by_power.min(MOST_OF_BRIGHT)
    };
    let counts: Vec<u32> = leaves.iter().zip(&sent).map(count).collect();
    reserve(&counts)?;
    Ok(traced(visibility, elements, leaves, row, &counts, through_openings))
}

/// What leaves exchange through openings.
///
/// - `stopped`: whether few rays will do.
///
/// # Errors
/// [`MemoryExceeded`].
fn through_openings(
    visibility: &VisibilityTester<'_>,
    elements: &Elements<'_>,
    leaves: &[u32],
    stopped: &dyn Fn() -> bool,
) -> Result<Vec<OpeningExchange>, MemoryExceeded> {
    let elements_of_sides = SideElements::new(visibility, &elements.hierarchy);
    let place = elements.hierarchy.numbers_of(leaves);
    let find = |target: RayTarget| {
        let (leaf, weights) = elements_of_sides.find_place(target)?;
        Some((place[leaf as usize], weights)).filter(|(number, _)| *number != NONE)
    };
    let sent: Vec<f64> = leaves.iter().map(|leaf| elements.sent[*leaf as usize].0.iter().sum()).collect();
    visibility.exchange_through_openings(&find, &sent, stopped)
}

/// What rays of each leaf hit.
///
/// - `counts`: of each leaf, how many rays. `through_openings`: what leaves exchange through openings.
fn traced(
    visibility: &VisibilityTester<'_>,
    elements: &Elements<'_>,
    leaves: &[u32],
    row: &[f64],
    counts: &[u32],
    through_openings: Vec<OpeningExchange>,
) -> LeafVisibility {
    let hierarchy: &Hierarchy = &elements.hierarchy;
    let elements_of_sides = SideElements::new(visibility, hierarchy);
    let place = hierarchy.numbers_of(leaves);
    let looked = |number: usize, leaf: &u32| {
        // Beyond the numbers of all patches.
        let own = (1 << 40) + number as u64;
        let of = |seen: RayTarget, is_mirrored: bool| match (elements_of_sides.find(seen), seen) {
            (NONE, _) | (_, RayTarget::Nothing | RayTarget::Lamp) => LeafHit::NOTHING,
            (leaf, RayTarget::Side { transmittance, through_opening, .. }) => {
                let leaf = place[leaf as usize];
                LeafHit { leaf, transmittance: transmittance as f32, through_opening, is_mirrored }
            }
        };
        let place = |index: u32, uniform: [f64; 2]| hierarchy.place(*leaf, index, uniform);
        if !visibility.by_mirrors {
            let straight = |ray: &Ray, _: &dyn Fn(u64) -> f64| of(visibility.trace(ray), false);
            return (visibility.trace_hemisphere(place, own, counts[number], straight), MirroredSky::default());
        }
        let by_mirrors = |ray: &Ray, uniform: &dyn Fn(u64) -> f64| {
            let MirroredTarget { target, is_mirrored, sky } = visibility.trace_by_mirrors(ray, uniform);
            (of(target, is_mirrored), sky)
        };
        let (hits, sky): (Vec<LeafHit>, Vec<Channels>) =
            visibility.trace_hemisphere(place, own, counts[number], by_mirrors).into_iter().unzip();
        (hits, MirroredSky::of(&sky))
    };
    let (seen, mirrored_sky): (Vec<Vec<LeafHit>>, Vec<MirroredSky>) =
        visibility.map(leaves, looked).into_iter().unzip();
    let joined = |is_joined: fn(&LeafHit) -> bool| {
        let mut joined = DisjointSets::new(leaves.len());
        for (number, seen) in (0..).zip(&seen) {
            let hits = seen.iter().filter(|hit| hit.leaf != NONE && is_joined(hit));
            hits.for_each(|hit| joined.join(number, hit.leaf));
        }
        joined
    };
    let sends = |leaf: u32| (elements.direct[leaf as usize] + elements.extra[leaf as usize]).max() > 0.0;
    let alight =
        joined(|_| true).joined_to_lit(|some| some.iter().map(|number| sends(leaves[*number as usize])).collect());
    let is_dark: Vec<bool> = alight.iter().map(|alight| !alight).collect();
    let enclosures = enclosures(joined(|hit| !hit.through_opening && !hit.is_mirrored), &is_dark);
    let part = |seen: &Vec<LeafHit>, is_mirrored: bool| {
        let hits = seen.iter().filter(|hit| hit.leaf != NONE && hit.is_mirrored == is_mirrored);
        hits.map(|hit| f64::from(hit.transmittance)).sum::<f64>() / seen.len() as f64
    };
    let parts = |is_mirrored: bool| seen.iter().map(|seen| part(seen, is_mirrored)).collect();
    let mut end = 0;
    let range = |seen: &Vec<LeafHit>| {
        let first = end;
        end += seen.len();
        first..end
    };
    LeafVisibility {
        rays: seen.iter().map(range).collect(),
        seen_part: parts(false),
        mirrored_part: parts(true),
        mirrored_sky,
        hits: seen.concat(),
        row: row.to_vec(),
        is_dark,
        enclosures,
        through_openings,
    }
}
