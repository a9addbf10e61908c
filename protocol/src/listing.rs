//! A listing of a byte stream for people: offset, bytes in hexadecimal, meaning.

use crate::{
    command::{BinaryDecoder, CommandReader},
    raster,
    record::{BinaryError, Witness},
    wire::{ESCAPE, Frame, FrameDecoder, MessageForm, PacketForm, Route, read_six_bit},
};
use std::{
    fmt::{self, Write},
    ops::Range,
};

/// Bytes in a row by default.
const ROW: usize = 16;
/// Rows of one field that are shown; of a longer field, the first ones.
const ROWS: usize = 4;
/// Characters of a command or of a field that are shown.
const SHOWN: usize = 120;

/// Longest line of a message that is gathered, in bytes; the rest of a longer one is not shown again.
const MAX_MESSAGE: usize = 4096;

/// Who sent a stream.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sender {
    /// A host: text is commands.
    #[default]
    Host,
    /// The machine: text is messages, one a line.
    Machine,
}

/// Lists a byte stream from either side of a line, with the decoders that the machine and the host use.
///
/// ```
/// use protocol::listing::Listing;
/// let mut text = String::new();
/// let mut listing = Listing::default();
/// listing.push(b"DISPLAY A;", &mut text).unwrap();
/// listing.finish(&mut text).unwrap();
/// assert!(text.ends_with("command: DISPLAY A;\n"));
/// ```
#[derive(Clone, Debug)]
pub struct Listing {
    frames: FrameDecoder,
    commands: CommandReader,
    binary: BinaryDecoder,
    sender: Sender,
    /// The line of a message that has not ended.
    message: Vec<u8>,
    offset: u64,
    /// Bytes in a row.
    width: usize,
}

impl Default for Listing {
    fn default() -> Listing {
        Listing {
            frames: FrameDecoder::default(),
            commands: CommandReader::default(),
            binary: BinaryDecoder::default(),
            sender: Sender::default(),
            message: Vec::new(),
            offset: 0,
            width: ROW,
        }
    }
}

impl Listing {
    /// A listing of what one side sent.
    pub fn of(sender: Sender) -> Listing {
        Listing { sender, ..Listing::default() }
    }

    /// This listing with so many bytes in a row, at least 1; 16 if not set.
    pub fn with_row(self, bytes: usize) -> Listing {
        Listing { width: bytes.max(1), ..self }
    }

    /// Lists more of the stream; a frame is listed when it is complete.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn push(&mut self, bytes: &[u8], out: &mut impl Write) -> fmt::Result {
        let Listing { frames, commands, binary, sender, message, offset, width } = self;
        let mut result = Ok(());
        frames.feed_quoted(bytes, |frame| {
            let mut rows = Rows { offset: *offset, width: *width, out: &mut *out, result };
            match (&frame, *sender) {
                (Frame::Text(text), Sender::Machine) => rows.messages(text, message),
                _ => rows.frame(frame, commands, binary),
            }
            result = rows.result;
            *offset += frame.stream_length() as u64;
            commands.is_quoting()
        });
        result
    }

    /// Lists what is left of an unfinished packet, and reports which command or message has no end.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn finish(&mut self, out: &mut impl Write) -> fmt::Result {
        let mut rows = Rows { offset: self.offset, width: self.width, out, result: Ok(()) };
        if let Some(frame) = self.frames.finish() {
            rows.frame(frame, &mut self.commands, &mut self.binary);
            self.offset += frame.stream_length() as u64;
        }
        if self.commands.is_unfinished() {
            let begin = readable(self.commands.unfinished());
            let missing = match self.commands.open() {
                Some((problem, _)) => problem.to_string(),
                None => "its ; is missing".into(),
            };
            rows.note(format_args!("unfinished: {begin}: {missing}"));
        }
        if !self.message.is_empty() {
            rows.note(format_args!("unfinished message: {}", readable(&self.message)));
        }
        rows.result
    }
}

/// Writes the rows of a frame that begins at `offset`.
struct Rows<'o, W> {
    offset: u64,
    width: usize,
    out: &'o mut W,
    result: fmt::Result,
}

