//! Transports of commands: as text or binary, in packets or not, whole or cut.

use protocol::{
    command::{CommandError, CommandReader},
    record::EncodeError,
    wire::{DataForm, MAX_COUNT_DATA, PacketForm, Route, Sending, write_commands_as, write_packet_as},
};
use rand_pcg::{
    Pcg64Mcg,
    rand_core::{Rng, SeedableRng},
};

/// The form of commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, clap::ValueEnum)]
pub enum Form {
    /// As they stand in the case.
    #[default]
    Text,
    /// Binary records of whole bytes.
    Binary8,
    /// Binary records in printable characters.
    Binary6,
}

/// What carries them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, clap::ValueEnum)]
pub enum Packets {
    /// Bare text.
    #[default]
    None,
    /// Count packets.
    Count,
    /// Escape packets.
    Escape,
    /// Long packets, with checks.
    Long,
}

impl Packets {
    /// The form of packets; none for bare text.
    pub fn form(self) -> Option<PacketForm> {
        match self {
            Packets::None => None,
            Packets::Count => Some(PacketForm::Count),
            Packets::Escape => Some(PacketForm::Escape),
            Packets::Long => Some(PacketForm::Long),
        }
    }
}

/// A form and a carrier.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Transport {
    /// The form of commands.
    pub form: Form,
    /// What carries them.
    pub packets: Packets,
}

/// The reason why a transport cannot carry a text.
#[derive(Debug, thiserror::Error)]
pub enum TransportError {
    /// Binary records need packets.
    #[error("the binary forms travel in packets only")]
    NoPackets,
    /// A case whose text cannot be parsed should be marked `text-only`.
    #[error("the text has no binary form: {0}")]
    Text(CommandError),
    /// The binary form lacks this command.
    #[error("the command has no binary record: {0}")]
    Record(EncodeError),
}

impl Transport {
    /// Every transport of commands.
    pub fn all() -> Vec<Transport> {
        let forms = <Form as clap::ValueEnum>::value_variants();
        let packets = <Packets as clap::ValueEnum>::value_variants();
        let all = forms.iter().flat_map(|&form| packets.iter().map(move |&packets| Transport { form, packets }));
        all.filter(|way| way.check().is_ok()).collect()
    }

    /// Whether the carrier can carry the form.
    ///
    /// # Errors
    /// [`TransportError::NoPackets`].
    pub fn check(self) -> Result<(), TransportError> {
        if self.form != Form::Text && self.packets == Packets::None { Err(TransportError::NoPackets) } else { Ok(()) }
    }
}

impl std::fmt::Display for Transport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?} in {:?}", self.form, self.packets)
    }
}

/// Encodes command text for its transport: into bytes of the line.
#[derive(Debug)]
pub struct Sender {
    transport: Transport,
    cut: Option<Pcg64Mcg>,
    reader: CommandReader,
}

impl Sender {
    /// A sender at the beginning of a stream.
    ///
    /// - `cut`: seed for cutting the stream at random places.
    pub fn new(way: Transport, cut: Option<u64>) -> Sender {
        Sender { transport: way, cut: cut.map(Pcg64Mcg::seed_from_u64), reader: CommandReader::default() }
    }

    /// Appends command text in the sender's transport. A statement may come in pieces.
    ///
    /// # Errors
    /// [`TransportError`] if the transport cannot carry the text.
    pub fn write(&mut self, text: &[u8], text_only: bool, out: &mut Vec<u8>) -> Result<(), TransportError> {
        if self.transport.form == Form::Text || text_only {
            self.write_text(text, out);
            return Ok(());
        }
        self.reader.push(text);
        let mut commands = Vec::new();
        for read in self.reader.by_ref() {
            commands.push(read.map_err(TransportError::Text)?.command);
        }
        let data = if self.transport.form == Form::Binary6 { DataForm::SixBit } else { DataForm::EightBit };
        let packets = self.transport.packets.form().ok_or(TransportError::NoPackets)?;
        write_commands_as(Sending { packets, data }, &commands, out).map_err(TransportError::Record)
    }

