//! No stream of bytes, however damaged, panics or stops the decoders.
//!
//! In the long lane, with `PERIS_LONG=1`, each property is tried on 250,000 streams.

use proptest::{
    prelude::*,
    sample::{Index, select},
};
use protocol::{
    command::{print, strategy::commands},
    listing::Listing,
    raster::{LookupEntry, RasterCommand, Run},
    wire::{
        DataForm, MessageForm, MessageReader, PacketForm, Route, Sending, write_commands_as, write_count_packet,
        write_escape_packet, write_packet, write_raster_as,
    },
};

/// A good stream of text, binary commands and raster records.
fn streams() -> impl Strategy<Value = Vec<u8>> {
    let sending = (select(PacketForm::ALL.to_vec()), select(DataForm::ALL.to_vec()))
        .prop_map(|(packets, data)| Sending { packets: packets.0, data: data.0 });
    prop::collection::vec((commands(), 0..6_u8, sending), 1..6).prop_map(|parts| {
        let mut stream = Vec::new();
        for (command, kind, sending) in &parts {
            let mut text = Vec::new();
            print(command, &mut text);
            match kind {
                // Outside packets the start bytes cannot stand in a text.
                0 => stream.extend(text.iter().filter(|b| !matches!(b, 22 | 28 | 29))),
                1 => write_packet(Route::Text, &text, &mut stream).expect("it is short"),
                2 => text.chunks(1000).for_each(|text| {
                    write_count_packet(Route::Text, text, &mut stream).expect("it is short");
                }),
                3 => write_escape_packet(Route::Text, &text, &mut stream).expect("it is short"),
                4 => write_commands_as(*sending, [command], &mut stream).expect("it is short"),
                _ => {
                    let runs = text.iter().map(|b| Run { count: u16::from(*b), color: [*b; 3] }).collect();
                    let entries = vec![LookupEntry { count: 1, color: [1, 2, 3] }];
                    let commands = [RasterCommand::Runs(runs), RasterCommand::LookupTable { index: 9, entries }];
                    write_raster_as(*sending, &commands, &mut stream).expect("it is short");
                }
            }
        }
        stream
    })
}

/// Lists the stream, in pieces, with every decoder; gives the listing.
fn decode(stream: &[u8], size: usize) -> String {
    let mut text = String::new();
    let mut listing = Listing::default();
    for piece in stream.chunks(size) {
        listing.push(piece, &mut text).expect("a string takes all text");
    }
    listing.finish(&mut text).expect("a string takes all text");
    for form in MessageForm::ALL {
        let mut reader = MessageReader::default();
        reader.expect(form);
        stream.chunks(size).for_each(|piece| reader.push(piece));
        let bytes: usize = reader.map(|message| message.map_or(0, |message| message.len())).sum();
        assert!(bytes <= stream.len());
    }
    text
}

/// How many streams of each kind.
fn cases() -> u32 {
    if std::env::var("PERIS_LONG").is_ok_and(|value| value == "1") { 250_000 } else { 300 }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases()))]
    #[test]
    fn good_streams_have_no_errors(stream in streams(), size in 1..500_usize) {
        let listing = decode(&stream, size);
        prop_assert!(!listing.contains("  error: ") && !listing.contains("not read"), "{}", listing);
    }

    #[test]
    fn damaged_streams_are_decoded_to_their_end(
        stream in streams(), size in 1..500_usize,
        damage in prop::collection::vec((any::<Index>(), any::<u8>(), select(b"sid".to_vec())), 1..20)
    ) {
        let mut stream = stream;
        for (place, byte, kind) in damage {
            let at = place.index(stream.len().max(1)).min(stream.len());
            match kind {
                b'i' => stream.insert(at, byte),
                b'd' if at < stream.len() => drop(stream.remove(at)),
                _ if at < stream.len() => stream[at] = byte,
                _ => {}
            }
        }
        prop_assert!(stream.is_empty() || !decode(&stream, size).is_empty());
    }

    #[test]
    fn random_bytes_are_decoded_to_their_end(stream in prop::collection::vec(any::<u8>(), 1..600), size in 1..100_usize) {
        prop_assert!(!decode(&stream, size).is_empty());
    }

    #[test]
    fn damaged_records_in_good_packets_are_decoded_to_their_end(
        command in commands(), damage in prop::collection::vec((any::<Index>(), any::<u8>()), 0..6), raster in any::<bool>()
    ) {
        // The checks of the packet are right, so that the damage reaches the records.
        let mut body = Vec::new();
        protocol::command::encode(&command, &mut body).expect("it is short");
        for (place, byte) in damage {
            let at = place.index(body.len());
            body[at] = byte;
        }
        let mut stream = Vec::new();
        let route = if raster { Route::Raster } else { Route::Binary };
        write_packet(route, &body, &mut stream).expect("it is short");
        prop_assert!(decode(&stream, 77).lines().last().is_some_and(|row| row.ends_with("check of the payload")));
    }
}
