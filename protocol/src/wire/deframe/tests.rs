//! Facts about the frame decoder.

use super::*;
use crate::wire::packet::{is_escaped, write_count_packet, write_escape_packet, write_packet};
use proptest::prelude::*;

/// A frame that owns its bytes; neighbouring texts are one.
#[derive(Clone, Debug, PartialEq)]
enum Owned {
    Text(Vec<u8>),
    Packet(PacketForm, Route, Vec<u8>),
    Empty,
    Noise(Vec<u8>, NoiseReason),
}

fn frames(pieces: &[&[u8]]) -> (Vec<Owned>, FrameDecoder) {
    let mut decoder = FrameDecoder::default();
    let mut all = Vec::new();
    for piece in pieces {
        decoder.feed(piece, |frame| match frame {
            Frame::Text(bytes) => match all.last_mut() {
                Some(Owned::Text(text)) => text.extend_from_slice(bytes),
                _ => all.push(Owned::Text(bytes.to_vec())),
            },
            Frame::Empty(_) => all.push(Owned::Empty),
            Frame::Packet { form, route, payload, .. } => all.push(Owned::Packet(form, route, payload.to_vec())),
            Frame::Noise { bytes, reason } => all.push(Owned::Noise(bytes.to_vec(), reason)),
        });
    }
    (all, decoder)
}

fn packet(payload: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    write_packet(Route::Binary, payload, &mut out).unwrap();
    out
}

fn long(payload: &[u8]) -> Owned {
    Owned::Packet(PacketForm::Long, Route::Binary, payload.to_vec())
}

#[test]
fn text_and_packets_are_told_apart() {
    let mut stream = b"DISP A;".to_vec();
    stream.extend(packet(b"one"));
    write_count_packet(Route::Text, b"REM A;", &mut stream).unwrap();
    stream.extend(packet(b""));
    stream.extend(b"x");
    let (all, decoder) = frames(&[&stream]);
    let count = Owned::Packet(PacketForm::Count, Route::Text, b"REM A;".to_vec());
    assert_eq!(all, [Owned::Text(b"DISP A;".into()), long(b"one"), count, long(b""), Owned::Text(b"x".into())]);
    let counters = decoder.counters();
    assert_eq!((counters.packets, counters.text_bytes, counters.noise_bytes), (3, 8, 0));
    assert_eq!(counters.packet_bytes as usize + 8, stream.len());
}

#[test]
fn start_bytes_inside_quotes_are_text() {
    let stream = b"\x1c\x20\x2210'\x1c!!\x16\x1d\x160'\x160x\x16\x16";
    let whole = |pieces: &[&[u8]]| {
        let (mut decoder, mut all, mut quoted) = (FrameDecoder::default(), Vec::new(), false);
        for piece in pieces {
            decoder.feed_quoted(piece, |frame| {
                match frame {
                    Frame::Text(bytes) => {
                        quoted ^= bytes.iter().filter(|byte| **byte == b'\'').count() % 2 == 1;
                        all.extend_from_slice(bytes);
                    }
                    Frame::Packet { route, payload, .. } => {
                        all.extend_from_slice(format!("[{route:?} {}]", payload.escape_ascii()).as_bytes());
                    }
                    Frame::Empty(_) => all.extend_from_slice(b"[]"),
                    Frame::Noise { .. } => panic!("{frame:?}"),
                }
                quoted
            });
        }
        String::from_utf8(all).unwrap()
    };
    let expected = "[Binary 0]'\x1c!!\x16\x1d\x160'[Text x][]";
    assert_eq!(whole(&[stream]), expected);
    for cut in 0..stream.len() {
        assert_eq!(whole(&[&stream[..cut], &stream[cut..]]), expected, "cut at {cut}");
    }
}

