//! Command files played on a machine in virtual time: text for the host line, operator commands, expectations.
//!
//! A line that begins with `@` is a directive; every other line goes to the machine as it is, as if a host had sent it.
//!
//! ```text
//! ECHO := F:PRINT; CONNECT DIALS<1>:<1>ECHO; CONNECT ECHO<1>:<1>HOST_MESSAGE;
//! @ dial 1 0.1
//! @ expect '0.1'
//! SEND 'x' TO <1>NOBODY;
//! @ expect error E 2
//! @ picture vector out.png
//! ```

mod pattern;
mod player;
mod script;

pub use player::{Failure, PlayEnd, PlayOptions, Player, Watcher};
pub use script::{Expected, Script, ScriptError, ScriptLine, ScriptProblem, Step};

#[cfg(test)]
mod tests;
