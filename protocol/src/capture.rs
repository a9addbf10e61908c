//! The format of captured sessions: what passed on every host line, in both directions, and what the operator did, with
//! its time.
//!
//! A capture is text. Its first line is [`HEADER`]; each other line is a record of four fields with one blank between
//! them:
//!
//! ```text
//! ps340 capture 1
//! 0.000000 1 + tcp:127.0.0.1:40000
//! 0.001250 1 > DISPLAY A;\r\n
//! 0.018102 1 < 1V 0.25,-0.125\r\n
//! 1.200000 0 ! dial 1 0.25
//! 2.500000 1 -
//! ```
//!
//! - the time in seconds since the capture began, with six decimals;
//! - the number of the line; 0 for an operator command;
//! - `+` the line opened, `>` bytes from the host, `<` bytes to the host, `-` the line closed, `!` an operator command;
//! - who attached for `+`; the operator command for `!`; the bytes for `>` and `<`: printable characters as they are,
//!   but `\\` for the backslash, `\r`, `\n`, `\t`, and `\xNN` for all other bytes.

use std::fmt::Write;

/// The first line of a capture.
pub const HEADER: &str = "ps340 capture 1";

/// Bytes of a line in one record; more are several records.
pub const PIECE: usize = 4096;

/// Longest operator command, in bytes.
pub const MAX_OPERATOR_COMMAND: usize = 64 << 10;

/// Longest line of a capture in bytes: every byte of an operator command escaped, and the fields before it.
const MAX_LINE: usize = 4 * MAX_OPERATOR_COMMAND + 128;

/// Longest name of who attached.
const MAX_PEER: usize = 1024;

/// What happened on a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Record {
    /// Microseconds since the capture began.
    pub micros: u64,
    /// The number of the line.
    pub line: u64,
    /// What.
    pub event: Event,
}

/// What may happen on a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A host attached; who.
    Open(String),
    /// Bytes from the host.
    FromHost(Vec<u8>),
    /// Bytes to the host.
    ToHost(Vec<u8>),
    /// The line closed.
    Close,
    /// An operator command was given; its text.
    OperatorCommand(String),
}

/// A line that is no record of a capture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line} of the capture: {problem}")]
pub struct CaptureError {
    /// The line, from 1.
    pub line: u64,
    /// What is wrong with it.
    pub problem: CaptureProblem,
}

/// What can be wrong with a line of a capture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CaptureProblem {
    /// The first line is not [`HEADER`].
    #[error("it is not '{HEADER}'")]
    Header,
    /// No time in seconds.
    #[error("it has no time in seconds")]
    Time,
    /// No number of a line.
    #[error("it has no number of a line")]
    Line,
    /// None of the five signs.
    #[error("its third field is none of + > < - !")]
    Sign,
    /// A backslash that is followed by nothing known.
    #[error("a backslash is followed by none of \\ r n t xNN")]
    Escape,
    /// Longer than any record.
    #[error("it is longer than {MAX_LINE} bytes")]
    TooLong,
}

/// Whether a file that begins so is a capture.
pub fn is_capture(beginning: &[u8]) -> bool {
    beginning.strip_prefix(HEADER.as_bytes()).is_some_and(|rest| matches!(rest.first(), None | Some(b'\n' | b'\r')))
}

impl Record {
    /// Appends the record as a line of text, or several for more than [`PIECE`] bytes.
    pub fn write(&self, out: &mut String) {
        let mut line = |sign: char, bytes: &[u8]| {
            // Writing into a string does not fail.
            let _ = write!(out, "{}.{:06} {} {sign}", self.micros / 1_000_000, self.micros % 1_000_000, self.line);
            if !bytes.is_empty() {
                out.push(' ');
                escape(bytes, out);
            }
            out.push('\n');
        };
        match &self.event {
            Event::Open(peer) => line('+', &peer.as_bytes()[..peer.len().min(MAX_PEER)]),
            Event::OperatorCommand(order) => line('!', &order.as_bytes()[..order.len().min(MAX_OPERATOR_COMMAND)]),
            Event::FromHost(bytes) => bytes.chunks(PIECE).for_each(|piece| line('>', piece)),
            Event::ToHost(bytes) => bytes.chunks(PIECE).for_each(|piece| line('<', piece)),
            Event::Close => line('-', &[]),
        }
    }

