//! Target: packets, messages, words of the parallel interface, captures, and their listings.

use crate::{campaign::Target, chance::Chance, pool::Features, seeds};
use protocol::{
    capture::{CaptureReader, Event, HEADER, MAX_OPERATOR_COMMAND, PIECE},
    listing::Listing,
    parallel::{self, ParallelFrameReader, Side},
    wire::{
        Counters, Frame, FrameDecoder, MessageForm, MessageReader, NoiseReason, PacketForm, Route, write_packet_as,
    },
};

pub static PACKETS: Target = Target { name: "packets", seeds: seeds::streams, run };

/// A frame that stands for itself; neighbouring texts are one.
#[derive(Clone, Debug, PartialEq)]
enum Piece {
    Text(Vec<u8>),
    Packet { form: PacketForm, route: Route, payload: Vec<u8>, raw: Vec<u8> },
    Empty,
    Noise(Vec<u8>, NoiseReason),
}

fn run(input: &[u8], features: &mut Features) {
    let pieces = cut(input);
    for decoder in [FrameDecoder::default(), FrameDecoder::long_packets_only()] {
        let whole = deframe(decoder.clone(), &[input]);
        assert_eq!(whole, deframe(decoder, &pieces), "the same frames however the stream is cut");
        let counters = whole.1;
        let bytes = counters.packet_bytes + counters.text_bytes + counters.noise_bytes;
        assert_eq!(bytes, input.len() as u64, "every byte is counted once: {counters:?}");
        whole.0.iter().for_each(check_packet);
        observe(&whole.0, features);
    }
    check_listing(&list(&[input]), input.len());
    check_listing(&list(&pieces), input.len());
    for form in MessageForm::ALL {
        let messages = |pieces: &[&[u8]]| {
            let mut reader = MessageReader::default();
            reader.expect(form);
            let mut messages = Vec::new();
            for piece in pieces {
                reader.push(piece);
                messages.extend(reader.by_ref());
            }
            messages
        };
        let whole = messages(&[input]);
        assert_eq!(whole, messages(&pieces), "the same messages however the stream is cut");
        features.saw_amount("messages", whole.len() as u64);
    }
    words(input, &pieces, features);
    captured(input, &pieces, features);
}

/// Cuts by lot, the same each time.
fn cut(input: &[u8]) -> Vec<&[u8]> {
    let mut chance = Chance::new(input.len() as u64);
    let longest = 1 + chance.below(80);
    let (mut pieces, mut rest) = (Vec::new(), input);
    while !rest.is_empty() {
        let (piece, behind) = rest.split_at((1 + chance.below(longest)).min(rest.len()));
        pieces.push(piece);
        rest = behind;
    }
    pieces
}

fn deframe(mut decoder: FrameDecoder, pieces: &[&[u8]]) -> (Vec<Piece>, Counters) {
    let mut found = Vec::new();
    for piece in pieces {
        decoder.feed(piece, |frame| add(&mut found, frame));
    }
    if let Some(frame) = decoder.finish() {
        add(&mut found, frame);
    }
    (found, decoder.counters())
}

fn add(found: &mut Vec<Piece>, frame: Frame<'_>) {
    match (frame, found.last_mut()) {
        (Frame::Text(text), Some(Piece::Text(before))) => before.extend_from_slice(text),
        (Frame::Text(text), _) => found.push(Piece::Text(text.to_vec())),
        (Frame::Packet { form, route, payload, raw }, _) => {
            found.push(Piece::Packet { form, route, payload: payload.to_vec(), raw: raw.to_vec() });
        }
        (Frame::Empty(_), _) => found.push(Piece::Empty),
        (Frame::Noise { bytes, reason }, _) => found.push(Piece::Noise(bytes.to_vec(), reason)),
    }
}

/// A packet that was read is written so; an escape packet may escape more than it must.
fn check_packet(piece: &Piece) {
    let Piece::Packet { form, route, payload, raw } = piece else { return };
    let mut written = Vec::new();
    write_packet_as(*form, *route, payload, &mut written).unwrap_or_else(|error| panic!("{piece:?}: {error}"));
    if *form == PacketForm::Escape {
        let again = deframe(FrameDecoder::default(), &[&written]).0;
        let same =
            |piece: &&Piece| matches!(piece, Piece::Packet { payload: p, route: r, .. } if p == payload && r == route);
        assert!(again.first().as_ref().is_some_and(same), "{again:?}");
    } else {
        assert_eq!(&written, raw);
    }
}

