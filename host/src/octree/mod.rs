//! The linear octree: sorted locational codes over triangles, location, and what a ray hits.
//!
//! Three structures stand on the same codes. [`Octree`] stores terminal nodes, each with every triangle that touches it,
//! for whoever asks for a place: neighbours, the inside test, rays that go from cell to cell. They are made when they are
//! first asked for. Its index files each triangle once, by its middle, in wide nodes for rays that start at the top.
//! [`Sorted`] files them so too, for whoever asks each triangle once: the pairs of a Boolean operation. Sorting takes less
//! than a tenth of the time of dividing, so neither of the two waits for terminal nodes.

pub mod brute_force;
mod build;
mod clip;
mod code;
mod cube;
mod descend;
mod edit;
mod file;
mod frame;
mod index;
mod inside;
mod items;
mod lanes;
mod nearest;
mod neighbours;
mod packet;
mod partition;
mod points;
mod shaft;
mod sorted;
mod statistics;
mod surface_points;
mod walk;

#[cfg(test)]
mod tests;

use std::sync::{Arc, OnceLock};

use glam::DVec3;

use crate::numeric::bounds::Bounds;
pub use crate::numeric::ray::{Hit, Ray};
use crate::numeric::triangle::MAX_MAGNITUDE;
use build::{Division, Leaves, Nodes, PARALLEL_TRIANGLES};
pub use code::{LocationalCode, MAX_DEPTH};
use cube::Cube;
pub use file::{ENDING, FileError, MAX_BYTES};
use frame::Line;
pub use frame::MAX_DISTANCE;
use index::Index;
pub use inside::Side;
pub use nearest::{Nearest, hausdorff};
pub use points::{Around, Points};
pub use shaft::{Between, Shaft};
pub use sorted::Sorted;
pub use statistics::Statistics;
pub use surface_points::{MAX_POINT_DEPTH, SurfacePoints};
use walk::Search;

/// Most triangles that one octree takes.
pub const MAX_TRIANGLES: usize = 1 << 28;

/// How an octree is built and walked.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Resolution N: the modelling cube has 2^N voxels a side. Counts as [`MAX_DEPTH`] above it.
    pub depth: u32,
    /// A cell is not divided if no more triangles than this are small enough for it and have their middle in it.
    pub leaf_triangles: usize,
    /// No cell has a smaller side than this, world units; 0 for no limit.
    pub leaf_side: f64,
    /// How rays find their way.
    pub walk: Walk,
}

impl Default for Settings {
    fn default() -> Self {
        Self { depth: 16, leaf_triangles: 8, leaf_side: 0.0, walk: Walk::Index }
    }
}

/// How a ray finds the cells on its way. All ways give the same hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Walk {
    /// Down an index of wide nodes over the triangles in the order of their codes. Needs no terminal nodes.
    #[default]
    Index,
    /// From cell to cell across the side that the leading direction meets, each found by binary search. Needs no index.
    LeadingDirection,
}

