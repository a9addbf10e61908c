//! Commands and raster records packed into packets.

use super::packet::{LONG_HEADER, MAX_COUNT_DATA, MAX_PAYLOAD, PacketForm, Route, long_header, write_packet_as};
use super::six_bit::write_six_bit;
use crate::{
    command::{Command, binary, print},
    raster::{self, RasterCommand},
    record::EncodeError,
};
use std::convert::Infallible;

/// Payload bytes after which a packet is closed, so that it stays in the caches on both sides. Ours.
pub const PREFERRED_PAYLOAD: usize = 136 << 10;

const _: () = assert!(PREFERRED_PAYLOAD <= MAX_PAYLOAD);
const _: () = assert!(binary::PART_POINTS * 16 + binary::PART_POINTS / 8 + 3 <= PREFERRED_PAYLOAD);

/// The reason why commands were not sent.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum SendError<E> {
    /// A command has no binary form.
    #[error(transparent)]
    Encode(EncodeError),
    /// The receiver of the packets failed.
    #[error(transparent)]
    Send(E),
}

/// What commands are sent as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DataForm {
    /// Command text. Raster operations have none and are sent in the 6-bit form.
    Text,
    /// Binary records, all eight bits.
    #[default]
    EightBit,
    /// Binary records in printable characters.
    SixBit,
}

impl DataForm {
    /// The forms with their words.
    pub const ALL: [(DataForm, &str); 3] =
        [(DataForm::Text, "text"), (DataForm::EightBit, "8-bit"), (DataForm::SixBit, "6-bit")];
}

/// How commands travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sending {
    /// In which packets.
    pub packets: PacketForm,
    /// As what.
    pub data: DataForm,
}

impl Default for Sending {
    /// Long packets of binary records.
    fn default() -> Sending {
        Sending { packets: PacketForm::Long, data: DataForm::EightBit }
    }
}

impl Sending {
    /// Data bytes of a record, or of several, after which a packet is closed. Historical packets are short, so that a
    /// damaged one costs little.
    const fn preferred(self) -> usize {
        self.before_six_bit(match self.packets {
            PacketForm::Count | PacketForm::Escape => MAX_COUNT_DATA,
            PacketForm::Long => PREFERRED_PAYLOAD,
        })
    }

    /// Most data bytes of a record.
    const fn longest(self) -> usize {
        self.before_six_bit(match self.packets {
            PacketForm::Count => MAX_COUNT_DATA,
            PacketForm::Escape | PacketForm::Long => MAX_PAYLOAD,
        })
    }

    const fn before_six_bit(self, bytes: usize) -> usize {
        if matches!(self.data, DataForm::SixBit) { bytes / 4 * 3 } else { bytes }
    }

    /// Vectors of a part that fit a packet: each has 16 bytes and a bit, and the part three more.
    const fn part_points(self) -> usize {
        (self.preferred() - 4) * 8 / (16 * 8 + 1)
    }
}

/// Packs records into packets and hands each packet on.
struct Packer<'s, E> {
    sending: Sending,
    route: Route,
    /// Space for the header of a long packet, then the data.
    packet: Vec<u8>,
    /// A packet of another form.
    stream: Vec<u8>,
    send: &'s mut dyn FnMut(&[u8]) -> Result<(), E>,
    failed: Option<E>,
}

impl<'s, E> Packer<'s, E> {
    fn new(sending: Sending, route: Route, send: &'s mut dyn FnMut(&[u8]) -> Result<(), E>) -> Self {
        Packer { sending, route, packet: vec![0; LONG_HEADER], stream: Vec::new(), send, failed: None }
    }

    /// Adds a record, which is never longer than [`Sending::longest`].
    fn record(&mut self, record: &[u8]) {
        if self.packet.len() - LONG_HEADER + record.len() > self.sending.preferred() {
            self.close();
        }
        self.packet.extend_from_slice(record);
    }