fn observe(pieces: &[Piece], features: &mut Features) {
    let mut before = (None, None);
    for piece in pieces {
        let now = match piece {
            Piece::Text(_) => (Some(0), None),
            Piece::Packet { form, route, payload, .. } => {
                features.saw((*form as u8, route.code(), payload.len().checked_ilog2()));
                (Some(1 + *form as u8), Some(route.word()))
            }
            Piece::Empty => (Some(10), None),
            Piece::Noise(_, reason) => (Some(20 + *reason as u8), None),
        };
        features.saw((before, now));
        before = now;
    }
}

fn list(pieces: &[&[u8]]) -> String {
    let mut text = String::new();
    let mut listing = Listing::default();
    for piece in pieces {
        listing.push(piece, &mut text).expect("a string takes all text");
    }
    listing.finish(&mut text).expect("a string takes all text");
    text
}

/// The rows show every byte of the stream, in order, or say how many are left out.
fn check_listing(listing: &str, length: usize) {
    let mut next = 0;
    for row in listing.lines() {
        if !row.starts_with(' ') {
            let offset = usize::from_str_radix(&row[..8], 16).expect("a row begins with its offset");
            assert_eq!(offset, next, "{row}\n{listing}");
            next += row.get(10..58).unwrap_or(&row[10..]).split_whitespace().count();
        } else if let Some(left_out) =
            row.trim_start().strip_suffix(" bytes more").and_then(|n| n.parse::<usize>().ok())
        {
            next += left_out;
        }
    }
    assert_eq!(next, length, "{listing}");
}

/// The words of the parallel interface.
fn words(input: &[u8], pieces: &[&[u8]], features: &mut Features) {
    let frames = |pieces: &[&[u8]]| {
        let mut reader = ParallelFrameReader::default();
        let mut frames = Vec::new();
        for piece in pieces {
            reader.push(piece);
            frames.extend(reader.by_ref());
        }
        frames
    };
    let whole = frames(&[input]);
    assert_eq!(whole, frames(pieces), "the same words however the stream is cut");
    for frame in &whole {
        match frame {
            parallel::ParallelFrame::Word(word) => {
                features.saw(parallel::CommandWord::from_word(*word).map(|command| command.code.name()))
            }
            parallel::ParallelFrame::Block(bytes) => features.saw_amount("block", bytes.len() as u64),
            parallel::ParallelFrame::Reset | parallel::ParallelFrame::Noise(_) => {}
        }
    }
    let mut listing = parallel::ParallelListing::default();
    let mut text = String::new();
    for (index, piece) in pieces.iter().enumerate() {
        listing.push(if index % 3 == 1 { Side::Machine } else { Side::Host }, piece, &mut text);
    }
}

/// Captures: what is read is written so, and read the same.
fn captured(input: &[u8], pieces: &[&[u8]], features: &mut Features) {
    let read = |pieces: &[&[u8]]| {
        let mut reader = CaptureReader::default();
        let mut records = Vec::new();
        for piece in pieces {
            reader.push(piece);
            records.extend(reader.by_ref());
        }
        reader.finish();
        records.extend(reader);
        records
    };
    let whole = read(&[input]);
    assert_eq!(whole, read(pieces), "the same records however the file is cut");
    for item in whole {
        match item {
            Ok(record) => {
                features.saw(std::mem::discriminant(&record.event));
                let fits = match &record.event {
                    Event::Open(peer) => peer.len() <= 1024,
                    Event::OperatorCommand(order) => order.len() <= MAX_OPERATOR_COMMAND,
                    Event::FromHost(bytes) | Event::ToHost(bytes) => (1..=PIECE).contains(&bytes.len()),
                    Event::Close => true,
                };
                if fits {
                    let mut text = format!("{HEADER}\n");
                    record.write(&mut text);
                    assert_eq!(read(&[text.as_bytes()]), [Ok(record)], "{text}");
                }
            }
            Err(error) => features.saw(std::mem::discriminant(&error.problem)),
        }
    }
}
