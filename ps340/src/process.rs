//! The process `ps340`: arguments, log and exit codes around the shell.

#[cfg(feature = "window")]
use crate::{calligraphic::Choice, console};
use crate::{
    cli,
    line::LineAddress,
    machine::{KeyboardMode, PlainText, Settings},
    shell::{ExitReason, INTERRUPTED, Operator, Options, TimeSource, run},
};
use clap::Parser;
use protocol::address::Endpoint;
use std::{
    io::{IsTerminal, Write},
    path::PathBuf,
    process::ExitCode,
};

/// An emulator of the Evans & Sutherland PS 340 graphics workstation.
///
/// Hosts attach to the host line and send command text or packets; see PROTOCOL.md. An operator turns dials,
/// presses keys and takes pictures by text lines; give 'help' to the operator line for the list.
#[derive(Parser, Debug)]
#[command(
    version,
    args_conflicts_with_subcommands = true,
    after_help = "Lines: tcp:HOST:PORT (port 0 takes a free one), unix:PATH, pty: (a pseudo-terminal; its path is printed),\n\
                  serial:DEVICE[,BAUD[,8N1]], stdio:, file:PATH (a plain or captured file that is sent as a host would),\n\
                  parallel:HOST:PORT (the words of the parallel interface, see PARALLEL.md).\n\
                  Conditions behind a line: ,speed=BITS_A_SECOND ,flow=xonxoff ,bits=7; behind file: ,pace=captured.\n\n\
                  Exit codes: 0 ended by 'quit' or with the operator on standard input, 1 cannot listen,\n\
                                 2 usage, 130 interrupted by a signal.\n\
                                 The environment variable PS340_LOG sets what is logged on standard error \
                                 (e.g. 'debug', 'warn')."
)]
struct Arguments {
    #[command(subcommand)]
    tool: Option<cli::Tool>,
    /// Where hosts attach, see below. May be given several times.
    #[arg(long, value_name = "LINE", default_value = "tcp:127.0.0.1:3400")]
    listen: Vec<LineAddress>,
    /// Writes what passes on all host lines, and what the operator does, to a file; 'file:FILE,pace=captured' plays it
    /// again. The file is FILE.part until the machine ends.
    #[arg(long, value_name = "FILE")]
    capture: Option<PathBuf>,
    /// Who gives orders: stdio, none, or an address to listen on. By default stdio if that is a terminal, else none.
    /// A Unix socket takes orders of its owner. Over TCP the first line must be 'token TOKEN', with the token of the
    /// environment variable PS340_TOKEN, or else the one that is printed at the start.
    #[arg(long, value_name = "stdio|none|ADDRESS")]
    operator: Option<String>,
    /// The folder below which the operator's orders write files; no name and no link leads out of it.
    #[arg(long, value_name = "DIR", default_value = ".")]
    files: PathBuf,
    /// Lets captures that are played write files and end the machine, as an operator may. Without it they use devices
    /// only.
    #[arg(long)]
    orders: bool,
    /// Lets it listen where other computers reach it. Whoever does can use the machine.
    #[arg(long)]
    public: bool,
    /// Where time comes from.
    #[arg(long, value_enum, default_value = "real")]
    clock: TimeSource,
    /// Who gets text that arrives outside packets: the command interpreter, or the terminal emulator.
    #[arg(long, value_enum, default_value = "commands")]
    plain_text: PlainText,
    /// Where typed characters go at the start: to the host as from a terminal, to the command interpreter, or to the
    /// function network. By default to the network; with '--plain-text terminal' to the host.
    #[arg(long, value_enum)]
    keyboard: Option<KeyboardMode>,
    /// Opens a window with both screens and all devices.
    #[cfg(feature = "window")]
    #[arg(long)]
    window: bool,
    /// Who draws the light of the vector screen.
    #[cfg(feature = "window")]
    #[arg(long, value_enum, default_value = "auto")]
    beam: Choice,
    /// Changes what keys of the window do; 'ps340 mapping' prints the table that is in force without a file.
    #[cfg(feature = "window")]
    #[arg(long, value_name = "FILE", requires = "window")]
    mapping: Option<PathBuf>,
    /// Pixels per unit of the window, instead of what the display says.
    #[cfg(feature = "window")]
    #[arg(long, value_name = "N", requires = "window", value_parser = scale)]
    scale: Option<f32>,
    /// Ends at once when the program that started it ends, even if that is killed. For programs that have a PS 340 of
    /// their own; what else is there to clean up stays. Only on Linux.
    #[arg(long)]
    with_parent: bool,
    /// Threads that draw; all cores by default.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

/// Reads the arguments, runs the machine, and returns the exit code.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if let Some(tool) = &arguments.tool {
        return cli::run(tool);
    }
    start_log();
    let ended = set_up(&arguments).and_then(|()| serve(arguments));
    match ended {
        Ok(ExitReason::Quit) => ExitCode::SUCCESS,
        Ok(ExitReason::Interrupted) => ExitCode::from(INTERRUPTED as u8),
        Err(Failure { code, message }) => {
            eprintln!("ps340: {message}");
            ExitCode::from(code)
        }
    }
}

