//! Errors of the tools, and the files that all tools read and write.

use std::{
    io::{self, Read, Write},
    path::Path,
};

/// An error of a tool.
#[derive(Debug, thiserror::Error)]
pub(super) enum ToolError {
    /// A file cannot be read or written.
    #[error("{file}: {error}")]
    File {
        /// The file.
        file: String,
        /// The error of the system.
        error: io::Error,
    },
    /// The reader of the output has gone, as `head` does; no error.
    #[error("the output is closed")]
    Closed,
    /// A picture cannot be written.
    #[error(transparent)]
    Picture(#[from] crate::picture::PictureError),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] files::WriteError),
    /// The arguments do not go together, or name something unknown.
    #[error("{0}")]
    Usage(String),
}

/// Opens a file; `-` is the standard input.
pub(super) fn open(file: &Path) -> Result<Box<dyn Read>, ToolError> {
    if file.as_os_str() == "-" {
        return Ok(Box::new(io::stdin().lock()));
    }
    let opened = std::fs::File::open(file);
    Ok(Box::new(opened.map_err(|error| ToolError::File { file: file.display().to_string(), error })?))
}

/// Reads a whole file; `-` is the standard input.
pub(super) fn read(file: &Path) -> Result<Vec<u8>, ToolError> {
    let mut bytes = Vec::new();
    let read = open(file)?.read_to_end(&mut bytes);
    read.map_err(|error| ToolError::File { file: file.display().to_string(), error })?;
    Ok(bytes)
}

/// Writes to the standard output.
pub(super) fn print(text: &str) -> Result<(), ToolError> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(of_output)
}

/// The tool error for an error of the standard output.
pub(super) fn of_output(error: io::Error) -> ToolError {
    match error.kind() {
        io::ErrorKind::BrokenPipe => ToolError::Closed,
        _ => ToolError::File { file: "standard output".into(), error },
    }
}
