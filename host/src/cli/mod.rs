//! The command line: one row for each sub-command, from which help and dispatch are derived.

#[macro_use]
mod say;
mod cancelled;
mod boolean;
mod check;
mod compose;
mod continuity;
mod convert;
mod database;
mod diff;
mod display;
mod exit;
mod formula;
mod functions;
mod interrupts;
mod intersect;
mod job;
mod measure;
mod octree;
mod plan;
mod progress;
mod render;
mod show;
mod source;
mod study;
mod study_render;
mod tessellate;
mod waits;

pub use exit::{Exit, Failure};
use source::load_lit;
pub use source::{Definitions, SCRIPT_HELP, load};
use waits::Waits;

use crate::memory;
use crate::scene::Scene;
use clap::{Arg, ArgMatches, Command};
use std::io::IsTerminal;
use std::num::NonZeroUsize;
use std::process::ExitCode;

/// Most threads that a command takes.
const MAX_THREADS: usize = 1024;
/// Which part of the machine's memory a command may take if nothing else is said: one of so many.
const PART_OF_MACHINE: u64 = 4;
/// Where options that all commands have stand in help texts: behind their own.
const LAST: usize = 900;
/// Least memory that a command may be given, bytes: less than its own code and stacks is no use.
const LEAST_MEMORY: u64 = 64 << 20;

/// A sub-command.
pub struct Row {
    /// Its name.
    pub name: &'static str,
    /// What it does, in a sentence.
    pub summary: &'static str,
    /// Adds its arguments.
    pub arguments: fn(Command) -> Command,
    /// Runs it.
    pub run: fn(&ArgMatches) -> Result<(), Failure>,
}

/// Every sub-command.
pub const COMMANDS: &[Row] = &[
    job::DEMO,
    job::RUN,
    show::ROW,
    render::ROW,
    compose::ROW,
    diff::ROW,
    plan::ROW,
    octree::ROW,
    study::ROW,
    tessellate::ROW,
    convert::ROW,
    database::ROW,
    boolean::ROW,
    intersect::ROW,
    check::ROW,
    measure::ROW,
    continuity::ROW,
    functions::ROW,
];

/// The command line as clap knows it.
pub fn command() -> Command {
    let memory = Arg::new("memory")
        .long("memory")
        .value_name("SIZE")
        .global(true)
        .display_order(LAST)
        .value_parser(bytes)
        .help("Most memory to take, such as 512M or 8G; a quarter of the machine's if not given");
    let program = Command::new("peris")
        .about("Models an environment, renders it, and shows it on a PS 340.")
        .version(env!("CARGO_PKG_VERSION"))
        .subcommand_required(true)
        .arg_required_else_help(true)
        .arg(memory)
        .after_help(exit::table());
    COMMANDS.iter().fold(program, |program, row| {
        let sub = (row.arguments)(Command::new(row.name)).about(row.summary).after_help(exit::table());
        program.subcommand(sub)
    })
}

/// Runs the program with the arguments of the process.
pub fn main() -> ExitCode {
    start_log();
    let matches = match command().try_get_matches() {
        Ok(matches) => matches,
        Err(error) => {
            // Printing fails only if nobody reads.
            let _ = error.print();
            return if error.use_stderr() { Exit::Usage.into() } else { Exit::Done.into() };
        }
    };
    let Some((name, arguments)) = matches.subcommand() else { return Exit::Usage.into() };
    let Some(row) = COMMANDS.iter().find(|row| row.name == name) else { return Exit::Usage.into() };
    progress::begin(matches!(arguments.try_get_one("json"), Ok(Some(true))));
    let asked = arguments.get_one("memory").copied();
    interrupts::begin(name, asked.or_else(|| Some(memory::machine()? / PART_OF_MACHINE)));
    let ended = (row.run)(arguments);
    progress::clear();
    match ended {
        Ok(()) => Exit::Done.into(),
        Err(failure) => {
            say::tell(&format!("peris {name}: {}", story(&failure.error)));
            failure.exit.into()
        }
    }
}

/// An error with its causes, without those that it tells itself.
fn story(error: &anyhow::Error) -> String {
    error.chain().skip(1).fold(error.to_string(), |text, cause| {
        let cause = cause.to_string();
        if text.contains(&cause) { text } else { format!("{text}: {cause}") }
    })
}

/// Says on standard error what is probably not meant.
fn warn(text: &str) {
    say::tell(&format!("warning: {text}"));
}

/// Says on standard error that a picture will be empty.
fn warn_of_emptiness(scene: &Scene) {
    if scene.objects.is_empty() {
        warn("the scene has no objects; only its background will be seen");
    }
}

/// Reads a number of threads.
fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let count = text.parse().ok().filter(|n: &NonZeroUsize| n.get() <= MAX_THREADS);
    count.ok_or_else(|| format!("give 1 to {MAX_THREADS}"))
}

/// Reads a number of bytes.
fn bytes(text: &str) -> Result<u64, String> {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match text[digits.len()..].to_ascii_uppercase().as_str() {
        "" | "B" => 0,
        "K" | "KB" | "KIB" => 10,
        "M" | "MB" | "MIB" => 20,
        "G" | "GB" | "GIB" => 30,
        "T" | "TB" | "TIB" => 40,
        _ => return Err("give a number of bytes with K, M, G or T behind it, such as 512M".into()),
    };
    let bytes = digits.parse().ok().map(|number: f64| number * 2f64.powi(unit));
    let bytes = bytes.filter(|bytes| (LEAST_MEMORY as f64..=u64::MAX as f64).contains(bytes));
    bytes
        .map(|bytes| bytes as u64)
        .ok_or_else(|| format!("give at least {}, such as 512M", memory::readable(LEAST_MEMORY)))
}

/// Reads a length above 0.
fn length(text: &str) -> Result<f64, String> {
    let length = text.parse().ok().filter(|length| *length > 0.0 && *length < f64::INFINITY);
    length.ok_or_else(|| "give a length above 0".to_string())
}

/// Reads a distance as a part of a diagonal.
fn part(text: &str) -> Result<f64, String> {
    let part = text.parse().ok().filter(|part| *part > 0.0 && *part <= 1.0);
    part.ok_or_else(|| "give a part of the diagonal, above 0 and at most 1".to_string())
}

/// Warnings go to standard error; the variable PERIS_LOG asks for more or less (for instance `PERIS_LOG=info`).
fn start_log() {
    let filter = tracing_subscriber::EnvFilter::try_from_env("PERIS_LOG")
        .unwrap_or_else(|_| tracing_subscriber::EnvFilter::new("warn"));
    let log = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal());
    log.without_time().with_target(false).init();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        command().debug_assert();
    }

    #[test]
    fn memory_is_given_in_bytes_and_their_multiples() {
        for (text, expected) in
            [("512M", 512 << 20), ("0.5GiB", 512 << 20), ("100000000", 100_000_000), ("2t", 2 << 40)]
        {
            assert_eq!(bytes(text), Ok(expected), "{text}");
        }
        for text in ["", "M", "63M", "-1G", "1X", "NaNG", "1e300G", "infT"] {
            assert!(bytes(text).is_err(), "{text}");
        }
    }

    #[test]
    fn every_command_documents_its_arguments_and_the_exit_codes() {
        for row in COMMANDS {
            let mut sub = command().find_subcommand(row.name).expect("present").clone();
            let help = sub.render_long_help().to_string();
            assert!(help.contains("130") && help.contains(row.summary), "{help}");
            for argument in sub.get_arguments() {
                assert!(argument.get_help().is_some(), "{}: {}", row.name, argument.get_id());
            }
        }
    }
}
