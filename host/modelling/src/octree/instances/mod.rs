//! The octree of instances: things that are stored once, their prototypes, and placed many times.
//!
//! A prototype is the [`Octree`](super::Octree) of a surface, or again instances. The octree of instances is a wide BVH
//! over their boxes, in the order of the codes of their middles, as it is over triangles. Where a ray comes to one of its
//! leaves it is taken into the coordinates of each prototype that is placed there, and goes on in the prototype's own
//! index. That is the seam between the two: a leaf of the upper index hands the ray over with the lengths between which
//! hits count, which are the same on both sides, and knows nothing else of what is below it.
//!
//! Instances are known in one of three ways: all are stored; they are in parts, each of which is stored when a ray
//! first comes to its box; or they are a function of the cell of a grid, and none is stored. For those in cells that
//! are far from the eye, aggregates may stand in: who makes prototypes knows the views, too.
//!
//! A prototype may be made on demand: when a ray comes to where it is placed, [`PrototypeMaker`] gives the instances that it
//! is made of, and the ray goes on through these.

mod error;
mod placement;
mod path;
mod blocks;
mod stored;
mod parts;
mod aggregates;
mod cells;
mod cell_walk;
mod octree;
mod descent;
mod made;
mod walk;

#[cfg(test)]
mod aggregates_tests;
#[cfg(test)]
mod made_tests;
#[cfg(test)]
mod tests;

pub use aggregates::{AggregateView, MOST_AGGREGATE_LEVELS};
pub use cells::{CellGrid, CellInstances, CellPlace};
pub use error::{
    InstanceError, MOST_CELLS, MOST_IN_CELL, MOST_INSTANCES, MOST_LEVELS, MOST_MADE_LEVELS, MOST_OVERHANG, MOST_PARTS,
    MOST_PROTOTYPES,
};
pub use made::{PrototypeMaker, RayInterval};
pub use octree::{InstanceCosts, InstanceOctree, Prototype};
pub use parts::InstanceParts;
pub use path::{InstanceHit, InstancePath, PlacedSurface};
pub use placement::{Instance, PlacementForm};
pub use walk::InstanceWalk;