impl<W: Write> Rows<'_, W> {
    fn frame(&mut self, frame: Frame<'_>, commands: &mut CommandReader, binary: &mut BinaryDecoder) {
        match frame {
            Frame::Text(text) => {
                let before = commands.pushed();
                commands.push(text);
                self.commands(&Body::plain(text), before, commands);
            }
            Frame::Noise { bytes, reason } => self.field(0, bytes, format_args!("dropped: {reason}")),
            Frame::Empty(bytes) => {
                self.field(0, bytes, format_args!("SYN SYN, empty escape packet: the end of the one before"))
            }
            Frame::Packet { form, route, payload, raw } => {
                let body = Body::new(form, payload, raw);
                self.header(form, route, &raw[..body.at(0)], payload.len());
                self.body(route, &body, commands, binary);
                if form == PacketForm::Long {
                    let end = body.at(payload.len());
                    self.field(end, &raw[end..], format_args!("check of the payload"));
                }
            }
        }
    }

    fn body(&mut self, route: Route, body: &Body<'_>, commands: &mut CommandReader, binary: &mut BinaryDecoder) {
        let mut six_bit = Vec::new();
        let whole = body.raw(0..body.payload.len());
        let mut command = |body: &[u8], place: &mut usize, fields: &mut Fields| {
            let command = binary.record(body, place, fields)?;
            Ok(command.map(|command| command.to_string()))
        };
        let raster = |body: &[u8], place: &mut usize, fields: &mut Fields| {
            raster::record(body, place, fields)?;
            Ok(None)
        };
        match route {
            Route::Binary => self.records(body, &mut command),
            Route::Raster => self.records(body, raster),
            Route::SixBitBinary | Route::SixBitRaster => {
                self.text(body.at(0), whole);
                match read_six_bit(body.payload, &mut six_bit) {
                    Ok(()) if route == Route::SixBitBinary => self.records(&Body::decoded(&six_bit), &mut command),
                    Ok(()) => self.records(&Body::decoded(&six_bit), raster),
                    Err(error) => self.note(format_args!("error: {error}")),
                }
            }
            Route::Text => {
                let before = commands.pushed();
                commands.push_packet(body.payload);
                self.commands(body, before, commands);
            }
            Route::Message => {
                self.text(body.at(0), whole);
                if let Some(form) = MessageForm::requested(body.payload) {
                    let wish = match form {
                        MessageForm::Text => "messages as text",
                        MessageForm::Packets => "messages as packets",
                        MessageForm::Own => "messages of its own, as packets",
                    };
                    self.note(format_args!("if it is from the host: {wish}"));
                }
            }
            Route::Channel(_) | Route::Terminal | Route::Diagnostic | Route::Other(_) => self.text(body.at(0), whole),
        }
    }

    fn header(&mut self, form: PacketForm, route: Route, bytes: &[u8], length: usize) {
        let route_row = format!("route '{}': {}", route.code().escape_ascii(), route.word());
        match form {
            PacketForm::Long => {
                self.field(0, &bytes[..1], format_args!("GS, start of a long packet"));
                self.field(1, &bytes[1..2], format_args!("{route_row}"));
                self.field(2, &bytes[2..6], format_args!("length of the payload: {length}"));
                self.field(6, &bytes[6..], format_args!("check of the header"));
            }
            PacketForm::Count => {
                self.field(0, &bytes[..1], format_args!("FS, start of a count packet"));
                self.field(1, &bytes[1..3], format_args!("count of route and data: {}", length + 1));
                self.field(3, &bytes[3..], format_args!("{route_row}"));
            }
            PacketForm::Escape => {
                self.field(0, &bytes[..1], format_args!("SYN, start of an escape packet"));
                self.field(1, &bytes[1..], format_args!("{route_row}"));
            }
        }
    }

    /// The records of a packet body.
    fn records(
        &mut self,
        body: &Body<'_>,
        mut record: impl FnMut(&[u8], &mut usize, &mut Fields) -> Result<Option<String>, BinaryError>,
    ) {
        let mut place = 0;
        while place < body.payload.len() {
            let mut fields = Fields { rows: Vec::new(), end: place };
            let start = place;
            let result = record(body.payload, &mut place, &mut fields);
            // A record that stays is read again, without the list that the decoder gave up.
            for (span, meaning) in fields.rows.into_iter().filter(|_| place > start) {
                self.body_field(body, span, &meaning);
            }
            match result {
                Ok(Some(command)) => self.note(format_args!("command: {}", shorten(&command))),
                Ok(None) => {}
                Err(error) => {
                    self.note(format_args!("error: {error}"));
                    let read = fields.end.max(start);
                    if place > read {
                        self.body_field(body, read..place, "not read");
                    }
                }
            }
        }
    }

    /// A field of a body: its bytes in the stream, or only its meaning if it does not stand there.
    fn body_field(&mut self, body: &Body<'_>, span: Range<usize>, meaning: &str) {
        match body.positions {
            BytePositions::Decoded => self.note(format_args!("{meaning}")),
            _ => self.field(body.at(span.start), body.raw(span), format_args!("{meaning}")),
        }
    }

    /// Lists text from the machine, and the messages that end in it.
    fn messages(&mut self, text: &[u8], message: &mut Vec<u8>) {
        let mut at = 0;
        for line in text.split_inclusive(|byte| *byte == b'\n') {
            self.text(at, line);
            at += line.len();
            let room = MAX_MESSAGE.saturating_sub(message.len());
            message.extend_from_slice(&line[..line.len().min(room)]);
            if line.ends_with(b"\n") {
                let whole = std::mem::take(message);
                self.note(format_args!("message: {}", readable(&whole)));
            }
        }
    }

    /// Lists a text, with each command after its bytes.
    ///
    /// - `before`: bytes of commands before it.
    fn commands(&mut self, body: &Body<'_>, before: u64, commands: &mut CommandReader) {
        let mut listed = 0;
        while let Some(item) = commands.next() {
            // The statement with its `;`, of which all but the last part may have been listed before.
            let end = CommandReader::position(commands) + commands.statement().len() as u64 + 1;
            let end = usize::try_from(end.saturating_sub(before)).unwrap_or(usize::MAX).min(body.payload.len());
            if end > listed {
                self.text(body.at(listed), body.raw(listed..end));
                listed = end;
            }
            match item {
                Ok(spanned) => {
                    self.note(format_args!("command: {}", shorten(&spanned.command.to_string())));
                    spanned.warnings.iter().for_each(|warning| self.note(format_args!("warning: {warning}")));
                }
                Err(error) => self.note(format_args!("error: {error}")),
            }
        }
        if listed < body.payload.len() {
            self.text(body.at(listed), body.raw(listed..body.payload.len()));
        }
    }

    /// Text at `at`, all of it.
    fn text(&mut self, at: usize, text: &[u8]) {
        for (index, row) in text.chunks(self.width).enumerate() {
            self.row(at + index * self.width, row, format_args!("\"{}\"", row.escape_ascii()));
        }
    }

    /// A field at `at`; of a long one the beginning.
    fn field(&mut self, at: usize, bytes: &[u8], meaning: fmt::Arguments<'_>) {
        let rows = bytes.len().div_ceil(self.width);
        for (index, row) in bytes.chunks(self.width).take(ROWS).enumerate() {
            match index {
                0 => self.row(at, row, meaning),
                _ => self.row(at + index * self.width, row, format_args!("")),
            }
        }
        if rows > ROWS {
            self.note(format_args!("{} bytes more", bytes.len() - ROWS * self.width));
        }
    }

    fn row(&mut self, at: usize, bytes: &[u8], meaning: fmt::Arguments<'_>) {
        let hex: Vec<String> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        let hex_width = 3 * self.width;
        let line = format!("{:08x}  {:<hex_width$} {meaning}", self.offset + at as u64, hex.join(" "));
        self.line(line.trim_end());
    }

    /// A row without bytes.
    fn note(&mut self, note: fmt::Arguments<'_>) {
        self.line(&format!("{:1$} {note}", "", 10 + 3 * self.width));
    }

    fn line(&mut self, line: &str) {
        if self.result.is_ok() {
            self.result = self.out.write_str(line).and_then(|()| self.out.write_char('\n'));
        }
    }
}

