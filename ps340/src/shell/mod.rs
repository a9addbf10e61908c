//! The process around the machine: opens the lines, and runs the thread that brings them and the machine together.

mod mirror;
mod options;
mod signals;
mod machine_loop;
mod lines;

pub use lines::{INTERRUPTED, Window, run};
pub use mirror::{ArcShown, FunctionShown, InputShown, Mirror, MirrorFrame, MirrorRequest, NodeShown, TrafficEntry};
pub use options::{ExitReason, Operator, Options, TimeSource};
