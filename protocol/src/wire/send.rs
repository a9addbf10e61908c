//! Binary commands and raster records packed into long packets.

use super::packet::{LONG_HEADER, MAX_PAYLOAD, Route, long_header};
use crate::{
    command::{Command, binary},
    raster::{self, RasterCommand},
    record::EncodeError,
};
use std::convert::Infallible;

/// Payload bytes after which a packet is closed, so that it stays in the caches on both sides. Ours.
pub const PREFERRED_PAYLOAD: usize = 136 << 10;

const _: () = assert!(PREFERRED_PAYLOAD <= MAX_PAYLOAD);
const _: () = assert!(binary::PART_POINTS * 16 + binary::PART_POINTS / 8 + 3 <= PREFERRED_PAYLOAD);

/// Why commands were not sent.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum SendError<E> {
    /// A command has no binary form.
    #[error(transparent)]
    Encode(EncodeError),
    /// The receiver of the packets failed.
    #[error(transparent)]
    Send(E),
}

/// Packs records into packets and hands each packet on.
struct Packer<'s, E> {
    route: Route,
    packet: Vec<u8>,
    send: &'s mut dyn FnMut(&[u8]) -> Result<(), E>,
    failed: Option<E>,
}

impl<'s, E> Packer<'s, E> {
    fn new(route: Route, send: &'s mut dyn FnMut(&[u8]) -> Result<(), E>) -> Self {
        Packer { route, packet: vec![0; LONG_HEADER], send, failed: None }
    }

    /// Adds a record, which is never longer than a packet.
    fn record(&mut self, record: &[u8]) {
        if self.packet.len() - LONG_HEADER + record.len() > PREFERRED_PAYLOAD {
            self.close();
        }
        self.packet.extend_from_slice(record);
    }

    /// Sends the packet if anything is in it.
    fn close(&mut self) {
        let length = self.packet.len() - LONG_HEADER;
        if length > 0 && self.failed.is_none() {
            self.packet[..LONG_HEADER].copy_from_slice(&long_header(self.route, length));
            let check = crc32fast::hash(&self.packet[LONG_HEADER..]);
            self.packet.extend_from_slice(&check.to_le_bytes());
            self.failed = (self.send)(&self.packet).err();
        }
        self.packet.truncate(LONG_HEADER);
    }

    /// What failed since the last question.
    fn result(&mut self) -> Result<(), SendError<E>> {
        self.failed.take().map_or(Ok(()), |error| Err(SendError::Send(error)))
    }
}

/// Sends commands as binary packets; `send` is given one whole packet after the other. Records are packed together, and
/// the last packet is sent at the end.
///
/// # Errors
/// A command that exceeds a limit of the records (those before it were sent), or what `send` gave.
pub fn send_commands<'c, E>(
    commands: impl IntoIterator<Item = &'c Command>,
    mut send: impl FnMut(&[u8]) -> Result<(), E>,
) -> Result<(), SendError<E>> {
    let mut packer = Packer::new(Route::Binary, &mut send);
    let mut scratch = Vec::new();
    for command in commands {
        let result = binary::records(command, &mut scratch, &mut |record| packer.record(record));
        if let Err(error) = result {
            packer.close();
            packer.result()?;
            return Err(SendError::Encode(error));
        }
        packer.result()?;
    }
    packer.close();
    packer.result()
}

/// Sends raster commands as packets, as [`send_commands`] does.
///
/// # Errors
/// A command that exceeds a limit of the records (those before it were sent), or what `send` gave.
pub fn send_raster<'c, E>(
    commands: impl IntoIterator<Item = &'c RasterCommand>,
    mut send: impl FnMut(&[u8]) -> Result<(), E>,
) -> Result<(), SendError<E>> {
    let mut packer = Packer::new(Route::Raster, &mut send);
    let mut scratch = Vec::new();
    for command in commands {
        let mut record = |command: &RasterCommand, packer: &mut Packer<'_, E>| {
            scratch.clear();
            raster::encode(command, &mut scratch)?;
            packer.record(&scratch);
            Ok(())
        };
        let result = match command {
            RasterCommand::Runs(runs) if runs.len() > RUNS => {
                runs.chunks(RUNS).try_for_each(|runs| record(&RasterCommand::Runs(runs.to_vec()), &mut packer))
            }
            command => record(command, &mut packer),
        };
        if let Err(error) = result {
            packer.close();
            packer.result()?;
            return Err(SendError::Encode(error));
        }
        packer.result()?;
    }
    packer.close();
    packer.result()
}

/// Runs in one record when many are sent: what fits a packet.
const RUNS: usize = 16_384;

