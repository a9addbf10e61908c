//! The reason why an operator command is not read, or not carried out.

/// The reason why a line is no operator command.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OperatorCommandError {
    /// The first word is unknown.
    #[error("unknown order '{word}'; {hint}'help' lists them")]
    Unknown {
        /// The word.
        word: String,
        /// A sentence about the operator command that is probably meant; empty if there is none.
        hint: String,
    },
    /// Something is missing.
    #[error("{0} is missing")]
    Missing(&'static str),
    /// Something cannot be read, or is out of range.
    #[error("'{found}' is not {expected}")]
    Bad {
        /// What stands there.
        found: String,
        /// What should.
        expected: &'static str,
    },
    /// There is no such program.
    #[error("{0}")]
    Example(String),
    /// There is more on the line.
    #[error("'{0}' is too much")]
    TooMuch(String),
}

/// The error for an operator command of a played file that reaches out.
pub(super) const REFUSED: &str = "a file that is played may not write files or end the machine without --orders";
