//! Surfaces that cross, cover or turn against themselves, and the simple surface of what they bound.
//!
//! A surface is simple if its winding number is 1 or 0 at every point off it. What any closed surface bounds are the
//! points at which its winding number is positive.

use super::expression::Expression;
use super::half_edges::HalfEdges;
use super::nudging::nudge;
use super::operand::{Operand, Operands};
use super::overlaps::{Overlaps, overlapping};
use super::result::Outcome;
use super::single_evaluation::{Evaluation, evaluate_once};
use super::snapping::{Scope, snapped};
use crate::mesh::{Mesh, bits};
use crate::numeric::bounds::Bounds;
use crate::numeric::triangle;
use crate::octree::TriangleBvh;
use crate::solid::SolidError;
use crate::solid::cleaning::is_closed;
use crate::solid::union_find::UnionFind;
use glam::DVec3;
use rustc_hash::FxHashSet;

/// A way to make a surface simple.
struct Attempt {
    /// How far points are moved, in units in the last place of the largest coordinate there.
    most: f64,
    /// What is snapped within that distance.
    scope: Scope,
    /// Whether it begins with the attempt that left the fewest pairs of triangles that overlap, and not from the first.
    from_best: bool,
}

/// Attempts, one after the other until one succeeds. To snap all that is near triangles that overlap serves where
/// sheets nearly coincide; only these, where they cross at small angles; and only what the best attempt left, where
/// that is little.
const ATTEMPTS: [Attempt; 6] = [
    Attempt { most: 4.0, scope: Scope::Near, from_best: false },
    Attempt { most: 4.0, scope: Scope::Overlapping, from_best: false },
    Attempt { most: 16.0, scope: Scope::Overlapping, from_best: true },
    Attempt { most: 32.0, scope: Scope::Near, from_best: false },
    Attempt { most: 32.0, scope: Scope::Overlapping, from_best: false },
    Attempt { most: 32.0, scope: Scope::Near, from_best: true },
];
/// How far points of a surface freed of self-intersections may be from the rounded one, in units in the last place of
/// the largest coordinate.
const MOST: f64 = 64.0;
/// How often points are snapped and nudged in an attempt at most.
const ROUNDS: usize = 6;
/// An attempt is given up if a round leaves more than this part of the pairs of triangles that overlapped before it.
const LEFT: f64 = 0.85;

/// What a closed surface bounds.
pub struct Resolution {
    /// The simple surface.
    pub outcome: Outcome,
    /// Whether it is the same surface, but for how it is divided.
    pub is_same: bool,
    /// An improper winding number of the given one, negative if there is such a one, and where it is.
    pub improper_winding: Option<(i32, DVec3)>,
}

/// Makes a closed surface simple.
///
/// - `overlaps`: pairs of its triangles that overlap, the lower first.
///
/// # Errors
/// [`SolidError::SelfIntersecting`].
pub fn resolve(mesh: &Mesh, overlaps: &[[u32; 2]]) -> Result<Resolution, SolidError> {
    let mesh = separated(mesh);
    let Evaluation { mut outcome, is_unchanged: is_all_kept, improper_winding: odd, .. } = divided(&mesh, overlaps);
    outcome.clean();
    Ok(Resolution { outcome: without_self_intersections(outcome)?, is_same: is_all_kept, improper_winding: odd })
}

/// The outcome freed of self-intersections, where rounding made it cross itself or turned parts of it inside out.
///
/// What lies within a few units in the last place becomes one: then sheets that nearly coincide have the same
/// triangles, which cancel. What is left on the wrong side of something is nudged to the right one. Both may have to be
/// done again, since what was moved meets others. Whatever comes out is looked at exactly: no two triangles overlap,
/// and the winding number of the surface is 1 inside and 0 outside.
///
/// No point is farther from the rounded surface than [`MOST`] units in the last place of the largest coordinate: each
/// that is no corner of it is measured. Each attempt takes about as long as a few operations on the triangles that
/// overlap, besides looking once at all triangles, and in each round at those that were changed.
///
/// # Errors
/// [`SolidError::SelfIntersecting`] if none of the attempts succeeds.
pub fn without_self_intersections(mut outcome: Outcome) -> Result<Outcome, SolidError> {
    outcome.clean();
    let first = overlapping(&outcome.mesh);
    if first.is_empty() {
        return Ok(right_side_out(&outcome).unwrap_or(outcome));
    }
    let (volume, bound) = (outcome.mesh.signed_volume(), change_of_volume(&outcome.mesh));
    let mut best = Trial { outcome: outcome.clone(), pairs: first.clone() };
    for (attempt, number) in ATTEMPTS.iter().zip(1..) {
        let is_right = |settled: &Outcome| {
            let change = (settled.mesh.signed_volume() - volume).abs();
            change <= (2.0 * attempt.most + 8.0) * bound
                && is_closed(&settled.mesh)
                && is_near(&settled.mesh, &outcome.mesh)
        };
        let from =
            if attempt.from_best { best.clone() } else { Trial { outcome: outcome.clone(), pairs: first.clone() } };
        let trial = from.apply(attempt);
        if trial.pairs.is_empty() {
            // What was turned inside out goes now. All that stays is whole; that is looked at all the same.
            let (mut settled, is_simple) = match right_side_out(&trial.outcome) {
                Some(next) => {
                    let overlaps = Overlaps::new(&trial.outcome.mesh, &[]).overlapping(&next.mesh);
                    (next, overlaps.is_empty())
                }
                None => (trial.outcome, true),
            };
            if is_simple && is_right(&settled) {
                settled.counts.repair_attempt = number;
                return Ok(settled);
            }
        } else if trial.pairs.len() < best.pairs.len() {
            best = trial;
        }
    }
    let [near, ..] = outcome.mesh.corners(first[0][0] as usize);
    Err(SolidError::SelfIntersecting { overlaps: first.len(), near, most: MOST })
}