/// The data of a packet, and where each byte of it stands in the stream.
struct Body<'a> {
    payload: &'a [u8],
    packet: &'a [u8],
    positions: BytePositions,
}

/// Where the bytes of a body stand in its packet.
enum BytePositions {
    /// One after the other from here on.
    From(usize),
    /// Each with its escape character, if it has one, at these positions; the last one is the end.
    At(Vec<usize>),
    /// Nowhere: they were decoded.
    Decoded,
}

impl<'a> Body<'a> {
    fn new(form: PacketForm, payload: &'a [u8], packet: &'a [u8]) -> Body<'a> {
        let seen = match form {
            PacketForm::Count | PacketForm::Long => BytePositions::From(form.overhead().0),
            PacketForm::Escape => {
                let mut places = Vec::with_capacity(payload.len() + 2);
                let mut at = 1; // after the start byte: the route, then the data
                while at < packet.len() {
                    places.push(at);
                    at += if packet[at] == ESCAPE { 2 } else { 1 };
                }
                places.push(packet.len());
                BytePositions::At(places.split_off(1))
            }
        };
        Body { payload, packet, positions: seen }
    }

    /// Bytes outside packets.
    fn plain(text: &'a [u8]) -> Body<'a> {
        Body { payload: text, packet: text, positions: BytePositions::From(0) }
    }

    /// Bytes that do not stand in the stream.
    fn decoded(payload: &'a [u8]) -> Body<'a> {
        Body { payload, packet: &[], positions: BytePositions::Decoded }
    }

    /// The position of byte `index` of the data in its packet; that of its end for their number.
    fn at(&self, index: usize) -> usize {
        match &self.positions {
            BytePositions::From(start) => start + index,
            BytePositions::At(places) => places.get(index).copied().unwrap_or(self.packet.len()),
            BytePositions::Decoded => 0,
        }
    }

    /// The bytes of the stream that are a piece of the data.
    fn raw(&self, span: Range<usize>) -> &'a [u8] {
        &self.packet[self.at(span.start)..self.at(span.end)]
    }
}

