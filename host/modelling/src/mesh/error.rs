//! What can be wrong with a mesh or its file, and where.

use super::JsonPath;
use crate::memory::MemoryExceeded;
use std::fmt;
use std::path::PathBuf;

/// A failure to read, write or accept a mesh.
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The extension names no known format.
    #[error("{}: unknown mesh format; known extensions are obj, stl, ply, gltf, glb and cmesh", path.display())]
    Format {
        /// The file.
        path: PathBuf,
    },
    /// The content cannot be understood or trusted.
    #[error("{}: {fault}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        fault: Fault,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] files::WriteError),
}

/// One thing wrong, and its location in the text, in the bytes or in the mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{location}: {problem}")]
pub struct Fault {
    /// Where.
    pub location: FaultLocation,
    /// What.
    pub problem: MeshProblem,
}

/// A location in a file or in a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultLocation {
    /// A line of a text, from 1.
    Line(usize),
    /// A byte of a binary file, from 0.
    Byte(usize),
    /// A vertex, from 0.
    Vertex(usize),
    /// A triangle, from 0.
    Triangle(usize),
    /// A member of a JSON document.
    Json(JsonPath),
    /// The mesh as a whole.
    Mesh,
}

impl FaultLocation {
    /// The fault `problem` at this location.
    pub(super) fn fault(self, problem: MeshProblem) -> Fault {
        Fault { location: self, problem }
    }
}

impl fmt::Display for FaultLocation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FaultLocation::Line(line) => write!(formatter, "line {line}"),
            FaultLocation::Byte(byte) => write!(formatter, "byte {byte}"),
            FaultLocation::Vertex(vertex) => write!(formatter, "vertex {vertex}"),
            FaultLocation::Triangle(triangle) => write!(formatter, "triangle {triangle}"),
            FaultLocation::Json(path) => write!(formatter, "{path}"),
            FaultLocation::Mesh => write!(formatter, "mesh"),
        }
    }
}

/// A thing that is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshProblem {
    /// The data ends too early.
    #[error("ends where {0} is expected")]
    Ends(&'static str),
    /// One thing stands where another must stand.
    #[error("expected {expected}, found `{found}`")]
    Expected {
        /// What may stand there.
        expected: &'static str,
        /// What stands there, shortened.
        found: String,
    },
    /// A file in which no triangle was found.
    #[error("holds no triangles")]
    NoTriangles,
    /// A coordinate that is infinite or not a number.
    #[error("a coordinate is not finite")]
    NotFinite,
    /// An index outside its table.
    #[error("index {index} is outside the {count} {table}")]
    Index {
        /// The index as it stands in the file.
        index: i64,
        /// Entries of the table.
        count: usize,
        /// What the table holds.
        table: &'static str,
    },
    /// More than PERIS is built for.
    #[error("{count} {what}, the limit is {limit}")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many.
        count: u64,
        /// The limit.
        limit: u64,
    },
    /// A face of one or two corners.
    #[error("a face needs at least 3 corners, this one has {0}")]
    FewCorners(usize),
    /// A table per corner that is neither empty nor as long as the triangles.
    #[error("{table} has {length} entries for {triangles} triangles")]
    Length {
        /// The table.
        table: &'static str,
        /// Its entries.
        length: usize,
        /// Triangles of the mesh.
        triangles: usize,
    },
    /// A coordinate that the format cannot hold.
    #[error("{value} does not fit into the single precision of the format")]
    Range {
        /// The coordinate.
        value: f64,
    },
    /// A member that must be there.
    #[error("is missing")]
    Missing,
    /// A list of numbers of another length, or of other things.
    #[error("expected {0} finite numbers")]
    Numbers(usize),
    /// A document that is none.
    #[error("{0}")]
    Syntax(String),
    /// Something that ends beyond what holds it.
    #[error("reaches beyond the {length} bytes there are")]
    Outside {
        /// The bytes there are.
        length: usize,
    },
    /// A file that belongs to this one and cannot be read.
    #[error("cannot read {name}: {why}")]
    Neighbour {
        /// Its name.
        name: String,
        /// What is wrong, in words.
        why: String,
    },
    /// A row of a table that cannot be.
    #[error("row {row}: {what}")]
    Row {
        /// Its number, from 0.
        row: usize,
        /// What is wrong, in words.
        what: &'static str,
    },
    /// A table that must have as many rows as another one.
    #[error("{rows} rows, where the other tables have {count}")]
    Rows {
        /// Its rows.
        rows: usize,
        /// Those of the others.
        count: usize,
    },
    /// More memory than is left.
    #[error(transparent)]
    Memory(#[from] MemoryExceeded),
    /// A mesh that the format cannot hold.
    #[error("{0}")]
    Unsuited(&'static str),
}

/// `text` shortened for an error message.
pub(super) fn shortened(text: &str) -> String {
    const SHOWN: usize = 40;
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}