/// A surface and the pairs of triangles of it that overlap.
#[derive(Clone)]
struct Trial {
    outcome: Outcome,
    pairs: Vec<[u32; 2]>,
}

impl Trial {
    /// What an attempt makes of it: without pairs if it succeeds, and otherwise with the fewest that it came to.
    fn apply(mut self, attempt: &Attempt) -> Trial {
        let mut best = self.clone();
        for _ in 0..ROUNDS {
            let before = self.pairs.len();
            let known = Overlaps::new(&self.outcome.mesh, &self.pairs);
            self.outcome = snapped(self.outcome, &self.pairs, attempt.most, attempt.scope);
            self.pairs = known.overlapping(&self.outcome.mesh);
            if !self.pairs.is_empty() {
                let known = Overlaps::new(&self.outcome.mesh, &self.pairs);
                nudge(&mut self.outcome.mesh, &self.pairs, attempt.most);
                self.outcome.clean();
                self.pairs = known.overlapping(&self.outcome.mesh);
            }
            if self.pairs.len() < best.pairs.len() {
                best = self.clone();
            }
            if self.pairs.len() as f64 > LEFT * before as f64 || self.pairs.is_empty() {
                break;
            }
        }
        best
    }
}

/// The border of the points at which a surface without overlapping triangles has a positive winding number; nothing if
/// that is all of it.
fn right_side_out(outcome: &Outcome) -> Option<Outcome> {
    let mesh = separated(&outcome.mesh);
    let Evaluation { outcome: mut next, is_unchanged: is_all_kept, .. } = divided(&mesh, &[]);
    if is_all_kept {
        return None;
    }
    next.clean();
    next.sources.iter_mut().for_each(|source| *source = outcome.sources[source[1] as usize]);
    next.counts = outcome.counts;
    Some(next)
}

/// What points that are moved by a unit in the last place of the largest coordinate can make of a volume, rounding
/// included; cubic units.
fn change_of_volume(mesh: &Mesh) -> f64 {
    let square = |triangle: usize| {
        let [a, b, c] = mesh.corners(triangle);
        a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a))
    };
    let largest = mesh.vertices.iter().map(|v| v.abs().max_element()).fold(0.0, f64::max);
    f64::EPSILON * largest * (0..mesh.triangles.len()).map(square).sum::<f64>()
}

/// Whether all points of a surface freed of self-intersections are as near the rounded one as they must be.
fn is_near(settled: &Mesh, rounded: &Mesh) -> bool {
    let corners: FxHashSet<[u64; 3]> = rounded.vertices.iter().map(|vertex| bits(*vertex)).collect();
    let moved: Vec<DVec3> =
        settled.vertices.iter().copied().filter(|vertex| !corners.contains(&bits(*vertex))).collect();
    let sorted = TriangleBvh::new(&rounded.vertices, &rounded.triangles);
    let largest = rounded.vertices.iter().map(|v| v.abs().max_element()).fold(0.0, f64::max);
    let reach = MOST * f64::EPSILON * largest;
    let is_near = |point: DVec3| {
        let mut is_near = false;
        sorted.touching(Bounds { min: point - reach, max: point + reach }, |triangle| {
            is_near = is_near || {
                let nearest = triangle::nearest(point, rounded.corners(triangle as usize));
                nearest.distance(point) <= reach
            };
        });
        is_near
    };
    moved.into_iter().all(is_near)
}

/// What a mesh bounds, with its surface divided where it crosses itself: where triangles overlap.
fn divided(mesh: &Mesh, overlaps: &[[u32; 2]]) -> Evaluation {
    let sorted = TriangleBvh::new(&mesh.vertices, &mesh.triangles);
    let operand = Operand { mesh, sorted: &sorted, quad_partners: &[], overlaps };
    evaluate_once(&Operands::new(vec![operand], false), &Expression::Operand(0))
}

/// The mesh with vertices of their own for all that is not joined by edges of two triangles.
fn separated(mesh: &Mesh) -> Mesh {
    let of_triangle = |(&[a, b, c], k): (&[u32; 3], u32)| [([a, b], 3 * k), ([b, c], 3 * k + 1), ([c, a], 3 * k + 2)];
    let sides = HalfEdges::new(mesh.vertices.len(), mesh.triangles.iter().zip(0..).flat_map(of_triangle));
    let next = |corner: u32| if corner % 3 == 2 { corner - 2 } else { corner + 1 };
    let vertex = |corner: u32| mesh.triangles[corner as usize / 3][corner as usize % 3];
    let mut corners = UnionFind::new(3 * mesh.triangles.len());
    for (_, beside) in sides.edges() {
        if let &[(_, one), (_, two)] = beside
            && vertex(one) != vertex(two)
        {
            corners.join(one, next(two));
            corners.join(next(one), two);
        }
    }
    let mut separated = Mesh { vertices: Vec::new(), ..mesh.clone() };
    let mut number = vec![u32::MAX; 3 * mesh.triangles.len()];
    for corner in 0..3 * mesh.triangles.len() as u32 {
        let root = corners.find(corner) as usize;
        if number[root] == u32::MAX {
            number[root] = separated.vertices.len() as u32;
            separated.vertices.push(mesh.vertices[vertex(corner) as usize]);
        }
        separated.triangles[corner as usize / 3][corner as usize % 3] = number[root];
    }
    separated
}
