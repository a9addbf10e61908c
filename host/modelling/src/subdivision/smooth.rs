//! One step of a smooth polyhedron without borders.

use glam::DVec3;
use rayon::prelude::*;

use super::polyhedron::Polyhedron;
use super::rings::{Rings, by_face, edges, fill};
use super::weights::step;

/// Cuts all corners and edges.
///
/// Corner h becomes vertex h. The new corners come in three parts: those of the faces within the old ones, in their
/// order; four for each edge; and those of a face for each vertex. All sides and their twins follow by counting, so
/// that nothing is searched.
pub(super) fn refined(mesh: &Polyhedron) -> Polyhedron {
    let count = mesh.corners.len() as u32;
    let rings = Rings::of(mesh);
    let edges = edges(mesh);
    // For each side the new corner at its end within the face of its edge; the one at its beginning follows.
    let mut slots = vec![0_u32; count as usize];
    for (edge, &side) in (0_u32..).zip(&edges) {
        slots[side as usize] = count + 4 * edge;
        slots[mesh.twins[side as usize] as usize] = count + 4 * edge + 2;
    }
    let vertex_corners = 3 * count;

    let total = 4 * count as usize;
    let [mut corners, mut next, mut twins] = [(); 3].map(|()| vec![0_u32; total]);
    for (part, own) in [(&mut corners, None), (&mut next, Some(&mesh.next)), (&mut twins, Some(&slots))] {
        let part = &mut part[..count as usize];
        match own {
            Some(own) => part.copy_from_slice(own),
            None => part.par_iter_mut().enumerate().for_each(|(h, corner)| *corner = h as u32),
        }
    }
    let range = count as usize..3 * count as usize;
    let parts = corners[range.clone()].par_chunks_exact_mut(4).zip(next[range.clone()].par_chunks_exact_mut(4));
    let parts = parts.zip(twins[range].par_chunks_exact_mut(4)).zip(&edges).enumerate();
    parts.for_each(|(edge, (((corners, next), twins), &side))| {
        let twin = mesh.twins[side as usize];
        let [after_side, after_twin] = [side, twin].map(|h| mesh.next[h as usize]);
        let first = count + 4 * edge as u32;
        let [at_end, at_start] = [after_twin, after_side].map(|h| vertex_corners + rings.ring_indices[h as usize]);
        corners.copy_from_slice(&[after_side, side, after_twin, twin]);
        next.copy_from_slice(&[first + 1, first + 2, first + 3, first]);
        twins.copy_from_slice(&[side, at_end, twin, at_start]);
    });
    corners[vertex_corners as usize..].copy_from_slice(&rings.corners);
    fill(&rings.starts, &mut next[vertex_corners as usize..], &|ring, part: &mut [u32]| {
        let first = vertex_corners + rings.starts[ring];
        part.iter_mut().zip(first + 1..).for_each(|(next, following)| *next = following);
        part[part.len() - 1] = first;
    });
    fill(&rings.starts, &mut twins[vertex_corners as usize..], &|ring, part: &mut [u32]| {
        let around = &rings.corners[rings.starts[ring] as usize..][..part.len()];
        let following = around[1..].iter().chain(&around[..1]);
        part.iter_mut().zip(following).for_each(|(twin, &corner)| *twin = slots[corner as usize] + 1);
    });

    let mut starts = Vec::with_capacity(mesh.starts.len() + edges.len() + rings.starts.len());
    starts.extend_from_slice(&mesh.starts);
    starts.extend((1..edges.len() as u32).map(|edge| count + 4 * edge));
    starts.extend(rings.starts.iter().map(|start| vertex_corners + start));
    let points = moved(mesh);
    Polyhedron { points, corners, starts, next, twins, is_plain: true, ..Polyhedron::default() }
}

/// The new positions of all corners.
pub(super) fn moved(mesh: &Polyhedron) -> Vec<DVec3> {
    by_face(mesh, &|face, new| match *new {
        [_, _, _] => move_few::<3>(mesh, face, new),
        [_, _, _, _] => move_few::<4>(mesh, face, new),
        _ => step(&mesh.face_points(face).collect::<Vec<_>>(), new),
    })
}

/// Without an allocation.
fn move_few<const N: usize>(mesh: &Polyhedron, face: usize, new: &mut [DVec3]) {
    let first = mesh.starts[face] as usize;
    let corners: [DVec3; N] = std::array::from_fn(|k| mesh.points[mesh.corners[first + k] as usize]);
    step(&corners, new);
}
