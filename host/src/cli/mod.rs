//! The command line: what each sub-command takes and does.

mod cancelled;
mod exit;
mod progress;
#[macro_use]
mod output;
mod interrupts;
mod subcommand;
mod values;
mod timeouts;
mod source;
mod display;
mod rendering_arguments;
mod rendering;
mod formula;
mod render;
mod animate;
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

pub use exit::{CommandFailure, Exit};
pub use program::{COMMANDS, command, main};
pub use source::{SCRIPT_HELP, ScriptArguments, load};
pub use subcommand::SubcommandRow;
