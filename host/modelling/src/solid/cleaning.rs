//! What is repaired in meshes before they bound a solid and after they were rounded, and whether they are closed.

use super::SolidError;
use super::union_find::UnionFind;
use crate::mesh::Mesh;
use crate::numeric::implicit::projection;
use rayon::prelude::*;
use std::collections::HashMap;

/// Edges that an error names.
const NAMED: usize = 8;

/// Repairs what rounding did to a closed mesh: vertices that fell together, and triangles that lost their area.
pub fn cleaned(mesh: Mesh) -> Mesh {
    let mut mesh = without_collapsed(mesh);
    dissolve(&mut mesh);
    mesh
}

/// The mesh with one vertex for each place, and without triangles that use one place twice.
pub fn without_collapsed(mut mesh: Mesh) -> Mesh {
    let first = mesh.first_of_each_position();
    if first.iter().zip(0..).any(|(first, index)| *first != index) {
        for triangle in &mut mesh.triangles {
            *triangle = triangle.map(|vertex| first[vertex as usize]);
        }
    }
    let is_collapsed = |t: &[u32; 3]| t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    if mesh.triangles.iter().any(is_collapsed) {
        let keep: Vec<bool> = mesh.triangles.iter().map(|t| !is_collapsed(t)).collect();
        retain(&mut mesh, &keep);
    }
    mesh
}

/// Keeps some triangles, with all that belongs to them.
pub fn retain(mesh: &mut Mesh, keep: &[bool]) {
    fn of<T: Copy>(table: &mut Vec<T>, keep: &[bool]) {
        let mut kept = keep.iter();
        table.retain(|_| *kept.next().unwrap_or(&true));
    }
    of(&mut mesh.triangles, keep);
    of(&mut mesh.corner_normals, keep);
    of(&mut mesh.corner_parameters, keep);
    of(&mut mesh.surfaces, keep);
}

/// Whether all edges are traversed both ways alike.
pub fn is_closed(mesh: &Mesh) -> bool {
    check_edges(mesh).is_ok()
}

/// Checks that all edges are traversed both ways alike; returns the number of sheets that edges of two triangles join.
pub fn check_edges(mesh: &Mesh) -> Result<usize, SolidError> {
    // An edge as one number, its direction in the last bit.
    let mut sides: Vec<(u64, u32)> = Vec::with_capacity(3 * mesh.triangles.len());
    for (t, triangle) in mesh.triangles.iter().zip(0..) {
        for k in 0..3 {
            let (a, b) = (u64::from(t[k]), u64::from(t[(k + 1) % 3]));
            sides.push((a.min(b) << 33 | a.max(b) << 1 | u64::from(a > b), triangle));
        }
    }
    sides.par_sort_unstable();
    let ends =
        |group: &[(u64, u32)]| [group[0].0 >> 33, group[0].0 >> 1 & 0xffff_ffff].map(|v| mesh.vertices[v as usize]);
    let (mut count, mut edges) = (0, Vec::new());
    let mut sheets = UnionFind::new(mesh.triangles.len());
    for group in sides.chunk_by(|a, b| a.0 >> 1 == b.0 >> 1) {
        if let [one, two] = group {
            sheets.join(one.1, two.1);
        }
        if group.iter().filter(|side| side.0 & 1 == 1).count() * 2 != group.len() {
            count += 1;
            if edges.len() < NAMED {
                edges.push(ends(group));
            }
        }
    }
    let sheets = (0..mesh.triangles.len() as u32).filter(|&t| sheets.find(t) == t).count();
    if count == 0 { Ok(sheets) } else { Err(SolidError::NotClosed { count, edges }) }
}

