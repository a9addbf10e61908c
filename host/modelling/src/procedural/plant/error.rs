//! Reasons for which a plant is none.

use super::outline::OutlineError;
use super::parameters::TreeNumberError;
use crate::memory::MemoryExceeded;
use crate::procedural::VariedError;
use crate::procedural::drawing::DrawingError;

/// A reason for which a plant does not grow.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// A number that is none.
    #[error(transparent)]
    Number(#[from] TreeNumberError),
    /// More stems than there may be.
    #[error("the plant has more than {most} stems")]
    TooManyStems {
        /// How many there may be.
        most: usize,
    },
    /// What was drawn does not become triangles.
    #[error(transparent)]
    Drawing(#[from] DrawingError),
    /// More memory than is left.
    #[error(transparent)]
    Memory(#[from] MemoryExceeded),
}

/// A fault of the text of a species, with its place.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}, column {column}: {problem}")]
pub struct SpeciesError {
    /// Its line, from 1.
    pub line: usize,
    /// Its column, from 1.
    pub column: usize,
    /// What is wrong.
    pub problem: SpeciesProblem,
}

/// What is wrong with the text of a species.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpeciesProblem {
    /// The text is no TOML.
    #[error("{0}")]
    Syntax(String),
    /// A key or word that is not known.
    #[error("{what} \"{name}\" is not known; {advice}")]
    Unknown {
        /// Of what kind it should be.
        what: &'static str,
        /// The word.
        name: String,
        /// Words that it may have meant.
        advice: String,
    },
    /// A key without which there is no species.
    #[error("\"{0}\" is missing")]
    Missing(&'static str),
    /// A value of another kind.
    #[error("{key} must be {expected}")]
    Kind {
        /// Its key.
        key: String,
        /// What it must be.
        expected: &'static str,
    },
    /// A mean and deviation that are none.
    #[error("{key}: {problem}")]
    Varied {
        /// Its key.
        key: String,
        /// What is wrong.
        problem: VariedError,
    },
    /// A number of the tree.
    #[error(transparent)]
    Number(#[from] TreeNumberError),
    /// An outline that is none.
    #[error(transparent)]
    Outline(#[from] OutlineError),
}
