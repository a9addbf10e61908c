//! What can be wrong with a database, and where.

use super::{LONGEST_NAME, MAX_RECORD, RecordKind};
use crate::mesh::MeshError;
use crate::picture::PictureError;
use std::path::PathBuf;

/// What is wrong with a database, with a record, or with a file from which one is made.
#[derive(Debug, thiserror::Error)]
pub enum DatabaseError {
    /// The file system refused.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file of a record cannot be written.
    #[error(transparent)]
    Write(#[from] files::WriteError),
    /// Another process writes to it.
    #[error("{}: another process writes to this database; try again when it has ended", path.display())]
    Busy {
        /// The file.
        path: PathBuf,
    },
    /// Another process reads or writes it in a way that cannot be shared.
    #[error("{}: another process uses this database with another version of the program; end it first", path.display())]
    Shared {
        /// The file.
        path: PathBuf,
    },
    /// Something else.
    #[error("{}: not a database of PERIS: {why}", path.display())]
    Other {
        /// The file.
        path: PathBuf,
        /// What is wrong, in words.
        why: String,
    },
    /// Its structure is damaged.
    #[error("{}: the database is damaged: {what}; `peris db check` tells which records are whole", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What was found.
        what: String,
    },
    /// It was left by a crash, and cannot be put in order where it is.
    #[error("{}: a process that wrote to this database was ended; open it once where it can be written, so that it is put in order", path.display())]
    Disorder {
        /// The file.
        path: PathBuf,
    },
    /// A later program wrote it.
    #[error("{what} has the form {found}; this program knows forms up to {known}. Use a later one")]
    Newer {
        /// What.
        what: String,
        /// Its form.
        found: u64,
        /// The latest form that is known.
        known: u64,
    },
    /// No such record.
    #[error("no {kind} is called \"{name}\"; {advice}")]
    Unknown {
        /// What was looked for.
        kind: String,
        /// Its name.
        name: String,
        /// What it may have meant, or the names that there are.
        advice: String,
    },
    /// There is such a record already.
    #[error("there is a {kind} \"{name}\" already")]
    Exists {
        /// What.
        kind: RecordKind,
        /// Its name.
        name: String,
    },
    /// A name that is none.
    #[error(
        "the name {0:?} is empty, longer than {LONGEST_NAME} bytes, begins or ends with a blank, or holds a control character"
    )]
    Name(String),
    /// A record that is larger than one may be.
    #[error("{kind} \"{name}\": larger than {MAX_RECORD} bytes")]
    TooLarge {
        /// What.
        kind: RecordKind,
        /// Its name.
        name: String,
    },
    /// A record that is damaged or impossible.
    #[error("{kind} \"{name}\": {problem}")]
    Record {
        /// What.
        kind: RecordKind,
        /// Its name.
        name: String,
        /// What is wrong.
        problem: String,
    },
    /// A file that gives no record, or cannot hold one.
    #[error("{}: {problem}", path.display())]
    Exchange {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// A mesh file.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A picture file.
    #[error(transparent)]
    Picture(#[from] PictureError),
}
