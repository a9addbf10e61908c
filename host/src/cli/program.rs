//! The program: one row for each sub-command, from which help and dispatch are derived.

use super::exit::{self, CommandFailure, Exit, story};
use super::subcommand::SubcommandRow;
use super::values::bytes;
use super::{
    animate, boolean, check, compose, continuity, convert, database, diff, functions, interrupts, intersect, job,
    measure, octree, output, plan, progress, render, show, study, tessellate,
};
use crate::memory;
use crate::stages::StageLayer;
use clap::{Arg, ArgMatches, Command};
use files::Destination;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use tracing_subscriber::layer::{Layer, SubscriberExt};
use tracing_subscriber::util::SubscriberInitExt;

/// The part of the machine's memory that a command may take if nothing else is said: one of so many.
const PART_OF_MACHINE: u64 = 4;
/// Where options that all commands have stand in help texts: behind their own.
const LAST: usize = 900;

/// Every sub-command.
pub const COMMANDS: &[SubcommandRow] = &[
    job::DEMO,
    job::RUN,
    show::ROW,
    render::ROW,
    animate::ROW,
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
    let profile = Arg::new("profile")
        .long("profile")
        .value_name("FILE")
        .global(true)
        .display_order(LAST)
        .value_parser(clap::value_parser!(PathBuf))
        .help("File for the time that each stage took, and its passes and rows on each thread, in the trace-event format that Perfetto and browsers show");
    let program = Command::new("peris")
        .about("Models an environment, renders it, and shows it on a PS 340.")
        .version(env!("CARGO_PKG_VERSION"))
        .subcommand_required(true)
        .arg_required_else_help(true)
        .arg(memory)
        .arg(profile)
        .after_help(exit::table());
    COMMANDS.iter().fold(program, |program, row| {
        let sub = (row.arguments)(Command::new(row.name)).about(row.summary).after_help(exit::table());
        program.subcommand(sub)
    })
}

/// Runs the program with the arguments of the process.
pub fn main() -> ExitCode {
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
    let profile = arguments.get_one::<PathBuf>("profile");
    start_log(profile.is_some());
    progress::begin(matches!(arguments.try_get_one("json"), Ok(Some(true))), profile.is_some());
    let asked = arguments.get_one("memory").copied();
    interrupts::begin(name, asked.or_else(|| Some(memory::machine()? / PART_OF_MACHINE)));
    let ended = run(row, arguments, profile.map(PathBuf::as_path));
    progress::clear();
    match ended {
        Ok(()) => Exit::Done.into(),
        Err(failure) => {
            output::write_error(&format!("peris {name}: {}", story(&failure.error)));
            failure.exit.into()
        }
    }
}

/// Runs a sub-command, and writes the profile of its stages if one is wanted, however it ended.
fn run(row: &SubcommandRow, arguments: &ArgMatches, profile: Option<&Path>) -> Result<(), CommandFailure> {
    let profile = profile.map(Destination::of).transpose()?;
    let ended = (row.run)(arguments);
    let written = profile.map_or(Ok(()), |file| file.write(|to| progress::write_profile(to)));
    ended.and(written.map_err(CommandFailure::from))
}

/// Warnings go to standard error; the variable PERIS_LOG asks for more or less (for instance `PERIS_LOG=info`).
///
/// Stages go to the line on the terminal and to their record.
///
/// - `profiles`: whether passes and rows are wanted, too.
fn start_log(profiles: bool) {
    let filter = tracing_subscriber::EnvFilter::try_from_env("PERIS_LOG")
        .unwrap_or_else(|_| tracing_subscriber::EnvFilter::new("warn"));
    let log = tracing_subscriber::fmt::layer()
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .without_time()
        .with_target(false)
        .with_filter(filter);
    tracing_subscriber::registry().with(log).with(StageLayer::new(progress::observe, profiles).filtered()).init();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        command().debug_assert();
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
