//! Errors of terrain.

use crate::memory::MemoryExceeded;

/// A reason for which there is no such terrain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TerrainError {
    /// A parameter is out of its range.
    #[error("{name} is {value}, not between {} and {}", range[0], range[1])]
    Parameter {
        /// Its name.
        name: &'static str,
        /// What it was to be.
        value: f64,
        /// The least and the greatest that it may be.
        range: [f64; 2],
    },
    /// No parameter has this name.
    #[error("terrain has no parameter {name}")]
    UnknownParameter {
        /// The name.
        name: String,
    },
    /// An octave is so fine, or the terrain reaches so far, that doubles cannot tell places in a cell of its lattice.
    #[error("octave {octave} is too fine for how far the terrain reaches")]
    TooFine {
        /// Number of the octave, from 0.
        octave: usize,
    },
    /// Corners of a region that enclose nothing, or too much.
    #[error("the region of the terrain is empty or not finite")]
    Region,
    /// Heights that overflow.
    #[error("heights of the terrain are not finite")]
    NotFinite,
    /// A cell of a grid has a number that it cannot have.
    #[error("{what} is {value} in column {column} of row {row}")]
    Cell {
        /// What the number is.
        what: &'static str,
        /// Number of the cell along x, from 0.
        column: usize,
        /// Its number along z, from 0.
        row: usize,
        /// The number.
        value: f64,
    },
    /// The erosion was cancelled before it was done.
    #[error("the erosion was cancelled")]
    Cancelled,
    /// Functions within functions, too many times over.
    #[error("functions of height are nested more than {most} times")]
    TooDeep {
        /// How many times they may be.
        most: usize,
    },
    /// A grid with fewer than two rows or columns, or with another number of heights than it says.
    #[error("{heights} heights are no grid of {columns} by {rows}")]
    GridSize {
        /// Heights along x.
        columns: usize,
        /// Heights along z.
        rows: usize,
        /// How many heights there are.
        heights: usize,
    },
    /// More triangles than were allowed.
    #[error("more than {most} triangles would be needed; enlarge the tolerance or the region in parts")]
    TooManyTriangles {
        /// How many were allowed.
        most: usize,
    },
    /// A tolerance that triangles cannot keep.
    #[error("triangles of this region cannot keep a tolerance of {tolerance}")]
    Tolerance {
        /// The tolerance.
        tolerance: f64,
    },
    /// The base of a solid is not below all of its ground.
    #[error("the base at {base} is not below the ground, whose lowest height is {lowest}")]
    Base {
        /// Height of the base.
        base: f64,
        /// Least height of a vertex.
        lowest: f64,
    },
    /// More memory than is left.
    #[error(transparent)]
    Memory(#[from] MemoryExceeded),
}
