//! Interpreters that belong to functions: F:CI, F:READSTREAM, F:RASTERSTREAM.
//!
//! What the functions give waits in a queue and is interpreted one message at a time, never one inside the other, so
//! that commands which cause commands need no stack; each message takes its share of the work of a step.

use super::{
    Machine,
    executing::raster_records,
    streams::{StreamChunk, StreamReader},
};
use crate::{
    interpreter::Message,
    memory::Refusal,
    port::{Cause, Fault, ObjectId, StreamKind},
};
use protocol::Value;

/// Bytes that wait to be interpreted; more are lost and reported. Ours.
const MAX_WAITING: usize = 4 << 20;
/// Functions with an interpreter of their own. Ours.
const MAX_INTERPRETERS: usize = 256;
/// What interpreting a message costs of the work of a step, besides what it causes: it takes about as long as so many
/// messages between functions.
const UNITS_PER_PIECE: u64 = 50;
/// Bytes of it that cost one unit more.
const BYTES_PER_UNIT: usize = 8;

impl Machine {
    /// Lets bytes wait for the interpreter of a function.
    pub(super) fn queue_stream(&mut self, function: ObjectId, stream: StreamKind, bytes: Box<[u8]>, fresh: bool) {
        // An empty message takes memory too.
        let size = bytes.len() + size_of::<StreamChunk>();
        if self.streams.bytes + size > MAX_WAITING {
            self.streams.lost += 1;
            let lost = self.streams.lost;
            let type_name = self.memory.network.function(function).map_or("CI", |row| row.name);
            let name = self.memory.title(function);
            let fault = Fault { function: type_name, cause: Cause::Flood { input: 1, lost } };
            return self.report(Message::Function { name, fault });
        }
        self.streams.bytes += size;
        self.streams.waiting.push_back(StreamChunk { function, stream, bytes, fresh });
    }

    /// Interprets the oldest message that waits, unless one is being interpreted. Returns whether there was one.
    pub(super) fn interpret_next(&mut self) -> bool {
        if self.streams.busy {
            return false;
        }
        let Some(piece) = self.streams.waiting.pop_front() else { return false };
        self.streams.bytes -= piece.bytes.len() + size_of::<StreamChunk>();
        self.work_left = self.work_left.saturating_sub(UNITS_PER_PIECE + (piece.bytes.len() / BYTES_PER_UNIT) as u64);
        let is_reader = |machine: &Machine, id: ObjectId| {
            let row = machine.memory.network.function(id);
            row.is_some_and(|row| ["CI", "READSTREAM", "RASTERSTREAM"].contains(&row.name))
        };
        if !is_reader(self, piece.function) {
            self.streams.interpreters.remove(&piece.function);
            return true;
        }
        let mut reader = self.streams.interpreters.remove(&piece.function).unwrap_or_default();
        if self.streams.interpreters.len() >= MAX_INTERPRETERS {
            let mut kept = std::mem::take(&mut self.streams.interpreters);
            kept.retain(|id, _| is_reader(self, *id));
            self.streams.interpreters = kept;
        }
        if self.streams.interpreters.len() >= MAX_INTERPRETERS {
            self.report(Message::Refused(Refusal::Full));
            return true;
        }
        if piece.fresh {
            reader = StreamReader::default();
        }
        // The commands that a function gives are nobody's, whoever caused them.
        let speaking = self.lines.reporting_to.take();
        self.streams.busy = true;
        let completed = match piece.stream {
            StreamKind::Text => self.interpret_text(&mut reader, &piece.bytes),
            StreamKind::Binary => self.interpret_records(&mut reader, &piece.bytes),
            StreamKind::Raster => raster_records(&piece.bytes, self),
        };
        self.streams.busy = false;
        self.lines.reporting_to = speaking;
        self.streams.interpreters.insert(piece.function, reader);
        self.reply(piece.function, 1, Value::Integer(i32::try_from(completed).unwrap_or(i32::MAX)));
        true
    }

    fn interpret_text(&mut self, reader: &mut StreamReader, text: &[u8]) -> usize {
        let mut completed = 0;
        reader.text.push(text);
        for read in reader.text.by_ref() {
            completed += usize::from(self.execute_read(&mut reader.interpreter, read));
        }
        completed
    }

    fn interpret_records(&mut self, reader: &mut StreamReader, records: &[u8]) -> usize {
        let mut completed = 0;
        let commands: Vec<_> = reader.binary.push(records).collect();
        for read in commands {
            match read {
                Ok(command) => {
                    self.execute(&mut reader.interpreter, command);
                    completed += 1;
                }
                Err(error) => self.report(Message::Binary(error)),
            }
        }
        completed
    }
}
