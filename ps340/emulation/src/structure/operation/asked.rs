//! What operate nodes ask of the walk.

use protocol::{Name, command::Rate};

/// What an operate node asks of the walk that comes to it, beside what it does to the state: the walk knows the time
/// and what somebody waits for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Asked<'a> {
    /// Nothing.
    Nothing,
    /// To set the phase.
    Phase {
        /// The lengths of the phases.
        rate: &'a Rate,
        /// The frame from which they are counted.
        since: u64,
    },
    /// To add a pick identifier to those on the way.
    Identifier(&'a Name),
    /// To keep the matrix, if somebody waits for it.
    Matrix,
    /// To gather the vectors below, if somebody waits for them.
    Vectors,
    /// To mark the strokes below, if somebody waits for them.
    Strokes,
    /// To begin a rendering, if this node is to be rendered.
    Rendering,
}
