//! Facts about the senders.

use super::*;
use crate::{
    command::{BinaryDecoder, CommandReader, Object, VectorClass, VectorList, strategy::commands},
    raster::Run,
    wire::{COUNT_START, ESCAPE_START, Frame, FrameDecoder, read_six_bit},
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
    let sent: Result<(), SendError<()>> = send_commands(Sending::default(), [&command], |packet| {
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
    let result = send_commands(Sending::default(), &commands, |_| {
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

/// What arrives, by whichever route.
fn received_as(stream: &[u8]) -> (Vec<Command>, Vec<RasterCommand>) {
    let (mut frames, mut binary, mut text) =
        (FrameDecoder::default(), BinaryDecoder::default(), CommandReader::default());
    let (mut commands, mut operations) = (Vec::new(), Vec::new());
    frames.feed(stream, |frame| match frame {
        Frame::Packet { route, payload, .. } => {
            let mut bytes = payload.to_vec();
            if matches!(route, Route::SixBitBinary | Route::SixBitRaster) {
                bytes.clear();
                read_six_bit(payload, &mut bytes).unwrap();
            }
            match route {
                Route::Text => {
                    text.push(&bytes);
                    commands.extend(text.by_ref().map(|read| read.unwrap().command));
                }
                Route::Binary | Route::SixBitBinary => commands.extend(binary.push(&bytes).map(Result::unwrap)),
                Route::Raster | Route::SixBitRaster => operations.extend(raster::decode(&bytes).map(Result::unwrap)),
                other => panic!("{other:?}"),
            }
        }
        Frame::Empty(_) => {}
        other => panic!("{other:?}"),
    });
    (commands, operations)
}

/// Every form of packets with every form of data.
fn sendings() -> impl Iterator<Item = Sending> {
    let with = |packets| DataForm::ALL.map(|data| Sending { packets, data: data.0 });
    PacketForm::ALL.into_iter().flat_map(move |packets| with(packets.0))
}

#[test]
fn a_record_that_fits_no_packet_is_sent_as_text() {
    let long = Command::Define { name: Some(name()), object: Object::Instance(vec![name(); 2_000]) };
    let commands = [Command::EndStructure, long, Command::Display(name())];
    for sending in sendings() {
        let mut stream = Vec::new();
        write_commands_as(sending, &commands, &mut stream).unwrap();
        assert!(received_as(&stream).0 == commands, "{sending:?}");
    }
}

#[test]
fn short_packets_carry_long_lists_and_long_runs() {
    let points = (0..5_000).map(|i| [i as f32, 0.5, 1.0, 1.0]).collect();
    let lines = (0..5_000).map(|i| i % 3 == 1).collect();
    let list = VectorList {
        block_normalized: false,
        fourth: crate::command::Fourth::Intensity,
        internal_units: false,
        class: VectorClass::Itemized,
        dimension: 3,
        estimate: Some(5_000),
        points,
        lines,
    };
    let commands = [Command::Define { name: Some(name()), object: Object::VectorList(list) }];
    let runs: Vec<Run> = (0..3_000).map(|i| Run { count: i, color: [22, 16, i as u8] }).collect();
    for sending in sendings() {
        let (mut stream, mut packets) = (Vec::new(), 0);
        let sent: Result<(), SendError<()>> = send_commands(sending, &commands, |packet| {
            packets += 1;
            assert!(sending.packets == PacketForm::Long || packet.len() <= 2 * MAX_COUNT_DATA + 5);
            stream.extend_from_slice(packet);
            Ok(())
        });
        assert_eq!((sent, packets > 15), (Ok(()), sending.packets != PacketForm::Long));
        write_raster_as(sending, &[RasterCommand::Runs(runs.clone())], &mut stream).unwrap();
        let (arrived, operations) = received_as(&stream);
        assert!(arrived == commands, "{sending:?}");
        let arrived: Vec<Run> = operations
            .into_iter()
            .flat_map(|o| if let RasterCommand::Runs(runs) = o { runs } else { vec![] })
            .collect();
        assert!(arrived == runs, "{sending:?}");
    }
}

#[test]
fn the_six_bit_form_is_printable_but_for_the_start_bytes() {
    let points = (0..3_000).map(|i| [f32::from_bits(0x3f80_0000 + i * 977), 0.5, 1.0, 1.0]).collect();
    let (class, lines) = (VectorClass::Dots, Vec::new());
    let list = VectorList {
        block_normalized: true,
        fourth: crate::command::Fourth::Intensity,
        internal_units: false,
        class,
        dimension: 3,
        estimate: None,
        points,
        lines,
    };
    let commands = [Command::Define { name: Some(name()), object: Object::VectorList(list) }];
    for (packets, start) in [(PacketForm::Count, COUNT_START), (PacketForm::Escape, ESCAPE_START)] {
        let mut stream = Vec::new();
        write_commands_as(Sending { packets, data: DataForm::SixBit }, &commands, &mut stream).unwrap();
        assert!(stream.iter().all(|byte| *byte == start || (b' '..127).contains(byte)));
    }
}

proptest! {
    #[test]
    fn commands_arrive_in_order(commands in prop::collection::vec(commands(), 0..8)) {
        let mut stream = Vec::new();
        write_commands(&commands, &mut stream).unwrap();
        prop_assert_eq!(received(&stream), commands);
    }

    #[test]
    fn commands_arrive_in_order_in_every_form(commands in prop::collection::vec(commands(), 0..6)) {
        // The text of BEGIN_STRUCTURE has no end of its own, and !RESET drops a text that has not ended.
        let ended = |command| match command {
            Command::Reset => vec![Command::EndStructure, Command::Reset],
            command => vec![command],
        };
        let commands: Vec<Command> = commands.into_iter().flat_map(ended).chain([Command::EndStructure]).collect();
        for sending in sendings() {
            let mut stream = Vec::new();
            write_commands_as(sending, &commands, &mut stream).unwrap();
            let (arrived, _) = received_as(&stream);
            prop_assert!(arrived == commands, "{:?}: {:?} for {:?}", sending, arrived, commands);
        }
    }
}
