//! The tools by their names, and how each is run.

use super::{decode, error::ToolError, lint, play, reference};
use clap::Subcommand;
use std::process::ExitCode;

/// What `ps340` does beside being the machine.
#[derive(Subcommand, Debug)]
pub enum Tool {
    /// Lists a stream of a host line byte by byte: offset, bytes, meaning.
    Decode(decode::DecodeArguments),
    /// Plays command files on a machine without a window, in virtual time, and checks what it says.
    Play(play::PlayArguments),
    /// Finds what is wrong in command files: names, inputs, kinds, functions that never fire.
    Lint(lint::LintArguments),
    /// Tells about the functions of the machine: all in a table, or one in full.
    Functions {
        /// The function to explain, such as ROUTE or F:ROUTE; without it, all are listed.
        name: Option<String>,
    },
    /// Tells about the commands of the language: all in a table, or one in full.
    Commands {
        /// The command to explain, such as 'vector_list' or 'set picking'; may be abbreviated; without it, all are listed.
        name: Vec<String>,
    },
    /// Prints what keys of the window do, as a file for '--mapping'.
    #[cfg(feature = "window")]
    Mapping,
}

/// Runs a tool and returns the exit code: 0 fine, 1 something was found or failed, 2 usage, 130 interrupted.
pub fn run(tool: &Tool) -> ExitCode {
    let result = match tool {
        Tool::Decode(arguments) => decode::run(arguments),
        Tool::Play(arguments) => play::run(arguments),
        Tool::Lint(arguments) => lint::run(arguments),
        Tool::Functions { name } => reference::functions(name.as_deref()),
        Tool::Commands { name } => reference::commands(name),
        #[cfg(feature = "window")]
        Tool::Mapping => super::error::print(crate::console::DEFAULT_MAPPING).map(|()| ExitCode::SUCCESS),
    };
    match result {
        Ok(code) => code,
        Err(ToolError::Closed) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("ps340: {error}");
            ExitCode::from(if matches!(error, ToolError::Usage(_)) { 2 } else { 1 })
        }
    }
}
