//! The sub-commands of `ps340`: tools for people who write programs for the machine.

mod decode;
mod lint;
mod play;
mod reference;

use clap::Subcommand;
use std::{
    io::{self, Read, Write},
    path::Path,
    process::ExitCode,
};

/// What `ps340` does beside being the machine.
#[derive(Subcommand, Debug)]
pub enum Tool {
    /// Lists a stream of a host line byte by byte: offset, bytes, meaning.
    Decode(decode::Arguments),
    /// Plays command files on a machine without a window, in virtual time, and checks what it says.
    Play(play::Arguments),
    /// Finds what is wrong in command files: names, inputs, kinds, functions that never fire.
    Lint(lint::Arguments),
    /// Tells about the functions of the machine: all in a table, or one in full.
    Functions {
        /// Which one, such as ROUTE or F:ROUTE.
        name: Option<String>,
    },
    /// Tells about the commands of the language: all in a table, or one in full.
    Commands {
        /// Which one, such as 'vector_list' or 'set picking'; may be abbreviated.
        name: Vec<String>,
    },
    /// Prints what keys of the window do, as a file for '--mapping'.
    #[cfg(feature = "window")]
    Mapping,
}

/// What went wrong while a tool ran.
#[derive(Debug, thiserror::Error)]
enum Trouble {
    /// A file cannot be read or written.
    #[error("{file}: {error}")]
    File {
        /// The file.
        file: String,
        /// What the system says.
        error: io::Error,
    },
    /// The reader of the output has gone, as `head` does; no error.
    #[error("the output is closed")]
    Closed,
    /// A picture cannot be written.
    #[error(transparent)]
    Picture(#[from] crate::picture::PictureError),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] files::WriteError),
    /// The arguments do not go together, or name something unknown.
    #[error("{0}")]
    Usage(String),
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
        Tool::Mapping => say(crate::console::DEFAULT_MAPPING).map(|()| ExitCode::SUCCESS),
    };
    match result {
        Ok(code) => code,
        Err(Trouble::Closed) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("ps340: {error}");
            ExitCode::from(if matches!(error, Trouble::Usage(_)) { 2 } else { 1 })
        }
    }
}

/// Opens a file; `-` is the standard input.
fn open(file: &Path) -> Result<Box<dyn Read>, Trouble> {
    if file.as_os_str() == "-" {
        return Ok(Box::new(io::stdin().lock()));
    }
    let opened = std::fs::File::open(file);
    Ok(Box::new(opened.map_err(|error| Trouble::File { file: file.display().to_string(), error })?))
}

/// Reads a whole file; `-` is the standard input.
fn read(file: &Path) -> Result<Vec<u8>, Trouble> {
    let mut bytes = Vec::new();
    let read = open(file)?.read_to_end(&mut bytes);
    read.map_err(|error| Trouble::File { file: file.display().to_string(), error })?;
    Ok(bytes)
}

/// Writes to the standard output.
fn say(text: &str) -> Result<(), Trouble> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(of_output)
}

/// What an error of the standard output is.
fn of_output(error: io::Error) -> Trouble {
    match error.kind() {
        io::ErrorKind::BrokenPipe => Trouble::Closed,
        _ => Trouble::File { file: "standard output".into(), error },
    }
}
