//! The settings of an octree.

/// How an octree is built and walked.
#[derive(Clone, Debug, PartialEq)]
pub struct OctreeSettings {
    /// Resolution N: the modelling cube has 2^N voxels a side. Counts as [`MAX_DEPTH`](super::MAX_DEPTH) above it.
    pub depth: u32,
    /// A cell is not divided if no more triangles than this are small enough for it and have their middle in it.
    pub leaf_triangles: usize,
    /// No cell has a smaller side than this, world units; 0 for no limit.
    pub leaf_side: f64,
    /// How rays find cells.
    pub walk: Walk,
}

impl Default for OctreeSettings {
    fn default() -> Self {
        Self { depth: 16, leaf_triangles: 8, leaf_side: 0.0, walk: Walk::Index }
    }
}

/// How a ray finds the cells along it. All walks give the same hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Walk {
    /// Down an index of wide nodes over the triangles in the order of their codes. Needs no terminal nodes.
    #[default]
    Index,
    /// From cell to cell across the side that the leading direction hits, each found by binary search. Needs no index.
    LeadingDirection,
}
