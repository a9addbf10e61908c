//! Objects put into an octree and taken out of it, without touching what lies elsewhere.
//!
//! Whether a cell is divided depends on nothing but the triangles in it. So a change can only matter in cells that the
//! object touches, and the result is the octree that would have been built of the final objects.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::build::{Leaves, Nodes, OctreeBuilder, TriangleReference, octants, within};
use super::code::LocationalCode;
use super::error::{MAX_TRIANGLES, OctreeError, check};
use super::settings::Walk;
use super::tree::{ObjectCounts, Octree};
use super::wide_bvh::WideBvh;

impl Octree {
    /// Puts an object in, as the last one.
    ///
    /// - `vertices`, `triangles`: as for [`Octree::build`]; the indices count from 0 in the object.
    /// - Returns the number of the object.
    ///
    /// Cost: dividing the nodes that the object touches, and copying the codes of the others. The index is dropped:
    /// rays go from cell to cell until [`Octree::with_walk`] makes another.
    ///
    /// # Errors
    /// Those of [`Octree::build`], and a vertex of a triangle outside the modelling cube. Then nothing is changed.
    pub fn insert(&mut self, vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<usize, OctreeError> {
        check(vertices, triangles)?;
        let total = self.triangles.len() + triangles.len();
        if total > MAX_TRIANGLES || self.vertices.len() + vertices.len() > u32::MAX as usize {
            return Err(OctreeError::TooManyTriangles { triangles: total });
        }
        let inside = |&&vertex: &&u32| self.cube.voxel(vertices[vertex as usize]).is_none();
        if let Some(&vertex) = triangles.iter().flatten().find(inside) {
            return Err(OctreeError::VertexOutside { vertex: vertex as usize });
        }
        self.divide();
        let first = self.vertices.len() as u32;
        let added = self.triangles.len()..total;
        Arc::make_mut(&mut self.vertices).extend(vertices);
        Arc::make_mut(&mut self.triangles).extend(triangles.iter().map(|corners| corners.map(|corner| corner + first)));
        self.objects.push(ObjectCounts { vertices: vertices.len(), triangles: triangles.len() });
        let division = self.division();
        let homes = merged(&self.nodes().homes, &division.homes(added.clone()));
        let mut leaves = Leaves::default();
        let references = division.references(added);
        let edit = Edit { division, old: self.leaves(), removed: 0..0, emptied: Vec::new() };
        edit.cell(LocationalCode::ROOT, 0..self.leaves().codes.len(), &homes, references, &mut leaves);
        self.nodes = Nodes { homes, leaves }.into();
        self.drop_index();
        Ok(self.objects.len() - 1)
    }

    /// Takes an object out; the later ones move up by one, and so do their triangles. `false` if there is none.
    ///
    /// Cost: as for [`Octree::insert`].
    pub fn remove(&mut self, object: usize) -> bool {
        let Some(&ObjectCounts { vertices, triangles }) = self.objects.get(object) else { return false };
        self.divide();
        let before = &self.objects[..object];
        let first_vertex: usize = before.iter().map(|o| o.vertices).sum();
        let first: usize = before.iter().map(|o| o.triangles).sum();
        let removed = first..first + triangles;
        let division = self.division();
        let homes = without(&self.nodes().homes, &division.homes(removed.clone()));
        let mut leaves = Leaves::default();
        let edit =
            Edit { division, old: self.leaves(), removed: removed.clone(), emptied: self.leaves().naming(&removed) };
        edit.cell(LocationalCode::ROOT, 0..self.leaves().codes.len(), &homes, Vec::new(), &mut leaves);
        let behind = leaves.triangles.iter_mut().filter(|triangle| **triangle as usize >= removed.end);
        behind.for_each(|triangle| *triangle -= triangles as u32);
        self.nodes = Nodes { homes, leaves }.into();
        let kept = Arc::make_mut(&mut self.triangles);
        kept.drain(removed);
        Arc::make_mut(&mut self.vertices).drain(first_vertex..first_vertex + vertices);
        kept[first..].iter_mut().flatten().for_each(|corner| *corner -= vertices as u32);
        self.objects.remove(object);
        self.drop_index();
        true
    }

    fn drop_index(&mut self) {
        (self.walk, self.index) = (Walk::LeadingDirection, WideBvh::default());
    }
}

/// A change of the octree from above.
struct Edit<'a> {
    division: OctreeBuilder<'a>,
    old: &'a Leaves,
    /// Triangles that go.
    removed: Range<usize>,
    /// The old nodes that name them, in order.
    emptied: Vec<usize>,
}

