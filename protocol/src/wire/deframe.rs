//! Frames out of a stream of bytes: text, packets, and noise.

use super::packet::{
    COUNT_BIAS, COUNT_RADIX, COUNT_START, ESCAPE, ESCAPE_START, LONG_HEADER, LONG_START, LONG_TRAILER,
    MAX_ESCAPE_STREAM, MAX_PAYLOAD, PacketForm, Route, header_check, is_escaped, unescape,
};
use std::ops::Range;

/// Bytes that the buffer has capacity for at least, and that [`FrameDecoder::feed`] takes at a time.
const BUFFER_CAPACITY: usize = 256 << 10;

/// Bytes of an escape packet that [`FrameDecoder::feed`] takes at a time, since its length is not known before its end.
const ESCAPE_PIECE: usize = 4096;

/// A piece of the stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame<'a> {
    /// Bytes outside packets. Where a run of text is cut depends on how the bytes came.
    Text(&'a [u8]),
    /// A packet, complete and checked.
    Packet {
        /// How it was written.
        form: PacketForm,
        /// Who is to read it.
        route: Route,
        /// Its data.
        payload: &'a [u8],
        /// All its bytes as they stand in the stream.
        raw: &'a [u8],
    },
    /// An escape packet without a route: it ends the one before it, and carries nothing itself.
    Empty(&'a [u8]),
    /// Bytes that are dropped.
    Noise {
        /// The bytes.
        bytes: &'a [u8],
        /// What is wrong with the bytes.
        reason: NoiseReason,
    },
}

impl Frame<'_> {
    /// How many bytes of the stream the frame takes.
    pub fn stream_length(&self) -> usize {
        match self {
            Frame::Text(bytes) | Frame::Empty(bytes) | Frame::Noise { bytes, .. } => bytes.len(),
            Frame::Packet { raw, .. } => raw.len(),
        }
    }
}

/// The reason why bytes are dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoiseReason {
    /// A count start byte without two count characters.
    #[error("no count follows the start byte of a count packet")]
    BadCount,
    /// A long start byte whose header does not agree with its check, or is too long.
    #[error("the header of a long packet does not agree with its check")]
    BadHeader,
    /// A long packet whose payload does not agree with its check; all of it is dropped.
    #[error("the payload of a long packet does not agree with its check")]
    BadPayload,
    /// An escape start byte with the start byte of another packet after it.
    #[error("no route follows the start byte of an escape packet")]
    NoRoute,
    /// An escape packet that does not end.
    #[error("an escape packet is longer than {MAX_ESCAPE_STREAM} bytes")]
    TooLong,
    /// The stream ended inside a packet.
    #[error("the stream ends inside a packet")]
    Truncated,
}

/// How much of what was received.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Good packets.
    pub packets: u64,
    /// Bytes in good packets, all counted.
    pub packet_bytes: u64,
    /// Bytes of text.
    pub text_bytes: u64,
    /// Long packets that were dropped for their payload.
    pub dropped_packets: u64,
    /// Bytes dropped, those of dropped packets among them.
    pub noise_bytes: u64,
}

/// Cuts a stream of bytes into frames, however it arrives.
///
/// Reading into the decoder's own buffer spares a copy: [`space`](Self::space), [`advance`](Self::advance), then
/// [`next_frame`](Self::next_frame) until it gives none. [`feed`](Self::feed) does the same for bytes that lie
/// elsewhere.
///
/// A packet with a bad header is one byte of noise, and the search goes on at the next byte; a count packet has no
/// check, so noise that looks like one swallows up to 4 KiB, and noise that looks like an escape packet swallows what
/// is there up to the next start byte. Each byte is looked at a constant number of times.
#[derive(Clone, Debug)]
pub struct FrameDecoder {
    buffer: Vec<u8>,
    start: usize,
    end: usize,
    /// Bytes from `start` on that the packet there needs in all, if that is known.
    needed: usize,
    /// How far the escape packet at `start` was looked through for its end.
    scan: Scan,
    /// Route and data of the latest escape packet.
    unescaped: Vec<u8>,
    historical: bool,
    /// Text outside packets is inside quotes, where start bytes are characters.
    quoted: bool,
    counters: Counters,
}

/// How much of an escape packet, from its start byte on, is known to hold no end.
#[derive(Clone, Copy, Debug, Default)]
struct Scan {
    bytes: usize,
    /// The next byte stands after an escape character.
    escaped: bool,
}

/// What stands at the start of the buffer.
enum Step {
    Text(usize),
    Packet(PacketForm, Route, Range<usize>, usize),
    /// The length of an escape packet, up to the start byte that ends it.
    Escaped(usize),
    Empty,
    Noise(usize, NoiseReason),
    /// A packet of which bytes are missing; how many it has if that is known, or else 0.
    Wait(usize),
}

impl Default for FrameDecoder {
    fn default() -> Self {
        FrameDecoder {
            buffer: Vec::new(),
            start: 0,
            end: 0,
            needed: 0,
            scan: Scan::default(),
            unescaped: Vec::new(),
            historical: true,
            quoted: false,
            counters: Counters::default(),
        }
    }
}

