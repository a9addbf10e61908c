//! A listing of a byte stream for people: offset, bytes in hexadecimal, meaning.

use crate::{
    command::{BinaryDecoder, CommandReader},
    raster,
    record::{BinaryError, Witness},
    wire::{Frame, FrameDecoder, MessageForm, PacketForm, Route, count_header, long_header},
};
use std::{
    fmt::{self, Write},
    ops::Range,
};

/// Bytes in a row.
const ROW: usize = 16;
/// Rows of one field that are shown; of a longer field, the first ones.
const ROWS: usize = 4;
/// Characters of a command or of a field that are shown.
const SHOWN: usize = 120;

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
#[derive(Clone, Debug, Default)]
pub struct Listing {
    frames: FrameDecoder,
    commands: CommandReader,
    binary: BinaryDecoder,
    offset: u64,
}

impl Listing {
    /// Lists more of the stream; a frame is listed when it is complete.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn push(&mut self, bytes: &[u8], out: &mut impl Write) -> fmt::Result {
        let Listing { frames, commands, binary, offset } = self;
        let mut result = Ok(());
        frames.feed(bytes, |frame| {
            let mut rows = Rows { offset: *offset, out: &mut *out, result };
            rows.frame(frame, commands, binary);
            result = rows.result;
            *offset += frame.stream_length() as u64;
        });
        result
    }

    /// Lists what is left of an unfinished packet.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn finish(&mut self, out: &mut impl Write) -> fmt::Result {
        let Some(frame) = self.frames.finish() else {
            return Ok(());
        };
        let mut rows = Rows { offset: self.offset, out, result: Ok(()) };
        rows.frame(frame, &mut self.commands, &mut self.binary);
        self.offset += frame.stream_length() as u64;
        rows.result
    }
}

/// Writes the rows of a frame that begins at `offset`.
struct Rows<'o, W> {
    offset: u64,
    out: &'o mut W,
    result: fmt::Result,
}

