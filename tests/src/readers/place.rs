//! A file for the readers that take a path instead of bytes.

use std::fs;
use std::path::Path;
use tempfile::TempDir;

thread_local! {
    /// One folder a thread, removed at its end.
    static FOLDER: TempDir = tempfile::tempdir().expect("there is a folder for temporary files");
}

/// Calls a function with the path of a file that holds the bytes, in a folder without other files.
///
/// - `name`: of the file; its ending may say what it is.
pub fn with_file<R>(name: &str, bytes: &[u8], read: impl FnOnce(&Path) -> R) -> R {
    FOLDER.with(|folder| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("a temporary file can be written");
        read(&path)
    })
}
