//! The linear octree: sorted locational codes over triangles, location, and what a ray hits.

pub mod brute_force;
mod build;
mod clip;
mod code;
mod cube;
mod frame;
mod index;
mod items;
mod packet;
mod partition;
mod sorted;
mod walk;

#[cfg(test)]
mod tests;

use glam::DVec3;
use serde::Serialize;

pub use crate::numeric::ray::{Hit, Ray};
use crate::numeric::triangle::MAX_MAGNITUDE;
use build::Division;
use clip::Bounds;
pub use code::{LocationalCode, MAX_DEPTH};
use cube::Cube;
pub use frame::MAX_DISTANCE;
use index::{Index, Node};
use items::Items;
use packet::Packet;
pub use sorted::Sorted;

/// Most triangles that one octree takes.
pub const MAX_TRIANGLES: usize = 1 << 28;

/// How an octree is built and walked.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Resolution N: the modelling cube has 2^N voxels a side. Counts as [`MAX_DEPTH`] above it.
    pub depth: u32,
    /// A cell with no more triangles than this is not divided.
    pub leaf_triangles: usize,
    /// How rays find their way.
    pub walk: Walk,
}

impl Default for Settings {
    fn default() -> Self {
        Self { depth: 16, leaf_triangles: 16, walk: Walk::Index }
    }
}

/// How a ray finds the cells on its way. All ways give the same hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Walk {
    /// Down an index of wide nodes that is derived from the sorted codes.
    #[default]
    Index,
    /// From cell to cell across the side that the leading direction meets, each found by binary search.
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

/// What an octree holds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Statistics {
    /// Triangles given.
    pub triangles: usize,
    /// Terminal nodes stored.
    pub leaves: usize,
    /// Terminal nodes larger than a voxel.
    pub partial_nodes: usize,
    /// Terminal nodes that are voxels.
    pub voxel_nodes: usize,
    /// Triangles named by all terminal nodes together.
    pub references: usize,
    /// Terminal nodes of each level, from the modelling cube down.
    pub depth_histogram: Vec<usize>,
    /// Side of the modelling cube, world units.
    pub side: f64,
    /// Memory of the codes, the index and the triangles, bytes.
    pub bytes: usize,
    /// `bytes` over `triangles`.
    pub bytes_per_triangle: f64,
}

/// A linear octree over triangles. It does not change; threads share it freely.
#[derive(Clone, Debug)]
pub struct Octree {
    cube: Cube,
    depth: u32,
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    walk: Walk,
    codes: Vec<LocationalCode>,
    /// Where the packets of each terminal node begin in `leaf_packets`, and at last where they end.
    leaf_starts: Vec<u32>,
    /// Packets that hold the triangles of each terminal node.
    leaf_packets: Vec<u32>,
    packets: Vec<Packet>,
    nodes: Vec<Node>,
    references: usize,
}

impl Octree {
    /// Builds the octree.
    ///
    /// - `vertices`: positions, world units.
    /// - `triangles`: corners, indices into `vertices`; degenerate ones are welcome and are never hit.
    ///
    /// # Errors
    /// A vertex that is not finite or too far out, an index out of range, more than [`MAX_TRIANGLES`]. No triangles
    /// at all is fine.
    pub fn build(vertices: &[DVec3], triangles: &[[u32; 3]], settings: &Settings) -> Result<Self, OctreeError> {
        check(vertices, triangles)?;
        let cube = enclose(vertices, triangles);
        let depth = settings.depth.min(MAX_DEPTH);
        let local: Vec<DVec3> = vertices.iter().map(|&p| cube.local(p)).collect();
        let division = Division { vertices: &local, triangles, depth, leaf_triangles: settings.leaf_triangles };
        let leaves = division.leaves();
        let corners = |triangle: u32| triangles[triangle as usize].map(|i| local[i as usize]);
        let items = Items::new(&leaves, triangles.len(), |triangle| {
            Bounds::of(&corners(triangle).map(|corner| corner.to_array()))
        });
        let index = Index::new(items.items, corners);
        // The packets of each terminal node, each once.
        let mut leaf_starts = vec![0];
        let mut leaf_packets: Vec<u32> = Vec::new();
        for leaf in 0..leaves.codes.len() {
            let start = leaf_packets.len();
            let items = &items.of_reference[leaves.range(leaf)];
            leaf_packets.extend(items.iter().map(|&item| index.packet_of_item[item as usize]));
            leaf_packets[start..].sort_unstable();
            let mut kept = start;
            for i in start..leaf_packets.len() {
                if i == start || leaf_packets[i] != leaf_packets[kept - 1] {
                    leaf_packets[kept] = leaf_packets[i];
                    kept += 1;
                }
            }
            leaf_packets.truncate(kept);
            leaf_starts.push(kept as u32);
        }
        Ok(Self {
            cube,
            depth,
            vertices: vertices.to_vec(),
            triangles: triangles.to_vec(),
            walk: settings.walk,
            references: leaves.triangles.len(),
            codes: leaves.codes,
            leaf_starts,
            leaf_packets,
            packets: index.packets,
            nodes: index.nodes,
        })
    }

