//! What the tests of two processes share: starting, asking and ending them, with a time limit on every wait; and the
//! conformance suite; a test of simple surfaces; the window that real events work; the corpus of Boolean operations;
//! the notices of crates of others; every reader of bytes; the source tree.

pub mod conformance;
pub mod simple;
pub mod corpus;
pub mod windowed;
pub mod facets;
pub mod source_tree;
pub mod notices;
pub mod readers;

use rustix::process::{Pid, Signal};
use std::{
    io::{BufRead, BufReader, Read, Write},
    net::TcpStream,
    path::Path,
    process::{Child, ChildStdin, Command, Stdio},
    sync::{
        atomic::{AtomicU64, Ordering},
        mpsc,
    },
    thread::JoinHandle,
    time::{Duration, Instant},
};

/// How long any single answer may take; generous, for machines with other work.
pub const TIMEOUT: Duration = Duration::from_secs(60);

/// A `ps340` process with its operator line on its standard streams. Killed when dropped.
#[derive(Debug)]
pub struct Machine {
    child: Child,
    operator_input: Option<ChildStdin>,
    errors: Option<JoinHandle<String>>,
    replies: mpsc::Receiver<String>,
    /// Where its host line is, as `HOST:PORT`.
    pub line: String,
    /// Its other host lines, as they were printed: `unix:PATH`, `pty:PATH`.
    pub more_lines: Vec<String>,
}

impl Machine {
    /// Starts the program with more arguments, and waits until it is ready.
    ///
    /// # Panics
    /// If it does not start.
    pub fn start(program: &str, arguments: &[&str]) -> Machine {
        let mut child = Command::new(program)
            .args(["--listen", "tcp:127.0.0.1:0", "--operator", "stdio", "--files", "/"])
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let orders = child.stdin.take();
        // Read all along, so that the machine never waits for space in the pipe.
        let errors = child.stderr.take().map(|errors| std::thread::spawn(move || read_all(errors)));
        let out = child.stdout.take().expect("standard output is piped");
        let (sender, replies) = mpsc::channel();
        std::thread::spawn(move || {
            for line in BufReader::new(out).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    return;
                }
            }
        });
        let mut machine =
            Machine { child, operator_input: orders, errors, replies, line: String::new(), more_lines: Vec::new() };
        loop {
            let line = machine.replies.recv_timeout(TIMEOUT).expect("the machine gets ready");
            match line.strip_prefix("ready line ") {
                Some(address) => match address.strip_prefix("tcp:") {
                    Some(address) => machine.line = address.to_string(),
                    None => machine.more_lines.push(address.to_string()),
                },
                None if line == "ready" => return machine,
                None => {}
            }
        }
    }

    /// Gives an operator command without waiting for the reply.
    pub fn give(&mut self, order: &str) {
        let orders = self.operator_input.as_mut().expect("the operator line is open");
        writeln!(orders, "{order}").expect("the machine takes orders");
    }

    /// Gives an operator command and returns the whole reply line.
    pub fn reply(&mut self, order: &str) -> String {
        self.give(order);
        self.replies.recv_timeout(TIMEOUT).unwrap_or_else(|e| panic!("no reply to '{order}': {e}"))
    }

    /// Gives an operator command that has to succeed; returns the reply without its `ok`.
    pub fn operator_command(&mut self, order: &str) -> String {
        let reply = self.reply(order);
        let text = reply.strip_prefix("ok").unwrap_or_else(|| panic!("'{order}' was answered '{reply}'"));
        text.trim_start().to_string()
    }

    /// Attaches a host.
    pub fn attach(&self) -> Host {
        Host::attach(&self.line)
    }

    /// Closes the operator line, so that the machine ends.
    pub fn close_operator(&mut self) {
        self.operator_input = None;
    }

    /// Kills the process at once.
    pub fn kill(&mut self) {
        self.child.kill().expect("the process can be killed");
        self.child.wait().expect("the process can be waited for");
    }

    /// Whether the process runs.
    pub fn runs(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(None))
    }

    /// Its process number.
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// Sends it a signal.
    pub fn signal(&self, signal: Signal) {
        send_signal(&self.child, signal);
    }

    /// Memory that it has now, in megabytes of a million bytes.
    pub fn resident_megabytes(&self) -> f64 {
        let path = format!("/proc/{}/status", self.child.id());
        let status = std::fs::read_to_string(path).expect("the process runs, on Linux");
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("it has memory");
        let kibibytes = line.trim().trim_end_matches("kB").trim().parse::<f64>().expect("a number");
        kibibytes * 1024.0 / 1e6
    }

    /// Waits for the end of the process; its exit code.
    pub fn end(&mut self) -> Option<i32> {
        wait(&mut self.child)
    }

    /// What it wrote on standard error; after its end.
    pub fn errors(&mut self) -> String {
        self.errors.take().and_then(|errors| errors.join().ok()).unwrap_or_default()
    }
}

