//! Frames of the parallel interface over a stream: words, blocks, and the reset line. Ours.

/// Most bytes in a block: the byte count is one word, and blocks are whole words.
pub const MAX_BLOCK_BYTES: usize = 65_534;

/// A frame: what one pulse of the interface, or one transfer by DMA, carried.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ParallelFrame {
    /// `W`: a word, highest byte first.
    Word(u16),
    /// `D`: a block, with its length in bytes as a word before it.
    Block(Vec<u8>),
    /// `R`: the reset line was pulsed.
    Reset,
    /// A byte that begins no frame.
    Noise(u8),
}

/// Appends a word.
pub fn write_word(word: u16, out: &mut Vec<u8>) {
    out.push(b'W');
    out.extend_from_slice(&word.to_be_bytes());
}

/// Appends a block, filled up to whole words; what is longer than [`MAX_BLOCK_BYTES`] is cut.
pub fn write_block(bytes: &[u8], out: &mut Vec<u8>) {
    let bytes = &bytes[..bytes.len().min(MAX_BLOCK_BYTES)];
    let odd = bytes.len() % 2;
    out.push(b'D');
    out.extend_from_slice(&((bytes.len() + odd) as u16).to_be_bytes());
    out.extend_from_slice(bytes);
    out.extend_from_slice(&[0][..odd]);
}

/// Appends a pulse of the reset line.
pub fn write_reset(out: &mut Vec<u8>) {
    out.push(b'R');
}

/// Cuts a stream into frames, however it arrives. An iterator over the frames that are complete.
#[derive(Clone, Debug, Default)]
pub struct ParallelFrameReader {
    buffer: Vec<u8>,
    start: usize,
}

impl ParallelFrameReader {
    /// Takes more of the stream.
    pub fn push(&mut self, bytes: &[u8]) {
        self.buffer.drain(..self.start);
        self.start = 0;
        self.buffer.extend_from_slice(bytes);
    }

    /// Whether a frame has begun and its end is still to come.
    pub fn is_unfinished(&self) -> bool {
        self.start < self.buffer.len()
    }
}

impl Iterator for ParallelFrameReader {
    type Item = ParallelFrame;

    fn next(&mut self) -> Option<ParallelFrame> {
        let rest = &self.buffer[self.start..];
        let word = |at: usize| Some(u16::from_be_bytes([*rest.get(at)?, *rest.get(at + 1)?]));
        let (frame, length) = match rest.first()? {
            b'W' => (ParallelFrame::Word(word(1)?), 3),
            b'D' => {
                let length = usize::from(word(1)?);
                (ParallelFrame::Block(rest.get(3..3 + length)?.to_vec()), 3 + length)
            }
            b'R' => (ParallelFrame::Reset, 1),
            byte => (ParallelFrame::Noise(*byte), 1),
        };
        self.start += length;
        Some(frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn blocks_are_whole_words() {
        let mut out = Vec::new();
        write_block(b"odd", &mut out);
        assert_eq!(out, b"D\x00\x04odd\0");
        out.clear();
        write_block(&vec![1; MAX_BLOCK_BYTES + 1], &mut out);
        assert_eq!((out.len(), &out[..3]), (MAX_BLOCK_BYTES + 3, &b"D\xff\xfe"[..]));
    }

    proptest! {
        #[test]
        fn frames_arrive_however_the_stream_is_cut(
            frames in prop::collection::vec((0..4_u8, any::<u16>(), prop::collection::vec(any::<u8>(), 0..30)), 0..8),
            size in 1_usize..20
        ) {
            let mut stream = Vec::new();
            let frames: Vec<ParallelFrame> = frames.into_iter().map(|(kind, word, mut bytes)| match kind {
                0 => {
                    write_word(word, &mut stream);
                    ParallelFrame::Word(word)
                }
                1 => {
                    write_block(&bytes, &mut stream);
                    bytes.extend(&[0][..bytes.len() % 2]);
                    ParallelFrame::Block(bytes)
                }
                2 => {
                    write_reset(&mut stream);
                    ParallelFrame::Reset
                }
                _ => {
                    stream.push(b'!');
                    ParallelFrame::Noise(b'!')
                }
            }).collect();
            let (mut reader, mut found) = (ParallelFrameReader::default(), Vec::new());
            for piece in stream.chunks(size) {
                reader.push(piece);
                found.extend(reader.by_ref());
            }
            prop_assert!(!reader.is_unfinished());
            prop_assert_eq!(found, frames);
        }
    }
}