    /// Reads a line without its end.
    fn read(line: &[u8]) -> Result<Record, CaptureProblem> {
        let mut fields = line.splitn(4, |byte| *byte == b' ');
        let mut text = || fields.next().and_then(|field| std::str::from_utf8(field).ok());
        let micros = text().and_then(micros).ok_or(CaptureProblem::Time)?;
        let number = text().and_then(|number| number.parse().ok()).ok_or(CaptureProblem::Line)?;
        let sign = text().ok_or(CaptureProblem::Sign)?;
        let bytes = unescape(fields.next().unwrap_or_default()).ok_or(CaptureProblem::Escape)?;
        let event = match sign {
            "+" => Event::Open(String::from_utf8_lossy(&bytes).into_owned()),
            ">" => Event::FromHost(bytes),
            "<" => Event::ToHost(bytes),
            "-" => Event::Close,
            "!" => Event::OperatorCommand(String::from_utf8_lossy(&bytes).into_owned()),
            _ => return Err(CaptureProblem::Sign),
        };
        Ok(Record { micros, line: number, event })
    }
}

/// Reads a capture, however its bytes arrive.
#[derive(Clone, Debug, Default)]
pub struct CaptureReader {
    buffer: Vec<u8>,
    start: usize,
    /// How far the end of the current line was looked for.
    scanned: usize,
    lines: u64,
    dropping: bool,
}

impl CaptureReader {
    /// Takes more of the file.
    pub fn push(&mut self, bytes: &[u8]) {
        self.buffer.drain(..self.start);
        self.scanned -= self.start;
        self.start = 0;
        self.buffer.extend_from_slice(bytes);
    }

    /// Ends a last line that has no end.
    pub fn finish(&mut self) {
        if self.start < self.buffer.len() {
            self.push(b"\n");
        }
    }
}

impl Iterator for CaptureReader {
    type Item = Result<Record, CaptureError>;

    /// The next record whose line is complete.
    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let found = self.buffer[self.scanned..].iter().position(|byte| *byte == b'\n');
            let end = found.map_or(self.buffer.len(), |at| self.scanned + at);
            self.scanned = end;
            let too_long = end - self.start > MAX_LINE;
            if found.is_none() {
                if too_long {
                    // The rest of the line is dropped as it comes.
                    self.start = end;
                    self.dropping = true;
                }
                return None;
            }
            let line = self.buffer[self.start..end].trim_ascii_end();
            self.lines += 1;
            let result = if std::mem::take(&mut self.dropping) || too_long {
                Some(Err(CaptureProblem::TooLong))
            } else if self.lines == 1 {
                (line != HEADER.as_bytes()).then_some(Err(CaptureProblem::Header))
            } else {
                (!line.is_empty()).then(|| Record::read(line))
            };
            self.start = end + 1;
            self.scanned = self.start;
            if let Some(result) = result {
                return Some(result.map_err(|problem| CaptureError { line: self.lines, problem }));
            }
        }
    }
}

/// Microseconds of a text such as `12.000345`.
fn micros(text: &str) -> Option<u64> {
    let (seconds, fraction) = text.split_once('.').unwrap_or((text, ""));
    if fraction.len() > 6 || !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let fraction: u64 = format!("{fraction:0<6}").parse().ok()?;
    seconds.parse::<u64>().ok()?.checked_mul(1_000_000)?.checked_add(fraction)
}

fn escape(bytes: &[u8], out: &mut String) {
    for &byte in bytes {
        match byte {
            b'\\' => out.push_str("\\\\"),
            b'\r' => out.push_str("\\r"),
            b'\n' => out.push_str("\\n"),
            b'\t' => out.push_str("\\t"),
            // A blank at the end of a line would not be seen.
            b' '..=b'~' if byte != b' ' || bytes.last() != Some(&b' ') => out.push(char::from(byte)),
            _ => {
                let _ = write!(out, "\\x{byte:02x}");
            }
        }
    }
}

