//! One host line: bytes into commands, raster operations and terminal text.

use super::Machine;
use crate::interpreter::{Interpreter, Message};
use crate::line::LineId;
use protocol::{
    command::{BinaryDecoder, CommandReader},
    raster,
    wire::{Frame, FrameDecoder, Route},
};

/// Who gets text that arrives outside packets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum PlainText {
    /// The command interpreter. Ours, so that a line typed with `nc` is a command.
    #[default]
    Commands,
    /// The terminal emulator, as the standard configuration of the machine did.
    Terminal,
}

/// What the machine keeps for each host.
#[derive(Debug)]
pub(super) struct HostLine {
    frames: FrameDecoder,
    decoders: Decoders,
}

/// The readers behind the frames, one for each route.
#[derive(Debug)]
struct Decoders {
    line: LineId,
    plain_text: PlainText,
    text: CommandReader,
    binary: BinaryDecoder,
    interpreter: Interpreter,
}

impl HostLine {
    /// A line on which nothing has been said.
    pub(super) fn new(line: LineId, plain_text: PlainText) -> HostLine {
        HostLine {
            frames: FrameDecoder::default(),
            decoders: Decoders {
                line,
                plain_text,
                text: CommandReader::default(),
                binary: BinaryDecoder::default(),
                interpreter: Interpreter::default(),
            },
        }
    }

    /// Takes bytes from the host and does what they say.
    pub(super) fn receive(&mut self, bytes: &[u8], machine: &mut Machine) {
        let HostLine { frames, decoders } = self;
        frames.feed(bytes, |frame| decoders.frame(frame, machine));
    }

    /// Gives up what is open. Returns the name of the structure that was.
    pub(super) fn abandon(&mut self) -> Option<String> {
        self.decoders.interpreter.abandon()
    }
}

impl Decoders {
    fn frame(&mut self, frame: Frame<'_>, machine: &mut Machine) {
        match frame {
            Frame::Text(text) => match self.plain_text {
                PlainText::Commands => self.commands(text, machine),
                PlainText::Terminal => machine.panel.type_text(text),
            },
            Frame::Packet { route, payload, .. } => match route {
                Route::Text => self.commands(payload, machine),
                Route::Binary => self.binary(payload, machine),
                Route::Raster => {
                    raster_records(payload, machine);
                }
                Route::Terminal => machine.panel.type_text(payload),
                Route::Message => {
                    let writer = machine.writers.get_mut(&self.line);
                    if !writer.is_some_and(|w| w.request(payload)) {
                        machine.report(Message::Line("a packet on the route of messages asks for no form".into()));
                    }
                }
                Route::Other(code) => {
                    let route = char::from(code).escape_default();
                    machine.report(Message::Line(format!("nobody reads packets on route '{route}'")));
                }
            },
            Frame::Noise { bytes, reason } => {
                machine.counters.noise += bytes.len() as u64;
                machine.report(Message::Line(format!("{} bytes dropped: {reason}", bytes.len())));
            }
        }
    }

    fn commands(&mut self, text: &[u8], machine: &mut Machine) {
        self.text.push(text);
        for read in self.text.by_ref() {
            match read {
                Ok(spanned) => machine.execute(&mut self.interpreter, spanned.command),
                Err(error) => machine.report(Message::Syntax(error)),
            }
        }
    }

    fn binary(&mut self, payload: &[u8], machine: &mut Machine) {
        // The decoder's iterator holds the decoder, so the commands are collected first; they are few a packet.
        let commands: Vec<_> = self.binary.push(payload).collect();
        for read in commands {
            match read {
                Ok(command) => machine.execute(&mut self.interpreter, command),
                Err(error) => machine.report(Message::Binary(error)),
            }
        }
    }
}

/// Carries out raster records; returns how many.
pub(super) fn raster_records(payload: &[u8], machine: &mut Machine) -> usize {
    let mut completed = 0;
    for read in raster::decode(payload) {
        match read {
            Ok(command) => {
                if let Err(fault) = machine.frame_buffer.apply(&command) {
                    machine.report(Message::Raster(fault));
                }
                completed += 1;
            }
            Err(error) => machine.report(Message::Line(error.to_string())),
        }
    }
    completed
}
