//! The linear octree: sorted locational codes over triangles, location, and what a ray hits.
//!
//! Three structures stand on the same codes. [`Octree`] stores terminal nodes, each with every triangle that touches
//! it, for whoever asks for a place: neighbours, the inside test, rays that go from cell to cell. They are made when
//! they are first asked for. Its index is a wide BVH that holds each triangle once, by its middle, for rays that start
//! at the top. [`TriangleBvh`] holds them once, too, for whoever asks each triangle once: the pairs of a Boolean
//! operation. Sorting takes less than a tenth of the time of dividing, so neither of the two waits for terminal nodes.

pub mod brute_force;
mod settings;
mod error;
mod code;
mod cube;
mod clip;
mod build;
mod bvh;
mod items;
mod lanes;
mod prepared_ray;
mod packet;
mod partition;
mod wide_bvh;
mod tree;
mod neighbours;
mod statistics;
mod edit;
mod file;
mod inside;
mod nearest;
mod points;
mod walk;
mod visit;
mod descend;
mod trace;
mod shaft;
mod surface_points;
mod instances;

#[cfg(test)]
mod tests;

pub use crate::numeric::ray::{Hit, Ray};
pub use bvh::TriangleBvh;
pub use code::{LocationalCode, MAX_DEPTH};
pub use error::{MAX_TRIANGLES, OctreeError};
pub use file::{ENDING, FileError, MAX_BYTES};
pub use inside::Containment;
pub use instances::{
    AggregateView, CellGrid, CellInstances, CellPlace, Instance, InstanceCosts, InstanceError, InstanceHit,
    InstanceOctree, InstanceParts, InstancePath, InstanceWalk, MOST_AGGREGATE_LEVELS, MOST_CELLS, MOST_IN_CELL,
    MOST_INSTANCES, MOST_LEVELS, MOST_MADE_LEVELS, MOST_OVERHANG, MOST_PARTS, MOST_PROTOTYPES, PlacedSurface,
    PlacementForm, Prototype, PrototypeMaker, RayInterval,
};
pub use nearest::{Nearest, hausdorff};
pub use points::{NearbyPoints, SortedPoints};
pub use prepared_ray::MAX_DISTANCE;
pub use settings::{OctreeSettings, Walk};
pub use shaft::{Shaft, ShaftContents};
pub use statistics::Statistics;
pub use surface_points::{MAX_POINT_DEPTH, SurfacePoints};
pub use tree::{Location, Octree, WalkCount};