#[test]
fn a_bad_payload_is_dropped_and_counted() {
    let mut stream = packet(b"damaged");
    stream[LONG_HEADER + 2] ^= 4;
    let length = stream.len();
    stream.extend(packet(b"good"));
    let (all, decoder) = frames(&[&stream]);
    assert_eq!(all, [Owned::Noise(stream[..length].into(), NoiseReason::BadPayload), long(b"good")]);
    assert_eq!((decoder.counters().dropped_packets, decoder.counters().noise_bytes), (1, length as u64));
}

#[test]
fn a_bad_header_is_one_byte_of_noise() {
    let mut stream = packet(b"");
    stream[3] ^= 1;
    let (all, _) = frames(&[&stream, &packet(b"good")]);
    assert_eq!(all[0], Owned::Noise(vec![LONG_START], NoiseReason::BadHeader));
    assert_eq!(all[1], Owned::Text(stream[1..].into()));
    assert_eq!(all[2..], [long(b"good")]);
}

#[test]
fn a_start_byte_without_count_is_noise() {
    let (all, _) = frames(&[b"\x1c\x1cA\x1c  "]);
    let noise = Owned::Noise(vec![28], NoiseReason::BadCount);
    assert_eq!(
        all,
        [noise.clone(), noise.clone(), Owned::Text(b"A".into()), noise, Owned::Text(b"  ".into())].to_vec()
    );
}

fn escaped(data: &[u8]) -> Owned {
    Owned::Packet(PacketForm::Escape, Route::Text, data.to_vec())
}

#[test]
fn an_escape_packet_ends_at_the_next_start_byte() {
    let (all, decoder) = frames(&[b"a\x160one\x160two\x16\x16b\x160three"]);
    let text = |text: &[u8]| Owned::Text(text.into());
    assert_eq!(all, [text(b"a"), escaped(b"one"), escaped(b"two"), Owned::Empty, text(b"b")]);
    assert!(decoder.is_unfinished());
    // The start byte of another form ends it too.
    let mut stream = b"\x160one".to_vec();
    stream.extend(packet(b"long"));
    stream.extend(b"\x160two");
    write_count_packet(Route::Text, b"count", &mut stream).unwrap();
    let count = Owned::Packet(PacketForm::Count, Route::Text, b"count".to_vec());
    assert_eq!(frames(&[&stream]).0, [escaped(b"one"), long(b"long"), escaped(b"two"), count]);
}

#[test]
fn an_escaped_byte_is_data() {
    let data = [16, 22, 28, 29, 16, 17, 0, 255];
    let mut stream = Vec::new();
    write_escape_packet(Route::Text, &data, &mut stream).unwrap();
    write_escape_packet(Route::Other(ESCAPE_START), b"", &mut stream).unwrap();
    stream.extend(b"\x16\x100\x10x\x16\x16");
    let odd = Owned::Packet(PacketForm::Escape, Route::Other(ESCAPE_START), vec![]);
    let all = [escaped(&data), Owned::Empty, odd, Owned::Empty, escaped(b"x"), Owned::Empty];
    let (found, decoder) = frames(&[&stream]);
    assert_eq!(found, all);
    assert_eq!((decoder.counters().packets, decoder.counters().packet_bytes), (3, stream.len() as u64));
}

#[test]
fn an_escape_start_byte_without_a_route_is_noise() {
    let mut stream = vec![ESCAPE_START];
    stream.extend(packet(b"good"));
    let noise = Owned::Noise(vec![ESCAPE_START], NoiseReason::NoRoute);
    assert_eq!(frames(&[&stream]).0, [noise, long(b"good")]);
}

#[test]
fn a_blank_between_empty_packets_brings_any_stream_back_to_text() {
    // Whatever came before: inside a packet, after a start byte or an escape character, or in text.
    for before in [&b""[..], b"x", b"\x16", b"\x160", b"\x160x\x10", b"\x16\x10", b"\x16\x16", b"\x160\x16"] {
        let (all, decoder) = frames(&[before, b"\x16\x16 \x16\x16", b"\x160good\x16\x16"]);
        assert!(!decoder.is_unfinished());
        assert_eq!(all[all.len() - 2..], [escaped(b"good"), Owned::Empty], "{before:?}");
    }
}

