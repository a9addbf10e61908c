//! The bytes of packets, and their writers.

use crate::record::{EncodeError, MAX_RECORD, within};

/// Start byte of a count packet: FS, control-backslash. Historical \[M\].
pub const COUNT_START: u8 = 28;
/// Added to each count character, so that it is printable. \[U\]
pub const COUNT_BIAS: u8 = 32;
/// Values of a count character. \[U\]
pub const COUNT_RADIX: usize = 64;
/// Most data bytes in a count packet, after the route byte. \[U\]
pub const MAX_COUNT_DATA: usize = COUNT_RADIX * COUNT_RADIX - 2;

/// Start byte of an escape packet: SYN, control-V. It also ends the escape packet before it. \[U\]
pub const ESCAPE_START: u8 = 22;
/// Escape character of escape packets: DLE, control-P. The byte after it is data, whatever it is. \[U\]
pub const ESCAPE: u8 = 16;
/// Most bytes of an escape packet in the stream: its start byte, then route and [`MAX_PAYLOAD`] bytes of data, each
/// after an escape character. Ours.
pub const MAX_ESCAPE_STREAM: usize = 3 + 2 * MAX_PAYLOAD;

/// Start byte of a long packet: GS. Ours.
pub const LONG_START: u8 = 29;
/// Bytes of a long packet before its payload: start, route, length (4), check of the header (2). Ours.
pub const LONG_HEADER: usize = 8;
/// Bytes of a long packet after its payload: CRC-32. Ours.
pub const LONG_TRAILER: usize = 4;
/// Most payload bytes in a long packet. Ours.
pub const MAX_PAYLOAD: usize = MAX_RECORD;

/// The kind of packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PacketForm {
    /// Historical, with a count: start byte, two count characters, route, data.
    Count,
    /// Historical, without a count: start byte, route, data, up to the next start byte.
    Escape,
    /// Ours: checked, and up to [`MAX_PAYLOAD`] long.
    Long,
}

impl PacketForm {
    /// The forms with their words.
    pub const ALL: [(PacketForm, &str); 3] =
        [(PacketForm::Count, "count"), (PacketForm::Escape, "escape"), (PacketForm::Long, "long")];

    /// Bytes before and after the payload; the route byte of an escape packet may be escaped and take one more.
    pub const fn overhead(self) -> (usize, usize) {
        match self {
            PacketForm::Count => (4, 0),
            PacketForm::Escape => (2, 0),
            PacketForm::Long => (LONG_HEADER, LONG_TRAILER),
        }
    }
}

/// Who is to read the data of a packet: its routing byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Route {
    /// `0`: command text for the interpreter. \[M\]
    Text,
    /// `1`: binary commands for the interpreter. The byte is \[M\], the records are ours.
    Binary,
    /// `2`: binary commands in the 6-bit form. The byte is \[M\], the characters are ours.
    SixBitBinary,
    /// `3` to `7`: a channel of the site, 3 to 7, which leaves the initial instance CHANNEL of that number. The bytes
    /// are \[U\], the instances are ours.
    Channel(u8),
    /// `8`: raster records in the 6-bit form. \[U\]
    SixBitRaster,
    /// `9`: raster records, 8-bit. The byte is \[U\], the records are ours.
    Raster,
    /// `=`: messages to the host, and from the host their form. \[U\]
    Message,
    /// `>`: text for the terminal emulator. \[U\]
    Terminal,
    /// `?`: a text for the log of the machine. The byte is \[U\].
    Diagnostic,
    /// Any other byte: nobody reads it.
    Other(u8),
}

impl Route {
    /// The routes that have a meaning, with the word for listings.
    pub const KNOWN: [(Route, &str); 13] = [
        (Route::Text, "command text"),
        (Route::Binary, "binary commands"),
        (Route::SixBitBinary, "binary commands, 6-bit"),
        (Route::Channel(3), "channel 3"),
        (Route::Channel(4), "channel 4"),
        (Route::Channel(5), "channel 5"),
        (Route::Channel(6), "channel 6"),
        (Route::Channel(7), "channel 7"),
        (Route::SixBitRaster, "raster, 6-bit"),
        (Route::Raster, "raster"),
        (Route::Message, "messages"),
        (Route::Terminal, "terminal emulator"),
        (Route::Diagnostic, "diagnostic"),
    ];

    /// The routing byte.
    pub const fn code(self) -> u8 {
        match self {
            Route::Text => b'0',
            Route::Binary => b'1',
            Route::SixBitBinary => b'2',
            Route::Channel(number) => b'0'.wrapping_add(number),
            Route::SixBitRaster => b'8',
            Route::Raster => b'9',
            Route::Message => b'=',
            Route::Terminal => b'>',
            Route::Diagnostic => b'?',
            Route::Other(code) => code,
        }
    }

    /// The route to these readers with data in the 6-bit form; none if they have no such form.
    pub const fn six_bit(self) -> Option<Route> {
        match self {
            Route::Binary => Some(Route::SixBitBinary),
            Route::Raster => Some(Route::SixBitRaster),
            _ => None,
        }
    }

    /// The word for the route in listings.
    pub fn word(self) -> &'static str {
        Route::KNOWN.iter().find(|row| row.0 == self).map_or("nobody", |row| row.1)
    }
}

impl From<u8> for Route {
    fn from(code: u8) -> Route {
        Route::KNOWN.iter().map(|row| row.0).find(|route| route.code() == code).unwrap_or(Route::Other(code))
    }
}