impl FrameDecoder {
    /// A decoder that takes the start bytes of count and escape packets for text.
    pub fn long_packets_only() -> Self {
        FrameDecoder { historical: false, ..FrameDecoder::default() }
    }

    /// Space for more bytes of the stream, at least 256 KiB. Take all frames out first, or the buffer grows.
    pub fn space(&mut self) -> &mut [u8] {
        if self.start == self.end {
            self.start = 0;
            self.end = 0;
        }
        let waiting = self.end - self.start;
        let room = BUFFER_CAPACITY.max(self.needed.saturating_sub(waiting));
        if self.buffer.len() - self.end < room {
            self.buffer.copy_within(self.start..self.end, 0);
            self.start = 0;
            self.end = waiting;
            if self.buffer.len() < waiting + room {
                self.buffer.resize(waiting + room.max(2 * BUFFER_CAPACITY), 0);
            }
        }
        &mut self.buffer[self.end..]
    }

    /// Notes that the first `count` bytes of [`space`](Self::space) were filled; more than there are count as all.
    pub fn advance(&mut self, count: usize) {
        self.end = (self.end + count).min(self.buffer.len());
    }

    /// The next frame; none until more bytes come.
    pub fn next_frame(&mut self) -> Option<Frame<'_>> {
        if self.start == self.end {
            return None;
        }
        let bytes = &self.buffer[self.start..self.end];
        let step = classify_start(bytes, self.historical, self.quoted, &mut self.scan);
        self.needed = if let Step::Wait(needed) = step { needed } else { 0 };
        let (frame, length) = take(step, bytes, &mut self.scan, &mut self.unescaped, &mut self.counters)?;
        self.start += length;
        Some(frame)
    }

    /// Takes bytes that lie elsewhere and gives all frames that they complete to `each`. Only what is not complete yet
    /// is copied.
    pub fn feed(&mut self, bytes: &[u8], mut each: impl FnMut(Frame<'_>)) {
        self.feed_quoted(bytes, |frame| {
            each(frame);
            false
        });
    }

    /// Does the same as [`feed`](Self::feed), and asks `each` whether the text outside packets is inside quotes now.
    /// Start bytes are characters there.
    pub fn feed_quoted(&mut self, mut bytes: &[u8], mut each: impl FnMut(Frame<'_>) -> bool) {
        while self.is_unfinished() && !bytes.is_empty() {
            bytes = self.complete(bytes, &mut each);
        }
        while !bytes.is_empty() {
            let step = classify_start(bytes, self.historical, self.quoted, &mut self.scan);
            if let Step::Wait(needed) = step {
                self.needed = needed;
                return self.append(bytes);
            }
            let taken = take(step, bytes, &mut self.scan, &mut self.unescaped, &mut self.counters);
            let Some((frame, length)) = taken else { return };
            self.quoted = each(frame);
            bytes = &bytes[length..];
        }
    }

    /// Takes so many bytes as the packet that has begun is known to need; returns the others.
    fn complete<'b>(&mut self, bytes: &'b [u8], each: &mut impl FnMut(Frame<'_>) -> bool) -> &'b [u8] {
        let waiting = self.end - self.start;
        let wanted = match self.buffer[self.start] {
            _ if self.needed > waiting => self.needed - waiting,
            ESCAPE_START if self.historical => ESCAPE_PIECE,
            _ => LONG_HEADER,
        };
        let (now, later) = bytes.split_at(wanted.min(bytes.len()));
        self.append(now);
        while let Some(frame) = self.next_frame() {
            self.quoted = each(frame);
        }
        later
    }

    /// Puts bytes into the buffer.
    fn append(&mut self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            let space = self.space();
            let (now, later) = bytes.split_at(bytes.len().min(space.len()));
            space[..now.len()].copy_from_slice(now);
            self.advance(now.len());
            bytes = later;
        }
    }

    /// Whether a packet has begun and its end is still to come.
    pub fn is_unfinished(&self) -> bool {
        self.start < self.end
    }

    /// Ends the stream: what is left of an unfinished packet, as noise.
    pub fn finish(&mut self) -> Option<Frame<'_>> {
        let left = self.end - self.start;
        if left == 0 {
            return None;
        }
        let bytes = &self.buffer[self.start..self.end];
        self.start = self.end;
        self.needed = 0;
        let step = Step::Noise(left, NoiseReason::Truncated);
        take(step, bytes, &mut self.scan, &mut self.unescaped, &mut self.counters).map(|taken| taken.0)
    }

    /// What was received so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }
}

