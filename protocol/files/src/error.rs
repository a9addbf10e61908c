//! The reason why a file is not written.

use std::io;
use std::path::PathBuf;

/// A file that is not written, or not where it was to be.
#[derive(Debug, thiserror::Error)]
#[error("writing {}: {problem}", path.display())]
pub struct WriteError {
    /// The file, as it was called.
    pub path: PathBuf,
    /// What stands in the way.
    #[source]
    pub problem: Problem,
}

/// What stands in the way of a file.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// Its name ends in nothing that could be a file.
    #[error("this names no file")]
    NoName,
    /// The folder is missing.
    #[error("there is no folder {}", .0.display())]
    NoFolder(PathBuf),
    /// What should be its folder is something else.
    #[error("{} is no folder", .0.display())]
    NotAFolder(PathBuf),
    /// A folder has its name.
    #[error("this is a folder")]
    IsAFolder,
    /// A device, pipe or socket has its name.
    #[error("this is a device, pipe or socket and no ordinary file")]
    NotOrdinary,
    /// A symbolic link has its name and leads nowhere.
    #[error("this is a link that leads nowhere")]
    DeadLink,
    /// A symbolic link has its name, where none is followed.
    #[error("this is a link, and stays as it is")]
    Link,
    /// It is not below the folder below which files may be.
    #[error("this is not below {}", .0.display())]
    Outside(PathBuf),
    /// The folder takes no files.
    #[error("the folder takes no files: {0}")]
    Closed(#[source] io::Error),
    /// What the system says.
    #[error("{0}")]
    System(#[source] io::Error),
    /// The writing failed, and the whole content is elsewhere.
    #[error("{why}; the whole file is kept as {}", saved_as.display())]
    Elsewhere {
        /// Where it is.
        saved_as: PathBuf,
        /// The reason why it is not at its destination.
        why: Box<Problem>,
    },
}
