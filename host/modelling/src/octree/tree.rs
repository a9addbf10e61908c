//! The octree of some objects: what it is made of, and where a point lies in it.

use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::build::{Leaves, Nodes, OctreeBuilder, PARALLEL_TRIANGLES};
use super::code::{LocationalCode, MAX_DEPTH};
use super::cube::Cube;
use super::error::{OctreeError, check};
use super::settings::{OctreeSettings, Walk};
use super::wide_bvh::WideBvh;
use crate::numeric::bounds::Bounds;

/// The location of a point in the octree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// In a voxel that holds boundary surface.
    Voxel(LocationalCode),
    /// In a larger cell that holds boundary surface and is not divided.
    Partial(LocationalCode),
    /// In a region without surface, which no stored node represents.
    Empty {
        /// The largest empty cube of the octree around the point.
        code: LocationalCode,
        /// The level of that cube: its side is 2^(N - level) voxels.
        level: u32,
    },
    /// Outside the modelling cube.
    Outside,
}

/// Work done for one ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WalkCount {
    /// Cells visited: nodes and leaves of the index, or cells of the walk.
    pub cells: u64,
    /// Triangles tested.
    pub triangles: u64,
}

/// Vertices and triangles that were put into an octree together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ObjectCounts {
    pub(super) vertices: usize,
    pub(super) triangles: usize,
}

/// A linear octree over the triangles of some objects. Threads share it freely.
///
/// Objects are numbered from 0 in the order in which they were put in, and so are their vertices and triangles, one
/// object after the other. Where an object is taken out, what comes behind it moves up, as in a vector.
#[derive(Clone, Debug)]
pub struct Octree {
    pub(super) cube: Cube,
    pub(super) depth: u32,
    pub(super) leaf_triangles: usize,
    pub(super) walk: Walk,
    /// Shared with whoever put them in.
    pub(super) vertices: Arc<Vec<DVec3>>,
    pub(super) triangles: Arc<Vec<[u32; 3]>>,
    pub(super) objects: Vec<ObjectCounts>,
    /// Made when they are first asked for: rays down the index do without.
    pub(super) nodes: OnceLock<Nodes>,
    /// Empty unless rays are to go down the index.
    pub(super) index: WideBvh,
}

impl Octree {
    /// Builds the octree of one object.
    ///
    /// - `vertices`: positions, world units.
    /// - `triangles`: corners, indices into `vertices`; degenerate ones are welcome and are never hit.
    ///
    /// # Errors
    /// A vertex that is not finite or too far out, an index out of range, more than
    /// [`MAX_TRIANGLES`](super::MAX_TRIANGLES). No triangles at all is fine.
    pub fn build(vertices: &[DVec3], triangles: &[[u32; 3]], settings: &OctreeSettings) -> Result<Self, OctreeError> {
        Self::sharing(Arc::new(vertices.to_vec()), Arc::new(triangles.to_vec()), settings)
    }

    /// Builds the octree of one object, whose vertices and triangles it does not copy.
    ///
    /// # Errors
    /// Those of [`Octree::build`].
    pub fn sharing(
        vertices: Arc<Vec<DVec3>>,
        triangles: Arc<Vec<[u32; 3]>>,
        settings: &OctreeSettings,
    ) -> Result<Self, OctreeError> {
        check(&vertices, &triangles)?;
        let mut octree = Self::of_cube(enclose(&vertices, &triangles), settings);
        (octree.vertices, octree.triangles) = (vertices, triangles);
        let [vertices, triangles] = [octree.vertices.len(), octree.triangles.len()];
        octree.objects = vec![ObjectCounts { vertices, triangles }];
        Ok(octree.with_walk(settings.walk))
    }

    /// An octree without objects, with a modelling cube around a box that all objects must lie in.
    ///
    /// Rays go from cell to cell until [`Octree::with_walk`] makes an index.
    ///
    /// # Errors
    /// A corner of the box, as vertex 0 or 1, that is not finite or too far out.
    pub fn around(bounds: Bounds, settings: &OctreeSettings) -> Result<Self, OctreeError> {
        check(&[bounds.min, bounds.max], &[])?;
        Ok(Self::of_cube(Cube::around(bounds.min.min(bounds.max), bounds.max.max(bounds.min)), settings))
    }

    pub(super) fn of_cube(cube: Cube, settings: &OctreeSettings) -> Self {
        // A level less for each time that the smallest cells would have to be doubled.
        let depth = (0..settings.depth.min(MAX_DEPTH)).take_while(|&level| {
            let half = cube.side * 0.5_f64.powi(level as i32 + 1);
            half >= settings.leaf_side || settings.leaf_side.is_nan()
        });
        Self {
            cube,
            depth: depth.count() as u32,
            leaf_triangles: settings.leaf_triangles,
            walk: Walk::LeadingDirection,
            vertices: Arc::default(),
            triangles: Arc::default(),
            objects: Vec::new(),
            nodes: OnceLock::new(),
            index: WideBvh::default(),
        }
    }

