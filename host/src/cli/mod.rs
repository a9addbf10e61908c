//! The command line: what each sub-command takes and does.

mod cancelled;
mod exit;
mod progress;
#[macro_use]
mod say;
mod interrupts;
mod row;
mod values;
mod waits;
mod source;
mod display;
mod formula;
mod render;
mod show;
mod job;
mod compose;
mod diff;
mod plan;
mod octree;
mod study_memo;
mod study_render;
mod study;
mod tessellate;
mod convert;
mod database;
mod boolean;
mod intersect;
mod check;
mod measure;
mod continuity;
mod functions;
mod program;

pub use exit::{Exit, CommandFailure};
pub use program::{COMMANDS, command, main};
pub use row::SubcommandRow;
pub use source::{ScriptArguments, SCRIPT_HELP, load};
