//! Bytes on the host line: text and packets, and messages back to the host.
//!
//! Bytes outside packets are plain text. A packet begins with one of two start bytes, carries a [`Route`] that says who
//! is to read it, and its data. `PROTOCOL.md` shows every byte.

mod packet;
mod deframe;
mod message;
mod send;

pub use deframe::{Counters, Frame, FrameDecoder, NoiseReason};
pub use message::{MAX_MESSAGE, MessageError, MessageForm, MessageReader, MessageWriter};
pub use packet::{
    COUNT_BIAS, COUNT_RADIX, COUNT_START, LONG_HEADER, LONG_START, LONG_TRAILER, MAX_COUNT_DATA, MAX_PAYLOAD,
    PacketForm, Route, count_header, header_check, long_header, write_count_packet, write_packet,
};
pub use send::{PREFERRED_PAYLOAD, SendError, send_commands, send_raster, write_commands, write_raster};