/// Appends a long packet.
///
/// # Errors
/// A payload longer than [`MAX_PAYLOAD`].
pub fn write_packet(route: Route, payload: &[u8], out: &mut Vec<u8>) -> Result<(), EncodeError> {
    within("the payload of a packet", payload.len(), MAX_PAYLOAD)?;
    out.reserve(LONG_HEADER + payload.len() + LONG_TRAILER);
    out.extend_from_slice(&long_header(route, payload.len()));
    out.extend_from_slice(payload);
    out.extend_from_slice(&crc32fast::hash(payload).to_le_bytes());
    Ok(())
}

/// The header of a long packet with `length` payload bytes, at most [`MAX_PAYLOAD`].
pub fn long_header(route: Route, length: usize) -> [u8; LONG_HEADER] {
    let mut header = [0; LONG_HEADER];
    header[0] = LONG_START;
    header[1] = route.code();
    header[2..6].copy_from_slice(&(length as u32).to_le_bytes());
    let check = header_check(&header[..6]);
    header[6..8].copy_from_slice(&check.to_le_bytes());
    header
}

/// Appends a packet of any form.
///
/// # Errors
/// Data longer than the form allows: [`MAX_COUNT_DATA`] or [`MAX_PAYLOAD`].
pub fn write_packet_as(form: PacketForm, route: Route, data: &[u8], out: &mut Vec<u8>) -> Result<(), EncodeError> {
    match form {
        PacketForm::Count => write_count_packet(route, data, out),
        PacketForm::Escape => write_escape_packet(route, data, out),
        PacketForm::Long => write_packet(route, data, out),
    }
}

/// Appends a count packet.
///
/// # Errors
/// Data longer than [`MAX_COUNT_DATA`].
pub fn write_count_packet(route: Route, data: &[u8], out: &mut Vec<u8>) -> Result<(), EncodeError> {
    within("the data of a count packet", data.len(), MAX_COUNT_DATA)?;
    out.extend_from_slice(&count_header(route, data.len()));
    out.extend_from_slice(data);
    Ok(())
}

/// The header of a count packet with `length` data bytes, at most [`MAX_COUNT_DATA`].
pub fn count_header(route: Route, length: usize) -> [u8; 4] {
    let count = length + 1; // the route byte counts
    let characters = [count / COUNT_RADIX, count % COUNT_RADIX].map(|digit| COUNT_BIAS + digit as u8);
    [COUNT_START, characters[0], characters[1], route.code()]
}

/// Appends an escape packet and the empty one that ends it.
///
/// # Errors
/// Data longer than [`MAX_PAYLOAD`].
pub fn write_escape_packet(route: Route, data: &[u8], out: &mut Vec<u8>) -> Result<(), EncodeError> {
    within("the data of an escape packet", data.len(), MAX_PAYLOAD)?;
    out.reserve(5 + data.len());
    out.push(ESCAPE_START);
    for mut rest in [&[route.code()], data] {
        while let Some(at) = rest.iter().position(|byte| is_escaped(*byte)) {
            out.extend_from_slice(&rest[..at]);
            out.extend_from_slice(&[ESCAPE, rest[at]]);
            rest = &rest[at + 1..];
        }
        out.extend_from_slice(rest);
    }
    out.extend_from_slice(&[ESCAPE_START; 2]);
    Ok(())
}

/// Whether a byte stands in an escape packet after the escape character only.
pub const fn is_escaped(byte: u8) -> bool {
    matches!(byte, ESCAPE_START | ESCAPE | COUNT_START | LONG_START)
}

/// Appends what an escape packet, from its route on, says without its escape characters.
pub fn unescape(escaped: &[u8], out: &mut Vec<u8>) {
    let mut rest = escaped;
    while let Some(at) = rest.iter().position(|byte| *byte == ESCAPE) {
        out.extend_from_slice(&rest[..at]);
        out.extend(rest.get(at + 1));
        rest = rest.get(at + 2..).unwrap_or_default();
    }
    out.extend_from_slice(rest);
}

/// The check of the first six bytes of a long packet: CRC-16 with polynomial 0x1021 and start value 0xFFFF, bits from
/// the highest on.
pub fn header_check(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xffff, |mut check: u16, &byte| {
        check ^= u16::from(byte) << 8;
        for _ in 0..8 {
            check = if check & 0x8000 == 0 { check << 1 } else { check << 1 ^ 0x1021 };
        }
        check
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_check_has_the_published_check_value() {
        assert_eq!(header_check(b"123456789"), 0x29b1);
    }

    #[test]
    fn routes_and_their_bytes_agree() {
        for code in 0..=255 {
            assert_eq!(Route::from(code).code(), code);
        }
        assert_eq!(Route::from(b'1'), Route::Binary);
        assert_eq!((Route::from(b'7'), Route::from(b':')), (Route::Channel(7), Route::Other(b':')));
    }

    #[test]
    fn count_packets_count_the_route_byte() {
        let mut out = Vec::new();
        write_count_packet(Route::Text, &[b'x'; 70], &mut out).unwrap();
        assert_eq!(out[..4], [28, 32 + 1, 32 + 7, b'0']);
        assert!(write_count_packet(Route::Text, &[0; MAX_COUNT_DATA], &mut out).is_ok());
        assert!(write_count_packet(Route::Text, &[0; MAX_COUNT_DATA + 1], &mut out).is_err());
        assert!(write_packet(Route::Text, &vec![0; MAX_PAYLOAD + 1], &mut out).is_err());
    }

    #[test]
    fn escape_packets_escape_what_would_end_them() {
        let mut out = Vec::new();
        write_escape_packet(Route::Text, &[b'a', 22, 16, 28, 29, 17], &mut out).unwrap();
        assert_eq!(out, [22, b'0', b'a', 16, 22, 16, 16, 16, 28, 16, 29, 17, 22, 22]);
        assert!(write_escape_packet(Route::Text, &vec![0; MAX_PAYLOAD + 1], &mut out).is_err());
    }
}