/// Why an octree cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OctreeError {
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} is not finite")]
    NonFiniteVertex {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A coordinate is beyond [`MAX_MAGNITUDE`].
    #[error("vertex {vertex} is farther than {MAX_MAGNITUDE:e} from the origin")]
    VertexTooFar {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {index}, but there are only {vertices}")]
    IndexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex that it names.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A coordinate is outside the modelling cube, which was given.
    #[error("vertex {vertex} is outside the modelling cube")]
    VertexOutside {
        /// Index of the vertex.
        vertex: usize,
    },
    /// More triangles than [`MAX_TRIANGLES`].
    #[error("{triangles} triangles are more than the {MAX_TRIANGLES} that one octree takes")]
    TooManyTriangles {
        /// Number of triangles.
        triangles: usize,
    },
}

/// Where a point lies.
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
        /// Its level: its side is 2^(N - level) voxels.
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
struct Object {
    vertices: usize,
    triangles: usize,
}

/// A linear octree over the triangles of some objects. Threads share it freely.
///
/// Objects are numbered from 0 in the order in which they were put in, and so are their vertices and triangles, one object
/// after the other. Where an object is taken out, what comes behind it moves up, as in a vector.
#[derive(Clone, Debug)]
pub struct Octree {
    cube: Cube,
    depth: u32,
    leaf_triangles: usize,
    walk: Walk,
    /// Shared with whoever put them in.
    vertices: Arc<Vec<DVec3>>,
    triangles: Arc<Vec<[u32; 3]>>,
    objects: Vec<Object>,
    /// Made when they are first asked for: rays down the index do without.
    nodes: OnceLock<Nodes>,
    /// Empty unless rays are to go down the index.
    index: Index,
}

impl Octree {
    /// Builds the octree of one object.
    ///
    /// - `vertices`: positions, world units.
    /// - `triangles`: corners, indices into `vertices`; degenerate ones are welcome and are never hit.
    ///
    /// # Errors
    /// A vertex that is not finite or too far out, an index out of range, more than [`MAX_TRIANGLES`]. No triangles
    /// at all is fine.
    pub fn build(vertices: &[DVec3], triangles: &[[u32; 3]], settings: &Settings) -> Result<Self, OctreeError> {
        Self::sharing(Arc::new(vertices.to_vec()), Arc::new(triangles.to_vec()), settings)
    }

    /// Builds the octree of one object, whose vertices and triangles it does not copy.
    ///
    /// # Errors
    /// Those of [`Octree::build`].
    pub fn sharing(
        vertices: Arc<Vec<DVec3>>,
        triangles: Arc<Vec<[u32; 3]>>,
        settings: &Settings,
    ) -> Result<Self, OctreeError> {
        check(&vertices, &triangles)?;
        let mut octree = Self::of_cube(enclose(&vertices, &triangles), settings);
        (octree.vertices, octree.triangles) = (vertices, triangles);
        let [vertices, triangles] = [octree.vertices.len(), octree.triangles.len()];
        octree.objects = vec![Object { vertices, triangles }];
        Ok(octree.with_walk(settings.walk))
    }

    /// An octree without objects, with a modelling cube around a box that all objects must lie in.
    ///
    /// Rays go from cell to cell until [`Octree::with_walk`] makes an index.
    ///
    /// # Errors
    /// A corner of the box, as vertex 0 or 1, that is not finite or too far out.
    pub fn around(bounds: Bounds, settings: &Settings) -> Result<Self, OctreeError> {
        check(&[bounds.min, bounds.max], &[])?;
        Ok(Self::of_cube(Cube::around(bounds.min.min(bounds.max), bounds.max.max(bounds.min)), settings))
    }

    fn of_cube(cube: Cube, settings: &Settings) -> Self {
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
            index: Index::default(),
        }
    }

    /// Makes the terminal nodes, unless they are there, on all threads.
    fn divide(&mut self) {
        if self.nodes.get().is_none() {
            self.nodes = self.division().nodes().into();
        }
    }

    /// The terminal nodes. Whoever asks first for them makes them on one thread: if it waited for others, they could be
    /// waiting for the same nodes.
    fn nodes(&self) -> &Nodes {
        self.nodes.get_or_init(|| Division { grain: usize::MAX, ..self.division() }.nodes())
    }

    fn leaves(&self) -> &Leaves {
        &self.nodes().leaves
    }

    fn division(&self) -> Division<'_> {
        Division {
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

    /// This octree, walked another way. Makes the index if the walk needs it; else drops it, and makes the terminal
    /// nodes.
    pub fn with_walk(mut self, walk: Walk) -> Self {
        let index = match walk {
            Walk::Index => Index::new(&self.division()),
            Walk::LeadingDirection => {
                self.divide();
                Index::default()
            }
        };
        Self { walk, index, ..self }
    }

    /// Finds the nearest hit with `t_min < t < t_max`, both exclusive.
    ///
    /// Either side of a triangle is hit. Edges and corners belong to their triangles, so a closed mesh lets no ray
    /// through; of several hits with the same `t` the triangle with the lowest index counts. A triangle seen exactly
    /// edge-on is not hit. A ray whose direction is zero, or that is not finite, or that begins farther away than
    /// [`MAX_DISTANCE`] sides of the modelling cube, hits nothing.
    #[inline]
    pub fn closest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<Hit> {
        match self.walk {
            Walk::Index => descend::nearest(self, ray, t_min, t_max, &mut WalkCount::default()),
            Walk::LeadingDirection => self.walked(ray, t_min, t_max, false).0,
        }
    }

    /// [`Octree::closest`], with the work that it took.
    pub fn closest_counted(&self, ray: &Ray, t_min: f64, t_max: f64) -> (Option<Hit>, WalkCount) {
        match self.walk {
            Walk::Index => {
                let mut count = WalkCount::default();
                (descend::nearest(self, ray, t_min, t_max, &mut count), count)
            }
            Walk::LeadingDirection => self.walked(ray, t_min, t_max, false),
        }
    }

    /// Gives all hits with `t_min < t < t_max`, in no order, until one is enough; says whether one was.
    ///
    /// A triangle may come more than once where rays go from cell to cell.
    pub fn each_hit(&self, ray: &Ray, t_min: f64, t_max: f64, mut enough: impl FnMut(Hit) -> bool) -> bool {
        match self.walk {
            Walk::Index => descend::each(self, ray, t_min, t_max, enough),
            Walk::LeadingDirection => {
                let mut from = t_min;
                while let Some(hit) = self.closest(ray, from, t_max) {
                    if enough(hit) {
                        return true;
                    }
                    from = hit.t;
                }
                false
            }
        }
    }

    /// Says whether anything is hit with `t_min < t < t_max`.
    #[inline]
    pub fn occluded(&self, ray: &Ray, t_min: f64, t_max: f64) -> bool {
        match self.walk {
            Walk::Index => descend::is_any(self, ray, t_min, t_max),
            Walk::LeadingDirection => self.walked(ray, t_min, t_max, true).0.is_some(),
        }
    }

    #[inline(always)]
    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        let [a, b, c] = self.triangles[triangle as usize];
        [self.vertices[a as usize], self.vertices[b as usize], self.vertices[c as usize]]
    }

    fn walked(&self, ray: &Ray, t_min: f64, t_max: f64, any: bool) -> (Option<Hit>, WalkCount) {
        let Some(line) = Line::new(ray, &self.cube, t_min, t_max) else { return Default::default() };
        let mut search = Search::new(self, &line, t_min, t_max, any);
        search.walk();
        search.found()
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
    fn locate_leaf(&self, voxel: LocationalCode) -> Result<usize, Location> {
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

fn check(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), OctreeError> {
    if let Some(vertex) = vertices.iter().position(|p| !p.is_finite()) {
        return Err(OctreeError::NonFiniteVertex { vertex });
    }
    if let Some(vertex) = vertices.iter().position(|p| p.abs().max_element() > MAX_MAGNITUDE) {
        return Err(OctreeError::VertexTooFar { vertex });
    }
    if triangles.len() > MAX_TRIANGLES {
        return Err(OctreeError::TooManyTriangles { triangles: triangles.len() });
    }
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&index) = corners.iter().find(|&&i| i as usize >= vertices.len()) {
            return Err(OctreeError::IndexOutOfRange { triangle, index, vertices: vertices.len() });
        }
    }
    Ok(())
}