#[test]
fn the_longest_escape_packet_arrives_and_a_longer_one_is_noise() {
    let data = vec![ESCAPE; MAX_PAYLOAD];
    let mut stream = Vec::new();
    write_escape_packet(Route::Other(ESCAPE), &data, &mut stream).unwrap();
    assert_eq!(stream.len() - 2, MAX_ESCAPE_STREAM);
    let pieces: Vec<&[u8]> = stream.chunks(65_537).collect();
    let (all, _) = frames(&pieces);
    assert_eq!(all, [Owned::Packet(PacketForm::Escape, Route::Other(ESCAPE), data), Owned::Empty]);
    stream.splice(3..3, [ESCAPE, b'x']);
    let (all, _) = frames(&[&stream]);
    assert!(matches!(&all[0], Owned::Noise(bytes, NoiseReason::TooLong) if bytes.len() == MAX_ESCAPE_STREAM + 1));
}

#[test]
fn the_largest_packet_arrives_and_a_larger_one_is_noise() {
    let payload: Vec<u8> = (0..MAX_PAYLOAD).map(|i| ((i * i) >> 7) as u8).collect();
    let stream = packet(&payload);
    let pieces: Vec<&[u8]> = stream.chunks(100_003).collect();
    let (all, decoder) = frames(&pieces);
    assert_eq!(all, [long(&payload)]);
    assert!(decoder.buffer.len() < MAX_PAYLOAD + 4 * BUFFER_CAPACITY);
    let mut header = [LONG_START, b'1', 1, 0, 16, 0, 0, 0];
    let check = header_check(&header[..6]);
    header[6..].copy_from_slice(&check.to_le_bytes());
    assert_eq!(frames(&[&header]).0[0], Owned::Noise(vec![LONG_START], NoiseReason::BadHeader));
}

#[test]
fn the_end_of_the_stream_gives_up_an_unfinished_packet() {
    let stream = packet(b"unfinished");
    let (all, mut decoder) = frames(&[&stream[..12]]);
    assert!(all.is_empty() && decoder.is_unfinished());
    let noise = Frame::Noise { bytes: &stream[..12], reason: NoiseReason::Truncated };
    assert_eq!(decoder.finish(), Some(noise));
    assert_eq!(decoder.finish(), None);
}

#[test]
fn without_historical_packets_their_start_bytes_are_text() {
    let mut decoder = FrameDecoder::long_packets_only();
    let mut text = Vec::new();
    decoder.feed(b"a\x1c!!\x160b", |frame| match frame {
        Frame::Text(bytes) => text.extend_from_slice(bytes),
        other => panic!("{other:?}"),
    });
    assert_eq!(text, b"a\x1c!!\x160b");
}

/// Bytes in which start bytes and count characters are frequent.
fn bytes(count: impl Into<prop::collection::SizeRange>) -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(prop_oneof![any::<u8>(), prop::sample::select(vec![28, 29, 32, 33, b'0', b'1', 0])], count)
}

