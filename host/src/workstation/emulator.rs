//! A PS 340 process of our own: started when no line is given, and ended with us.

use super::{Timeouts, WorkstationError};
use protocol::address::Address;
use std::{
    env,
    io::{BufRead, BufReader, Read, Write},
    os::unix::process::CommandExt,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::mpsc,
    time::{Duration, Instant},
};

/// The environment variable that says where the program `ps340` is.
pub const PROGRAM_VARIABLE: &str = "PERIS_PS340";
/// How long a process that was told to quit may take before it is killed.
const QUIT_TIME: Duration = Duration::from_secs(2);

/// A running `ps340` and its operator line.
#[derive(Debug)]
pub struct Emulator {
    child: Child,
    commands: mpsc::Sender<String>,
    timeouts: Timeouts,
    replies: mpsc::Receiver<String>,
    line: Address,
    has_window: bool,
}

impl Emulator {
    /// Starts `ps340`: the program named by [`PROGRAM_VARIABLE`], or the one beside this program, or the one on the
    /// search path. It listens on a free local port, and ends when we do: when this is dropped, and at the latest when
    /// the thread that called this, or its process, ends.
    ///
    /// - `timeouts`: how long it may take to get ready, and to carry out operator commands.
    /// - `files`: the folder below which operator commands write files.
    /// - `window`: whether it opens one, with both screens and all devices.
    ///
    /// # Errors
    /// [`WorkstationError::Start`] names the program.
    pub fn start(timeouts: Timeouts, files: &Path, window: bool) -> Result<Emulator, WorkstationError> {
        let program = program();
        let error = |e: std::io::Error| WorkstationError::Start { program: program.clone(), reason: e.to_string() };
        let mut child = Command::new(&program)
            .args(["--listen", "tcp:127.0.0.1:0", "--operator", "stdio", "--with-parent", "--files"])
            .arg(files)
            .args(window.then_some("--window"))
            // A group of its own: Ctrl-C on the terminal is ours to answer, and ends it through us.
            .process_group(0)
            .env("PS340_LOG", env::var("PS340_LOG").unwrap_or_else(|_| "warn".into()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(error)?;
        let (Some(orders), Some(replies)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(error(std::io::ErrorKind::BrokenPipe.into()));
        };
        let (orders, replies) = (write_lines(orders), read_lines(replies));
        let line = match until_ready(&replies, timeouts.attach) {
            Ok(line) => line,
            Err(reason) => {
                // Nobody else would end it while this process lives.
                let _ = child.kill();
                let _ = child.wait();
                return Err(error(std::io::Error::other(reason)));
            }
        };
        Ok(Emulator { child, commands: orders, timeouts, replies, line, has_window: window })
    }

    /// Where its host line is.
    pub fn line(&self) -> &Address {
        &self.line
    }

    /// Whether it has a window of its own.
    pub fn has_window(&self) -> bool {
        self.has_window
    }

    /// Its process number.
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// Whether it ended by itself as it was asked to, as by closing its window.
    pub fn has_quit(&mut self) -> bool {
        let end = Instant::now() + QUIT_TIME;
        loop {
            match self.child.try_wait() {
                Ok(None) if Instant::now() < end => std::thread::sleep(Duration::from_millis(5)),
                Ok(status) => return status.is_some_and(|status| status.success()),
                Err(_) => return false,
            }
        }
    }

    /// Sends an operator command, and returns the reply without its `ok`.
    ///
    /// # Errors
    /// [`WorkstationError::OperatorCommand`] if the command is refused, [`WorkstationError::Timeout`] if there is no
    /// reply within [`Timeouts::operator_command`], [`WorkstationError::Ended`] if the process is gone.
    pub fn operator_command(&mut self, order: &str) -> Result<String, WorkstationError> {
        self.send_operator_command(order)?;
        match self.replies.recv_timeout(self.timeouts.operator_command) {
            Ok(reply) => understood(order, &reply),
            Err(mpsc::RecvTimeoutError::Disconnected) => Err(WorkstationError::Ended),
            Err(mpsc::RecvTimeoutError::Timeout) => {
                let seconds = self.timeouts.operator_command.as_secs();
                Err(WorkstationError::Timeout { what: format!("the reply to '{order}'"), seconds })
            }
        }
    }

    /// Sends an operator command without waiting for the reply, which [`reply`](Self::reply) gets.
    ///
    /// # Errors
    /// [`WorkstationError::Ended`] if the process is gone.
    pub fn send_operator_command(&mut self, command: &str) -> Result<(), WorkstationError> {
        self.commands.send(command.into()).map_err(|_| WorkstationError::Ended)
    }

    /// The next reply line, if it is there.
    ///
    /// # Errors
    /// [`WorkstationError::Ended`] if the process is gone.
    pub fn reply(&mut self) -> Result<Option<String>, WorkstationError> {
        match self.replies.try_recv() {
            Ok(reply) => Ok(Some(reply)),
            Err(mpsc::TryRecvError::Empty) => Ok(None),
            Err(mpsc::TryRecvError::Disconnected) => Err(WorkstationError::Ended),
        }
    }
}

/// Waits until a process that was started is ready; where its host line is.
///
/// # Errors
/// What it did instead.
fn until_ready(said: &mpsc::Receiver<String>, timeout: Duration) -> Result<Address, String> {
    let end = Instant::now() + timeout;
    let mut line = None;
    loop {
        let text = said.recv_timeout(end.saturating_duration_since(Instant::now())).map_err(|error| match error {
            mpsc::RecvTimeoutError::Timeout => format!("it does not get ready within {} s", timeout.as_secs()),
            mpsc::RecvTimeoutError::Disconnected => "it ended at once".into(),
        })?;
        match text.as_str() {
            "ready" => return line.ok_or_else(|| "it does not say where it listens".into()),
            other => line = other.strip_prefix("ready line ").and_then(|a| a.parse().ok()).or(line),
        }
    }
}

/// A reply without its `ok`.
fn understood(command: &str, reply: &str) -> Result<String, WorkstationError> {
    match reply.strip_prefix("ok") {
        Some(text) => Ok(text.trim_start().to_string()),
        None => {
            let reason = reply.strip_prefix("error ").unwrap_or(reply).to_string();
            Err(WorkstationError::OperatorCommand { command: command.to_string(), reason })
        }
    }
}

/// Lines without their ends, read by a thread of their own, so that a wait for one can have an end.
fn read_lines(from: impl Read + Send + 'static) -> mpsc::Receiver<String> {
    let (sender, lines) = mpsc::channel();
    std::thread::spawn(move || {
        for line in BufReader::new(from).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    lines
}

/// Takes lines for a process, written by a thread of their own: one that does not read them stops nobody else.
fn write_lines(mut to: impl Write + Send + 'static) -> mpsc::Sender<String> {
    let (sender, lines) = mpsc::channel();
    std::thread::spawn(move || {
        for line in lines {
            if writeln!(to, "{line}").and_then(|()| to.flush()).is_err() {
                return;
            }
        }
    });
    sender
}

impl Drop for Emulator {
    fn drop(&mut self) {
        let _ = self.commands.send("quit".into());
        let end = Instant::now() + QUIT_TIME;
        while Instant::now() < end {
            match self.child.try_wait() {
                Ok(None) => std::thread::sleep(Duration::from_millis(5)),
                Ok(Some(_)) | Err(_) => return,
            }
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn program() -> PathBuf {
    if let Some(given) = env::var_os(PROGRAM_VARIABLE) {
        return given.into();
    }
    let beside = env::current_exe().ok().map(|me| me.with_file_name("ps340"));
    beside.filter(|p| p.is_file()).unwrap_or_else(|| "ps340".into())
}
