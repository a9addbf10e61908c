//! A session with a workstation over its host line.

use super::{
    StructureCommands, Timeouts, WorkstationError,
    motion::FRAME_NOW,
    network::{self, Question},
    structure,
    structure_commands::FRAMES_PER_SECOND,
};
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
    sync::mpsc,
    thread,
    time::{Duration, Instant},
};

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

/// A wait for something from the workstation.
struct Wait<'a> {
    what: &'a str,
    timeout: Duration,
    end: Instant,
}

impl<'a> Wait<'a> {
    fn begin(what: &'a str, timeout: Duration) -> Wait<'a> {
        Wait { what, timeout, end: Instant::now() + timeout }
    }

    /// The time that is left.
    fn left(&self) -> Result<Duration, WorkstationError> {
        let left = self.end.checked_duration_since(Instant::now()).filter(|time| !time.is_zero());
        left.ok_or_else(|| WorkstationError::Timeout { what: self.what.into(), seconds: self.timeout.as_secs() })
    }
}

/// An attached workstation.
pub struct Session {
    line: Box<dyn Line>,
    timeouts: Timeouts,
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
    /// Attaches to a workstation, and asks for messages of its own as packets: other programs on other lines read
    /// theirs, and what the workstation reports about commands of this session is logged here.
    ///
    /// - `timeouts`: how long the workstation may take, now and later.
    ///
    /// # Errors
    /// [`WorkstationError::Attach`], [`WorkstationError::Closed`].
    pub fn attach(address: &Address, timeouts: Timeouts) -> Result<Session, WorkstationError> {
        let failed = |reason: String| WorkstationError::Attach { line: address.clone(), reason };
        let (sender, opened) = mpsc::channel();
        let target = address.clone();
        // The system looks names up, and waits for those who listen and do not accept, without limits of ours.
        thread::spawn(move || sender.send(open(&target)));
        let line = opened.recv_timeout(timeouts.attach).map_err(|_| {
            failed(format!("no answer within {} s (--patience gives it more time)", timeouts.attach.as_secs()))
        })?;
        let line = line.map_err(|e| failed(e.to_string()))?;
        line.set_write_timeout(timeouts.answer).map_err(|e| failed(e.to_string()))?;
        let mut session = Session {
            line,
            timeouts,
            out: Vec::new(),
            reader: MessageReader::default(),
            messages: VecDeque::new(),
            marks: 0,
        };
        MessageForm::Own.write_request(&mut session.out);
        session.reader.expect(MessageForm::Own);
        // A host that has said nothing may have to give its place to another.
        session.flush()?;
        Ok(session)
    }