/// The frame of what stands at the start of `bytes`, and its length; none if bytes of it are missing.
fn take<'a>(
    step: Step,
    bytes: &'a [u8],
    scan: &mut Scan,
    unescaped: &'a mut Vec<u8>,
    counters: &mut Counters,
) -> Option<(Frame<'a>, usize)> {
    Some(match step {
        Step::Wait(_) => return None,
        Step::Escaped(length) => {
            *scan = Scan::default();
            counters.packets += 1;
            counters.packet_bytes += length as u64;
            let raw = &bytes[..length];
            unescaped.clear();
            unescape(&raw[1..], unescaped);
            let (route, payload) = unescaped.split_first()?;
            (Frame::Packet { form: PacketForm::Escape, route: Route::from(*route), payload, raw }, length)
        }
        Step::Empty => {
            counters.packet_bytes += 2;
            (Frame::Empty(&bytes[..2]), 2)
        }
        Step::Text(length) => {
            counters.text_bytes += length as u64;
            (Frame::Text(&bytes[..length]), length)
        }
        Step::Noise(length, reason) => {
            *scan = Scan::default();
            counters.noise_bytes += length as u64;
            counters.dropped_packets += u64::from(reason == NoiseReason::BadPayload);
            (Frame::Noise { bytes: &bytes[..length], reason }, length)
        }
        Step::Packet(form, route, payload, length) => {
            counters.packets += 1;
            counters.packet_bytes += length as u64;
            let raw = &bytes[..length];
            (Frame::Packet { form, route, payload: &raw[payload], raw }, length)
        }
    })
}

/// What stands at the start of `bytes`, which are not empty.
fn classify_start(bytes: &[u8], historical: bool, quoted: bool, scan: &mut Scan) -> Step {
    match bytes[0] {
        _ if quoted => Step::Text(1 + find_start(&bytes[1..], historical)),
        LONG_START => scan_long(bytes),
        COUNT_START if historical => scan_counted(bytes),
        ESCAPE_START if historical => scan_escaped(bytes, scan),
        _ => Step::Text(find_start(bytes, historical)),
    }
}

fn scan_escaped(bytes: &[u8], scan: &mut Scan) -> Step {
    match bytes.get(1) {
        None => return Step::Wait(0),
        Some(&ESCAPE_START) => return Step::Empty,
        Some(&COUNT_START | &LONG_START) => return Step::Noise(1, NoiseReason::NoRoute),
        Some(_) => {}
    }
    let limit = bytes.len().min(MAX_ESCAPE_STREAM + 1);
    let mut at = scan.bytes.max(1) + usize::from(scan.escaped);
    while at < limit {
        match bytes[at..limit].iter().position(|byte| is_escaped(*byte)) {
            Some(clear) if bytes[at + clear] != ESCAPE => return Step::Escaped(at + clear),
            // What stands after the escape character is data.
            Some(clear) => at += clear + 2,
            None => at = limit,
        }
    }
    *scan = Scan { bytes: limit, escaped: at > limit };
    if limit > MAX_ESCAPE_STREAM { Step::Noise(limit, NoiseReason::TooLong) } else { Step::Wait(0) }
}

fn scan_long(bytes: &[u8]) -> Step {
    let Some((header, rest)) = bytes.split_first_chunk::<LONG_HEADER>() else {
        return Step::Wait(0);
    };
    let length = u32::from_le_bytes([header[2], header[3], header[4], header[5]]) as usize;
    let check = u16::from_le_bytes([header[6], header[7]]);
    if length > MAX_PAYLOAD || header_check(&header[..6]) != check {
        return Step::Noise(1, NoiseReason::BadHeader);
    }
    let total = LONG_HEADER + length + LONG_TRAILER;
    if bytes.len() < total {
        return Step::Wait(total);
    }
    let (payload, trailer) = rest[..length + LONG_TRAILER].split_at(length);
    if crc32fast::hash(payload).to_le_bytes() != trailer {
        return Step::Noise(total, NoiseReason::BadPayload);
    }
    Step::Packet(PacketForm::Long, Route::from(header[1]), LONG_HEADER..LONG_HEADER + length, total)
}

fn scan_counted(bytes: &[u8]) -> Step {
    let digit = |at: usize| bytes.get(at).map(|b| usize::from(b.wrapping_sub(COUNT_BIAS)));
    let is_digit = |digit: Option<usize>| digit.is_none_or(|digit| digit < COUNT_RADIX);
    let (high, low) = (digit(1), digit(2));
    if !is_digit(high) || !is_digit(low) || (high, low) == (Some(0), Some(0)) {
        return Step::Noise(1, NoiseReason::BadCount);
    }
    let (Some(high), Some(low)) = (high, low) else {
        return Step::Wait(0);
    };
    let total = 3 + high * COUNT_RADIX + low;
    if bytes.len() < total {
        return Step::Wait(total);
    }
    Step::Packet(PacketForm::Count, Route::from(bytes[3]), 4..total, total)
}

/// The number of bytes before the first start byte.
fn find_start(bytes: &[u8], historical: bool) -> usize {
    const BLOCK: usize = 32;
    // Without historical packets the other two are the long one again.
    let (count, escape) = if historical { (COUNT_START, ESCAPE_START) } else { (LONG_START, LONG_START) };
    let is_start = |b: u8| (b == LONG_START) | (b == count) | (b == escape);
    let clear = bytes.chunks_exact(BLOCK).take_while(|block| !block.iter().fold(false, |any, &b| any | is_start(b)));
    let skipped = clear.count() * BLOCK;
    let rest = &bytes[skipped..];
    skipped + rest.iter().position(|&b| is_start(b)).unwrap_or(rest.len())
}

#[cfg(test)]
mod tests;