    /// Adds text, which may be cut anywhere.
    fn text(&mut self, mut text: &[u8]) {
        while !text.is_empty() {
            let room = self.sending.preferred() - (self.packet.len() - LONG_HEADER);
            let (now, later) = text.split_at(text.len().min(room));
            self.packet.extend_from_slice(now);
            if !later.is_empty() {
                self.close();
            }
            text = later;
        }
    }

    /// Takes what follows for another reader.
    fn turn_to(&mut self, route: Route) {
        if self.route != route {
            self.close();
            self.route = route;
        }
    }

    /// Sends the packet if anything is in it.
    fn close(&mut self) {
        let length = self.packet.len() - LONG_HEADER;
        if length > 0 && self.failed.is_none() {
            self.failed = match (self.sending.packets, self.sending.data, self.route.six_bit()) {
                (form, DataForm::SixBit, Some(route)) => {
                    let mut characters = Vec::new();
                    write_six_bit(&self.packet[LONG_HEADER..], &mut characters);
                    self.send_as(form, route, &characters)
                }
                (PacketForm::Long, _, _) => {
                    self.packet[..LONG_HEADER].copy_from_slice(&long_header(self.route, length));
                    let check = crc32fast::hash(&self.packet[LONG_HEADER..]);
                    self.packet.extend_from_slice(&check.to_le_bytes());
                    (self.send)(&self.packet).err()
                }
                (form, _, _) => {
                    let data = std::mem::take(&mut self.packet);
                    let failed = self.send_as(form, self.route, &data[LONG_HEADER..]);
                    self.packet = data;
                    failed
                }
            };
        }
        self.packet.truncate(LONG_HEADER);
    }

    fn send_as(&mut self, form: PacketForm, route: Route, data: &[u8]) -> Option<E> {
        self.stream.clear();
        // Never longer than the form allows: `record` and `text` see to that.
        let written = write_packet_as(form, route, data, &mut self.stream);
        debug_assert!(written.is_ok(), "{written:?}");
        (self.send)(&self.stream).err()
    }

    /// What failed since the last question.
    fn result(&mut self) -> Result<(), SendError<E>> {
        self.failed.take().map_or(Ok(()), |error| Err(SendError::Send(error)))
    }

    /// Ends with what could not be encoded, after what was before it.
    fn refuse(&mut self, error: EncodeError) -> SendError<E> {
        self.close();
        self.result().err().unwrap_or(SendError::Encode(error))
    }
}

/// Sends commands in a form of data and packets; `send` is given one whole packet after the other. Records are packed
/// together, and the last packet is sent at the end.
///
/// Long vector lists are cut so that they fit the packets. A command with a record that is too long for a packet is
/// sent as text, which may be cut anywhere.
///
/// # Errors
/// A command that exceeds a limit of the records (those before it were sent), or what `send` gave.
pub fn send_commands<'c, E>(
    sending: Sending,
    commands: impl IntoIterator<Item = &'c Command>,
    mut send: impl FnMut(&[u8]) -> Result<(), E>,
) -> Result<(), SendError<E>> {
    let mut packer = Packer::new(sending, Route::Binary, &mut send);
    let mut scratch = Vec::new();
    for command in commands {
        if sending.data == DataForm::Text {
            packer.turn_to(Route::Text);
            scratch.clear();
            print(command, &mut scratch);
            packer.text(&scratch);
        } else if sending == Sending::default() {
            let result = binary::records(command, &mut scratch, &mut |record| packer.record(record));
            result.map_err(|error| packer.refuse(error))?;
        } else {
            short_records(sending, command, &mut scratch, &mut packer).map_err(|error| packer.refuse(error))?;
        }
        packer.result()?;
    }
    packer.close();
    packer.result()
}

/// Packs a command for packets that may be too short for a record.
fn short_records<E>(
    sending: Sending,
    command: &Command,
    scratch: &mut Vec<u8>,
    packer: &mut Packer<'_, E>,
) -> Result<(), EncodeError> {
    let mut records: Vec<Vec<u8>> = Vec::new();
    binary::records_in_parts(command, sending.part_points(), scratch, &mut |record| records.push(record.to_vec()))?;
    if records.iter().all(|record| record.len() <= sending.longest()) {
        packer.turn_to(Route::Binary);
        records.iter().for_each(|record| packer.record(record));
    } else {
        packer.turn_to(Route::Text);
        scratch.clear();
        print(command, scratch);
        packer.text(scratch);
    }
    Ok(())
}

