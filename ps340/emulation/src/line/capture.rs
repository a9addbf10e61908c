//! Capture of what passes on the host lines, and of what the operator does, to a file.

use super::LineId;
use files::{Destination, LogFile};
use protocol::capture::{Event, HEADER, Record};
use std::{
    io::{self, Write},
    path::Path,
    sync::{Arc, Mutex, MutexGuard},
    time::Instant,
};

/// A file that takes what passes on the lines; clones share it.
#[derive(Clone, Debug)]
pub struct Capture {
    shared: Arc<Mutex<Tape>>,
}

#[derive(Debug)]
struct Tape {
    /// None after the file was finished or could not be written.
    file: Option<LogFile>,
    begin: Instant,
    text: String,
}

impl Capture {
    /// Begins a capture, which grows under its name with `.part` after it until it is finished.
    ///
    /// # Errors
    /// Those of the file.
    pub fn create(path: &Path) -> io::Result<Capture> {
        let mut file = Destination::of(path).and_then(LogFile::create).map_err(io::Error::other)?;
        writeln!(file, "{HEADER}")?;
        let tape = Tape { file: Some(file), begin: Instant::now(), text: String::new() };
        Ok(Capture { shared: Arc::new(Mutex::new(tape)) })
    }

    /// Ends the capture, which gets its name now, in place of a file that had it.
    pub fn finish(&self) {
        if let Some(Err(error)) = self.tape().file.take().map(LogFile::finish) {
            tracing::error!("the capture is not whole: {error}");
        }
    }

    fn tape(&self) -> MutexGuard<'_, Tape> {
        // A thread that panicked while it wrote leaves at worst half a record.
        self.shared.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Writes down that the operator did something now.
    pub fn record_operator_command(&self, command: &str) {
        self.record(LineId(0), Event::OperatorCommand(command.into()));
    }

    /// Writes down what happened on a line now.
    pub(super) fn record(&self, line: LineId, event: Event) {
        let mut tape = self.tape();
        let Tape { file, begin, text } = &mut *tape;
        let micros = u64::try_from(begin.elapsed().as_micros()).unwrap_or(u64::MAX);
        text.clear();
        Record { micros, line: line.0, event }.write(text);
        if let Some(Err(error)) = file.as_mut().map(|file| file.write_all(text.as_bytes())) {
            tracing::error!("the capture ends: {error}");
            *file = None;
        }
    }
}
