//! `ps340 play`: command files on a machine in virtual time, with pictures, a transcript and an exit code.

use super::error::{ToolError, print, read};
use crate::{
    example::{EXAMPLES, example},
    machine::Settings,
    picture::Picture,
    play::{PlayEnd, PlayOptions, Player, Script, Watcher},
};
use files::{Destination, LogFile, Sandbox};
use std::{
    io::{self, BufWriter, IsTerminal, Write},
    path::PathBuf,
    process::ExitCode,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

/// How often the progress on a terminal changes.
const PROGRESS: Duration = Duration::from_millis(200);

/// Arguments of `play`.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Lines that begin with '@' are directives, all others go to the machine:
  @ ORDER                    any order of the operator, such as: dial 1 0.1, key 2, picture vector a.png
  @ expect 'TEXT'            the next message to the host is TEXT
  @ expect /PATTERN*/        ... is as the pattern says, in which * is any text
  @ expect NUMBER [TOL]      ... is a number, TOL away at most
  @ expect typed 'TEXT\\r'    the keyboard, in the terminal's mode, sends TEXT to the host
  @ expect error E 5 ...     the next error of the machine begins so (W and I: warnings, informations)
  @ expect none [FRAMES]     no message comes
  @ # ...                    a comment
'within FRAMES' behind the first four changes how long they wait. Messages to the host go to standard output.
Exit codes: 0 all came as expected, 1 a step failed or an error came that no step expected, 2 usage, 130 interrupted.")]
pub struct PlayArguments {
    /// Command files, played one after the other on one machine; '-' is the standard input.
    #[arg(required_unless_present_any = ["example", "list"])]
    files: Vec<PathBuf>,
    /// Plays a program that ships with the machine, before the files.
    #[arg(long, value_name = "NAME")]
    example: Option<String>,
    /// Lists the programs that ship with the machine.
    #[arg(long)]
    list: bool,
    /// Prints the program of --example instead of playing it.
    #[arg(long, requires = "example")]
    print: bool,
    /// Lets frames pass behind the last line (60 are a second).
    #[arg(long, value_name = "N", default_value_t = 1)]
    frames: u64,
    /// Writes the vector screen as it is at the end, PNG or EXR.
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Writes what was sent and said: > text, @ directive, = reply, < message to the host, ! message of the machine.
    /// The file is FILE.part until the end, and stays so if the run is interrupted.
    #[arg(long, value_name = "FILE")]
    transcript: Option<PathBuf>,
    /// Lets directives write files and end the machine, such as '@ picture vector a.png' and '@ quit'; 'ps340 lint'
    /// lists them.
    #[arg(long)]
    orders: bool,
    /// The folder below which directives write files.
    #[arg(long = "files", value_name = "DIR", default_value = ".")]
    below: PathBuf,
    /// Frames that an expectation waits, if it does not say.
    #[arg(long, value_name = "N", default_value_t = 60)]
    patience: u64,
    /// Goes on after a failed step, and forgives errors of the machine that no step expected.
    #[arg(long)]
    keep_going: bool,
    /// Says nothing but failures.
    #[arg(short, long)]
    quiet: bool,
}

/// Plays the files.
pub(super) fn run(arguments: &PlayArguments) -> Result<ExitCode, ToolError> {
    if arguments.list {
        let lines = EXAMPLES.iter().map(|e| format!("{:<8} {}\n", e.name, e.summary()));
        return print(&lines.collect::<String>()).map(|()| ExitCode::SUCCESS);
    }
    let chosen = arguments.example.as_deref().map(example).transpose().map_err(ToolError::Usage)?;
    if let Some(chosen) = chosen.filter(|_| arguments.print) {
        return print(chosen.text).map(|()| ExitCode::SUCCESS);
    }
    let mut scripts = Vec::new();
    let mut readable = true;
    let mut add = |file: &str, bytes: &[u8]| match Script::read(file, bytes) {
        Ok(script) => scripts.push(script),
        Err(errors) => {
            readable = false;
            errors.iter().for_each(|error| eprintln!("{error}"));
        }
    };
    if let Some(chosen) = chosen {
        add(chosen.name, chosen.text.as_bytes());
    }
    for file in &arguments.files {
        add(&file.display().to_string(), &read(file)?);
    }
    if !readable {
        return Ok(ExitCode::from(2));
    }
    let picture = arguments.picture.as_deref().map(Picture::destination).transpose()?;
    let options = PlayOptions { frames: arguments.patience, keep_going: arguments.keep_going };
    let below = || {
        let folder = &arguments.below;
        Sandbox::open(folder).map_err(|error| ToolError::File { file: folder.display().to_string(), error })
    };
    let files = arguments.orders.then(below).transpose()?;
    let mut player = Player::new(Settings::default(), options, files);
    let mut screen = Transcript::new(arguments, &scripts)?;
    let end = play(&mut player, &scripts, arguments.frames, &mut screen);
    screen.clear();
    finish(&mut player, end, arguments, picture.as_ref(), screen)
}

fn play(player: &mut Player, scripts: &[Script], frames: u64, screen: &mut Transcript) -> PlayEnd {
    for script in scripts {
        match player.play(script, screen) {
            PlayEnd::Played => {}
            end => return end,
        }
    }
    let end = player.wait(frames, screen);
    player.hang_up(screen);
    end
}

/// Writes what is to be left at the end, and returns the exit code.
fn finish(
    player: &mut Player,
    end: PlayEnd,
    arguments: &PlayArguments,
    picture: Option<&Destination>,
    screen: Transcript,
) -> Result<ExitCode, ToolError> {
    // What an interrupted run leaves takes no older file's place.
    let is_whole = end != PlayEnd::Stopped;
    if let Some(file) = picture.filter(|_| is_whole) {
        player.machine().vector_picture(None).write(file)?;
    }
    screen.close(is_whole)?;
    let failures = player.take_failures();
    for failure in &failures {
        eprintln!("{failure}");
    }
    if !arguments.quiet {
        let counters = player.machine().counters();
        let (errors, steps, frame) = (failures.len(), player.steps(), player.machine().frame());
        eprintln!(
            "{} commands, {frame} frames, {} messages to the host, {steps} expectations, {errors} failures",
            counters.commands, counters.messages_out
        );
    }
    Ok(match end {
        PlayEnd::Stopped => ExitCode::from(130),
        _ if failures.is_empty() => ExitCode::SUCCESS,
        _ => ExitCode::from(1),
    })
}

/// Where the log goes: standard output, the transcript, progress on a terminal.
struct Transcript {
    transcript: Option<BufWriter<LogFile>>,
    /// The first error of the transcript; it is reported at the end.
    broken: Option<io::Error>,
    quiet: bool,
    /// Lines of all files, for the progress; none if there is no terminal.
    progress: Option<usize>,
    shown: Instant,
    interrupted: Arc<AtomicBool>,
}

impl Transcript {
    fn new(arguments: &PlayArguments, scripts: &[Script]) -> Result<Transcript, ToolError> {
        let transcript = arguments.transcript.as_ref().map(|path| LogFile::create(Destination::of(path)?));
        let lines = scripts.iter().map(|script| script.lines.len()).sum();
        let interrupted = Arc::new(AtomicBool::new(false));
        watch_interrupt(interrupted.clone());
        Ok(Transcript {
            transcript: transcript.transpose()?.map(BufWriter::new),
            broken: None,
            quiet: arguments.quiet,
            progress: (!arguments.quiet && io::stderr().is_terminal()).then_some(lines),
            shown: Instant::now(),
            interrupted,
        })
    }

    /// Takes the progress off the terminal.
    fn clear(&self) {
        if self.progress.is_some() {
            eprint!("\r\x1b[K");
        }
    }

    /// Ends the transcript; one that is not whole stays beside its name.
    fn close(mut self, is_whole: bool) -> Result<(), ToolError> {
        let Some(transcript) = self.transcript.take() else { return Ok(()) };
        let file = transcript.get_ref().part().display().to_string();
        let written = match self.broken {
            Some(error) => Err(error),
            None => transcript.into_inner().map_err(io::IntoInnerError::into_error),
        };
        let log = written.map_err(|error| ToolError::File { file: file.clone(), error })?;
        if is_whole {
            return Ok(log.finish()?);
        }
        eprintln!("interrupted: the transcript so far is in {file}");
        Ok(())
    }
}

impl Watcher for Transcript {
    fn log(&mut self, sign: char, text: &[u8]) {
        if let Some(transcript) = &mut self.transcript
            && self.broken.is_none()
        {
            let written = write!(transcript, "{sign} ").and_then(|()| transcript.write_all(text));
            self.broken = written.and_then(|()| writeln!(transcript)).err();
        }
        let shown = sign == '<' || (sign == '=' && text != b"ok");
        if !self.quiet && (shown || sign == '!') {
            self.clear();
            // A reader that has gone is no reason to end the run.
            let text = String::from_utf8_lossy(text);
            let _ = match sign {
                '!' => writeln!(io::stderr().lock(), "{text}"),
                _ => writeln!(io::stdout().lock(), "{text}"),
            };
        }
    }

    fn stops(&mut self, file: &str, line: usize, frame: u64) -> bool {
        if let Some(lines) = self.progress.filter(|_| self.shown.elapsed() >= PROGRESS) {
            self.shown = Instant::now();
            eprint!("\r\x1b[K{file}:{line} of {lines} lines, frame {frame}");
        }
        self.interrupted.load(Ordering::Relaxed)
    }
}

/// Sets a flag at Ctrl-C; a second Ctrl-C ends the process at once.
fn watch_interrupt(flag: Arc<AtomicBool>) {
    let Ok(runtime) = tokio::runtime::Builder::new_current_thread().enable_all().build() else { return };
    std::thread::spawn(move || {
        runtime.block_on(async {
            while tokio::signal::ctrl_c().await.is_ok() {
                if flag.swap(true, Ordering::Relaxed) {
                    std::process::exit(130);
                }
            }
        });
    });
}