/// The reason for which the process ends without a machine, or with one that failed.
struct Failure {
    code: u8,
    message: String,
}

impl Failure {
    /// Something cannot be had.
    fn failed(message: impl ToString) -> Failure {
        Failure { code: 1, message: message.to_string() }
    }

    /// The arguments are wrong.
    fn usage(message: impl ToString) -> Failure {
        Failure { code: 2, message: message.to_string() }
    }
}

fn start_log() {
    let filter = tracing_subscriber::EnvFilter::try_from_env("PS340_LOG");
    tracing_subscriber::fmt()
        .with_env_filter(filter.unwrap_or_else(|_| tracing_subscriber::EnvFilter::new("warn,ps340=info")))
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .with_target(false)
        .without_time()
        .init();
}

/// Sets up what holds for the whole process.
fn set_up(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.with_parent {
        processes::end_with_parent().map_err(|error| Failure::failed(format!("--with-parent: {error}")))?;
    }
    if let Some(threads) = arguments.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global().map_err(Failure::failed)?;
    }
    Ok(())
}

/// Who gives orders.
///
/// - `stdio_lines`: how many hosts have the standard streams.
fn operator(asked: Option<&str>, stdio_lines: usize) -> Result<Operator, Failure> {
    let operator = match asked {
        None if std::io::stdin().is_terminal() && stdio_lines == 0 => Operator::Stdio,
        None | Some("none") => Operator::None,
        Some("stdio") => Operator::Stdio,
        Some(address) => Operator::Socket(address.parse().map_err(Failure::usage)?),
    };
    match stdio_lines + usize::from(operator == Operator::Stdio) {
        0 | 1 => Ok(operator),
        _ => Err(Failure::usage("the standard streams serve one host, or the operator")),
    }
}

/// Runs the machine until it ends.
fn serve(arguments: Arguments) -> Result<ExitReason, Failure> {
    let listen = arguments.listen;
    let stdio_lines = listen.iter().filter(|line| line.endpoint == Endpoint::Stdio).count();
    let operator = operator(arguments.operator.as_deref(), stdio_lines)?;
    let usual = match arguments.plain_text {
        PlainText::Commands => KeyboardMode::Interactive,
        PlainText::Terminal => KeyboardMode::Terminal,
    };
    let settings = Settings { plain_text: arguments.plain_text, keyboard: arguments.keyboard.unwrap_or(usual) };
    #[cfg(feature = "window")]
    let drawer =
        arguments.beam.drawer(arguments.window).map_err(|error| Failure::failed(format!("--beam gpu: {error}")))?;
    #[cfg(not(feature = "window"))]
    let drawer = crate::calligraphic::Drawer::Processor;
    let options = Options {
        listen,
        capture: arguments.capture,
        operator,
        clock: arguments.clock,
        replays_operator: arguments.orders,
        files: arguments.files,
        public: arguments.public,
        settings,
        drawer,
    };
    // What is not for a host must not stand in its stream.
    let say = |line: &str| match stdio_lines {
        0 => {
            let mut out = std::io::stdout().lock();
            let _ = writeln!(out, "{line}").and_then(|()| out.flush());
        }
        _ => eprintln!("{line}"),
    };
    #[cfg(feature = "window")]
    if arguments.window {
        let appearance = appearance(arguments.mapping.as_deref(), arguments.scale).map_err(Failure::usage)?;
        return console::open(&options, appearance, say).map_err(Failure::failed);
    }
    run(&options, None, say).map_err(Failure::failed)
}

/// How the window begins.
///
/// # Errors
/// The file that cannot be read, or the line of it that is wrong.
#[cfg(feature = "window")]
fn appearance(mapping: Option<&std::path::Path>, scale: Option<f32>) -> Result<console::Appearance, String> {
    let mut appearance = console::Appearance { scale, ..Default::default() };
    if let Some(file) = mapping {
        let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
        appearance.mapping.read(&text).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    Ok(appearance)
}

/// Reads the argument of `--scale`.
#[cfg(feature = "window")]
fn scale(text: &str) -> Result<f32, String> {
    let scale = text.parse().ok().filter(|scale| (0.25..=8.0).contains(scale));
    scale.ok_or_else(|| "not a number from 0.25 to 8".into())
}