impl Edit<'_> {
    /// Adds the new terminal nodes of a cell.
    ///
    /// - `nodes`: the old ones there.
    /// - `homes`: of the final triangles there.
    /// - `added`: triangles that come, with higher numbers than the old ones.
    fn cell(
        &self,
        cell: LocationalCode,
        nodes: Range<usize>,
        homes: &[LocationalCode],
        added: Vec<TriangleReference>,
        leaves: &mut Leaves,
    ) {
        let emptied = self.emptied.partition_point(|&node| node < nodes.start);
        if added.is_empty() && self.emptied.get(emptied).is_none_or(|&node| node >= nodes.end) {
            leaves.append(self.old, nodes);
            return;
        }
        let is_whole = nodes.is_empty() || self.old.codes[nodes.start] == cell;
        // As many triangles as this or fewer touch the cell; they are counted only where their number might matter.
        let most = self.old.range(nodes.clone()).len() + added.len();
        if !is_whole && self.division.is_divided(cell, homes.len(), most) {
            self.octants(cell, nodes, homes, &added, leaves);
            return;
        }
        let mut triangles = self.old.triangles[self.old.range(nodes.clone())].to_vec();
        triangles.retain(|&triangle| !self.removed.contains(&(triangle as usize)));
        triangles.sort_unstable();
        triangles.dedup();
        triangles.extend(added.iter().map(|r| r.triangle));
        match self.division.is_divided(cell, homes.len(), triangles.len()) {
            true if is_whole => {
                self.division.divide(cell, self.division.references_in(cell, &triangles), homes, leaves);
            }
            true => self.octants(cell, nodes, homes, &added, leaves),
            false if triangles.is_empty() => {}
            false => leaves.push(cell, triangles.into_iter()),
        }
    }

    /// Edits the octants of a cell that was divided and stays so.
    fn octants(
        &self,
        cell: LocationalCode,
        nodes: Range<usize>,
        homes: &[LocationalCode],
        added: &[TriangleReference],
        leaves: &mut Leaves,
    ) {
        for (octant, added) in octants(cell).zip(self.division.distribute(cell, added)) {
            let nodes = self.old.within(octant, nodes.clone());
            self.cell(octant, nodes, within(homes, octant), added, leaves);
        }
    }
}

/// Two sorted sequences as one.
fn merged(one: &[LocationalCode], other: &[LocationalCode]) -> Vec<LocationalCode> {
    let mut all = Vec::with_capacity(one.len() + other.len());
    let mut rest = one;
    for &code in other {
        let before = rest.partition_point(|&c| c <= code);
        all.extend_from_slice(&rest[..before]);
        all.push(code);
        rest = &rest[before..];
    }
    all.extend_from_slice(rest);
    all
}

/// A sorted sequence without some of its members, sorted, each taken away as often as it is named.
fn without(all: &[LocationalCode], taken: &[LocationalCode]) -> Vec<LocationalCode> {
    let mut kept = Vec::with_capacity(all.len().saturating_sub(taken.len()));
    let mut rest = all;
    for code in taken {
        let before = rest.partition_point(|c| c < code);
        kept.extend_from_slice(&rest[..before]);
        rest = rest.get(before + 1..).unwrap_or(&[]);
    }
    kept.extend_from_slice(rest);
    kept
}
