//! Surfaces that cross, cover or turn against themselves, and the simple surface of what they bound.
//!
//! A surface is simple if it winds once or not at all around every point off it. What any closed surface bounds are
//! the points that it winds around more than not at all.

use super::operand::{Operand, Operands, overlaps};
use super::result::Outcome;
use super::sides::Sides;
use super::snapping::snapped;
use super::union_find::UnionFind;
use super::{Expression, Work, work};
use crate::mesh::Mesh;
use crate::octree::Sorted;
use crate::solid::import::is_closed;
use glam::DVec3;

/// What counts as near when a surface is drawn together, in units in the last place, one attempt after the other.
const ROUNDINGS: [f64; 4] = [2.0, 16.0, 128.0, 1024.0];
/// When surfaces are drawn together, one round of attempts after the other: the first turn, how many in a row, and turns
/// from there to the next such row. In all others they are divided; drawing together may make what only that settles.
const RHYTHMS: [[usize; 3]; 4] = [[0, 2, 3], [0, 1, 3], [0, 1, TURNS], [2, 1, 4]];
/// Most turns of an attempt.
const TURNS: usize = 15;
/// Most turns of all attempts together; each takes about as long as an operation on the result.
const MOST_TURNS: usize = 150;

/// What a closed surface bounds.
pub struct Resolution {
    /// The simple surface.
    pub outcome: Outcome,
    /// Whether it is the same surface, but for how it is divided.
    pub is_same: bool,
    /// Where the given one winds otherwise than once or not at all, and how often.
    pub odd: Option<(i32, DVec3)>,
}

/// Makes a closed surface simple.
pub fn resolve(mesh: &Mesh) -> Resolution {
    let mesh = separated(mesh);
    let Work { mut outcome, is_all_kept, odd, .. } = divided(&mesh);
    outcome.clean();
    Resolution { outcome: settled(outcome), is_same: is_all_kept, odd }
}

/// The outcome made simple where rounding made it cross itself; as it is where that does not succeed.
///
/// What lies within a few roundings becomes one, and what crosses nevertheless is divided there and rounded anew. Where that
/// does not settle it soon, it begins again with more roundings or another rhythm, until [`MOST_TURNS`] are used up.
pub fn settled(mut outcome: Outcome) -> Outcome {
    outcome.clean();
    let pairs = overlapping(&outcome.mesh);
    if pairs.is_empty() {
        return outcome;
    }
    // What rounding may make of the volume. Whoever moves points further has spoilt something.
    let reach = outcome.mesh.vertices.iter().map(|v| v.abs().max_element()).fold(0.0, f64::max);
    let (volume, bound) = (outcome.mesh.signed_volume(), 8.0 * f64::EPSILON * reach * outcome.mesh.area());
    let never = Attempt { rhythm: [TURNS, 0, TURNS], roundings: 0.0 };
    let drawn = RHYTHMS.into_iter().flat_map(|rhythm| ROUNDINGS.map(|roundings| Attempt { rhythm, roundings }));
    let mut turns = MOST_TURNS;
    for (attempt, number) in std::iter::once(never).chain(drawn).zip(1..) {
        if let Some(mut settled) = attempt.on(outcome.clone(), pairs.clone(), &mut turns)
            && (settled.mesh.signed_volume() - volume).abs() <= bound
        {
            settled.counts.settled = number;
            return settled;
        }
    }
    outcome.counts.crossing = pairs.len() as u64;
    outcome
}

/// A way to make a surface simple, which may succeed. In each turn it is drawn together or divided.
struct Attempt {
    /// When it is drawn together; one of [`RHYTHMS`].
    rhythm: [usize; 3],
    /// What counts as near when it is drawn together, in units in the last place.
    roundings: f64,
}

impl Attempt {
    /// The outcome made simple, if that succeeds.
    ///
    /// - `pairs`: the triangles that overlap.
    /// - `turns`: how many are left; those that it takes are taken from them.
    fn on(&self, mut trial: Outcome, mut pairs: Vec<[u32; 2]>, turns: &mut usize) -> Option<Outcome> {
        let [first_draw, draws, period] = self.rhythm;
        let first = pairs.len();
        let mut least = first;
        for turn in 0..TURNS.min(*turns) {
            *turns -= 1;
            trial = match turn.checked_sub(first_draw) {
                Some(turn) if turn % period < draws => snapped(trial, &pairs, self.roundings),
                _ => again(trial),
            };
            pairs = overlapping(&trial.mesh);
            if pairs.is_empty() {
                // What was turned inside out goes now.
                let trial = again(trial);
                return (overlapping(&trial.mesh).is_empty() && is_closed(&trial.mesh)).then_some(trial);
            }
            if pairs.len() > 4 * first + 100 || turn > 2 && pairs.len() > 4 * least + 20 {
                return None;
            }
            least = least.min(pairs.len());
        }
        None
    }
}

/// Divides a surface where it crosses itself, and rounds again.
fn again(outcome: Outcome) -> Outcome {
    let mesh = separated(&outcome.mesh);
    let mut next = divided(&mesh).outcome;
    next.clean();
    next.sources.iter_mut().for_each(|source| *source = outcome.sources[source[1] as usize]);
    next.counts = outcome.counts;
    next
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
