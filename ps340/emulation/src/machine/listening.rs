//! One host line: bytes into commands, raster operations and terminal text.

use super::{
    Machine, PlainText,
    executing::raster_records,
    host_line::{Decoders, HostLine},
};
use crate::interpreter::Message;
use protocol::{
    Value,
    value::MAX_STRING,
    wire::{Frame, Route, read_six_bit},
};

/// Characters of a diagnostic packet that are shown.
const DIAGNOSTIC_CHARACTERS: usize = 240;

/// The instances of the routes `0` to `9`; only 3 to 7 are channels of the site.
const CHANNELS: [&str; 10] = ["", "", "", "CHANNEL3", "CHANNEL4", "CHANNEL5", "CHANNEL6", "CHANNEL7", "", ""];

impl HostLine {
    /// Takes bytes from the host, and carries out what they request.
    pub(super) fn receive(&mut self, bytes: &[u8], machine: &mut Machine) {
        let HostLine { frames, decoders } = self;
        frames.feed_quoted(bytes, |frame| {
            decoders.frame(frame, machine);
            decoders.text.is_quoting()
        });
    }
}

impl Decoders {
    fn frame(&mut self, frame: Frame<'_>, machine: &mut Machine) {
        match frame {
            Frame::Text(text) => match self.plain_text {
                PlainText::Commands => {
                    self.text.push(text);
                    self.commands(machine);
                }
                PlainText::Terminal => machine.show_text(Some(self.line), text),
            },
            Frame::Packet { route, payload, .. } => self.packet(route, payload, machine),
            Frame::Empty(_) => {}
            Frame::Noise { bytes, reason } => {
                machine.counters.noise += bytes.len() as u64;
                machine.report(Message::Line(format!("{} bytes dropped: {reason}", bytes.len())));
            }
        }
    }

    fn packet(&mut self, route: Route, payload: &[u8], machine: &mut Machine) {
        match route {
            Route::Text => {
                self.text.push_packet(payload);
                self.commands(machine);
            }
            Route::Binary => self.binary(payload, machine),
            Route::Raster => drop(raster_records(payload, machine)),
            Route::SixBitBinary | Route::SixBitRaster => {
                let mut records = Vec::new();
                match read_six_bit(payload, &mut records) {
                    Ok(()) if route == Route::SixBitBinary => self.binary(&records, machine),
                    Ok(()) => drop(raster_records(&records, machine)),
                    Err(error) => machine.report(Message::Line(format!("a 6-bit packet is dropped: {error}"))),
                }
            }
            Route::Channel(number) => {
                if payload.len() > MAX_STRING {
                    let text =
                        format!("{} bytes for CHANNEL{number}, more than {MAX_STRING}, are dropped", payload.len());
                    return machine.report(Message::Line(text));
                }
                machine.emit_from_line(CHANNELS[usize::from(number) % 10], Value::string(payload));
            }
            Route::Terminal => machine.show_text(Some(self.line), payload),
            Route::Diagnostic => {
                let text: String = payload.escape_ascii().map(char::from).take(DIAGNOSTIC_CHARACTERS).collect();
                machine.report(Message::Diagnostic(text));
            }
            Route::Message => {
                if let Err(message) = machine.request_form(self.line, payload) {
                    machine.report(message);
                }
            }
            Route::Other(code) => {
                let route = char::from(code).escape_default();
                machine.report(Message::Line(format!("nobody reads packets on route '{route}'")));
            }
        }
    }

    fn commands(&mut self, machine: &mut Machine) {
        for read in self.text.by_ref() {
            machine.execute_read(&mut self.interpreter, read);
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
