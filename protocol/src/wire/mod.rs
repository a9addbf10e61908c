//! Bytes on the host line: text and packets, and messages back to the host.
//!
//! Bytes outside packets are plain text. A packet begins with one of three start bytes, carries a [`Route`] that says
//! who is to read it, and its data. `PROTOCOL.md` shows every byte.

mod packet;
mod six_bit;
mod deframe;
mod message;
mod send;

pub use deframe::{Counters, Frame, FrameDecoder, NoiseReason};
pub use message::{MAX_MESSAGE, MessageError, MessageForm, MessageReader, MessageWriter};
pub use packet::{
    COUNT_BIAS, COUNT_RADIX, COUNT_START, ESCAPE, ESCAPE_START, LONG_HEADER, LONG_START, LONG_TRAILER, MAX_COUNT_DATA,
    MAX_ESCAPE_STREAM, MAX_PAYLOAD, PacketForm, Route, count_header, header_check, is_escaped, long_header,
    write_count_packet, write_escape_packet, write_packet, write_packet_as,
};
pub use send::{
    DataForm, PREFERRED_PAYLOAD, SendError, Sending, send_commands, send_raster, write_commands, write_commands_as,
    write_raster, write_raster_as,
};
pub use six_bit::{SIX_BIT_ZERO, SixBitError, read_six_bit, write_six_bit};