impl Drop for Machine {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A host that types at a line, as `nc` does.
#[derive(Debug)]
pub struct Host {
    stream: TcpStream,
    reader: BufReader<TcpStream>,
}

impl Host {
    /// Attaches to `HOST:PORT`.
    pub fn attach(line: &str) -> Host {
        let stream = TcpStream::connect(line).expect("the machine listens");
        stream.set_read_timeout(Some(TIMEOUT)).expect("a time limit can be set");
        let reader = BufReader::new(stream.try_clone().expect("a second handle"));
        Host { stream, reader }
    }

    /// Waits for the end of the line; returns what was sent until then.
    pub fn rest(&mut self) -> String {
        let mut rest = Vec::new();
        self.reader.read_to_end(&mut rest).expect("the end within the time limit");
        String::from_utf8_lossy(&rest).into_owned()
    }

    /// Sends bytes.
    pub fn send(&mut self, bytes: impl AsRef<[u8]>) {
        self.stream.write_all(bytes.as_ref()).expect("the machine takes bytes");
    }

    /// The next message, without its line end.
    pub fn message(&mut self) -> String {
        let mut line = Vec::new();
        self.reader.read_until(b'\n', &mut line).expect("a message within the time limit");
        String::from_utf8_lossy(&line).trim_end_matches(['\r', '\n']).to_string()
    }

    /// The next bytes, as they come.
    pub fn bytes(&mut self, count: usize) -> Vec<u8> {
        let mut bytes = vec![0; count];
        self.reader.read_exact(&mut bytes).expect("so many bytes within the time limit");
        bytes
    }

    /// Waits until everything sent so far is carried out.
    pub fn synchronize(&mut self) {
        static ROUNDS: AtomicU64 = AtomicU64::new(0);
        // Every host gets every message: that of another host is not the end of what this one sent.
        let mark = format!("ROUND {}", ROUNDS.fetch_add(1, Ordering::Relaxed));
        self.send(format!("\nSEND '{mark}' TO <1>HOST_MESSAGE;"));
        while self.message() != mark {}
    }
}

/// The end of a program that was run.
#[derive(Debug)]
pub struct Ended {
    /// Its exit code; none if a signal ended it.
    pub code: Option<i32>,
    /// Its standard output.
    pub out: String,
    /// Its standard error.
    pub errors: String,
}

/// Runs a program to its end, killed when it takes longer than `limit`.
pub fn run(program: &str, arguments: &[&str], environment: &[(&str, &str)], folder: &Path, limit: Duration) -> Ended {
    let mut child = Command::new(program)
        .args(arguments)
        .envs(environment.iter().copied())
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let out = child.stdout.take().expect("piped");
    let errors = child.stderr.take().expect("piped");
    let out = std::thread::spawn(move || read_all(out));
    let errors = std::thread::spawn(move || read_all(errors));
    let end = Instant::now() + limit;
    let code = loop {
        match child.try_wait().expect("the process can be asked") {
            Some(status) => break status.code(),
            None if Instant::now() > end => {
                let _ = child.kill();
                let _ = child.wait();
                panic!("{arguments:?} took longer than {limit:?}");
            }
            None => std::thread::sleep(Duration::from_millis(10)),
        }
    };
    Ended { code, out: out.join().unwrap_or_default(), errors: errors.join().unwrap_or_default() }
}

/// Sends a signal to a process that was started and not yet waited for.
pub fn send_signal(child: &Child, signal: Signal) {
    let process = i32::try_from(child.id()).ok().and_then(Pid::from_raw).expect("a process number");
    rustix::process::kill_process(process, signal).expect("the process can be signalled");
}

fn read_all(mut from: impl Read) -> String {
    let mut bytes = Vec::new();
    let _ = from.read_to_end(&mut bytes);
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Waits for the end of a process; its exit code, none if a signal ended it.
pub fn wait(child: &mut Child) -> Option<i32> {
    let end = Instant::now() + TIMEOUT;
    while Instant::now() < end {
        if let Some(status) = child.try_wait().expect("the process can be asked") {
            return status.code();
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("the process did not end within {TIMEOUT:?}");
}
