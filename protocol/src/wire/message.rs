//! Messages to the host, one string each, in three forms.
//!
//! A connection begins in the text form: the bytes of a message, then CR LF. The CR is historical \[M\]; the LF is
//! ours, so that a terminal shows lines. A CR that ends the message is that of CR LF: a typed RETURN, which is a
//! message of one CR, ends one line and not two. A packet on the route `=` with the body `P` switches the messages of
//! that connection to the packet form: one long packet on the route `=` for each message, with exactly its bytes. The
//! body `O` asks for packets of the connection's own: messages that its own commands lead to HOST_MESSAGE, and, on the
//! route `?`, what the machine reports about its commands; no other host receives them, and it receives those of no
//! other. The body `T` switches back. All three are ours.

use super::{
    deframe::{Frame, FrameDecoder, NoiseReason},
    packet::{MAX_PAYLOAD, Route, write_packet},
};
use crate::record::EncodeError;
use std::collections::VecDeque;

/// Longest message, in bytes. Ours.
pub const MAX_MESSAGE: usize = MAX_PAYLOAD;

/// How the messages of a connection travel, and whose they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MessageForm {
    /// The bytes, then CR LF.
    #[default]
    Text,
    /// Packets on the route `=`.
    Packets,
    /// Packets of this connection alone: its messages on the route `=`, reports about its commands on the route `?`.
    Own,
}

impl MessageForm {
    /// All of them.
    pub const ALL: [MessageForm; 3] = [MessageForm::Text, MessageForm::Packets, MessageForm::Own];

    /// The body of the packet from the host that asks for the form.
    pub const fn request(self) -> &'static [u8] {
        match self {
            MessageForm::Text => b"T",
            MessageForm::Packets => b"P",
            MessageForm::Own => b"O",
        }
    }

    /// The form that the body of a packet on the route `=` from the host asks for.
    pub fn requested(body: &[u8]) -> Option<MessageForm> {
        MessageForm::ALL.into_iter().find(|form| form.request() == body)
    }

    /// Appends the packet that asks for the form.
    pub fn write_request(self, out: &mut Vec<u8>) {
        write_packet(Route::Message, self.request(), out).expect("one byte is no long payload");
    }
}

/// The reason why a message did not arrive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MessageError {
    /// A line of text that is longer than [`MAX_MESSAGE`]; it is dropped up to its end.
    #[error("a message is longer than {MAX_MESSAGE} bytes")]
    TooLong,
    /// Bytes that are no message.
    #[error("a message was lost: {0}")]
    Lost(NoiseReason),
}

/// The machine's side: writes messages in the form that the host asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MessageWriter {
    form: MessageForm,
}

impl MessageWriter {
    /// The form in use.
    pub fn form(&self) -> MessageForm {
        self.form
    }

    /// Writes in this form from now on.
    pub fn set_form(&mut self, form: MessageForm) {
        self.form = form;
    }

    /// Appends a message to what goes to the host.
    ///
    /// In the text form the host takes the first CR LF for the end of the message, also one inside it, and does not see
    /// a CR at its end.
    ///
    /// # Errors
    /// A message longer than [`MAX_MESSAGE`].
    pub fn write(&self, message: &[u8], out: &mut Vec<u8>) -> Result<(), EncodeError> {
        crate::record::within("the message", message.len(), MAX_MESSAGE)?;
        match self.form {
            MessageForm::Text => {
                out.extend_from_slice(message);
                out.extend_from_slice(if message.ends_with(b"\r") { b"\n" } else { b"\r\n" });
                Ok(())
            }
            MessageForm::Packets | MessageForm::Own => write_packet(Route::Message, message, out),
        }
    }

    /// Appends a report about a command to what goes to a host that asked for [`MessageForm::Own`]; nothing else has a
    /// place for it in the other forms.
    ///
    /// # Errors
    /// A report longer than [`MAX_MESSAGE`].
    pub fn write_report(&self, report: &str, out: &mut Vec<u8>) -> Result<(), EncodeError> {
        if self.form == MessageForm::Own { write_packet(Route::Diagnostic, report.as_bytes(), out) } else { Ok(()) }
    }
}

