//! Surfaces that cross, cover or turn against themselves, and the simple surface of what they bound.
//!
//! A surface is simple if it winds once or not at all around every point off it. What any closed surface bounds are
//! the points that it winds around more than not at all.

use super::nudging::nudge;
use super::operand::{Operand, Operands, overlaps};
use super::result::Outcome;
use super::sides::Sides;
use super::snapping::{Scope, snapped};
use super::union_find::UnionFind;
use super::{Expression, Work, work};
use crate::mesh::Mesh;
use crate::octree::Sorted;
use crate::solid::SolidError;
use crate::solid::import::is_closed;
use glam::DVec3;

/// How far points are moved, in units in the last place of the largest coordinate there, and what is drawn together within
/// that distance: all that is near triangles that overlap, or only these, which serves better where sheets cross at small
/// angles. One after the other, until one succeeds.
const ATTEMPTS: [(f64, Scope); 4] =
    [(4.0, Scope::Near), (4.0, Scope::Overlapping), (32.0, Scope::Near), (32.0, Scope::Overlapping)];
/// How often points are drawn together and nudged in an attempt.
const TURNS: usize = 3;

/// What a closed surface bounds.
pub struct Resolution {
    /// The simple surface.
    pub outcome: Outcome,
    /// Whether it is the same surface, but for how it is divided.
    pub is_same: bool,
    /// Where the given one winds less than not at all, or else more than once, and how often.
    pub odd: Option<(i32, DVec3)>,
}

/// Makes a closed surface simple.
///
/// # Errors
/// [`SolidError::Unsettled`].
pub fn resolve(mesh: &Mesh) -> Result<Resolution, SolidError> {
    let mesh = separated(mesh);
    let Work { mut outcome, is_all_kept, odd, .. } = divided(&mesh);
    outcome.clean();
    Ok(Resolution { outcome: settled(outcome)?, is_same: is_all_kept, odd })
}

/// The outcome made simple where rounding made it cross itself or turned parts of it inside out.
///
/// What lies within a few roundings becomes one: then sheets that nearly coincide have the same triangles, which cancel.
/// What is left on the wrong side of something is nudged to the right one. Both may have to be done again, since what was
/// moved meets others. Whatever comes out is looked at exactly: no two triangles overlap, and the surface winds once around
/// what is inside and not at all around what is outside.
///
/// No coordinate is farther from what it was rounded to than six times the distance of the attempt that succeeded: a turn
/// draws a point as far as that once, and nudges it as far once. Each attempt takes about as long as a few operations on the
/// triangles that overlap, besides looking twice at all triangles in each turn.
///
/// # Errors
/// [`SolidError::Unsettled`] if none of the attempts succeeds.
pub fn settled(mut outcome: Outcome) -> Result<Outcome, SolidError> {
    outcome.clean();
    let first = overlapping(&outcome.mesh);
    if first.is_empty() {
        return Ok(right_side_out(&outcome).unwrap_or(outcome));
    }
    let (volume, bound) = (outcome.mesh.signed_volume(), change_of_volume(&outcome.mesh));
    for ((most, scope), number) in ATTEMPTS.into_iter().zip(1..) {
        let is_right = |settled: &Outcome| {
            let change = (settled.mesh.signed_volume() - volume).abs();
            change <= (2.0 * most + 8.0) * bound && is_closed(&settled.mesh) && overlapping(&settled.mesh).is_empty()
        };
        let settled = attempt(outcome.clone(), first.clone(), most, scope);
        // What was turned inside out goes now.
        let settled = settled.map(|settled| right_side_out(&settled).unwrap_or(settled));
        if let Some(mut settled) = settled.filter(is_right) {
            settled.counts.settled = number;
            return Ok(settled);
        }
    }
    let [near, ..] = outcome.mesh.corners(first[0][0] as usize);
    let most = ATTEMPTS.iter().map(|(most, _)| *most).fold(0.0, f64::max);
    Err(SolidError::Unsettled { overlaps: first.len(), near, most })
}

/// The outcome without triangles that overlap, if that succeeds.
fn attempt(mut trial: Outcome, mut pairs: Vec<[u32; 2]>, most: f64, scope: Scope) -> Option<Outcome> {
    let limit = 2 * pairs.len() + 20;
    for _ in 0..TURNS {
        trial = snapped(trial, &pairs, most, scope);
        pairs = overlapping(&trial.mesh);
        if !pairs.is_empty() {
            nudge(&mut trial.mesh, &pairs, most);
            trial.clean();
            pairs = overlapping(&trial.mesh);
        }
        if pairs.is_empty() {
            return Some(trial);
        }
        if pairs.len() > limit {
            return None;
        }
    }
    None
}

/// The border of what a surface winds around more than not at all; nothing if that is all of it.
fn right_side_out(outcome: &Outcome) -> Option<Outcome> {
    let mesh = separated(&outcome.mesh);
    let Work { outcome: mut next, is_all_kept, .. } = divided(&mesh);
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

/// What a mesh bounds, with its surface divided where it crosses itself.
fn divided(mesh: &Mesh) -> Work {
    let sorted = Sorted::new(&mesh.vertices, &mesh.triangles);
    work(&Operands::new(vec![Operand { mesh, sorted: &sorted, mates: &[] }], false), &Expression::Operand(0))
}

fn overlapping(mesh: &Mesh) -> Vec<[u32; 2]> {
    overlaps(mesh, &Sorted::new(&mesh.vertices, &mesh.triangles))
}

/// The mesh with vertices of their own for all that is not joined by edges of two triangles.
fn separated(mesh: &Mesh) -> Mesh {
    let of_triangle = |(&[a, b, c], k): (&[u32; 3], u32)| [([a, b], 3 * k), ([b, c], 3 * k + 1), ([c, a], 3 * k + 2)];
    let sides = Sides::new(mesh.vertices.len(), mesh.triangles.iter().zip(0..).flat_map(of_triangle));
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
