//! A session with a workstation over its host line.

use super::{WorkstationError, network, structure};
use glam::DMat4;
use protocol::{
    Value,
    address::Address,
    command::Command,
    raster::RasterCommand,
    record::EncodeError,
    wire::{
        MessageError, MessageForm, MessageReader, PREFERRED_PAYLOAD, Route, write_commands, write_packet, write_raster,
    },
};
use std::{
    collections::VecDeque,
    io::{self, Read, Write},
    net::TcpStream,
    os::unix::net::UnixStream,
    time::{Duration, Instant},
};

/// How long an answer may take.
pub const ANSWER_TIME: Duration = Duration::from_secs(30);
/// Bytes that are gathered before they go to the line.
const BUFFER_BYTES: usize = 256 << 10;

/// A byte stream in both directions.
trait Line: Read + Write + Send {
    fn set_read_timeout(&self, time: Duration) -> io::Result<()>;
    fn set_write_timeout(&self, time: Duration) -> io::Result<()>;
}

impl Line for TcpStream {
    fn set_read_timeout(&self, time: Duration) -> io::Result<()> {
        TcpStream::set_read_timeout(self, Some(time))
    }

    fn set_write_timeout(&self, time: Duration) -> io::Result<()> {
        TcpStream::set_write_timeout(self, Some(time))
    }
}

impl Line for UnixStream {
    fn set_read_timeout(&self, time: Duration) -> io::Result<()> {
        UnixStream::set_read_timeout(self, Some(time))
    }

    fn set_write_timeout(&self, time: Duration) -> io::Result<()> {
        UnixStream::set_write_timeout(self, Some(time))
    }
}

/// An attached workstation.
pub struct Session {
    line: Box<dyn Line>,
    out: Vec<u8>,
    reader: MessageReader,
    messages: VecDeque<Vec<u8>>,
    marks: u64,
}

impl std::fmt::Debug for Session {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Session").field("waiting", &self.messages.len()).finish_non_exhaustive()
    }
}

impl Session {
    /// Attaches to a workstation, and asks for its messages as packets.
    ///
    /// # Errors
    /// [`WorkstationError::Attach`].
    pub fn attach(address: &Address) -> Result<Session, WorkstationError> {
        let failed = |e: io::Error| WorkstationError::Attach { line: address.clone(), reason: e.to_string() };
        let line: Box<dyn Line> = match address {
            Address::Tcp(at) => {
                let stream = TcpStream::connect(at.as_str()).map_err(failed)?;
                stream.set_nodelay(true).map_err(failed)?;
                Box::new(stream)
            }
            Address::Unix(path) => Box::new(UnixStream::connect(path).map_err(failed)?),
        };
        line.set_write_timeout(ANSWER_TIME).map_err(failed)?;
        let mut session =
            Session { line, out: Vec::new(), reader: MessageReader::default(), messages: VecDeque::new(), marks: 0 };
        MessageForm::Packets.write_request(&mut session.out);
        session.reader.expect(MessageForm::Packets);
        Ok(session)
    }

    /// Sends commands in binary form.
    ///
    /// # Errors
    /// [`WorkstationError::Closed`].
    pub fn commands(&mut self, commands: &[Command]) -> Result<(), WorkstationError> {
        write_commands(commands, &mut self.out).map_err(unsendable)?;
        if self.out.len() > BUFFER_BYTES { self.flush() } else { Ok(()) }
    }

    /// Sends command text.
    ///
    /// # Errors
    /// [`WorkstationError::Closed`].
    pub fn text(&mut self, text: &str) -> Result<(), WorkstationError> {
        for piece in text.as_bytes().chunks(PREFERRED_PAYLOAD) {
            write_packet(Route::Text, piece, &mut self.out).map_err(unsendable)?;
        }
        Ok(())
    }

    /// Sends operations for the raster screen.
    ///
    /// # Errors
    /// [`WorkstationError::Closed`].
    pub fn raster(&mut self, commands: &[RasterCommand]) -> Result<(), WorkstationError> {
        write_raster(commands, &mut self.out).map_err(unsendable)?;
        if self.out.len() > BUFFER_BYTES { self.flush() } else { Ok(()) }
    }

    /// Brings everything on its way to the workstation.
    ///
    /// # Errors
    /// [`WorkstationError::Closed`].
    pub fn flush(&mut self) -> Result<(), WorkstationError> {
        let written = self.line.write_all(&self.out).and_then(|()| self.line.flush());
        self.out.clear();
        written.map_err(closed)
    }

