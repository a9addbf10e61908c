//! Files that are read as a whole, if there is memory for them.

use super::reserve;
use std::io;
use std::path::Path;

/// The content of an ordinary file, as [`files::read`] reads it, if there is memory for it.
///
/// - `most`: bytes that it may have.
///
/// # Errors
/// Those of [`files::read`], and [`super::MemoryExceeded`] as another error.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    reserve_for(path, most)?;
    files::read(path, most)
}

/// The content of an ordinary file that is text, as [`files::read_text`] reads it, if there is memory for it.
///
/// - `most`: bytes that it may have.
///
/// # Errors
/// Those of [`files::read_text`], and [`super::MemoryExceeded`] as another error.
pub fn read_text(path: &Path, most: u64) -> io::Result<String> {
    reserve_for(path, most)?;
    files::read_text(path, most)
}

/// Asks for the memory of a file that is not too long anyway. What is no file is left to whoever opens it.
fn reserve_for(path: &Path, most: u64) -> io::Result<()> {
    let length = std::fs::metadata(path).map_or(0, |found| found.len());
    reserve(length.min(most), || "its content".into()).map_err(io::Error::other)
}