/// Sends raster commands in a form of data and packets, as [`send_commands`] does. Long runs are cut so that they fit
/// the packets; [`DataForm::Text`] stands for the 6-bit form.
///
/// # Errors
/// Those of [`send_commands`].
pub fn send_raster<'c, E>(
    sending: Sending,
    commands: impl IntoIterator<Item = &'c RasterCommand>,
    mut send: impl FnMut(&[u8]) -> Result<(), E>,
) -> Result<(), SendError<E>> {
    let data = if sending.data == DataForm::Text { DataForm::SixBit } else { sending.data };
    let sending = Sending { data, ..sending };
    let most_runs = RUNS.min((sending.preferred() - 3) / 5);
    let mut packer = Packer::new(sending, Route::Raster, &mut send);
    let mut scratch = Vec::new();
    for command in commands {
        let mut record = |command: &RasterCommand, packer: &mut Packer<'_, E>| {
            scratch.clear();
            raster::encode(command, &mut scratch)?;
            packer.record(&scratch);
            Ok(())
        };
        let result = match command {
            RasterCommand::Runs(runs) if runs.len() > most_runs => {
                runs.chunks(most_runs).try_for_each(|runs| record(&RasterCommand::Runs(runs.to_vec()), &mut packer))
            }
            command => record(command, &mut packer),
        };
        result.map_err(|error| packer.refuse(error))?;
        packer.result()?;
    }
    packer.close();
    packer.result()
}

/// Runs in one record when many are sent: what fits a long packet.
const RUNS: usize = 16_384;

const _: () = assert!(RUNS <= raster::MAX_RUNS && RUNS * 5 + 3 <= PREFERRED_PAYLOAD);
// A whole lookup table fits the shortest packet.
const _: () = assert!(4 + 4 * raster::MAX_LOOKUP_ENTRIES <= MAX_COUNT_DATA / 4 * 3);

/// Appends the packets of [`send_commands`] in the default form: binary records.
///
/// # Errors
/// A command that exceeds a limit of the records.
pub fn write_commands<'c>(
    commands: impl IntoIterator<Item = &'c Command>,
    out: &mut Vec<u8>,
) -> Result<(), EncodeError> {
    write_commands_as(Sending::default(), commands, out)
}

/// Appends the packets of [`send_commands`].
///
/// # Errors
/// A command that exceeds a limit of the records.
pub fn write_commands_as<'c>(
    sending: Sending,
    commands: impl IntoIterator<Item = &'c Command>,
    out: &mut Vec<u8>,
) -> Result<(), EncodeError> {
    encoded(send_commands(sending, commands, |packet| collect(packet, out)))
}

/// Appends the packets of [`send_raster`] in the default form: binary records.
///
/// # Errors
/// A command that exceeds a limit of the records.
pub fn write_raster<'c>(
    commands: impl IntoIterator<Item = &'c RasterCommand>,
    out: &mut Vec<u8>,
) -> Result<(), EncodeError> {
    write_raster_as(Sending::default(), commands, out)
}

/// Appends the packets of [`send_raster`].
///
/// # Errors
/// A command that exceeds a limit of the records.
pub fn write_raster_as<'c>(
    sending: Sending,
    commands: impl IntoIterator<Item = &'c RasterCommand>,
    out: &mut Vec<u8>,
) -> Result<(), EncodeError> {
    encoded(send_raster(sending, commands, |packet| collect(packet, out)))
}

fn collect(packet: &[u8], out: &mut Vec<u8>) -> Result<(), Infallible> {
    out.extend_from_slice(packet);
    Ok(())
}

fn encoded(result: Result<(), SendError<Infallible>>) -> Result<(), EncodeError> {
    result.map_err(|error| match error {
        SendError::Encode(error) => error,
        SendError::Send(never) => match never {},
    })
}

#[cfg(test)]
mod tests;
