//! The process around the machine: opens the lines, and runs the thread that brings them and the machine together.

mod mirror;
mod options;
mod signals;
mod turns;
mod around;

pub use around::{INTERRUPTED, Window, run};
pub use mirror::{ArcShown, MirrorRequest, FunctionShown, InputShown, Mirror, NodeShown, TrafficEntry, MirrorFrame};
pub use options::{TimeSource, ExitReason, Operator, Options};