    /// The next message from the workstation.
    ///
    /// # Errors
    /// [`WorkstationError::Silent`] if none comes within `patience`, [`WorkstationError::Closed`].
    pub fn message(&mut self, patience: Duration, what: &str) -> Result<Vec<u8>, WorkstationError> {
        self.flush()?;
        let end = Instant::now() + patience;
        let silent = || WorkstationError::Silent { what: what.to_string(), seconds: patience.as_secs() };
        let mut buffer = vec![0; 64 << 10];
        loop {
            if let Some(message) = self.messages.pop_front() {
                return Ok(message);
            }
            let left = end.checked_duration_since(Instant::now()).filter(|t| !t.is_zero()).ok_or_else(silent)?;
            self.line.set_read_timeout(left).map_err(closed)?;
            match self.line.read(&mut buffer) {
                Ok(0) => return Err(WorkstationError::Closed { reason: String::new() }),
                Ok(n) => {
                    self.reader.push(&buffer[..n]);
                    for message in self.reader.by_ref() {
                        let lost = |e: MessageError| WorkstationError::Closed { reason: e.to_string() };
                        self.messages.push_back(message.map_err(lost)?);
                    }
                }
                Err(e) if matches!(e.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {}
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                Err(e) => return Err(closed(e)),
            }
        }
    }

    /// Waits until the workstation has carried out everything sent so far: a message goes round.
    ///
    /// # Errors
    /// [`WorkstationError::Silent`], [`WorkstationError::Closed`].
    pub fn synchronize(&mut self) -> Result<(), WorkstationError> {
        self.marks += 1;
        // Every host gets every message: the process tells the marks of two hosts apart.
        let mark = format!("PERIS MARK {} {}", std::process::id(), self.marks);
        self.commands(&[network::send(Value::string(&mark), 1, "HOST_MESSAGE")])?;
        let mut others = VecDeque::new();
        let result = loop {
            match self.message(ANSWER_TIME, "the end of what was sent") {
                Ok(message) if message == mark.as_bytes() => break Ok(()),
                Ok(message) => others.push_back(message),
                Err(error) => break Err(error),
            }
        };
        others.append(&mut self.messages);
        self.messages = others;
        result
    }

    /// The matrix of the view that is set at the workstation, by the network of [`network::commands`].
    ///
    /// Returns scene coordinates (z negated) to clip space, in the glam form of [`protocol::Value`].
    ///
    /// # Errors
    /// [`WorkstationError::Silent`], [`WorkstationError::Closed`], [`WorkstationError::Answer`].
    pub fn view(&mut self) -> Result<DMat4, WorkstationError> {
        self.commands(&[network::send(Value::Boolean(true), 1, network::VIEW_TRIGGER)])?;
        let mut lines = Vec::new();
        let mut others = VecDeque::new();
        while lines.len() < 5 {
            let message = self.message(ANSWER_TIME, "the matrix of the view")?;
            if lines.is_empty() && !message.starts_with(b"MATRIX_4X4") {
                others.push_back(message);
            } else {
                lines.push(String::from_utf8_lossy(&message).into_owned());
            }
        }
        others.append(&mut self.messages);
        self.messages = others;
        let mut rows = [[0.0; 4]; 4];
        for (row, line) in rows.iter_mut().zip(&lines[1..]) {
            let failed = || WorkstationError::Answer { answer: line.clone(), expected: "a row of four numbers" };
            let numbers = line.trim_end_matches(';').split([' ', ',']).filter(|w| !w.is_empty());
            let numbers = numbers.map(|w| w.parse::<f64>().ok().filter(|x| x.is_finite()));
            *row = numbers.collect::<Option<Vec<f64>>>().and_then(|n| n.try_into().ok()).ok_or_else(failed)?;
        }
        Ok(DMat4::from_cols_array_2d(&rows))
    }

    /// Shows a scene, with its dials, labels and keys. The scene is there when this returns.
    ///
    /// # Errors
    /// [`WorkstationError`].
    pub fn show(&mut self, shown: &structure::Shown, diagonal: f64) -> Result<(), WorkstationError> {
        self.commands(&shown.commands)?;
        self.commands(&network::commands(diagonal))?;
        self.synchronize()
    }
}

fn unsendable(error: EncodeError) -> WorkstationError {
    WorkstationError::Scene(error.to_string())
}

fn closed(error: io::Error) -> WorkstationError {
    WorkstationError::Closed { reason: error.to_string() }
}
