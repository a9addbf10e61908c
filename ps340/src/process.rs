//! The process `ps340`: arguments, log and exit codes around the shell.

use crate::{
    line::Address,
    machine::{PlainText, Settings},
    shell::{Clock, End, Operator, Options, run},
};
use clap::{Parser, Subcommand};
use protocol::command::reference;
use std::{
    io::{IsTerminal, Write},
    process::ExitCode,
};

/// An emulator of the Evans & Sutherland PS 340 graphics workstation.
///
/// Hosts attach to the host line and send command text or packets; see PROTOCOL.md. An operator turns dials,
/// presses keys and takes pictures by text lines; give 'help' to the operator line for the list.
#[derive(Parser, Debug)]
#[command(
    version,
    after_help = "Exit codes: 0 ended by 'quit' or with the operator on standard input, 1 cannot listen,\n\
                                 2 usage, 130 interrupted by a signal.\n\
                                 The environment variable PS340_LOG sets what is logged on standard error \
                                 (e.g. 'debug', 'warn')."
)]
#[command(args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(subcommand)]
    subject: Option<Subject>,
    /// Where hosts attach: tcp:HOST:PORT (port 0 takes a free one) or unix:PATH. May be given several times.
    #[arg(long, value_name = "ADDRESS", default_value = "tcp:127.0.0.1:3400")]
    listen: Vec<Address>,
    /// Who gives orders: stdio, none, or an address to listen on. By default stdio if that is a terminal, else none.
    #[arg(long, value_name = "stdio|none|ADDRESS")]
    operator: Option<String>,
    /// Where time comes from.
    #[arg(long, value_enum, default_value = "real")]
    clock: Clock,
    /// Who gets text that arrives outside packets: the command interpreter, or the terminal emulator.
    #[arg(long, value_enum, default_value = "commands")]
    plain_text: PlainText,
    /// Threads that draw; all cores by default.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

/// What to tell instead of starting the machine.
#[derive(Subcommand, Debug)]
enum Subject {
    /// Tells about the commands of the language: all in a table, or one in full.
    Commands {
        /// Which one, such as 'vector_list' or 'set picking'; may be abbreviated.
        name: Vec<String>,
    },
}

/// Tells about the commands on standard output; a reader that goes away early is no failure.
fn tell_commands(name: &[String]) -> ExitCode {
    let text = if name.is_empty() {
        Ok(reference::list())
    } else {
        let rows = reference::find(&name.join(" "));
        rows.map(|rows| rows.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
    };
    match text {
        Ok(text) => {
            let _ = std::io::stdout().lock().write_all(text.as_bytes());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("ps340: {error}");
            ExitCode::from(2)
        }
    }
}

/// Reads the arguments, runs the machine, and returns the exit code.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if let Some(Subject::Commands { name }) = &arguments.subject {
        return tell_commands(name);
    }
    let filter = tracing_subscriber::EnvFilter::try_from_env("PS340_LOG");
    tracing_subscriber::fmt()
        .with_env_filter(filter.unwrap_or_else(|_| tracing_subscriber::EnvFilter::new("info")))
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .with_target(false)
        .without_time()
        .init();
    if let Some(threads) = arguments.threads
        && let Err(error) = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()
    {
        eprintln!("ps340: {error}");
        return ExitCode::from(1);
    }
    let operator = match arguments.operator.as_deref() {
        None if std::io::stdin().is_terminal() => Operator::Stdio,
        None | Some("none") => Operator::None,
        Some("stdio") => Operator::Stdio,
        Some(address) => match address.parse() {
            Ok(address) => Operator::Socket(address),
            Err(error) => {
                eprintln!("ps340: {error}");
                return ExitCode::from(2);
            }
        },
    };
    let settings = Settings { plain_text: arguments.plain_text };
    let options = Options { listen: arguments.listen, operator, clock: arguments.clock, settings };
    let say = |line: &str| {
        let mut out = std::io::stdout().lock();
        let _ = writeln!(out, "{line}").and_then(|()| out.flush());
    };
    match run(&options, say) {
        Ok(End::Quit) => ExitCode::SUCCESS,
        Ok(End::Interrupted) => ExitCode::from(130),
        Err(error) => {
            eprintln!("ps340: {error}");
            ExitCode::from(1)
        }
    }
}