impl<W: Write> Rows<'_, W> {
    fn frame(&mut self, frame: Frame<'_>, commands: &mut CommandReader, binary: &mut BinaryDecoder) {
        match frame {
            Frame::Text(text) => {
                self.text(0, text);
                self.commands(text, commands);
            }
            Frame::Noise { bytes, reason } => self.field(0, bytes, format_args!("dropped: {reason}")),
            Frame::Packet { form, route, payload } => {
                self.header(form, route, payload.len());
                let at = form.overhead().0;
                match route {
                    Route::Text => {
                        self.text(at, payload);
                        self.commands(payload, commands);
                    }
                    Route::Binary => self.records(at, payload, |body, place, fields| {
                        let command = binary.record(body, place, fields)?;
                        Ok(command.map(|command| command.to_string()))
                    }),
                    Route::Raster => self.records(at, payload, |body, place, fields| {
                        raster::record(body, place, fields)?;
                        Ok(None)
                    }),
                    Route::Message => {
                        self.text(at, payload);
                        if let Some(form) = MessageForm::requested(payload) {
                            let wish = if form == MessageForm::Text { "text" } else { "packets" };
                            self.note(format_args!("if it is from the host: messages as {wish}"));
                        }
                    }
                    Route::Terminal | Route::Other(_) => self.text(at, payload),
                }
                if form == PacketForm::Long {
                    let check = crc32fast::hash(payload).to_le_bytes();
                    self.field(at + payload.len(), &check, format_args!("check of the payload"));
                }
            }
        }
    }

    fn header(&mut self, form: PacketForm, route: Route, length: usize) {
        // The header says nothing that form, route and length do not; so it is written again.
        let route_row = format!("route '{}': {}", route.code().escape_ascii(), route.word());
        match form {
            PacketForm::Long => {
                let bytes = long_header(route, length);
                self.field(0, &bytes[..1], format_args!("GS, start of a long packet"));
                self.field(1, &bytes[1..2], format_args!("{route_row}"));
                self.field(2, &bytes[2..6], format_args!("length of the payload: {length}"));
                self.field(6, &bytes[6..], format_args!("check of the header"));
            }
            PacketForm::Count => {
                let bytes = count_header(route, length);
                self.field(0, &bytes[..1], format_args!("FS, start of a count packet"));
                self.field(1, &bytes[1..3], format_args!("count of route and data: {}", length + 1));
                self.field(3, &bytes[3..], format_args!("{route_row}"));
            }
        }
    }

    /// The records of a packet body at `at`.
    fn records(
        &mut self,
        at: usize,
        body: &[u8],
        mut record: impl FnMut(&[u8], &mut usize, &mut Fields) -> Result<Option<String>, BinaryError>,
    ) {
        let mut place = 0;
        while place < body.len() {
            let mut fields = Fields { rows: Vec::new(), end: place };
            let start = place;
            let result = record(body, &mut place, &mut fields);
            // A record that stays is read again, without the list that the decoder gave up.
            for (span, meaning) in fields.rows.into_iter().filter(|_| place > start) {
                self.field(at + span.start, &body[span], format_args!("{meaning}"));
            }
            match result {
                Ok(Some(command)) => self.note(format_args!("command: {}", shorten(&command))),
                Ok(None) => {}
                Err(error) => {
                    self.note(format_args!("error: {error}"));
                    let read = fields.end.max(start);
                    if place > read {
                        self.field(at + read, &body[read..place], format_args!("not read"));
                    }
                }
            }
        }
    }

    /// Lists the commands that end in a text.
    fn commands(&mut self, text: &[u8], commands: &mut CommandReader) {
        commands.push(text);
        for item in commands {
            match item {
                Ok(spanned) => self.note(format_args!("command: {}", shorten(&spanned.command.to_string()))),
                Err(error) => self.note(format_args!("error: {error}")),
            }
        }
    }

    /// Text at `at`, all of it.
    fn text(&mut self, at: usize, text: &[u8]) {
        for (index, row) in text.chunks(ROW).enumerate() {
            self.row(at + index * ROW, row, format_args!("\"{}\"", row.escape_ascii()));
        }
    }

    /// A field at `at`; of a long one the beginning.
    fn field(&mut self, at: usize, bytes: &[u8], meaning: fmt::Arguments<'_>) {
        let rows = bytes.len().div_ceil(ROW);
        for (index, row) in bytes.chunks(ROW).take(ROWS).enumerate() {
            match index {
                0 => self.row(at, row, meaning),
                _ => self.row(at + index * ROW, row, format_args!("")),
            }
        }
        if rows > ROWS {
            self.note(format_args!("{} bytes more", bytes.len() - ROWS * ROW));
        }
    }

    fn row(&mut self, at: usize, bytes: &[u8], meaning: fmt::Arguments<'_>) {
        let hex: Vec<String> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        let line = format!("{:08x}  {:<48} {meaning}", self.offset + at as u64, hex.join(" "));
        self.line(line.trim_end());
    }

    /// A row without bytes.
    fn note(&mut self, note: fmt::Arguments<'_>) {
        self.line(&format!("{:58} {note}", ""));
    }

    fn line(&mut self, line: &str) {
        if self.result.is_ok() {
            self.result = self.out.write_str(line).and_then(|()| self.out.write_char('\n'));
        }
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
        wire::{write_commands, write_count_packet, write_packet},
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
            "00000000  44 49 53 50 4c 41 59 20 41 3b 0d 0a 44 49 53 50  \"DISPLAY A;\\r\\nDISP\"\n\
             00000010  4c 41 59 20 31 3b                                \"LAY 1;\"\n\
             \x20                                                          command: DISPLAY A;\n\
             \x20                                                          error: 1:9: expected a name, found `1`\n"
        );
    }

    #[test]
    fn every_byte_of_a_damaged_stream_is_listed() {
        let mut stream = b"text \x1d\x1c ".to_vec();
        write_commands(&[Command::EndStructure, parse(b"SEND 'a' TO <1>B;").unwrap()], &mut stream).unwrap();
        write_packet(Route::Binary, &[0x40, 1, 0, b'A', 0x99, 1, 2, 3], &mut stream).unwrap();
        write_packet(Route::Binary, &[0x11, 1, 0], &mut stream).unwrap();
        write_packet(Route::Message, b"P", &mut stream).unwrap();
        write_count_packet(Route::Raster, &[1, 9, 9, 9, 77], &mut stream).unwrap();
        stream.extend([29, b'0', 9, 0]);
        let listing = list(&stream);
        assert_eq!(bytes_of(&listing), stream);
        for part in ["not read", "messages as packets", "the stream ends inside a packet", "SEND 'a' TO <1>B;"] {
            assert!(listing.contains(part), "{part}: {listing}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(100))]
        #[test]
        fn the_rows_show_the_stream_byte_by_byte(commands in prop::collection::vec(commands(), 0..5), noise in any::<[u8; 9]>()) {
            let mut stream = Vec::new();
            write_commands(&commands, &mut stream).unwrap();
            stream.extend(noise);
            let listing = list(&stream);
            if listing.contains(" bytes more") || listing.contains(" more\n") {
                return Ok(());
            }
            prop_assert_eq!(bytes_of(&listing), stream);
        }
    }
}
