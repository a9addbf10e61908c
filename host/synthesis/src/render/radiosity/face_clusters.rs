//! Face clusters: smooth pieces of surfaces of many small triangles, each of which is one element.
//!
//! At first each triangle is a piece. Neighbours that are each other's best partner become one piece, as long as a piece
//! is small and nearly flat, until none are left.
//!
//! # Source
//! Face clusters: Willmott, Heckbert and Garland 1999. Mutually best partners: Borůvka 1926.

use super::node::{HierarchyNode, key};
use super::shortest_edges::ShortestEdges;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap as HashMap;

/// Patches of a face cluster at the least: light over fewer is smoother if each is an element.
const FEWEST: usize = 4;
/// The greatest angle of a normal of a face cluster to the mean one, radians.
const FACING: f64 = 0.35;

/// Sums over the patches of a piece: of their areas, and of areas times middles and unit normals.
#[derive(Clone, Copy)]
struct Sums {
    area: f64,
    moment: DVec3,
    normal: DVec3,
}

impl Sums {
    fn of(node: &HierarchyNode) -> Sums {
        Sums { area: node.area, moment: node.middle * node.area, normal: node.normal * node.area }
    }

    fn of_both([a, b]: [Sums; 2]) -> Sums {
        Sums { area: a.area + b.area, moment: a.moment + b.moment, normal: a.normal + b.normal }
    }
}

/// A piece of surface.
struct Piece {
    /// Its patches, and the pieces beside it; in order.
    members: Vec<u32>,
    beside: Vec<u32>,
    sums: Sums,
    /// The piece that it became part of.
    merged_into: Option<u32>,
    /// The best piece to be one with, and the cost of that.
    best: Option<(f64, u32)>,
}

/// Divides patches into face clusters and patches that are alone, in the order of their first patches.
///
/// - `own`: a node for each patch.
/// - `edges`: of elements; the radius of a face cluster is no greater.
/// - `is_alone`: whether a patch is to be an element by itself.
pub(super) fn face_clusters(
    own: &[HierarchyNode],
    edges: &ShortestEdges,
    is_alone: impl Fn(u32) -> bool,
) -> Vec<Vec<u32>> {
    let mut pieces: Vec<Piece> = neighbours(own, |patch, node| node.radius <= edges.of(node) && !is_alone(patch))
        .into_iter()
        .enumerate()
        .map(|(patch, beside)| {
            let sums = Sums::of(&own[patch]);
            Piece { members: vec![patch as u32], beside, sums, merged_into: None, best: None }
        })
        .collect();
    let mut changed: Vec<u32> =
        (0..pieces.len() as u32).filter(|piece| !pieces[*piece as usize].beside.is_empty()).collect();
    while !changed.is_empty() {
        let best: Vec<Option<(f64, u32)>> =
            changed.par_iter().map(|piece| best_partner(&pieces, *piece, own, edges)).collect();
        for (piece, best) in changed.iter().zip(best) {
            pieces[*piece as usize].best = best;
        }
        let partner = |piece: u32| pieces[piece as usize].best.map(|(_, partner)| partner);
        let pairs: Vec<[u32; 2]> = changed
            .iter()
            .filter_map(|one| {
                let other = partner(*one)?;
                // Of two that both changed, the lower tells of them.
                let is_told = *one < other || changed.binary_search(&other).is_err();
                (is_told && partner(other) == Some(*one)).then_some([*one.min(&other), *one.max(&other)])
            })
            .collect();
        changed.clear();
        for [kept, gone] in pairs {
            changed.extend(merge(&mut pieces, kept, gone));
        }
        changed.retain(|piece| pieces[*piece as usize].merged_into.is_none());
        changed.sort_unstable();
        changed.dedup();
    }
    let mut found: Vec<Vec<u32>> = Vec::new();
    for piece in pieces.into_iter().filter(|piece| piece.merged_into.is_none()) {
        if piece.members.len() >= FEWEST {
            found.push(piece.members);
        } else {
            found.extend(piece.members.into_iter().map(|patch| vec![patch]));
        }
    }
    found.sort_unstable_by_key(|members| members[0]);
    found
}

