//! What can go wrong with pictures.

use crate::memory::MemoryExceeded;
use files::WriteError;
use std::path::PathBuf;

/// What can go wrong with a picture.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// An empty side, or too many pixels.
    #[error("a picture of {width} x {height} pixels is empty or larger than {} pixels", super::MAX_PIXELS)]
    Size {
        /// Columns asked for.
        width: u32,
        /// Rows asked for.
        height: u32,
    },
    /// A file holds a number that is infinite or none.
    #[error("{}: pixel {x},{y} holds something that is no finite number", path.display())]
    Number {
        /// The file.
        path: PathBuf,
        /// Column, from the left.
        x: u32,
        /// Row, from the top.
        y: u32,
    },
    /// Two pictures that were to be compared or combined differ in size.
    #[error("pictures of different size: {0} x {1} and {2} x {3} pixels")]
    Mismatch(u32, u32, u32, u32),
    /// The name ends in something else than the formats known.
    #[error("{}: a picture's name ends in {endings}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// The endings that are known.
        endings: &'static str,
    },
    /// The file is broken, or holds what is not read.
    #[error("{}: {problem}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// Its pixels would take more memory than there is.
    #[error(transparent)]
    Memory(#[from] MemoryExceeded),
    /// The file cannot be opened.
    #[error("{}: {source}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}
