//! Statistics of an octree.

use serde::Serialize;

use super::Octree;

/// Statistics of an octree.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Statistics {
    /// Objects put in.
    pub objects: usize,
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
    /// Most triangles that one terminal node names.
    pub most_references: usize,
    /// Resolution N: the modelling cube has 2^N voxels a side.
    pub depth: u32,
    /// Terminal nodes of each level, from the modelling cube down to the voxels.
    pub depth_histogram: Vec<usize>,
    /// Side of the modelling cube, world units.
    pub side: f64,
    /// Share of the modelling cube that the terminal nodes fill, 0..=1.
    pub filled: f64,
    /// Memory of the codes and the triangles, bytes.
    pub linear_bytes: usize,
    /// Memory of that and of the index, bytes.
    pub bytes: usize,
    /// `bytes` over `triangles`.
    pub bytes_per_triangle: f64,
}

impl Octree {
    /// Memory of what is there, bytes: of terminal nodes only if they were asked for before.
    pub fn bytes(&self) -> usize {
        let index = size_of_val(self.index.packets.as_slice()) + size_of_val(self.index.nodes.as_slice());
        self.linear_bytes() + index
    }

    fn linear_bytes(&self) -> usize {
        let nodes = self.nodes.get().map_or(0, |nodes| {
            size_of_val(nodes.homes.as_slice())
                + size_of_val(nodes.leaves.codes.as_slice())
                + size_of_val(nodes.leaves.ends.as_slice())
                + size_of_val(nodes.leaves.triangles.as_slice())
        });
        nodes
            + size_of_val(self.vertices.as_slice())
            + size_of_val(self.triangles.as_slice())
            + size_of_val(self.objects.as_slice())
    }

    /// The statistics of the octree, terminal nodes included.
    pub fn statistics(&self) -> Statistics {
        let mut depth_histogram = vec![0; self.depth as usize + 1];
        for code in &self.leaves().codes {
            depth_histogram[code.level() as usize] += 1;
        }
        let (linear_bytes, bytes) = (self.linear_bytes(), self.bytes());
        let leaves = self.leaves().codes.len();
        let voxel_nodes = depth_histogram.last().copied().unwrap_or(0);
        let volumes = depth_histogram.iter().zip(0..).map(|(&count, level)| count as f64 * 0.125_f64.powi(level));
        Statistics {
            objects: self.objects.len(),
            triangles: self.triangles.len(),
            leaves,
            partial_nodes: leaves - voxel_nodes,
            voxel_nodes,
            references: self.leaves().triangles.len(),
            most_references: (0..leaves).map(|leaf| self.leaves().of(leaf).len()).max().unwrap_or(0),
            filled: volumes.sum(),
            depth: self.depth,
            depth_histogram,
            side: self.cube.side,
            linear_bytes,
            bytes,
            bytes_per_triangle: bytes as f64 / self.triangles.len().max(1) as f64,
        }
    }
}
