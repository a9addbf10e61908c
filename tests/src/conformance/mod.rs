//! The conformance suite: cases as text files, and a runner that proves them over the wire on any machine.
//!
//! `protocol/CONFORMANCE.md` describes the files and how to run them.

pub mod case;
pub mod parse;
pub mod compare;
pub mod walk;
pub mod form;
pub mod line;
pub mod mutation;
pub mod person;
pub mod strokes;
pub mod session;
pub mod report;
pub mod suite;

pub use case::{Case, Expected, Step, StrokeLine, Tag};
pub use form::{Form, Packets, Transport};
pub use line::Line;
pub use parse::{CaseError, parse};
pub use person::{Operator, OperatorLine, Person};
pub use report::{Outcome, Report, Verdict};
pub use session::{Failure, Session, Target};
pub use suite::{read_folder, run};

/// The folder with the files of cases that belong to this source tree.
pub fn cases_folder() -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance")
}
