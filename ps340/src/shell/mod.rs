//! The process around the machine: opens the lines, and runs the thread that brings them and the machine together.

mod mirror;
mod options;
mod signals;
mod turns;
mod around;

pub use around::{INTERRUPTED, Window, run};
pub use mirror::{ArcShown, Asked, FunctionShown, InputShown, Mirror, NodeShown, Passed, Shown};
pub use options::{Clock, End, Operator, Options};