/// The host's side: messages out of the stream from the machine, however it arrives.
///
/// It takes every byte for text until [`expect`](Self::expect) notes that packets were requested. From then on it takes
/// both, since messages that were on their way still come as text.
///
/// It gives the messages as an iterator. Reports about the host's own commands are apart from them, in
/// [`next_report`](Self::next_report).
#[derive(Clone, Debug)]
pub struct MessageReader {
    form: MessageForm,
    decoder: FrameDecoder,
    lines: Lines,
    reports: VecDeque<String>,
}

/// Lines of text out of pieces.
#[derive(Clone, Debug, Default)]
struct Lines {
    line: Vec<u8>,
    /// The line is too long and is dropped up to its end.
    dropping: bool,
    ready: VecDeque<Result<Vec<u8>, MessageError>>,
}

impl Default for MessageReader {
    fn default() -> Self {
        let decoder = FrameDecoder::long_packets_only();
        MessageReader { form: MessageForm::Text, decoder, lines: Lines::default(), reports: VecDeque::new() }
    }
}

impl MessageReader {
    /// Notes which form was requested; to be called when the request is sent.
    pub fn expect(&mut self, form: MessageForm) {
        self.form = form;
    }

    /// Takes more of the stream.
    pub fn push(&mut self, bytes: &[u8]) {
        let MessageReader { form, decoder, lines, reports } = self;
        if *form == MessageForm::Text && !decoder.is_unfinished() {
            return lines.push(bytes);
        }
        decoder.feed(bytes, |frame| match frame {
            Frame::Text(text) => lines.push(text),
            Frame::Packet { route: Route::Message, payload, .. } => lines.ready.push_back(Ok(payload.to_vec())),
            Frame::Packet { route: Route::Diagnostic, payload, .. } if *form == MessageForm::Own => {
                reports.push_back(String::from_utf8_lossy(payload).into_owned());
            }
            Frame::Packet { .. } | Frame::Empty(_) => {}
            // In what is left of the text form a start byte is a character like any other.
            Frame::Noise { bytes, reason: NoiseReason::BadHeader | NoiseReason::BadCount } => lines.push(bytes),
            Frame::Noise { reason, .. } => lines.ready.push_back(Err(MessageError::Lost(reason))),
        });
    }

    /// The next report of the machine about a command of this host, such as `E 2 *** Name not found: CUBE`. It stood in
    /// the stream before every message that was read after it.
    pub fn next_report(&mut self) -> Option<String> {
        self.reports.pop_front()
    }

    /// Whether a message has begun and its end is still to come.
    pub fn is_unfinished(&self) -> bool {
        self.lines.dropping || !self.lines.line.is_empty() || self.decoder.is_unfinished()
    }
}

impl Iterator for MessageReader {
    type Item = Result<Vec<u8>, MessageError>;

    /// The next message that is complete.
    fn next(&mut self) -> Option<Self::Item> {
        self.lines.ready.pop_front()
    }
}

