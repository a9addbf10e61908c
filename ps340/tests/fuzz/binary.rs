//! Target: the binary records of commands and of the raster, as they are and in the 6-bit form.

use crate::{campaign::Target, pool::Features, seeds, vocabulary::pairs};
use protocol::{
    command::{BinaryDecoder, Command, encode, print, reference::name_of},
    raster,
    wire::{DataForm, Frame, FrameDecoder, PacketForm, Route, Sending, read_six_bit, write_commands_as, write_six_bit},
};

pub static BINARY: Target = Target { name: "binary", seeds: seeds::records, run };

/// What stands between two packets in an input.
pub const BETWEEN: &[u8] = &[0xFE, 0xFD];

fn run(input: &[u8], features: &mut Features) {
    let mut decoder = BinaryDecoder::default();
    for body in bodies(input) {
        for result in decoder.push(body) {
            match result {
                Ok(command) => {
                    features.saw(("command", name_of(&command)));
                    pairs(&command, |before, word| features.saw((before, word)));
                    check(&command);
                }
                Err(error) => features.saw((error.field, std::mem::discriminant(&error.problem))),
            }
        }
        check_raster(body, features);
        check_six_bit(body, features);
    }
    features.saw(("unfinished", decoder.is_unfinished()));
}

fn bodies(input: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = Some(input);
    std::iter::from_fn(move || {
        let all = rest?;
        let end = all.windows(BETWEEN.len()).position(|window| window == BETWEEN);
        rest = end.map(|end| &all[end + BETWEEN.len()..]);
        Some(&all[..end.unwrap_or(all.len())])
    })
}

/// A command that was decoded is encoded, and decoded as the same; in every packet and form that can carry it too.
fn check(command: &Command) {
    let mut body = Vec::new();
    encode(command, &mut body).unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert_eq!(decoded(&body), std::slice::from_ref(command));
    let mut text = Vec::new();
    print(command, &mut text);
    let packets = PacketForm::ALL[body.len() % PacketForm::ALL.len()].0;
    for data in [DataForm::EightBit, DataForm::SixBit] {
        let mut stream = Vec::new();
        // A record may be too long for a short packet.
        if write_commands_as(Sending { packets, data }, [command], &mut stream).is_ok() {
            assert_eq!(received(&stream), std::slice::from_ref(command), "{packets:?} {data:?}");
        }
    }
}

fn decoded(body: &[u8]) -> Vec<Command> {
    BinaryDecoder::default().push(body).map(|result| result.unwrap_or_else(|error| panic!("{error}"))).collect()
}

/// The commands in the packets of a stream.
fn received(stream: &[u8]) -> Vec<Command> {
    let (mut decoder, mut commands, mut eight) = (BinaryDecoder::default(), Vec::new(), Vec::new());
    FrameDecoder::default().feed(&[stream, b"\x16\x16"].concat(), |frame| {
        let Frame::Packet { route, payload, .. } = frame else { return };
        let body = if route == Route::SixBitBinary {
            eight.clear();
            read_six_bit(payload, &mut eight).expect("what was written can be read");
            &eight[..]
        } else {
            payload
        };
        commands.extend(decoder.push(body).map(|result| result.expect("what was written can be read")));
    });
    commands
}

fn check_raster(body: &[u8], features: &mut Features) {
    for result in raster::decode(body) {
        match result {
            Ok(command) => {
                features.saw(("raster", std::mem::discriminant(&command)));
                let mut again = Vec::new();
                raster::encode(&command, &mut again).unwrap_or_else(|error| panic!("{command:?}: {error}"));
                assert_eq!(raster::decode(&again).collect::<Vec<_>>(), [Ok(command)]);
            }
            Err(error) => features.saw(("raster", error.field, std::mem::discriminant(&error.problem))),
        }
    }
}

fn check_six_bit(body: &[u8], features: &mut Features) {
    let mut characters = Vec::new();
    write_six_bit(body, &mut characters);
    let mut bytes = Vec::new();
    read_six_bit(&characters, &mut bytes).expect("what was written can be read");
    assert_eq!(bytes, body);
    bytes.clear();
    match read_six_bit(body, &mut bytes) {
        Ok(()) => {
            let mut again = Vec::new();
            write_six_bit(&bytes, &mut again);
            assert!(again.iter().eq(body.iter().filter(|byte| **byte > b' ')));
        }
        Err(error) => features.saw(("6-bit", std::mem::discriminant(&error))),
    }
}