    fn write_text(&mut self, text: &[u8], out: &mut Vec<u8>) {
        let mut rest = text;
        while !rest.is_empty() {
            let most = if self.transport.packets == Packets::None { usize::MAX } else { MAX_COUNT_DATA };
            let most = self.cut.as_mut().map_or(most, |random| 1 + random.next_u32() as usize % 200);
            let (now, later) = rest.split_at(rest.len().min(most));
            match self.transport.packets.form() {
                None => out.extend_from_slice(now),
                Some(form) => write_packet_as(form, Route::Text, now, out).expect("a piece fits every packet"),
            }
            rest = later;
        }
    }

    /// The pieces in which bytes are given to the line: one, or random ones.
    pub fn pieces<'b>(&mut self, bytes: &'b [u8]) -> Vec<&'b [u8]> {
        let Some(random) = &mut self.cut else { return vec![bytes] };
        let mut pieces = Vec::new();
        let mut rest = bytes;
        while !rest.is_empty() {
            // Mostly short pieces, some of a kilobyte.
            let most = if random.next_u32() % 4 == 0 { 1000 } else { 30 };
            let length = (1 + random.next_u32() as usize % most).min(rest.len());
            let (now, later) = rest.split_at(length);
            pieces.push(now);
            rest = later;
        }
        pieces
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::{
        command::{BinaryDecoder, Command},
        wire::{Frame, FrameDecoder, read_six_bit},
    };

    /// The commands that a machine would decode.
    fn decoded_commands(stream: &[u8]) -> Vec<Command> {
        let (mut frames, mut text, mut binary) =
            (FrameDecoder::default(), CommandReader::default(), BinaryDecoder::default());
        let mut all = Vec::new();
        frames.feed(stream, |frame| match frame {
            Frame::Text(bytes) | Frame::Packet { route: Route::Text, payload: bytes, .. } => {
                text.push(bytes);
                all.extend(text.by_ref().map(|read| read.unwrap().command));
            }
            Frame::Packet { route: Route::Binary, payload, .. } => all.extend(binary.push(payload).map(Result::unwrap)),
            Frame::Packet { route: Route::SixBitBinary, payload, .. } => {
                let mut bytes = Vec::new();
                read_six_bit(payload, &mut bytes).unwrap();
                all.extend(binary.push(&bytes).map(Result::unwrap));
            }
            // The two start bytes that end an escape packet.
            Frame::Empty(_) => {}
            other => panic!("{other:?}"),
        });
        all
    }

    #[test]
    fn every_way_says_the_same_also_when_it_is_cut() {
        let text: String = (0..400).map(|i| format!("V{i} := VECTOR_LIST {i},0 1,{i}; DISPLAY V{i};\n")).collect();
        let plain = decoded_commands(text.as_bytes());
        assert_eq!(plain.len(), 800);
        for way in Transport::all() {
            for cut in [None, Some(7)] {
                let mut sender = Sender::new(way, cut);
                let mut stream = Vec::new();
                // A statement that comes in two pieces.
                let (first, second) = text.as_bytes().split_at(1001);
                sender.write(first, false, &mut stream).unwrap();
                sender.write(second, false, &mut stream).unwrap();
                assert!(decoded_commands(&stream) == plain, "{way}");
                assert_eq!(sender.pieces(&stream).concat(), stream);
            }
        }
    }

    #[test]
    fn a_text_that_is_no_command_has_no_binary_form() {
        let way = Transport { form: Form::Binary8, packets: Packets::Long };
        let mut sender = Sender::new(way, None);
        assert!(matches!(sender.write(b"DISPLAY 3;", false, &mut Vec::new()), Err(TransportError::Text(_))));
        assert!(sender.write(b"DISPLAY 3;", true, &mut Vec::new()).is_ok());
        assert!(Transport { form: Form::Binary8, packets: Packets::None }.check().is_err());
    }
}
