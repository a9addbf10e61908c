//! A sub-command of the program, as help and dispatch need it.

use super::exit::CommandFailure;
use clap::{ArgMatches, Command};

/// A sub-command.
pub struct SubcommandRow {
    /// Its name.
    pub name: &'static str,
    /// What it does, in a sentence.
    pub summary: &'static str,
    /// Adds its arguments.
    pub arguments: fn(Command) -> Command,
    /// Runs it.
    pub run: fn(&ArgMatches) -> Result<(), CommandFailure>,
}