fn payloads() -> impl Strategy<Value = Vec<Vec<u8>>> {
    prop::collection::vec(bytes(0..60), 1..8)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]
    #[test]
    fn any_split_gives_the_same_frames(
        noise in bytes(0..40), payloads in payloads(), cuts in prop::collection::vec(any::<prop::sample::Index>(), 0..12)
    ) {
        let mut stream = noise;
        for (index, payload) in payloads.iter().enumerate() {
            match index % 3 {
                0 => stream.extend(packet(payload)),
                1 => write_count_packet(Route::Text, payload, &mut stream).unwrap(),
                _ => write_escape_packet(Route::Text, payload, &mut stream).unwrap(),
            }
        }
        let mut cuts: Vec<usize> = cuts.iter().map(|cut| cut.index(stream.len())).chain([0, stream.len()]).collect();
        cuts.sort_unstable();
        let pieces: Vec<&[u8]> = cuts.windows(2).map(|cut| &stream[cut[0]..cut[1]]).collect();
        let (whole, _) = frames(&[&stream]);
        prop_assert_eq!(&frames(&pieces).0, &whole);
        let single: Vec<&[u8]> = stream.chunks(1).collect();
        prop_assert_eq!(&frames(&single).0, &whole);
    }

    #[test]
    fn packets_behind_noise_arrive(noises in payloads(), payloads in payloads()) {
        // Noise between packets, but no historical start byte: those packets carry no check.
        let mut stream = Vec::new();
        let mut expected = Vec::new();
        for (noise, payload) in noises.iter().zip(&payloads) {
            stream.extend(noise.iter().map(|b| if matches!(*b, COUNT_START | ESCAPE_START) { b'!' } else { *b }));
            stream.extend(packet(payload));
            expected.push(long(payload));
        }
        let packets: Vec<Owned> = frames(&[&stream]).0.into_iter().filter(|f| matches!(f, Owned::Packet(..))).collect();
        prop_assert_eq!(packets, expected);
    }

    #[test]
    fn escape_packets_behind_noise_arrive(noises in payloads(), payloads in payloads()) {
        // The noise holds start bytes of escape packets and escape characters, but not of the packets with a length.
        let mut stream = Vec::new();
        for (noise, payload) in noises.iter().zip(&payloads) {
            stream.extend(noise.iter().filter(|byte| !matches!(**byte, COUNT_START | LONG_START)));
            // An escape character would take the first start byte, and a packet the second.
            stream.extend([b'.', ESCAPE_START, ESCAPE_START, ESCAPE_START, ESCAPE_START]);
            write_escape_packet(Route::Binary, payload, &mut stream).unwrap();
        }
        let all = frames(&[&stream]).0;
        let mut rest = all.iter();
        for payload in noises.iter().zip(&payloads).map(|pair| pair.1) {
            let expected = Owned::Packet(PacketForm::Escape, Route::Binary, payload.clone());
            prop_assert!(rest.any(|frame| *frame == expected), "{:?} in {:?}", expected, all);
        }
    }

    #[test]
    fn an_escape_packet_holds_no_bare_start_byte(data in bytes(0..100)) {
        let mut stream = Vec::new();
        write_escape_packet(Route::Text, &data, &mut stream).unwrap();
        let inner = &stream[1..stream.len() - 2];
        let bare = inner.iter().enumerate().filter(|(at, byte)| is_escaped(**byte) && **byte != ESCAPE && inner[at - 1] != ESCAPE);
        prop_assert_eq!(bare.count(), 0);
    }

    #[test]
    fn damage_costs_only_what_it_touches(
        payloads in payloads(), damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4)
    ) {
        // The damaged packets come first; after them a run of text longer than any count packet, then a good one.
        let mut stream = Vec::new();
        payloads.iter().for_each(|payload| stream.extend(packet(payload)));
        for (place, byte) in damage {
            let at = place.index(stream.len());
            match byte % 3 {
                0 => stream[at] = byte,
                1 => stream.insert(at, byte),
                _ => drop(stream.remove(at)),
            }
        }
        stream.extend(vec![b'.'; COUNT_RADIX * COUNT_RADIX]);
        stream.extend(packet(b"good"));
        let (all, _) = frames(&[&stream]);
        prop_assert_eq!(all.last(), Some(&long(b"good")));
    }

    #[test]
    fn the_frames_cover_the_stream(stream in bytes(0..400)) {
        let mut decoder = FrameDecoder::default();
        let mut covered = 0;
        decoder.feed(&stream, |frame| covered += frame.stream_length());
        covered += decoder.finish().map_or(0, |frame| frame.stream_length());
        prop_assert_eq!(covered, stream.len());
    }
}
