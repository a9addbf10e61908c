//! Light over face clusters: that of several of them that are connected, the more of each the nearer it is, so that no
//! outline of one is seen.

use super::corners::ElementCorners;
use super::hierarchy::Hierarchy;
use super::node::{NONE, key, normal_and_area};
use crate::color::Channels;
use glam::{DMat2, DVec2, DVec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap as HashMap;

/// Triangles share a corner if the cosine between their normals is greater.
const ALIKE: f64 = 0.5;
/// How far the light of a face cluster is spread, in the greatest radii of face clusters.
const REACH: f64 = 2.5;
/// Summand of the variance of places, in squares of that, so that few of them tell no gradient.
const DAMPED: f64 = 3e-3;

/// A place where light is known: in a face cluster, or at a corner that one shares with an element.
struct Known {
    light: [Channels; 2],
    at: DVec3,
    normal: DVec3,
    /// Of a face cluster: those that share corners with it, itself too, and what is known at its corners; in order.
    beside: Vec<u32>,
}

/// A corner of triangles, and of which face clusters they are.
struct Fine {
    at: DVec3,
    normal: DVec3,
    of: Vec<u32>,
}

/// Adds what comes to the corners of triangles that are part of face clusters, and tells for each patch where to find
/// it.
///
/// - `lit`: the face clusters to which light comes, with what comes to each of them.
/// - `values`: what comes to the corners of elements; where such a corner is one of a triangle, it has that value.
pub(super) fn spread(
    hierarchy: &Hierarchy,
    shared: &ElementCorners,
    lit: impl Iterator<Item = (u32, [Channels; 2])>,
    values: &mut Vec<[Channels; 2]>,
) -> Vec<[u32; 3]> {
    let lit: Vec<(u32, [Channels; 2])> = lit.collect();
    let mut known: Vec<Known> = lit
        .iter()
        .map(|(leaf, light)| {
            let [at, normal] = hierarchy.central(*leaf);
            Known { light: *light, at, normal, beside: Vec::new() }
        })
        .collect();
    let reach = lit.iter().map(|(leaf, _)| REACH * hierarchy.nodes[*leaf as usize].radius).fold(0.0, f64::max);
    let mut fine: Vec<Fine> = Vec::new();
    let mut corners = vec![[NONE; 3]; hierarchy.patches.len()];
    let mut there: HashMap<[u64; 3], Vec<u32>> = HashMap::default();
    // Which of what is known stands for a corner of elements.
    let mut ends: HashMap<u32, u32> = HashMap::default();
    for (number, (leaf, _)) in (0..).zip(&lit) {
        for patch in hierarchy.members(*leaf) {
            let of = &hierarchy.patches[*patch as usize];
            let normal = normal_and_area(of.corners).0;
            corners[*patch as usize] = of.corners.map(|at| {
                if let Some(corner) = shared.find(at, normal, ALIKE) {
                    let end = *ends.entry(corner).or_insert_with(|| {
                        known.push(Known { light: values[corner as usize], at, normal, beside: Vec::new() });
                        known.len() as u32 - 1
                    });
                    known[number as usize].beside.push(end);
                    return corner;
                }
                let there = there.entry(key(at)).or_default();
                let found = there.iter().find(|other| fine[**other as usize].normal.dot(normal) > ALIKE);
                let place = found.copied().unwrap_or_else(|| {
                    there.push(fine.len() as u32);
                    fine.push(Fine { at, normal, of: Vec::new() });
                    fine.len() as u32 - 1
                });
                let of = &mut fine[place as usize].of;
                if of.last() != Some(&number) {
                    of.push(number);
                }
                place + values.len() as u32
            });
        }
    }
    for Fine { of, .. } in &fine {
        of.iter().for_each(|one| known[*one as usize].beside.extend(of));
    }
    known.par_iter_mut().for_each(|Known { beside, .. }| {
        beside.sort_unstable();
        beside.dedup();
    });
    let light = |Fine { at, normal, of }: &Fine| {
        let mut near: Vec<u32> = of.iter().flat_map(|one| &known[*one as usize].beside).copied().collect();
        near.sort_unstable();
        near.dedup();
        let near: Vec<&Known> = near.iter().map(|number| &known[*number as usize]).collect();
        linear(*at, *normal, reach, &near).unwrap_or(known[of[0] as usize].light)
    };
    let found: Vec<[Channels; 2]> = fine.par_iter().map(light).collect();
    values.extend(found);
    corners
}

/// Light at a place by what is known around it: as if it was linear there, the more by what is nearer. No more and no
/// less than anything around. None if nothing is near.
///
/// # Source
/// Lancaster and Salkauskas 1981, moving least squares; with a damped gradient.
fn linear(at: DVec3, normal: DVec3, reach: f64, near: &[&Known]) -> Option<[Channels; 2]> {
    let weights = near.iter().map(|Known { at: other, normal: facing, .. }| {
        ((1.0 - at.distance(*other) / reach).max(0.0) * facing.dot(normal).max(0.0)).powi(2)
    });
    let weighted: Vec<(&Known, f64)> = near.iter().copied().zip(weights).filter(|(_, weight)| *weight > 0.0).collect();
    let all: f64 = weighted.iter().map(|(_, weight)| weight).sum();
    if all <= 0.0 {
        return None;
    }
    let (across, along) = normal.any_orthonormal_pair();
    let place = |known: &Known| DVec2::new((known.at - at).dot(across), (known.at - at).dot(along)) / reach;
    let middle = weighted.iter().map(|(known, weight)| place(known) * *weight).sum::<DVec2>() / all;
    let (mut spread, mut mean, mut slope) = (DMat2::ZERO, [Channels::ZERO; 2], [[Channels::ZERO; 2]; 2]);
    let (mut least, mut most) = ([Channels::splat(f64::INFINITY); 2], [Channels::splat(f64::NEG_INFINITY); 2]);
    for (known, weight) in weighted {
        let off = place(known) - middle;
        spread += DMat2::from_cols(off * off.x, off * off.y) * (weight / all);
        for part in 0..2 {
            let light = known.light[part];
            mean[part] += light * (weight / all);
            slope[part] = [0, 1].map(|axis| slope[part][axis] + light * (off[axis] * weight / all));
            least[part] = both(least[part], light, f64::min);
            most[part] = both(most[part], light, f64::max);
        }
    }
    let step = (spread + DMat2::from_diagonal(DVec2::splat(DAMPED))).inverse() * middle;
    Some([0, 1].map(|part| {
        let light = mean[part] - slope[part][0] * step.x - slope[part][1] * step.y;
        both(both(light, least[part], f64::max), most[part], f64::min)
    }))
}

fn both(a: Channels, b: Channels, of: fn(f64, f64) -> f64) -> Channels {
    Channels(std::array::from_fn(|lane| of(a.0[lane], b.0[lane])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_linear_stays_so_and_nothing_is_more_than_all_around() {
        let field = |at: DVec3| [Channels::splat(3.0 + at.x - 2.0 * at.y), Channels::splat(1.0)];
        let grid = (0..49).map(|k| DVec3::new(f64::from(k % 7) - 3.0, f64::from(k / 7) - 3.0, 0.0));
        let known: Vec<Known> =
            grid.map(|at| Known { light: field(at), at, normal: DVec3::Z, beside: Vec::new() }).collect();
        let near: Vec<&Known> = known.iter().collect();
        for at in [DVec3::new(0.3, 0.2, 0.0), DVec3::new(-1.2, 0.9, 0.0), DVec3::new(1.5, -1.5, 0.0)] {
            let found = linear(at, DVec3::Z, 3.0, &near).expect("near");
            let exact = field(at);
            assert!((found[0].0[0] - exact[0].0[0]).abs() < 0.05 && (found[1].0[7] - 1.0).abs() < 1e-12, "{found:?}");
        }
        // At the rim it does not continue to rise.
        let rim = linear(DVec3::new(4.0, -4.0, 0.0), DVec3::Z, 3.0, &near).expect("near");
        assert!(rim[0].max() <= 12.0, "{rim:?}");
        // What faces away, or is far, tells nothing.
        assert!(linear(DVec3::ZERO, DVec3::NEG_Z, 3.0, &near).is_none());
        assert!(linear(DVec3::X * 99.0, DVec3::Z, 3.0, &near).is_none());
        let one = linear(DVec3::new(0.1, 0.0, 0.0), DVec3::Z, 0.5, &near).expect("near");
        assert_eq!(one[0], known[24].light[0]);
    }
}
