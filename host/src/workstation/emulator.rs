//! A PS 340 process of our own: started when no line is given, and ended with us.

use super::WorkstationError;
use protocol::address::Address;
use std::{
    env,
    io::{BufRead, BufReader, Write},
    path::PathBuf,
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
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
    orders: Option<ChildStdin>,
    replies: BufReader<ChildStdout>,
    line: Address,
}

impl Emulator {
    /// Starts `ps340`: the program named by [`PROGRAM_VARIABLE`], or the one beside this program, or the one
    /// on the search path. It listens on a free local port, and ends when we do.
    ///
    /// # Errors
    /// [`WorkstationError::Start`] names the program.
    pub fn start() -> Result<Emulator, WorkstationError> {
        let program = program();
        let error = |e: std::io::Error| WorkstationError::Start { program: program.clone(), reason: e.to_string() };
        let mut child = Command::new(&program)
            .args(["--listen", "tcp:127.0.0.1:0", "--operator", "stdio"])
            .env("PS340_LOG", env::var("PS340_LOG").unwrap_or_else(|_| "warn".into()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(error)?;
        let (Some(orders), Some(replies)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(error(std::io::ErrorKind::BrokenPipe.into()));
        };
        let mut replies = BufReader::new(replies);
        let mut line = None;
        loop {
            let mut text = String::new();
            if replies.read_line(&mut text).map_err(error)? == 0 {
                return Err(error(std::io::Error::other("it ended at once")));
            }
            match text.trim_end() {
                "ready" => break,
                other => line = other.strip_prefix("ready line ").and_then(|a| a.parse().ok()).or(line),
            }
        }
        let line = line.ok_or_else(|| error(std::io::Error::other("it does not say where it listens")))?;
        Ok(Emulator { child, orders: Some(orders), replies, line })
    }

    /// Where its host line is.
    pub fn line(&self) -> &Address {
        &self.line
    }

    /// Its process number.
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// Gives an order to the operator line, and returns the reply without its `ok`.
    ///
    /// # Errors
    /// [`WorkstationError::Order`] if the order is refused, [`WorkstationError::Ended`] if the process is gone.
    pub fn order(&mut self, order: &str) -> Result<String, WorkstationError> {
        let ended = |_| WorkstationError::Ended;
        let orders = self.orders.as_mut().ok_or(WorkstationError::Ended)?;
        writeln!(orders, "{order}").and_then(|()| orders.flush()).map_err(ended)?;
        let mut reply = String::new();
        if self.replies.read_line(&mut reply).map_err(ended)? == 0 {
            return Err(WorkstationError::Ended);
        }
        let reply = reply.trim_end();
        match reply.strip_prefix("ok") {
            Some(text) => Ok(text.trim_start().to_string()),
            None => {
                let reason = reply.strip_prefix("error ").unwrap_or(reply).to_string();
                Err(WorkstationError::Order { order: order.to_string(), reason })
            }
        }
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        if let Some(mut orders) = self.orders.take() {
            let _ = writeln!(orders, "quit");
        }
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
