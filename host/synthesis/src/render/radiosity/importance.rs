//! Importance: how much of the light of each element comes to pictures.
//!
//! An element that a picture shows has importance 1. One that only sends light to such has their importance times what
//! it reflects, and so on from bounce to bounce. The irradiance of an element may err the more the less it is important:
//! of the inside of a closed body, or of the far side of a floor, pictures know nothing.
//!
//! # Source
//! Importance of elements: Smits, Arvo and Salesin 1992. There it is a mean over all directions; here it is the most that
//! any direction has, so that a room of which a picture shows a corner counts as a whole.

use super::elements::Elements;
use super::hierarchy::Hierarchy;
use super::node::{NONE, normal_and_area};
use super::shown::ShownPlaces;
use super::side_elements::SideElements;
use super::visibility::VisibilityTester;
use glam::DVec3;

/// No element is less important.
const LEAST: f64 = 1.0 / 16.0;
/// Bounces of light from an element to a picture, at the most.
const BOUNCES: usize = 4;
/// Directions in which an element looks for others.
const DIRECTIONS: u32 = 16;
/// Numbers of these directions, beyond those of all others.
const OF_IMPORTANCE: u64 = 1 << 47;

/// The importance of each leaf, 1/16..=1.
///
/// - `leaves`: their nodes.
pub(super) fn importance(
    visibility: &VisibilityTester<'_>,
    elements: &Elements<'_>,
    shown: &ShownPlaces,
    leaves: &[u32],
) -> Vec<f64> {
    if !shown.are_all() {
        return vec![1.0; leaves.len()];
    }
    let hierarchy = &elements.hierarchy;
    let of_sides = SideElements::new(visibility, hierarchy);
    let number_of = hierarchy.numbers_of(leaves);
    let find = |target| match of_sides.find(target) {
        NONE => NONE,
        leaf => number_of[leaf as usize],
    };
    let is_shown = |_, leaf: &u32| {
        let shows = |place: [DVec3; 2]| shown.targets(visibility, place).any(|target| of_sides.find(target) == *leaf);
        test_points(hierarchy, *leaf).into_iter().any(shows)
    };
    let mut importance: Vec<f64> =
        visibility.map(leaves, is_shown).into_iter().map(|is_shown| if is_shown { 1.0 } else { 0.0 }).collect();
    // What is beside an opening passes on all light of what is behind it.
    for (importance, leaf) in importance.iter_mut().zip(leaves) {
        if elements.is_beside_opening(*leaf) {
            *importance = 1.0;
        }
    }
    for number in shown.places().iter().map(|target| find(*target)).filter(|number| *number != NONE) {
        importance[number as usize] = 1.0;
    }
    let seen: Vec<Vec<u32>> = visibility.map(leaves, |number, leaf| {
        let place = |index: u32, uniform: [f64; 2]| hierarchy.place(*leaf, index, uniform);
        let own = OF_IMPORTANCE + number as u64;
        let seen = visibility.trace_hemisphere(place, own, DIRECTIONS, |ray, _| find(visibility.trace(ray)));
        seen.into_iter().filter(|number| *number != NONE).collect()
    });
    let reflectance: Vec<f64> = leaves.iter().map(|leaf| elements.reflectance[*leaf as usize].max()).collect();
    for _ in 0..BOUNCES {
        let before = importance.clone();
        for (number, seen) in seen.iter().enumerate() {
            for other in seen.iter().map(|other| *other as usize) {
                importance[number] = importance[number].max(reflectance[number] * before[other]);
                importance[other] = importance[other].max(reflectance[other] * before[number]);
            }
        }
    }
    importance.into_iter().map(|importance| importance.max(LEAST)).collect()
}

/// Points of a leaf with their unit normals, of which a picture that shows the leaf shows some.
fn test_points(hierarchy: &Hierarchy, leaf: u32) -> Vec<[DVec3; 2]> {
    let node = &hierarchy.nodes[leaf as usize];
    if node.is_cluster() {
        let of = |patch: &u32| {
            let patch = &hierarchy.patches[*patch as usize];
            [patch.middle(), normal_and_area(patch.corners).0]
        };
        return hierarchy.members(leaf).iter().map(of).collect();
    }
    let inwards = node.corners.map(|corner| [corner * 0.9 + node.middle * 0.1, node.normal]);
    hierarchy.points(leaf).into_iter().chain(inwards).collect()
}
