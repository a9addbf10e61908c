//! `ps340 decode`: what every byte of a stream means.

use super::error::{ToolError, of_output, open};
use protocol::{
    capture::{CaptureReader, Event, Record, is_capture},
    listing::{Listing, Sender},
};
use std::{
    collections::BTreeMap,
    fmt::Write,
    io::{self, BufWriter, Read},
    path::PathBuf,
    process::ExitCode,
};

/// Bytes that are read and listed at a time.
const PIECE: usize = 64 << 10;

/// Arguments of `decode`.
#[derive(clap::Args, Debug)]
#[command(after_help = "A capture, as 'ps340 --capture FILE' writes it, is recognised by its first line; both \
                        directions of every line are listed in it.")]
pub struct DecodeArguments {
    /// A plain stream or a capture; '-' is the standard input.
    file: PathBuf,
    /// Who sent a plain stream; of a capture, whose bytes are listed.
    #[arg(long, value_enum)]
    from: Option<StreamSide>,
}

/// Whose bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum StreamSide {
    /// The host: commands and packets. The default of a plain stream.
    Host,
    /// The machine: messages.
    Machine,
    /// Both; of captures only, where it is the default.
    Both,
}

/// Lists a file.
pub(super) fn run(arguments: &DecodeArguments) -> Result<ExitCode, ToolError> {
    let name = arguments.file.display().to_string();
    let mut file = open(&arguments.file)?;
    let of_file = |error| ToolError::File { file: name.clone(), error };
    let mut first = vec![0; PIECE];
    let mut length = 0;
    // A pipe may give a few bytes at a time; the first line must be whole to be recognised.
    while length < protocol::capture::HEADER.len() + 1 {
        match read_some(&mut file, &mut first[length..]).map_err(of_file)? {
            0 => break,
            read => length += read,
        }
    }
    first.truncate(length);
    if is_capture(&first) {
        return capture(arguments.from.unwrap_or(StreamSide::Both), &first, &mut file, &name);
    }
    let sender = match arguments.from {
        None | Some(StreamSide::Host) => Sender::Host,
        Some(StreamSide::Machine) => Sender::Machine,
        Some(StreamSide::Both) => {
            return Err(ToolError::Usage("--from both is for captures; a plain stream has one".into()));
        }
    };
    let mut out = BufWriter::new(io::stdout().lock());
    let mut listing = Listing::of(sender);
    let mut text = String::new();
    let mut piece = first;
    while !piece.is_empty() {
        // Writing into a string does not fail.
        let _ = listing.push(&piece, &mut text);
        put(&mut text, &mut out)?;
        piece.resize(PIECE, 0);
        let read = read_some(&mut file, &mut piece).map_err(of_file)?;
        piece.truncate(read);
    }
    let _ = listing.finish(&mut text);
    put(&mut text, &mut out)?;
    io::Write::flush(&mut out).map_err(of_output)?;
    Ok(ExitCode::SUCCESS)
}

/// Lists the records of a capture, each with the time and its line.
fn capture(from: StreamSide, first: &[u8], file: &mut dyn Read, name: &str) -> Result<ExitCode, ToolError> {
    let mut out = BufWriter::new(io::stdout().lock());
    let mut listings: BTreeMap<(u64, bool), Listing> = BTreeMap::new();
    let (mut reader, mut text, mut code) = (CaptureReader::default(), String::new(), ExitCode::SUCCESS);
    let mut piece = first.to_vec();
    loop {
        let ended = piece.is_empty();
        if ended {
            reader.finish();
        }
        reader.push(&piece);
        for record in reader.by_ref() {
            match record {
                Ok(record) => list_record(&record, from, &mut listings, &mut text),
                Err(error) => {
                    code = ExitCode::from(1);
                    put(&mut text, &mut out)?;
                    eprintln!("ps340: {name}: {error}");
                }
            }
            put(&mut text, &mut out)?;
        }
        if ended {
            break;
        }
        piece.resize(PIECE, 0);
        let read = read_some(file, &mut piece);
        let read = read.map_err(|error| ToolError::File { file: name.into(), error })?;
        piece.truncate(read);
    }
    for ((line, from_host), mut listing) in listings {
        let mut rest = String::new();
        let _ = listing.finish(&mut rest);
        if !rest.is_empty() {
            let side = if from_host { "from the host" } else { "to the host" };
            let _ = write!(text, "at the end of line {line}, {side}:\n{rest}");
        }
    }
    put(&mut text, &mut out)?;
    io::Write::flush(&mut out).map_err(of_output)?;
    Ok(code)
}

/// Lists one record of a capture. Offsets count the bytes of one direction of one line.
fn list_record(record: &Record, from: StreamSide, listings: &mut BTreeMap<(u64, bool), Listing>, text: &mut String) {
    let seconds = record.micros as f64 / 1e6;
    let (sender, bytes) = match &record.event {
        Event::Open(peer) => {
            let _ = writeln!(text, "{seconds:.6} s, line {}: {peer} attached", record.line);
            return;
        }
        Event::Close => {
            let _ = writeln!(text, "{seconds:.6} s, line {}: closed", record.line);
            return;
        }
        Event::OperatorCommand(order) => {
            let _ = writeln!(text, "{seconds:.6} s, operator: {order}");
            return;
        }
        Event::FromHost(bytes) => (Sender::Host, bytes),
        Event::ToHost(bytes) => (Sender::Machine, bytes),
    };
    let from_host = sender == Sender::Host;
    if from != StreamSide::Both && (from == StreamSide::Host) != from_host {
        return;
    }
    let side = if from_host { "from the host" } else { "to the host" };
    let _ = writeln!(text, "{seconds:.6} s, line {}, {side}, {} bytes:", record.line, bytes.len());
    let listing = listings.entry((record.line, from_host)).or_insert_with(|| Listing::of(sender));
    let _ = listing.push(bytes, text);
}

fn read_some(file: &mut dyn Read, into: &mut [u8]) -> io::Result<usize> {
    loop {
        match file.read(into) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            read => return read,
        }
    }
}

/// Writes a text out and empties it.
fn put(text: &mut String, out: &mut impl io::Write) -> Result<(), ToolError> {
    out.write_all(text.as_bytes()).map_err(of_output)?;
    text.clear();
    Ok(())
}
