//! Rings: the corners that lie around each vertex.

use rayon::prelude::*;

use super::polyhedron::Polyhedron;

/// So many faces are handled one after the other.
const BLOCK: usize = 4096;

/// The corners around each vertex of a polyhedron without borders, counter-clockwise. Each fan of faces has a ring.
pub(super) struct Rings {
    /// The corners of one ring after the other.
    pub corners: Vec<u32>,
    /// For each ring where it begins in `corners`, and last the length of that.
    pub starts: Vec<u32>,
    /// For each corner its place in `corners`.
    pub ring_indices: Vec<u32>,
}

impl Rings {
    pub fn of(mesh: &Polyhedron) -> Rings {
        let count = mesh.corners.len();
        let mut rings = Rings {
            corners: vec![0; count],
            starts: Vec::with_capacity(mesh.points.len() + 1),
            ring_indices: vec![u32::MAX; count],
        };
        let mut begin = 0;
        for first in 0..count as u32 {
            if rings.ring_indices[first as usize] != u32::MAX {
                continue;
            }
            rings.starts.push(begin);
            let mut end = begin;
            let mut corner = first;
            loop {
                rings.corners[end as usize] = corner;
                rings.ring_indices[corner as usize] = end;
                end += 1;
                // Clockwise, which needs no search for the side before.
                corner = mesh.next[mesh.twins[corner as usize] as usize];
                if corner == first {
                    break;
                }
            }
            let ring = &mut rings.corners[begin as usize..end as usize];
            ring[1..].reverse();
            for (place, &corner) in (begin..).zip(&*ring) {
                rings.ring_indices[corner as usize] = place;
            }
            begin = end;
        }
        rings.starts.push(begin);
        rings
    }
}

/// Fills the part of `out` that belongs to each face (or ring), with several threads.
///
/// - `starts`: where each part begins, and last the length of `out`.
pub(super) fn fill<T: Send>(starts: &[u32], out: &mut [T], with: &(impl Fn(usize, &mut [T]) + Sync)) {
    fill_from(0, starts, out, with);
}

fn fill_from<T: Send>(first: usize, starts: &[u32], out: &mut [T], with: &(impl Fn(usize, &mut [T]) + Sync)) {
    let count = starts.len().saturating_sub(1);
    if count <= BLOCK {
        let mut rest = out;
        for (face, ends) in starts.windows(2).enumerate() {
            let (part, behind) = rest.split_at_mut((ends[1] - ends[0]) as usize);
            with(first + face, part);
            rest = behind;
        }
        return;
    }
    let middle = count / 2;
    let (left, right) = out.split_at_mut((starts[middle] - starts[0]) as usize);
    rayon::join(
        || fill_from(first, &starts[..=middle], left, with),
        || fill_from(first + middle, &starts[middle..], right, with),
    );
}

/// The new positions of all corners by a rule for whole faces.
pub(super) fn by_face<T: Send + Clone + Default>(
    mesh: &Polyhedron,
    with: &(impl Fn(usize, &mut [T]) + Sync),
) -> Vec<T> {
    let mut out = vec![T::default(); mesh.corners.len()];
    fill(&mesh.starts, &mut out, with);
    out
}

/// For each edge its side of lower number, in order.
pub(super) fn edges(mesh: &Polyhedron) -> Vec<u32> {
    let is_first = |&side: &u32| side < mesh.twins[side as usize];
    (0..mesh.twins.len() as u32).into_par_iter().filter(is_first).collect()
}
