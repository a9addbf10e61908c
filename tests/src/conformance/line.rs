//! A host line from the host's side: bytes out, bytes in with a time limit, whatever carries them.

use protocol::address::Address;
use rustix::{
    event::{PollFd, PollFlags},
    time::Timespec,
};
use std::{
    fmt,
    fs::{File, OpenOptions},
    io::{self, Read, Write},
    net::{Shutdown, TcpStream, ToSocketAddrs},
    os::unix::net::UnixStream,
    path::PathBuf,
    str::FromStr,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    time::{Duration, Instant},
};

/// How long a machine may take to let a host go.
const GOODBYE: Duration = Duration::from_secs(3);
/// How long a machine may take to take a connection.
const CONNECT_LIMIT: Duration = Duration::from_secs(10);
/// How long a machine may refuse to take bytes.
const WRITE_LIMIT: Duration = Duration::from_secs(30);

/// How soon the reader of a terminal sees that it is to end: 2 ms.
const TERMINAL_TURN: Timespec = Timespec { tv_sec: 0, tv_nsec: 2_000_000 };

/// The endpoint of a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Endpoint {
    /// A socket that listens.
    Socket(Address),
    /// A terminal device: a pseudo-terminal, or a serial line that is set up already.
    Terminal(PathBuf),
}

impl FromStr for Endpoint {
    type Err = String;

    /// `tcp:HOST:PORT`, `unix:PATH`, `pty:PATH` or `serial:PATH`.
    fn from_str(text: &str) -> Result<Endpoint, String> {
        for prefix in ["pty:", "serial:"] {
            if let Some(path) = text.strip_prefix(prefix) {
                return Ok(Endpoint::Terminal(path.into()));
            }
        }
        text.parse().map(Endpoint::Socket).map_err(|e: protocol::address::AddressError| e.to_string())
    }
}

impl fmt::Display for Endpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Endpoint::Socket(address) => address.fmt(f),
            Endpoint::Terminal(path) => path.display().fmt(f),
        }
    }
}

/// A line to a machine.
pub struct Line {
    stream: Stream,
    inbox: mpsc::Receiver<io::Result<Vec<u8>>>,
}

enum Stream {
    Tcp(TcpStream),
    Unix(UnixStream),
    /// A terminal, and whether its reader is to end: nothing else ends a read of a terminal.
    Terminal(File, Arc<AtomicBool>),
}

/// Reads a terminal until it is asked to end, so that no reader takes what is meant for the next host.
struct TerminalReader {
    file: File,
    has_left: Arc<AtomicBool>,
}

impl Read for TerminalReader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while !self.has_left.load(Ordering::Acquire) {
            let mut waited = [PollFd::new(&self.file, PollFlags::IN)];
            if rustix::event::poll(&mut waited, Some(&TERMINAL_TURN))? > 0 {
                return self.file.read(buffer);
            }
        }
        Ok(0)
    }
}

impl std::fmt::Debug for Line {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Line").finish_non_exhaustive()
    }
}

impl Line {
    /// Attaches to a machine.
    ///
    /// # Errors
    /// Those of the system.
    pub fn attach(place: &Endpoint) -> io::Result<Line> {
        let (stream, reader): (Stream, Box<dyn Read + Send>) = match place {
            Endpoint::Socket(Address::Tcp(at)) => {
                let stream = connect(at)?;
                stream.set_nodelay(true)?;
                stream.set_write_timeout(Some(WRITE_LIMIT))?;
                let reader = stream.try_clone()?;
                (Stream::Tcp(stream), Box::new(reader))
            }
            Endpoint::Socket(Address::Unix(path)) => {
                let stream = UnixStream::connect(path)?;
                stream.set_write_timeout(Some(WRITE_LIMIT))?;
                let reader = stream.try_clone()?;
                (Stream::Unix(stream), Box::new(reader))
            }
            Endpoint::Terminal(path) => {
                let file = OpenOptions::new().read(true).write(true).open(path)?;
                make_raw(&file)?;
                let has_left = Arc::new(AtomicBool::new(false));
                let reader = TerminalReader { file: file.try_clone()?, has_left: has_left.clone() };
                (Stream::Terminal(file, has_left), Box::new(reader))
            }
        };
        let (sender, inbox) = mpsc::channel();
        std::thread::spawn(move || read_on(reader, &sender));
        Ok(Line { stream, inbox })
    }

    /// Gives bytes to the line.
    ///
    /// # Errors
    /// Those of the system.
    pub fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        match &mut self.stream {
            Stream::Tcp(stream) => stream.write_all(bytes),
            Stream::Unix(stream) => stream.write_all(bytes),
            Stream::Terminal(file, _) => file.write_all(bytes),
        }
    }

    /// Bytes that came, waiting until `deadline` at most; none then.
    ///
    /// # Errors
    /// Those of the system, and `UnexpectedEof` if the machine closed the line.
    pub fn receive(&mut self, deadline: Instant) -> io::Result<Option<Vec<u8>>> {
        match self.inbox.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
            Ok(Ok(bytes)) => Ok(Some(bytes)),
            Ok(Err(error)) => Err(error),
            Err(mpsc::RecvTimeoutError::Timeout) => Ok(None),
            Err(mpsc::RecvTimeoutError::Disconnected) => Err(io::ErrorKind::UnexpectedEof.into()),
        }
    }

    /// Leaves, and waits until the machine has let the line go, so that the next host meets no trace of this one.
    pub fn detach(mut self) {
        let closed = match &self.stream {
            Stream::Tcp(stream) => stream.shutdown(Shutdown::Write),
            Stream::Unix(stream) => stream.shutdown(Shutdown::Write),
            Stream::Terminal(_, has_left) => {
                has_left.store(true, Ordering::Release);
                Ok(())
            }
        };
        let deadline = Instant::now() + GOODBYE;
        if closed.is_ok() {
            while let Ok(Some(_)) = self.receive(deadline) {}
        }
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        // Also ends the thread that reads.
        let _ = match &self.stream {
            Stream::Tcp(stream) => stream.shutdown(Shutdown::Both),
            Stream::Unix(stream) => stream.shutdown(Shutdown::Both),
            Stream::Terminal(_, has_left) => {
                has_left.store(true, Ordering::Release);
                Ok(())
            }
        };
    }
}

/// Connects to the first address of a host that answers.
fn connect(at: &str) -> io::Result<TcpStream> {
    let mut result = Err(io::ErrorKind::AddrNotAvailable.into());
    for address in at.to_socket_addrs()? {
        result = TcpStream::connect_timeout(&address, CONNECT_LIMIT);
        if result.is_ok() {
            break;
        }
    }
    result
}

/// Switches off echo, translation and line editing.
fn make_raw(file: &File) -> io::Result<()> {
    use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
    let mut settings = tcgetattr(file)?;
    settings.make_raw();
    Ok(tcsetattr(file, OptionalActions::Now, &settings)?)
}

/// Hands on what comes, until the end or until nobody listens.
fn read_on(mut reader: Box<dyn Read + Send>, sender: &mpsc::Sender<io::Result<Vec<u8>>>) {
    let mut buffer = vec![0; 64 << 10];
    loop {
        let read = match reader.read(&mut buffer) {
            Ok(0) => return,
            Ok(length) => Ok(buffer[..length].to_vec()),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => Err(error),
        };
        let ended = read.is_err();
        if sender.send(read).is_err() || ended {
            return;
        }
    }
}
