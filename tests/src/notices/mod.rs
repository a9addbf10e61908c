//! What the licences of other crates ask to be passed on with a program: which crates, under which terms, and their
//! texts.

mod crates;
mod print;
mod terms;
mod texts;

pub use crates::{Locked, carried};
pub use print::print;

/// Where the notices are, from the root of the workspace.
pub const PATH: &str = ".cargo/licences/CRATES.md";

/// The reason why the notices cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum NoticesError {
    /// A file cannot be read.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: std::path::PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file or an answer is not of the form that is expected.
    #[error("{what}: {problem}")]
    Form {
        /// What could not be read.
        what: String,
        /// What is wrong.
        problem: String,
    },
    /// No licence that is allowed is enough for a crate.
    #[error("{name}: none of the licences in .cargo/deny.toml is enough for {licence:?}")]
    Terms {
        /// The crate.
        name: String,
        /// What it offers.
        licence: String,
    },
}

/// Reads a text.
fn read(path: &std::path::Path) -> Result<String, NoticesError> {
    std::fs::read_to_string(path).map_err(|source| NoticesError::File { path: path.into(), source })
}

/// Reads a file of TOML.
fn read_toml(path: &std::path::Path) -> Result<toml_edit::DocumentMut, NoticesError> {
    read(path)?.parse().map_err(|error: toml_edit::TomlError| NoticesError::Form {
        what: path.display().to_string(),
        problem: error.to_string(),
    })
}