    /// Makes the terminal nodes, unless they are there, on all threads.
    pub(super) fn divide(&mut self) {
        if self.nodes.get().is_none() {
            self.nodes = self.division().nodes().into();
        }
    }

    /// The terminal nodes. Whoever asks first for them makes them on one thread: if it waited for others, they could be
    /// waiting for the same nodes.
    pub(super) fn nodes(&self) -> &Nodes {
        self.nodes.get_or_init(|| OctreeBuilder { grain: usize::MAX, ..self.division() }.nodes())
    }

    pub(super) fn leaves(&self) -> &Leaves {
        &self.nodes().leaves
    }

    pub(super) fn division(&self) -> OctreeBuilder<'_> {
        OctreeBuilder {
            cube: self.cube,
            vertices: &self.vertices,
            triangles: &self.triangles,
            depth: self.depth,
            leaf_triangles: self.leaf_triangles,
            grain: PARALLEL_TRIANGLES,
        }
    }

    /// This octree with its terminal nodes, which else are made when they are first asked for, and then on one thread.
    pub fn divided(mut self) -> Self {
        self.divide();
        self
    }

    /// This octree with another walk. Makes the index if the walk needs it; else drops it, and makes the terminal
    /// nodes.
    pub fn with_walk(mut self, walk: Walk) -> Self {
        let index = match walk {
            Walk::Index => WideBvh::new(&self.division()),
            Walk::LeadingDirection => {
                self.divide();
                WideBvh::default()
            }
        };
        Self { walk, index, ..self }
    }

    #[inline(always)]
    pub(super) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        let [a, b, c] = self.triangles[triangle as usize];
        [self.vertices[a as usize], self.vertices[b as usize], self.vertices[c as usize]]
    }

    /// Number of objects.
    pub fn objects(&self) -> usize {
        self.objects.len()
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The terminal nodes that hold surface, sorted.
    pub fn codes(&self) -> &[LocationalCode] {
        &self.leaves().codes
    }

    /// The triangles that touch a terminal node, ascending; none for any other cube.
    pub fn triangles_in(&self, node: LocationalCode) -> &[u32] {
        self.leaves().codes.binary_search(&node).map_or(&[], |leaf| self.leaves().of(leaf))
    }

    /// Lowest and highest corner of a cell, world units.
    pub fn bounds(&self, code: LocationalCode) -> (DVec3, DVec3) {
        self.cube.bounds(code)
    }

    /// Finds the cell that holds a point: truncate, interleave, binary search.
    pub fn locate(&self, point: DVec3) -> Location {
        match self.cube.voxel(point) {
            Some(voxel) => match self.locate_leaf(LocationalCode::containing(voxel, MAX_DEPTH)) {
                Ok(leaf) if self.leaves().codes[leaf].level() == self.depth => {
                    Location::Voxel(self.leaves().codes[leaf])
                }
                Ok(leaf) => Location::Partial(self.leaves().codes[leaf]),
                Err(empty) => empty,
            },
            None => Location::Outside,
        }
    }

    /// The terminal node that holds a voxel, or else the empty region around it.
    ///
    /// If the longest run of digits that the voxel shares with a stored code has i of them, the cube of its first
    /// i + 1 digits holds no stored node: that is the empty region. A neighbour in the order shares the longest run.
    pub(super) fn locate_leaf(&self, voxel: LocationalCode) -> Result<usize, Location> {
        let after = self.leaves().codes.partition_point(|&code| code <= voxel);
        let before = after.checked_sub(1).filter(|&leaf| self.leaves().codes[leaf].contains(voxel));
        if let Some(leaf) = before {
            return Ok(leaf);
        }
        let neighbours = [after.checked_sub(1), Some(after)].into_iter().flatten();
        let shared =
            neighbours.filter_map(|leaf| self.leaves().codes.get(leaf)).map(|code| code.common_digits(voxel)).max();
        let level = shared.map_or(0, |digits| digits + 1);
        Err(Location::Empty { code: voxel.ancestor(level), level })
    }
}

/// The modelling cube around what the triangles use.
fn enclose(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Cube {
    let used = triangles.iter().flatten().map(|&i| vertices[i as usize]);
    let (low, high) = used.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    if low.is_finite() { Cube::around(low, high) } else { Cube::around(DVec3::ZERO, DVec3::ZERO) }
}
