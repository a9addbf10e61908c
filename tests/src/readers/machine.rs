//! Readers of what comes to the PS 340: commands, packets, records, captures, operator commands, play files.

use protocol::capture::CaptureReader;
use protocol::command::{BinaryDecoder, Command, CommandReader, encode, parse, print};
use protocol::listing::Listing;
use protocol::parallel::{self, AddressList, ParallelFrameReader, Side};
use protocol::raster;
use protocol::wire::{FrameDecoder, MessageForm, MessageReader, read_six_bit, write_six_bit};
use ps340::operator;
use ps340::play::Script;

/// Two cuts of a stream, in which readers must find the same.
fn pieces(bytes: &[u8]) -> [Vec<&[u8]>; 2] {
    [vec![bytes], bytes.chunks(7).collect()]
}

/// However the text is cut, it holds the same commands; each prints as it is read.
pub fn commands(bytes: &[u8]) {
    let [whole, cut] = pieces(bytes).map(|pieces| {
        let mut reader = CommandReader::default();
        let mut found = Vec::new();
        for piece in pieces {
            reader.push(piece);
            found.extend(reader.by_ref());
        }
        (found, reader.is_unfinished())
    });
    assert_eq!(whole, cut);
    for item in whole.0.into_iter().flatten() {
        prints(&item.command);
    }
}

fn prints(command: &Command) {
    let mut text = Vec::new();
    print(command, &mut text);
    assert_eq!(parse(&text).as_ref(), Ok(command), "{}", text.escape_ascii());
}

/// What is decoded of commands, of the raster, and of the form of six bits is encoded and decoded as the same.
pub fn binary(bytes: &[u8]) {
    for command in BinaryDecoder::default().push(bytes).flatten() {
        let mut body = Vec::new();
        encode(&command, &mut body).expect("what was decoded can be encoded");
        let again: Result<Vec<Command>, _> = BinaryDecoder::default().push(&body).collect();
        assert_eq!(again.as_deref(), Ok(&[command][..]));
    }
    for command in raster::decode(bytes).flatten() {
        let mut body = Vec::new();
        raster::encode(&command, &mut body).expect("what was decoded can be encoded");
        assert_eq!(raster::decode(&body).collect::<Vec<_>>(), [Ok(command)]);
    }
    let (mut characters, mut back) = (Vec::new(), Vec::new());
    write_six_bit(bytes, &mut characters);
    read_six_bit(&characters, &mut back).expect("what was written is read");
    assert_eq!(back, bytes);
    let _ = read_six_bit(bytes, &mut back);
}

/// Every byte is counted once, the same messages are found however the stream is cut, and all of it can be listed.
pub fn packets(bytes: &[u8]) {
    for pieces in pieces(bytes) {
        let mut decoder = FrameDecoder::default();
        let mut listing = (Listing::default(), String::new());
        for piece in pieces {
            decoder.feed(piece, |_| {});
            listing.0.push(piece, &mut listing.1).expect("a string takes all text");
        }
        decoder.finish();
        listing.0.finish(&mut listing.1).expect("a string takes all text");
        let counted = decoder.counters();
        assert_eq!(counted.packet_bytes + counted.text_bytes + counted.noise_bytes, bytes.len() as u64);
    }
    for form in MessageForm::ALL {
        let [whole, cut] = pieces(bytes).map(|pieces| {
            let mut reader = MessageReader::default();
            reader.expect(form);
            let mut found = Vec::new();
            for piece in pieces {
                reader.push(piece);
                found.extend(reader.by_ref());
            }
            found
        });
        assert_eq!(whole, cut);
    }
}

/// However the stream of the parallel interface is cut, it holds the same words, and all of it can be listed.
pub fn parallel(bytes: &[u8]) {
    let [whole, cut] = pieces(bytes).map(|pieces| {
        let mut reader = ParallelFrameReader::default();
        let (mut found, mut listing, mut text) = (Vec::new(), parallel::ParallelListing::default(), String::new());
        for piece in pieces {
            reader.push(piece);
            found.extend(reader.by_ref());
            listing.push(Side::Host, piece, &mut text);
        }
        found
    });
    assert_eq!(whole, cut);
    if let Ok((addresses, rest)) = AddressList::read(bytes) {
        let mut written = Vec::new();
        addresses.write(&mut written);
        assert_eq!(written[..], bytes[..bytes.len() - rest.len()]);
    }
}

/// However a capture is cut, it holds the same records.
pub fn capture(bytes: &[u8]) {
    let [whole, cut] = pieces(bytes).map(|pieces| {
        let mut reader = CaptureReader::default();
        let mut found = Vec::new();
        for piece in pieces {
            reader.push(piece);
            found.extend(reader.by_ref());
        }
        reader.finish();
        found.extend(reader);
        found
    });
    assert_eq!(whole, cut);
}

/// Lines of the operator are read; none is obeyed.
pub fn operator_commands(bytes: &[u8]) {
    for line in String::from_utf8_lossy(bytes).lines() {
        let _ = operator::parse(line);
        operator::unescape(line);
    }
}

/// A play file is read; none of it is played.
pub fn play(bytes: &[u8]) {
    if let Ok(script) = Script::read("a.play", bytes) {
        assert!(script.lines.len() <= bytes.len());
    }
}

/// A program is looked through; what is found has a location in it.
pub fn lint(bytes: &[u8]) {
    for finding in ps340::lint::lint(&[("a.ps300".into(), bytes.to_vec())]) {
        assert_eq!(finding.file, "a.ps300");
    }
}
