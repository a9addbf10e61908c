//! Boolean operations on solids that are hard on numbers: a seeded corpus, and the score of each of its cases.

mod classes;
mod scoring;
mod points;

pub use classes::{CLASSES, Class};
pub use scoring::{evaluated, score};

use host::mesh::Mesh;
use host::solid::Expression;

/// What is asked.
#[derive(Clone, Debug)]
pub enum CorpusCase {
    /// All operations on two solids.
    Pair {
        /// The solids.
        solids: [Mesh; 2],
        /// The volume of what they have in common, where that is known.
        common: Option<f64>,
    },
    /// Operations one after the other, each on the result before: against all of them at once.
    Chain(Vec<Mesh>),
    /// An expression over several solids at once.
    Tree {
        /// The solids.
        solids: Vec<Mesh>,
        /// What is made of them.
        expression: Expression,
        /// The volume of the result, where that is known.
        volume: Option<f64>,
    },
    /// The union of the first two, with coordinates of single precision, and a third.
    Single([Mesh; 3]),
    /// A surface that is not simple: it must be refused, and repaired to this volume.
    NotSimple {
        /// The surface.
        mesh: Mesh,
        /// The volume of all points with a winding number other than 0.
        volume: f64,
    },
}

/// How a case ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Score {
    /// All of it was right.
    Passed,
    /// It was not done, and why.
    Refused(String),
    /// Something was wrong.
    Wrong(String),
    /// It took too long.
    TimedOut,
    /// It panicked.
    Crashed,
}

impl Score {
    /// The word for it.
    pub fn word(&self) -> &'static str {
        match self {
            Score::Passed => "passed",
            Score::Refused(_) => "refused",
            Score::Wrong(_) => "wrong",
            Score::TimedOut => "timed out",
            Score::Crashed => "crashed",
        }
    }
}