/// Collects the fields of a record.
struct Fields {
    rows: Vec<(Range<usize>, String)>,
    end: usize,
}

impl Witness for Fields {
    fn field(&mut self, place: Range<usize>, label: &'static str, meaning: fmt::Arguments<'_>) {
        self.end = self.end.max(place.end);
        self.rows.push((place, shorten(&format!("{label}: {meaning}"))));
    }
}

/// Bytes as text without blanks around it, up to a length.
fn readable(bytes: &[u8]) -> String {
    let character = |byte: &u8| match byte {
        b' '..=b'~' => char::from(*byte).to_string(),
        byte => byte.escape_ascii().to_string(),
    };
    shorten(&bytes.trim_ascii().iter().take(SHOWN + 1).map(character).collect::<String>())
}

/// The first line of a text, up to a length.
fn shorten(text: &str) -> String {
    let line = text.lines().next().unwrap_or_default();
    let short: String = line.chars().take(SHOWN).collect();
    if short.len() < text.len() { format!("{short} ...") } else { short }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        command::{Command, parse, strategy::commands},
        wire::{
            DataForm, Sending, write_commands, write_commands_as, write_count_packet, write_escape_packet, write_packet,
        },
    };
    use proptest::prelude::*;

    fn list(stream: &[u8]) -> String {
        let mut text = String::new();
        let mut listing = Listing::default();
        listing.push(stream, &mut text).unwrap();
        listing.finish(&mut text).unwrap();
        text
    }

    /// The bytes that the rows show, in order, with their offsets checked.
    fn bytes_of(listing: &str) -> Vec<u8> {
        let mut bytes = Vec::new();
        for row in listing.lines().filter(|row| !row.starts_with(' ')) {
            let offset = usize::from_str_radix(&row[..8], 16).unwrap();
            assert_eq!(offset, bytes.len(), "{row}");
            let hex = row.get(10..58).unwrap_or(&row[10..]);
            bytes.extend(hex.split_whitespace().map(|byte| u8::from_str_radix(byte, 16).unwrap()));
        }
        bytes
    }

    #[test]
    fn text_is_listed_with_its_commands() {
        let listing = list(b"DISPLAY A;\r\nDISPLAY 1;");
        assert_eq!(
            listing,
            "00000000  44 49 53 50 4c 41 59 20 41 3b                    \"DISPLAY A;\"\n\
             \x20                                                          command: DISPLAY A;\n\
             0000000a  0d 0a 44 49 53 50 4c 41 59 20 31 3b              \"\\r\\nDISPLAY 1;\"\n\
             \x20                                                          error: 2:9: expected a name, found `1`\n"
        );
    }

    #[test]
    fn a_row_has_as_many_bytes_as_is_said() {
        let mut text = String::new();
        Listing::default().with_row(4).push(b"DISPLAY A;", &mut text).unwrap();
        let rows: Vec<&str> = text.lines().collect();
        assert_eq!(rows[0], "00000000  44 49 53 50  \"DISP\"");
        assert_eq!(rows[2], "00000008  41 3b        \"A;\"");
        assert_eq!(rows[3], "                       command: DISPLAY A;");
        assert_eq!(rows.len(), 4);
    }

    /// The rows without bytes.
    fn notes(listing: &str) -> Vec<&str> {
        listing.lines().filter(|row| row.starts_with(' ')).map(str::trim).collect()
    }

    #[test]
    fn each_command_stands_behind_its_bytes_however_the_stream_is_cut() {
        let stream = b"A := BEGIN_S R := ROT X 3; END_S;\nREMOVE A; DISP";
        for cut in 0..stream.len() {
            let (mut listing, mut text) = (Listing::default(), String::new());
            listing.push(&stream[..cut], &mut text).unwrap();
            listing.push(&stream[cut..], &mut text).unwrap();
            listing.finish(&mut text).unwrap();
            assert_eq!(bytes_of(&text), stream);
            let rotate = text.find("command: R := ROTATE").unwrap();
            let read = bytes_of(&text[..text[..rotate].rfind('\n').unwrap()]).len();
            assert_eq!(read, 26, "{text}");
            assert_eq!(notes(&text)[4], "unfinished: DISP: its ; is missing");
        }
        assert_eq!(notes(&list(b"SEND 'x TO <1>A;")), ["unfinished: SEND 'x TO <1>A;: the text has no closing quote"]);
    }

    #[test]
    fn text_of_the_machine_is_listed_with_its_messages() {
        let mut listing = Listing::of(Sender::Machine);
        let mut text = String::new();
        for piece in [&b"0.1\r\nE 1 **"[..], b"* no\n"] {
            listing.push(piece, &mut text).unwrap();
        }
        listing.finish(&mut text).unwrap();
        assert_eq!(bytes_of(&text), b"0.1\r\nE 1 *** no\n");
        assert_eq!(notes(&text), ["message: 0.1", "message: E 1 *** no"]);
        listing.push(b"half a line", &mut text).unwrap();
        listing.finish(&mut text).unwrap();
        assert_eq!(notes(&text).last(), Some(&"unfinished message: half a line"));
    }

    #[test]
    fn every_byte_of_a_damaged_stream_is_listed() {
        let mut stream = b"text \x1d\x1c ".to_vec();
        write_commands(&[Command::EndStructure, parse(b"SEND 'a' TO <1>B;").unwrap()], &mut stream).unwrap();
        write_packet(Route::Binary, &[0x40, 1, 0, b'A', 0x99, 1, 2, 3], &mut stream).unwrap();
        write_packet(Route::Binary, &[0x11, 1, 0], &mut stream).unwrap();
        write_packet(Route::Message, b"P", &mut stream).unwrap();
        write_count_packet(Route::Raster, &[1, 9, 9, 9, 77], &mut stream).unwrap();
        write_escape_packet(Route::Binary, &[0x40, 1, 0, 22, 0x40, 1, 0, b'A'], &mut stream).unwrap();
        write_packet(Route::SixBitBinary, b"@040@~", &mut stream).unwrap();
        write_packet(Route::SixBitRaster, b"p", &mut stream).unwrap();
        stream.extend([0x16, 0x10, b'0', 0x10, b'X', 0x16, 29, b'0', 9, 0]);
        let listing = list(&stream);
        assert_eq!(bytes_of(&listing), stream);
        for part in ["not read", "messages as packets", "the stream ends inside a packet", "SEND 'a' TO <1>B;"] {
            assert!(listing.contains(part), "{part}: {listing}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(100))]
        #[test]
        fn the_rows_show_the_stream_byte_by_byte(
            commands in prop::collection::vec(commands(), 0..5), noise in any::<[u8; 9]>(),
            packets in prop::sample::select(PacketForm::ALL.to_vec()), data in prop::sample::select(DataForm::ALL.to_vec())
        ) {
            let mut stream = Vec::new();
            write_commands_as(Sending { packets: packets.0, data: data.0 }, &commands, &mut stream).unwrap();
            stream.extend(noise);
            let listing = list(&stream);
            if listing.contains(" bytes more") || listing.contains(" more\n") {
                return Ok(());
            }
            prop_assert_eq!(bytes_of(&listing), stream);
        }
    }
}
