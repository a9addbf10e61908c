//! Errors of placing instances.

use super::placement::MOST_OCTAVES;
use crate::memory::MemoryExceeded;

/// Most instances of one instance octree; one of them may place another octree as large.
pub const MOST_INSTANCES: usize = 1 << 28;
/// Most prototypes of one instance octree.
pub const MOST_PROTOTYPES: usize = u16::MAX as usize;
/// Instances may be placed by instances so many times over.
pub const MOST_LEVELS: usize = 8;
/// A prototype that is made may be made of instances so many times over.
pub const MOST_MADE_LEVELS: usize = 3;
/// Most parts of instances that are known part by part.
pub const MOST_PARTS: usize = MOST_PROTOTYPES;
/// Most cells of a grid along an axis.
pub const MOST_CELLS: u32 = 1 << 21;
/// Most instances of a cell.
pub const MOST_IN_CELL: u32 = 1 << 22;
/// What is placed in a cell may come this many sides of the cell out of it.
pub const MOST_OVERHANG: f64 = 8.0;

/// A reason for which instances cannot be placed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InstanceError {
    /// More instances than [`MOST_INSTANCES`].
    #[error("{instances} instances are more than the {MOST_INSTANCES} of one level; place groups of them")]
    TooManyInstances {
        /// Number of instances.
        instances: usize,
    },
    /// More prototypes than [`MOST_PROTOTYPES`].
    #[error("{prototypes} prototypes are more than the {MOST_PROTOTYPES} of one level")]
    TooManyPrototypes {
        /// Number of prototypes.
        prototypes: usize,
    },
    /// Instances of instances, more than [`MOST_LEVELS`] times over.
    #[error("instances are nested {levels} times, more than {MOST_LEVELS}")]
    TooManyLevels {
        /// How many times.
        levels: usize,
    },
    /// An instance names a prototype that does not exist.
    #[error("instance {instance} places prototype {prototype}, but there are only {prototypes}")]
    UnknownPrototype {
        /// Number of the instance.
        instance: usize,
        /// The prototype that it names.
        prototype: u16,
        /// Number of prototypes.
        prototypes: usize,
    },
    /// A placement is infinite or not a number, or comes to be by rounding.
    #[error("the placement of instance {instance} is not finite")]
    NotFinite {
        /// Number of the instance.
        instance: usize,
    },
    /// A placement flattens what it places, or comes close to that.
    #[error("the placement of instance {instance} flattens it")]
    Flat {
        /// Number of the instance.
        instance: usize,
    },
    /// A placement that is no rotation with a scale, where others are not kept.
    #[error(
        "the placement of instance {instance} is no rotation with a scale between 2^-{MOST_OCTAVES} and 2^{MOST_OCTAVES}"
    )]
    NotSimilar {
        /// Number of the instance.
        instance: usize,
    },
    /// More parts than [`MOST_PARTS`].
    #[error("{parts} parts are more than {MOST_PARTS}")]
    TooManyParts {
        /// Number of parts.
        parts: usize,
    },
    /// More cells along an axis than [`MOST_CELLS`].
    #[error("{} by {} cells are more than {MOST_CELLS} along an axis; place groups of objects in larger cells", cells[0], cells[1])]
    TooManyCells {
        /// Along both axes.
        cells: [u32; 2],
    },
    /// More instances in a cell than [`MOST_IN_CELL`].
    #[error("{instances} instances in a cell are more than {MOST_IN_CELL}; divide the cells")]
    TooManyInCell {
        /// In each cell.
        instances: u32,
    },
    /// Cells so small beside what is placed in them that rays would ask very many.
    #[error(
        "what is placed reaches {overhang} out of its cell, more than {MOST_OVERHANG} times its side {side}; enlarge the cells"
    )]
    SmallCells {
        /// How far at the most.
        overhang: f64,
        /// Side of a cell.
        side: f64,
    },
    /// More memory than is left.
    #[error(transparent)]
    Memory(#[from] MemoryExceeded),
}