fn unescape(mut text: &[u8]) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len());
    while let Some(at) = text.iter().position(|byte| *byte == b'\\') {
        bytes.extend_from_slice(&text[..at]);
        let (byte, length) = match text.get(at + 1)? {
            b'\\' => (b'\\', 2),
            b'r' => (b'\r', 2),
            b'n' => (b'\n', 2),
            b't' => (b'\t', 2),
            b'x' => {
                let digits = std::str::from_utf8(text.get(at + 2..at + 4)?).ok()?;
                if !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
                    return None;
                }
                (u8::from_str_radix(digits, 16).ok()?, 4)
            }
            _ => return None,
        };
        bytes.push(byte);
        text = &text[at + length..];
    }
    bytes.extend_from_slice(text);
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(text: &[u8], size: usize) -> Vec<Result<Record, CaptureError>> {
        let (mut reader, mut all) = (CaptureReader::default(), Vec::new());
        for piece in text.chunks(size) {
            reader.push(piece);
            all.extend(reader.by_ref());
        }
        reader.finish();
        all.extend(reader);
        all
    }

    #[test]
    fn the_example_of_the_document_is_read() {
        let text = format!(
            "{HEADER}\n0.000000 1 + tcp:127.0.0.1:40000\n0.001250 1 > DISPLAY A;\\r\\n\n\n\
             12.5 1 < \\x1d\\\\ \\t\\x20\r\n2.500000 2 -\n3.0 0 ! type a\\\\r"
        );
        assert!(is_capture(text.as_bytes()) && !is_capture(b"ps340 capture 10"));
        let records: Vec<Record> = read(text.as_bytes(), 7).into_iter().map(Result::unwrap).collect();
        let record = |micros, line, event| Record { micros, line, event };
        assert_eq!(
            records,
            [
                record(0, 1, Event::Open("tcp:127.0.0.1:40000".into())),
                record(1_250, 1, Event::FromHost(b"DISPLAY A;\r\n".into())),
                record(12_500_000, 1, Event::ToHost(b"\x1d\\ \t ".into())),
                record(2_500_000, 2, Event::Close),
                record(3_000_000, 0, Event::OperatorCommand("type a\\r".into())),
            ]
        );
    }

    #[test]
    fn a_bad_line_is_told_and_the_next_one_is_read() {
        let long = "x".repeat(3 * MAX_LINE);
        let text = format!(
            "capture\n1 1 > a\n-1 1 > a\n1.1234567 1 -\n1 x -\n1 1 =\n1 1 > \\q\n1 1 > \\x1\n1 1 > \\x+1\n{long}\n1 1 > b"
        );
        use CaptureProblem::{Escape, Header, Line, Sign, Time, TooLong};
        let problems: Vec<_> = read(text.as_bytes(), 1000)
            .into_iter()
            .map(|result| result.map(|record| record.event).map_err(|error| (error.line, error.problem)))
            .collect();
        let expected = [(1, Header), (3, Time), (4, Time), (5, Line), (6, Sign), (7, Escape), (8, Escape), (9, Escape)];
        let mut all: Vec<_> = expected.into_iter().chain([(10, TooLong)]).map(Err).collect();
        all.insert(1, Ok(Event::FromHost(b"a".into())));
        all.push(Ok(Event::FromHost(b"b".into())));
        assert_eq!(problems, all);
    }

    proptest! {
        #[test]
        fn records_read_back(
            records in prop::collection::vec((any::<u32>(), any::<u64>(), prop::collection::vec(any::<u8>(), 1..40), any::<bool>()), 0..8),
            size in 1_usize..50
        ) {
            let mut text = format!("{HEADER}\n");
            let records: Vec<Record> = records.into_iter().map(|(micros, line, bytes, from)| {
                let event = if from { Event::FromHost(bytes) } else { Event::ToHost(bytes) };
                Record { micros: micros.into(), line, event }
            }).collect();
            records.iter().for_each(|record| record.write(&mut text));
            prop_assert!(text.bytes().all(|byte| matches!(byte, b'\n' | b' '..=b'~')));
            prop_assert_eq!(read(text.as_bytes(), size).into_iter().collect::<Result<Vec<_>, _>>(), Ok(records));
        }

        #[test]
        fn long_pieces_are_cut(length in PIECE..3 * PIECE, byte in any::<u8>()) {
            let bytes = vec![byte; length];
            let mut text = format!("{HEADER}\n");
            Record { micros: 1, line: 1, event: Event::FromHost(bytes.clone()) }.write(&mut text);
            let mut all = Vec::new();
            for record in read(text.as_bytes(), 5000) {
                match record.map(|record| record.event) {
                    Ok(Event::FromHost(piece)) => all.extend(piece),
                    other => panic!("{other:?}"),
                }
            }
            prop_assert!(all == bytes);
        }
    }
}