    /// How long the workstation may take.
    pub fn timeouts(&self) -> Timeouts {
        self.timeouts
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
    /// [`WorkstationError::Timeout`] if it does not read, [`WorkstationError::Closed`].
    pub fn flush(&mut self) -> Result<(), WorkstationError> {
        let written = self.line.write_all(&self.out).and_then(|()| self.line.flush());
        self.out.clear();
        written.map_err(|error| match error.kind() {
            io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut => {
                let what = "it to read what is sent".to_string();
                WorkstationError::Timeout { what, seconds: self.timeouts.answer.as_secs() }
            }
            _ => closed(error),
        })
    }

    /// The next message from the workstation.
    ///
    /// # Errors
    /// [`WorkstationError::Timeout`] if none comes within `timeout`, [`WorkstationError::Closed`].
    pub fn message(&mut self, timeout: Duration, what: &str) -> Result<Vec<u8>, WorkstationError> {
        self.next(&Wait::begin(what, timeout))
    }

    /// The next message within the time of a wait.
    fn next(&mut self, wait: &Wait<'_>) -> Result<Vec<u8>, WorkstationError> {
        self.flush()?;
        let mut buffer = vec![0; 64 << 10];
        loop {
            if let Some(message) = self.messages.pop_front() {
                return Ok(message);
            }
            self.line.set_read_timeout(wait.left()?).map_err(closed)?;
            match self.line.read(&mut buffer) {
                Ok(0) => return Err(WorkstationError::Closed { reason: String::new() }),
                Ok(n) => {
                    self.reader.push(&buffer[..n]);
                    while let Some(report) = self.reader.next_report() {
                        log(&report);
                    }
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
    /// [`WorkstationError::Timeout`], [`WorkstationError::Closed`].
    pub fn synchronize(&mut self) -> Result<(), WorkstationError> {
        self.marks += 1;
        let mark = format!("PERIS MARK {}", self.marks);
        self.commands(&[network::send(Value::string(&mark), 1, "HOST_MESSAGE")])?;
        let mut others = VecDeque::new();
        let wait = Wait::begin("the end of what was sent", self.timeouts.answer);
        let result = loop {
            match self.next(&wait) {
                Ok(message) if message == mark.as_bytes() => break Ok(()),
                Ok(message) => others.push_back(message),
                Err(error) => break Err(error),
            }
        };
        others.append(&mut self.messages);
        self.messages = others;
        result
    }

    /// The matrix of the view that is set at the workstation, by the network of [`network::commands`], which another
    /// session may have sent.
    ///
    /// Returns scene coordinates (z negated) to clip space, in the glam form of [`protocol::Value`].
    ///
    /// # Errors
    /// [`WorkstationError::Timeout`], [`WorkstationError::Closed`], [`WorkstationError::Answer`].
    pub fn view(&mut self) -> Result<DMat4, WorkstationError> {
        let lines = self.answer(&network::VIEW)?;
        let mut rows = [[0.0; 4]; 4];
        for (row, line) in rows.iter_mut().zip(&lines[1..]) {
            let failed = || WorkstationError::Answer { answer: line.clone(), expected: "a row of four numbers" };
            let numbers = line.trim_end_matches(';').split([' ', ',']).filter(|w| !w.is_empty());
            let numbers = numbers.map(|w| w.parse::<f64>().ok().filter(|x| x.is_finite()));
            *row = numbers.collect::<Option<Vec<f64>>>().and_then(|n| n.try_into().ok()).ok_or_else(failed)?;
        }
        Ok(DMat4::from_cols_array_2d(&rows))
    }

    /// How long everything in a scene that moves at the workstation has done so since it began, or began anew, seconds; by
    /// the network that came with the scene, in whatever session.
    ///
    /// # Errors
    /// [`WorkstationError::Timeout`], [`WorkstationError::Closed`], [`WorkstationError::Answer`].
    pub fn motion_seconds(&mut self) -> Result<f64, WorkstationError> {
        let answer = self.answer(&FRAME_NOW)?.concat();
        let frame = answer.strip_prefix(FRAME_NOW.prefix).and_then(|number| number.trim().parse::<i32>().ok());
        let failed = || WorkstationError::Answer { answer: answer.clone(), expected: "the number of a frame" };
        Ok(f64::from(frame.ok_or_else(failed)?) / f64::from(FRAMES_PER_SECOND))
    }

    /// The messages that answer a question; others that come meanwhile are kept.
    fn answer(&mut self, question: &Question) -> Result<Vec<String>, WorkstationError> {
        self.commands(&question.ask())?;
        let mut lines = Vec::new();
        let mut others = VecDeque::new();
        let wait = Wait::begin(question.what, self.timeouts.answer);
        while lines.len() < question.messages {
            let message = self.next(&wait)?;
            if lines.is_empty() && !message.starts_with(question.prefix.as_bytes()) {
                others.push_back(message);
            } else {
                lines.push(String::from_utf8_lossy(&message).into_owned());
            }
        }
        others.append(&mut self.messages);
        self.messages = others;
        self.commands(&[question.leave()])?;
        Ok(lines)
    }

    /// Shows a scene, with its dials, labels and keys. The scene is there when this returns.
    ///
    /// - `movement`: what a turn of dials 5 to 7 moves, scene units.
    ///
    /// # Errors
    /// [`WorkstationError`].
    pub fn show(&mut self, shown: &StructureCommands, movement: f64) -> Result<(), WorkstationError> {
        self.commands(&[structure::delete()])?;
        self.commands(&shown.commands)?;
        self.commands(&network::commands(movement))?;
        if shown.instances.is_some() {
            self.commands(&network::detail())?;
        }
        self.synchronize()
    }

    /// Shows a scene in place of another one, as far as dials have turned that. Nobody sees a half of it.
    ///
    /// - `movement`: what a turn of dials 5 to 7 moves, scene units.
    ///
    /// # Errors
    /// [`WorkstationError`].
    pub fn replace(&mut self, shown: &StructureCommands, movement: f64) -> Result<(), WorkstationError> {
        self.commands(&[Command::Begin, structure::delete_objects()])?;
        self.commands(&shown.commands)?;
        self.commands(&network::zero_dials(movement))?;
        if shown.instances.is_some() {
            self.commands(&network::detail())?;
        }
        self.commands(&[Command::End])?;
        self.synchronize()
    }
}

/// An error is to be seen; a warning, that a name is defined anew, is usual.
fn log(report: &str) {
    if report.starts_with('E') {
        tracing::warn!("the workstation reports: {report}");
    } else {
        tracing::debug!("the workstation reports: {report}");
    }
}

/// Opens a line; takes as long as the system wants.
fn open(address: &Address) -> io::Result<Box<dyn Line>> {
    Ok(match address {
        Address::Tcp(at) => {
            let stream = TcpStream::connect(at.as_str())?;
            stream.set_nodelay(true)?;
            Box::new(stream)
        }
        Address::Unix(path) => Box::new(UnixStream::connect(path)?),
    })
}

fn unsendable(error: EncodeError) -> WorkstationError {
    WorkstationError::Scene(error.to_string())
}

fn closed(error: io::Error) -> WorkstationError {
    WorkstationError::Closed { reason: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::wire::MessageWriter;
    use std::net::TcpListener;

    #[test]
    fn a_partner_that_does_not_read_is_given_up() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = Address::Tcp(listener.local_addr().expect("an address").to_string());
        let mut session = Session::attach(&address, Timeouts::of(1)).expect("it is taken in");
        let partner = listener.accept();
        session.text(&"A := F:NOP; ".repeat(2_000_000)).expect("it waits here");
        let error = session.flush().expect_err("nobody reads");
        assert_eq!(error, WorkstationError::Timeout { what: "it to read what is sent".into(), seconds: 1 });
        drop(partner);
    }

    /// Says something else for ever.
    fn talk(mut partner: TcpStream) -> io::Result<()> {
        let mut writer = MessageWriter::default();
        writer.set_form(MessageForm::Own);
        let mut message = Vec::new();
        writer.write(b"SOMETHING ELSE", &mut message).map_err(io::Error::other)?;
        loop {
            partner.write_all(&message)?;
            thread::sleep(Duration::from_millis(100));
        }
    }

    #[test]
    fn a_partner_that_talks_of_other_things_is_given_up() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = Address::Tcp(listener.local_addr().expect("an address").to_string());
        let mut session = Session::attach(&address, Timeouts::of(1)).expect("it is taken in");
        std::thread::spawn(move || talk(listener.accept()?.0));
        let error = session.synchronize().expect_err("it never comes to the point");
        assert!(matches!(error, WorkstationError::Timeout { seconds: 1, .. }), "{error}");
    }
}