    /// The same octree, walked another way.
    pub fn with_walk(self, walk: Walk) -> Self {
        Self { walk, ..self }
    }

    /// Finds the nearest hit with `t_min < t < t_max`, both exclusive.
    ///
    /// Either side of a triangle is hit. Edges and corners belong to their triangles, so a closed mesh lets no ray
    /// through; of several hits with the same `t` the triangle with the lowest index counts. A triangle seen exactly
    /// edge-on is not hit. A ray whose direction is zero, or that is not finite, or that begins farther away than
    /// [`MAX_DISTANCE`] sides of the modelling cube, hits nothing.
    pub fn closest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<Hit> {
        self.closest_counted(ray, t_min, t_max).0
    }

    /// [`Octree::closest`], with the work that it took.
    pub fn closest_counted(&self, ray: &Ray, t_min: f64, t_max: f64) -> (Option<Hit>, WalkCount) {
        walk::search(self, ray, t_min, t_max, false)
    }

    /// Says whether anything is hit with `t_min < t < t_max`.
    pub fn occluded(&self, ray: &Ray, t_min: f64, t_max: f64) -> bool {
        walk::search(self, ray, t_min, t_max, true).0.is_some()
    }

    /// What the octree holds.
    pub fn statistics(&self) -> Statistics {
        let mut depth_histogram = vec![0; self.depth as usize + 1];
        for code in &self.codes {
            depth_histogram[code.level() as usize] += 1;
        }
        let bytes = size_of_val(self.vertices.as_slice())
            + size_of_val(self.triangles.as_slice())
            + size_of_val(self.codes.as_slice())
            + size_of_val(self.leaf_starts.as_slice())
            + size_of_val(self.leaf_packets.as_slice())
            + size_of_val(self.packets.as_slice())
            + size_of_val(self.nodes.as_slice());
        let voxel_nodes = depth_histogram.last().copied().unwrap_or(0);
        Statistics {
            triangles: self.triangles.len(),
            leaves: self.codes.len(),
            partial_nodes: self.codes.len() - voxel_nodes,
            voxel_nodes,
            references: self.references,
            depth_histogram,
            side: self.cube.side,
            bytes,
            bytes_per_triangle: bytes as f64 / self.triangles.len().max(1) as f64,
        }
    }

    /// The terminal nodes that hold surface, sorted.
    pub fn codes(&self) -> &[LocationalCode] {
        &self.codes
    }

    /// Lowest and highest corner of a cell, world units.
    pub fn bounds(&self, code: LocationalCode) -> (DVec3, DVec3) {
        self.cube.bounds(code)
    }

    /// Finds the cell that holds a point: truncate, interleave, binary search.
    pub fn locate(&self, point: DVec3) -> Location {
        match self.cube.voxel(point) {
            Some(voxel) => match self.locate_leaf(LocationalCode::containing(voxel, MAX_DEPTH)) {
                Ok(leaf) if self.codes[leaf].level() == self.depth => Location::Voxel(self.codes[leaf]),
                Ok(leaf) => Location::Partial(self.codes[leaf]),
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
        let after = self.codes.partition_point(|&code| code <= voxel);
        let before = after.checked_sub(1).filter(|&leaf| self.codes[leaf].contains(voxel));
        if let Some(leaf) = before {
            return Ok(leaf);
        }
        let neighbours = [after.checked_sub(1), Some(after)].into_iter().flatten();
        let shared = neighbours.filter_map(|leaf| self.codes.get(leaf)).map(|code| code.common_digits(voxel)).max();
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