impl Lines {
    fn push(&mut self, bytes: &[u8]) {
        for piece in bytes.split_inclusive(|b| *b == b'\n') {
            // Two more bytes than a message: its CR LF.
            if self.line.len() + piece.len() > MAX_MESSAGE + 2 {
                if !self.dropping {
                    self.ready.push_back(Err(MessageError::TooLong));
                }
                self.dropping = true;
                // Its last byte is enough to see the CR of the end.
                let last = self.line.last().copied().filter(|_| piece == b"\n");
                self.line = last.into_iter().collect();
                self.line.extend(&piece[piece.len().saturating_sub(2)..]);
            } else {
                self.line.extend_from_slice(piece);
            }
            if self.line.ends_with(b"\r\n") {
                self.line.truncate(self.line.len() - 2);
                let message = std::mem::take(&mut self.line);
                if !std::mem::take(&mut self.dropping) {
                    self.ready.push_back(Ok(message));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn written(messages: &[&[u8]], writer: MessageWriter) -> Vec<u8> {
        let mut out = Vec::new();
        messages.iter().for_each(|message| writer.write(message, &mut out).unwrap());
        out
    }

    fn packets() -> MessageWriter {
        MessageWriter { form: MessageForm::Packets }
    }

    #[test]
    fn a_form_is_asked_for_by_its_letter() {
        for (body, form) in [(&b"T"[..], MessageForm::Text), (b"P", MessageForm::Packets), (b"O", MessageForm::Own)] {
            assert_eq!(MessageForm::requested(body), Some(form));
        }
        assert_eq!(MessageForm::requested(b"?"), None);
    }

    #[test]
    fn reports_come_apart_from_messages_and_only_to_those_who_asked() {
        let mut writer = packets();
        let mut stream = Vec::new();
        writer.write_report("E 1", &mut stream).unwrap();
        assert!(stream.is_empty());
        writer.set_form(MessageForm::Own);
        writer.write_report("E 2", &mut stream).unwrap();
        writer.write(b"A", &mut stream).unwrap();
        writer.write_report("E 3", &mut stream).unwrap();
        let mut reader = MessageReader::default();
        reader.expect(MessageForm::Own);
        stream.chunks(3).for_each(|piece| reader.push(piece));
        assert_eq!(reader.by_ref().collect::<Vec<_>>(), [Ok(b"A".to_vec())]);
        let reports: Vec<String> = std::iter::from_fn(|| reader.next_report()).collect();
        assert_eq!(reports, ["E 2", "E 3"]);
    }

    #[test]
    fn a_typed_return_is_one_line_end() {
        let stream = written(&[b"\r", b"A\r", b"", b"1V 0.25,-0.125"], MessageWriter::default());
        assert_eq!(stream, b"\r\nA\r\n\r\n1V 0.25,-0.125\r\n");
        let mut reader = MessageReader::default();
        reader.push(&stream);
        let messages: Vec<Vec<u8>> = reader.map(Result::unwrap).collect();
        assert_eq!(messages, [&b""[..], b"A", b"", b"1V 0.25,-0.125"]);
    }

    #[test]
    fn text_that_was_on_its_way_arrives_after_packets_were_asked_for() {
        let mut stream = written(&[b"late \x1d text", b"more"], MessageWriter::default());
        stream.extend(written(&[b"a\r\nb", b"\x1d\x1c"], packets()));
        let mut reader = MessageReader::default();
        reader.push(&stream[..3]);
        reader.expect(MessageForm::Packets);
        stream[3..].chunks(5).for_each(|piece| reader.push(piece));
        assert!(!reader.is_unfinished());
        let messages: Vec<Vec<u8>> = reader.map(Result::unwrap).collect();
        assert_eq!(messages, [&b"late \x1d text"[..], b"more", b"a\r\nb", b"\x1d\x1c"]);
    }

    #[test]
    fn a_line_without_end_is_an_error_and_the_next_one_arrives() {
        let mut reader = MessageReader::default();
        for _ in 0..20 {
            reader.push(&[b'x'; MAX_MESSAGE / 10]);
        }
        assert!(reader.lines.line.capacity() < 3 * MAX_MESSAGE);
        reader.push(b"\r");
        reader.push(b"\ngood\r\n");
        assert_eq!(reader.next(), Some(Err(MessageError::TooLong)));
        assert_eq!(reader.next(), Some(Ok(b"good".to_vec())));
        assert_eq!(reader.next(), None);
    }

    #[test]
    fn the_longest_message_arrives_in_both_forms() {
        let message = vec![b'm'; MAX_MESSAGE];
        for writer in [MessageWriter::default(), packets()] {
            let mut reader = MessageReader::default();
            reader.expect(writer.form());
            reader.push(&written(&[&message], writer));
            assert_eq!(reader.next(), Some(Ok(message.clone())));
            assert!(writer.write(&vec![0; MAX_MESSAGE + 1], &mut Vec::new()).is_err());
        }
    }

    proptest! {
        #[test]
        fn any_split_gives_the_messages(
            messages in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..30), 0..6),
            in_packets in any::<bool>(), size in 1_usize..9
        ) {
            let clean = |message: &Vec<u8>| {
                let mut message: Vec<u8> = message.iter().copied().filter(|b| *b != b'\n').collect();
                message.truncate(message.iter().rposition(|b| *b != b'\r').map_or(0, |last| last + 1));
                message
            };
            let messages: Vec<Vec<u8>> = if in_packets { messages } else { messages.iter().map(clean).collect() };
            let writer = if in_packets { packets() } else { MessageWriter::default() };
            let slices: Vec<&[u8]> = messages.iter().map(Vec::as_slice).collect();
            let mut reader = MessageReader::default();
            reader.expect(writer.form());
            written(&slices, writer).chunks(size).for_each(|piece| reader.push(piece));
            prop_assert_eq!(reader.collect::<Result<Vec<_>, _>>(), Ok(messages));
        }
    }
}
