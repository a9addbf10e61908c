//! Whether a surface is simple, tested with integers and in another way than the Boolean operations do: no code is
//! shared.
//!
//! A surface is simple if it is closed, if no two triangles have more in common than corners and the edges between, and
//! if its winding number is 1 behind each triangle and 0 before it.

mod integer;
mod triangle_overlap;
mod predicates;
mod winding;

use glam::DVec3;
use host::mesh::Mesh;
use predicates::Points;
use std::collections::{BTreeMap, HashMap};

/// The reason why a surface is not simple.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotSimple {
    /// Three corners are on one line.
    #[error("triangle {0} has no area")]
    Flat(usize),
    /// An edge is traversed more often in one direction than in the other.
    #[error("the edge from {} to {} is open", .0[0], .0[1])]
    Open([DVec3; 2]),
    /// Two triangles have more in common than corners and edges.
    #[error("triangles {} and {} cross or cover each other, and {count} pairs in all", .pair[0], .pair[1])]
    Crossing {
        /// The first of them.
        pair: [usize; 2],
        /// How many.
        count: usize,
    },
    /// Its winding number just before a triangle is not 0.
    #[error("before triangle {triangle} it winds {winding} times")]
    Winding {
        /// The number of the triangle.
        triangle: usize,
        /// Its winding number there.
        winding: i32,
    },
}

/// Looks whether a surface is simple.
///
/// Cost: n log n for triangles of about one size that lie side by side.
///
/// # Errors
/// [`NotSimple`].
///
/// # Panics
/// If a coordinate is no finite number.
pub fn check(mesh: &Mesh) -> Result<(), NotSimple> {
    let (at, triangles) = by_position(mesh);
    let points = Points::of(&at);
    let is_flat = |t: &[u32; 3]| (0..3).all(|axis| points.turn(axis, *t) == 0);
    if let Some(flat) = triangles.iter().position(is_flat) {
        return Err(NotSimple::Flat(flat));
    }
    let sheets = sheets(&at, &triangles)?;
    let pairs = triangle_overlap::pairs(&points, &triangles);
    if let Some(&pair) = pairs.first() {
        return Err(NotSimple::Crossing { pair, count: pairs.len() });
    }
    for triangle in sheets {
        let winding = winding::before(&points, &triangles, triangle);
        if winding != 0 {
            return Err(NotSimple::Winding { triangle, winding });
        }
    }
    Ok(())
}

/// The positions of the corners, each once, and the triangles over them.
fn by_position(mesh: &Mesh) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut at, mut known) = (Vec::new(), HashMap::new());
    let mut number = |place: DVec3| {
        // 0 and -0 are one position.
        *known.entry(place.to_array().map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
            at.push(place);
            at.len() as u32 - 1
        })
    };
    let triangles =
        mesh.triangles.iter().map(|t| t.map(|vertex| number(mesh.vertices[vertex as usize]))).collect::<Vec<_>>();
    (at, triangles)
}

/// A triangle of each part that is connected by edges of two triangles.
fn sheets(at: &[DVec3], triangles: &[[u32; 3]]) -> Result<Vec<usize>, NotSimple> {
    // The triangles at each edge, and in which direction they run along it.
    let mut edges: BTreeMap<[u32; 2], Vec<(usize, bool)>> = BTreeMap::new();
    for (index, t) in triangles.iter().enumerate() {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            edges.entry([a.min(b), a.max(b)]).or_default().push((index, a < b));
        }
    }
    let mut beside = vec![Vec::new(); triangles.len()];
    for (ends, around) in &edges {
        if around.iter().filter(|(_, is_up)| *is_up).count() * 2 != around.len() {
            return Err(NotSimple::Open(ends.map(|end| at[end as usize])));
        }
        if let [(one, _), (two, _)] = around[..] {
            beside[one].push(two);
            beside[two].push(one);
        }
    }
    let (mut firsts, mut is_seen) = (Vec::new(), vec![false; triangles.len()]);
    for first in 0..triangles.len() {
        if is_seen[first] {
            continue;
        }
        firsts.push(first);
        let mut stack = vec![first];
        while let Some(index) = stack.pop() {
            if !std::mem::replace(&mut is_seen[index], true) {
                stack.extend(&beside[index]);
            }
        }
    }
    Ok(firsts)
}

#[cfg(test)]
mod tests;
