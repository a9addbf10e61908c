//! Triangles of which there are too many for a surface to be closed.

use super::super::boolean::UnionFind;
use super::super::import::retain;
use super::sides;
use crate::mesh::Mesh;
use std::collections::{BTreeMap, HashMap};

/// For each edge, the lower end first, the triangles that have it.
type Edges = HashMap<[u32; 2], Vec<u32>>;

fn edges(mesh: &Mesh) -> Edges {
    let mut edges = Edges::new();
    for (t, corners) in (0..).zip(&mesh.triangles) {
        for [a, b] in sides(*corners) {
            edges.entry([a.min(b), a.max(b)]).or_default().push(t);
        }
    }
    edges
}

/// How often triangles run along an edge from its lower end, less how often they run back.
fn net<'a>(mesh: &Mesh, edge: [u32; 2], triangles: impl Iterator<Item = &'a u32>) -> i32 {
    let runs = |t: &u32| if sides(mesh.triangles[*t as usize]).contains(&edge) { 1 } else { -1 };
    triangles.map(runs).sum()
}

/// Leaves out triangles that have the corners of an earlier one, whichever way they turn; returns how many were left out.
///
/// - `everywhere`: if not, only where the surface is not closed: at edges that more triangles run through one way than the
///   other. Two that lie back to back in a closed surface stay then.
pub(super) fn leave_out_duplicates(mesh: &mut Mesh, everywhere: bool) -> usize {
    let mut alike: BTreeMap<[u32; 3], Vec<u32>> = BTreeMap::new();
    for (t, &corners) in (0..).zip(&mesh.triangles) {
        let mut corners = corners;
        corners.sort_unstable();
        alike.entry(corners).or_default().push(t);
    }
    alike.retain(|_, triangles| triangles.len() > 1);
    if alike.is_empty() {
        return 0;
    }
    let edges = edges(mesh);
    let mut keep = vec![true; mesh.triangles.len()];
    for triangles in alike.values() {
        let is_open = |[a, b]: [u32; 2]| {
            let edge = [a.min(b), a.max(b)];
            net(mesh, edge, edges[&edge].iter()) != 0
        };
        if everywhere || sides(mesh.triangles[triangles[0] as usize]).into_iter().any(is_open) {
            triangles[1..].iter().for_each(|&t| keep[t as usize] = false);
        }
    }
    retain(mesh, &keep);
    keep.iter().filter(|keep| !**keep).count()
}

/// Leaves out fins: sheets, joined by edges of two triangles, that begin at edges of three or more which are closed without
/// them, the smaller first. Returns how many triangles were left out.
///
/// A wall within a body is one, and so is what sticks out of a body and is open.
pub(super) fn leave_out_fins(mesh: &mut Mesh) -> usize {
    let edges = edges(mesh);
    let is_crowded = |(edge, all): &(&[u32; 2], &Vec<u32>)| all.len() > 2 && net(mesh, **edge, all.iter()) != 0;
    let mut crowded: Vec<(&[u32; 2], &Vec<u32>)> = edges.iter().filter(is_crowded).collect();
    if crowded.is_empty() {
        return 0;
    }
    crowded.sort_unstable();
    let mut joined = UnionFind::new(mesh.triangles.len());
    for all in edges.values() {
        if let [one, two] = all[..] {
            joined.join(one, two);
        }
    }
    let mut sheets: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for t in 0..mesh.triangles.len() as u32 {
        sheets.entry(joined.find(t)).or_default().push(t);
    }
    let mut beside: Vec<u32> = crowded.iter().flat_map(|(_, all)| all.iter()).map(|&t| joined.find(t)).collect();
    beside.sort_unstable();
    beside.dedup();
    let area = |sheet: &u32| sheets[sheet].iter().map(|&t| mesh.area_vector(t as usize).length()).sum::<f64>();
    let mut candidates: Vec<(f64, u32)> = beside.iter().map(|sheet| (area(sheet), *sheet)).collect();
    candidates.sort_by(|one, two| one.0.total_cmp(&two.0).then(one.1.cmp(&two.1)));
    let mut keep = vec![true; mesh.triangles.len()];
    for (_, sheet) in candidates {
        // Its edges that others have too, and whether one of them is open now.
        let (mut is_needed, mut was_open) = (false, false);
        for &t in &sheets[&sheet] {
            for [a, b] in sides(mesh.triangles[t as usize]) {
                let edge = [a.min(b), a.max(b)];
                let kept = || edges[&edge].iter().filter(|t| keep[**t as usize]);
                let others = || kept().filter(|t| joined.root(**t) != sheet);
                if others().next().is_some() {
                    is_needed |= net(mesh, edge, others()) != 0;
                    was_open |= net(mesh, edge, kept()) != 0;
                }
            }
        }
        if was_open && !is_needed {
            sheets[&sheet].iter().for_each(|&t| keep[t as usize] = false);
        }
    }
    retain(mesh, &keep);
    keep.iter().filter(|keep| !**keep).count()
}