/// For each patch that takes part, those that share an edge with it and do, too.
fn neighbours(own: &[HierarchyNode], takes_part: impl Fn(u32, &HierarchyNode) -> bool) -> Vec<Vec<u32>> {
    let mut at_edge: HashMap<[[u64; 3]; 2], Vec<u32>> = HashMap::default();
    let mut beside: Vec<Vec<u32>> = vec![Vec::new(); own.len()];
    for (patch, node) in (0..).zip(own).filter(|(patch, node)| takes_part(*patch, node)) {
        for i in 0..3 {
            let mut edge = [key(node.corners[i]), key(node.corners[(i + 1) % 3])];
            edge.sort_unstable();
            let others = at_edge.entry(edge).or_default();
            for other in others.iter() {
                beside[patch as usize].push(*other);
                beside[*other as usize].push(patch);
            }
            others.push(patch);
        }
    }
    beside.par_iter_mut().for_each(|beside| {
        beside.sort_unstable();
        beside.dedup();
    });
    beside
}

/// The best piece that one can be one with, and the cost: how large both together are and how far they bend.
fn best_partner(pieces: &[Piece], piece: u32, own: &[HierarchyNode], edges: &ShortestEdges) -> Option<(f64, u32)> {
    // By rounding errors, none is left out that bends no farther.
    let least_cosine = FACING.cos() - 1e-9;
    let cost = |other: &u32| {
        // In one order, so that both find the same cost.
        let both = [piece.min(*other), piece.max(*other)].map(|piece| &pieces[piece as usize]);
        let sum = Sums::of_both(both.map(|piece| piece.sums));
        let (middle, normal) = (sum.moment / sum.area, sum.normal.normalize_or_zero());
        let (mut farthest, mut cosine) = (0.0f64, 1.0f64);
        // The shortest edges of what is larger are no longer.
        let most = edges.at(middle, 0.0).powi(2);
        for node in both.iter().flat_map(|piece| &piece.members).map(|patch| &own[*patch as usize]) {
            cosine = cosine.min(node.normal.dot(normal));
            farthest = node.corners.iter().fold(farthest, |most, corner| most.max(corner.distance_squared(middle)));
            if farthest > most || cosine < least_cosine {
                return None;
            }
        }
        let radius = farthest.sqrt();
        let (size, bend) = (radius / edges.at(middle, radius), cosine.clamp(-1.0, 1.0).acos() / FACING);
        (size <= 1.0 && bend <= 1.0).then_some((size * size + bend * bend, *other))
    };
    pieces[piece as usize].beside.iter().filter_map(cost).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
}

/// Makes two pieces one. Tells which pieces are to look for a partner again.
fn merge(pieces: &mut [Piece], kept: u32, gone: u32) -> Vec<u32> {
    let Piece { members, beside, sums, .. } = &mut pieces[gone as usize];
    let (members, others, sums) = (std::mem::take(members), std::mem::take(beside), *sums);
    pieces[gone as usize].merged_into = Some(kept);
    for other in others.iter().filter(|other| **other != kept) {
        let beside = &mut pieces[*other as usize].beside;
        beside.retain(|piece| *piece != gone);
        if let Err(place) = beside.binary_search(&kept) {
            beside.insert(place, kept);
        }
    }
    let piece = &mut pieces[kept as usize];
    piece.members.extend(members);
    piece.sums = Sums::of_both([piece.sums, sums]);
    piece.members.sort_unstable();
    piece.beside.extend(others);
    piece.beside.retain(|other| *other != kept && *other != gone);
    piece.beside.sort_unstable();
    piece.beside.dedup();
    let mut changed = piece.beside.clone();
    changed.push(kept);
    changed
}
