//! Triangles of which there are too many for a surface to be closed.

use super::super::cleaning::retain;
use super::super::union_find::UnionFind;
use crate::mesh::Mesh;
use crate::mesh::edges::{EdgeTable, EdgeUse};
use std::collections::BTreeMap;

/// The edges of a mesh, to be found by triangle.
struct Edges {
    table: EdgeTable,
    /// By triangle and side, the place of the edge in the table.
    of_triangle: Vec<[usize; 3]>,
}

impl Edges {
    fn of(mesh: &Mesh) -> Edges {
        let table = EdgeTable::of(mesh);
        let mut of_triangle = vec![[0; 3]; mesh.triangles.len()];
        for (place, edge) in table.edges.iter().enumerate() {
            for at in table.uses(edge) {
                of_triangle[at.triangle as usize][usize::from(at.side)] = place;
            }
        }
        Edges { table, of_triangle }
    }

    fn all(&self) -> impl Iterator<Item = &[EdgeUse]> {
        self.table.edges.iter().map(|edge| self.table.uses(edge))
    }

    /// The triangles along each side of one.
    fn around(&self, triangle: u32) -> impl Iterator<Item = &[EdgeUse]> {
        self.of_triangle[triangle as usize].into_iter().map(|place| self.table.uses(&self.table.edges[place]))
    }
}

/// How often triangles run along an edge from its lower end, less how often they run back.
fn net<'a>(uses: impl IntoIterator<Item = &'a EdgeUse>) -> i32 {
    uses.into_iter().map(|at| if at.forward { 1 } else { -1 }).sum()
}

/// Leaves out triangles that have the corners of an earlier one, whichever way they turn; returns how many were left
/// out.
///
/// - `everywhere`: if not, only where the surface is not closed: at edges that more triangles traverse one way than
///   the other. Two that lie back to back in a closed surface stay then.
pub(super) fn remove_duplicates(mesh: &mut Mesh, everywhere: bool) -> usize {
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
    let edges = Edges::of(mesh);
    let mut keep = vec![true; mesh.triangles.len()];
    for triangles in alike.values() {
        if everywhere || edges.around(triangles[0]).any(|uses| net(uses) != 0) {
            triangles[1..].iter().for_each(|&t| keep[t as usize] = false);
        }
    }
    retain(mesh, &keep);
    keep.iter().filter(|keep| !**keep).count()
}

/// Leaves out dangling faces: sheets, joined by edges of two triangles, that begin at edges of three or more which are
/// closed without them, the smaller first. Returns how many triangles were left out.
///
/// A wall within a body is one, and so is what sticks out of a body and is open.
pub(super) fn remove_dangling(mesh: &mut Mesh) -> usize {
    let edges = Edges::of(mesh);
    let crowded: Vec<&[EdgeUse]> = edges.all().filter(|uses| uses.len() > 2 && net(*uses) != 0).collect();
    if crowded.is_empty() {
        return 0;
    }
    let mut joined = UnionFind::new(mesh.triangles.len());
    for uses in edges.all() {
        if let [one, two] = uses {
            joined.join(one.triangle, two.triangle);
        }
    }
    let mut sheets: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for t in 0..mesh.triangles.len() as u32 {
        sheets.entry(joined.find(t)).or_default().push(t);
    }
    let mut beside: Vec<u32> = crowded.iter().copied().flatten().map(|at| joined.find(at.triangle)).collect();
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
            for uses in edges.around(t) {
                let kept = || uses.iter().filter(|at| keep[at.triangle as usize]);
                let others = || kept().filter(|at| joined.root(at.triangle) != sheet);
                if others().next().is_some() {
                    is_needed |= net(others()) != 0;
                    was_open |= net(kept()) != 0;
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