const _: () = assert!(RUNS <= raster::MAX_RUNS && RUNS * 5 + 3 <= PREFERRED_PAYLOAD);

/// Appends the packets of [`send_commands`].
///
/// # Errors
/// A command that exceeds a limit of the records.
pub fn write_commands<'c>(
    commands: impl IntoIterator<Item = &'c Command>,
    out: &mut Vec<u8>,
) -> Result<(), EncodeError> {
    encoded(send_commands(commands, |packet| collect(packet, out)))
}

/// Appends the packets of [`send_raster`].
///
/// # Errors
/// A command that exceeds a limit of the records.
pub fn write_raster<'c>(
    commands: impl IntoIterator<Item = &'c RasterCommand>,
    out: &mut Vec<u8>,
) -> Result<(), EncodeError> {
    encoded(send_raster(commands, |packet| collect(packet, out)))
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
mod tests {
    use super::*;
    use crate::{
        command::{BinaryDecoder, Object, VectorClass, VectorList, strategy::commands},
        raster::Run,
        wire::{Frame, FrameDecoder},
    };
    use proptest::prelude::*;

    fn received(stream: &[u8]) -> Vec<Command> {
        let (mut frames, mut binary, mut all) = (FrameDecoder::default(), BinaryDecoder::default(), Vec::new());
        frames.feed(stream, |frame| match frame {
            Frame::Packet { route: Route::Binary, payload, .. } => all.extend(binary.push(payload).map(Result::unwrap)),
            other => panic!("{other:?}"),
        });
        all
    }

    #[test]
    fn a_long_list_is_cut_into_packets_between_records() {
        let points = (0..100_000).map(|i| [i as f32, 0.0, 1.0, 1.0]).collect();
        let list = VectorList {
            block_normalized: true,
            fourth: crate::command::Fourth::Intensity,
            internal_units: false,
            class: VectorClass::Separate,
            dimension: 3,
            estimate: None,
            points,
            lines: Vec::new(),
        };
        let command = Command::Define { name: None, object: Object::VectorList(list) };
        let mut packets = 0;
        let sent: Result<(), SendError<()>> = send_commands([&command], |packet| {
            packets += 1;
            assert!(packet.len() <= PREFERRED_PAYLOAD + 12);
            Ok(())
        });
        assert_eq!((sent, packets), (Ok(()), 13));
        let mut stream = Vec::new();
        write_commands([&command, &Command::EndStructure], &mut stream).unwrap();
        assert!(received(&stream) == [command, Command::EndStructure]);
    }

    #[test]
    fn the_failure_of_the_receiver_ends_the_sending() {
        let commands = vec![Command::Define { name: None, object: Object::Instance(vec![name(); 10_000]) }; 10];
        let mut packets = 0;
        let result = send_commands(&commands, |_| {
            packets += 1;
            if packets == 2 { Err("closed") } else { Ok(()) }
        });
        assert_eq!((result, packets), (Err(SendError::Send("closed")), 2));
    }

    fn name() -> crate::Name {
        crate::Name::new("A123456789").unwrap()
    }

    #[test]
    fn commands_before_one_without_binary_form_are_sent() {
        let long = Command::Define { name: None, object: Object::Instance(vec![name(); 70_000]) };
        let mut stream = Vec::new();
        assert!(write_commands([&Command::EndStructure, &long], &mut stream).is_err());
        assert_eq!(received(&stream), [Command::EndStructure]);
    }

    #[test]
    fn the_runs_of_a_whole_screen_arrive() {
        let runs: Vec<Run> =
            (0..307_200_u32).map(|i| Run { count: 1, color: i.to_le_bytes()[..3].try_into().unwrap() }).collect();
        let commands = [RasterCommand::Erase { color: [1, 2, 3] }, RasterCommand::Runs(runs.clone())];
        let mut stream = Vec::new();
        write_raster(&commands, &mut stream).unwrap();
        let mut received = Vec::new();
        FrameDecoder::default().feed(&stream, |frame| match frame {
            Frame::Packet { route: Route::Raster, payload, .. } => {
                for command in raster::decode(payload) {
                    match command.unwrap() {
                        RasterCommand::Runs(runs) => received.extend(runs),
                        other => assert_eq!(other, commands[0]),
                    }
                }
            }
            other => panic!("{other:?}"),
        });
        assert!(received == runs);
    }

    proptest! {
        #[test]
        fn commands_arrive_in_order(commands in prop::collection::vec(commands(), 0..8)) {
            let mut stream = Vec::new();
            write_commands(&commands, &mut stream).unwrap();
            prop_assert_eq!(received(&stream), commands);
        }
    }
}