/// Dissolves triangles without an area, whose corners are on one line: the neighbour across the longest side takes the
/// corner in the middle. The surface stays the same set of points.
pub fn dissolve(mesh: &mut Mesh) {
    let is_flat = |mesh: &Mesh, t: usize| projection(mesh.corners(t)).is_none();
    let mut flat: Vec<u32> =
        (0..mesh.triangles.len()).into_par_iter().filter(|&t| is_flat(mesh, t)).map(|t| t as u32).collect();
    if flat.is_empty() {
        return;
    }
    let mut of_side: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
    let sides = |t: [u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    for (index, &t) in mesh.triangles.iter().enumerate() {
        sides(t).into_iter().for_each(|side| of_side.entry(side).or_default().push(index as u32));
    }
    let mut keep = vec![true; mesh.triangles.len()];
    // Each step lowers the sum of the sides of flat triangles, or removes one.
    while let Some(index) = flat.pop() {
        if !keep[index as usize] {
            continue;
        }
        let t = mesh.triangles[index as usize];
        // The long side goes from a to c, with b between.
        let k = (0..3).find(|&k| is_between(mesh, t[k], t[(k + 1) % 3], t[(k + 2) % 3])).unwrap_or(0);
        let [a, b, c] = [t[k], t[(k + 1) % 3], t[(k + 2) % 3]];
        let Some(&other) = of_side.get(&[a, c]).and_then(|all| all.iter().find(|&&o| o != index)) else { continue };
        let forget = |index: u32, t: [u32; 3], of_side: &mut HashMap<[u32; 2], Vec<u32>>| {
            for side in sides(t) {
                of_side.entry(side).or_default().retain(|&i| i != index);
            }
        };
        let u = mesh.triangles[other as usize];
        let j = u.iter().position(|&v| v == a).unwrap_or(0);
        let d = u[(j + 2) % 3];
        forget(index, t, &mut of_side);
        forget(other, u, &mut of_side);
        if d == b {
            // The two cover each other from both sides.
            (keep[index as usize], keep[other as usize]) = (false, false);
            continue;
        }
        // a b c and a c d become a b d and b c d, all on the surface of the neighbour.
        let at = |v: u32| mesh.vertices[v as usize];
        let (pa, pc) = (at(a), at(c));
        let part = (at(b) - pa).length() / (pc - pa).length();
        for (slot, corners) in [(index, [a, b, d]), (other, [b, c, d])] {
            copy_tables(mesh, other, u, slot, corners, [a, c, b], part);
            mesh.triangles[slot as usize] = corners;
            sides(corners).into_iter().for_each(|side| of_side.entry(side).or_default().push(slot));
            if is_flat(mesh, slot as usize) {
                flat.push(slot);
            }
        }
    }
    retain(mesh, &keep);
}

/// Whether `b` is the middle one of three corners on one line.
fn is_between(mesh: &Mesh, a: u32, b: u32, c: u32) -> bool {
    let [a, b, c] = [a, b, c].map(|v| mesh.vertices[v as usize]);
    (a.min(c).cmple(b) & b.cmple(a.max(c))).all()
}

/// Gives a slot what the corners of triangle `from` (with vertices `old`) have; a new corner between two of them has
/// the mean of theirs.
fn copy_tables(
    mesh: &mut Mesh,
    from: u32,
    old: [u32; 3],
    slot: u32,
    corners: [u32; 3],
    [a, c, new]: [u32; 3],
    part: f64,
) {
    let place = |v: u32| old.iter().position(|&o| o == v).unwrap_or(0);
    let (from, slot) = (from as usize, slot as usize);
    if let Some(&normals) = mesh.corner_normals.get(from) {
        let mean = (normals[place(a)] * (1.0 - part) + normals[place(c)] * part).normalize_or(normals[place(a)]);
        mesh.corner_normals[slot] = corners.map(|v| if v == new { mean } else { normals[place(v)] });
    }
    if let Some(&parameters) = mesh.corner_parameters.get(from) {
        let mean = parameters[place(a)] * (1.0 - part) + parameters[place(c)] * part;
        mesh.corner_parameters[slot] = corners.map(|v| if v == new { mean } else { parameters[place(v)] });
    }
    if let Some(&surface) = mesh.surfaces.get(from) {
        mesh.surfaces[slot] = surface;
    }
}
