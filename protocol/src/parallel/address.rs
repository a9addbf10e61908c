//! Address lists: which memory a physical read or write is about.

use super::ParallelError;

/// Most blocks in an address list. The driver used one; more are ours.
pub const MAX_BLOCKS: usize = 64;

/// A piece of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// Where it begins: what LOOKUP gave, and an even number of bytes on.
    pub address: u32,
    /// How many words it has.
    pub words: u16,
}

/// The list at the beginning of a block: a word with the number of pieces, then for each the low word of its address,
/// the high word, and its number of words. All words have their highest byte first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AddressList(pub Vec<Block>);

impl AddressList {
    /// Appends the list.
    pub fn write(&self, out: &mut Vec<u8>) {
        let mut word = |word: u16| out.extend_from_slice(&word.to_be_bytes());
        word(self.0.len() as u16);
        for block in &self.0 {
            word(block.address as u16);
            word((block.address >> 16) as u16);
            word(block.words);
        }
    }

    /// Reads a list; also what follows it.
    ///
    /// # Errors
    /// [`ParallelError::ByteCount`] for bytes that end before the list does, or for none or more than [`MAX_BLOCKS`]
    /// pieces.
    pub fn read(bytes: &[u8]) -> Result<(AddressList, &[u8]), ParallelError> {
        let word = |at: usize| {
            let pair = bytes.get(2 * at..2 * at + 2).ok_or(ParallelError::ByteCount)?;
            Ok(u16::from_be_bytes([pair[0], pair[1]]))
        };
        let count = usize::from(word(0)?);
        if count == 0 || count > MAX_BLOCKS {
            return Err(ParallelError::ByteCount);
        }
        let block = |index: usize| {
            let (low, high, words) = (word(3 * index + 1)?, word(3 * index + 2)?, word(3 * index + 3)?);
            Ok(Block { address: u32::from(high) << 16 | u32::from(low), words })
        };
        let blocks = (0..count).map(block).collect::<Result<Vec<Block>, ParallelError>>()?;
        Ok((AddressList(blocks), &bytes[2 * (1 + 3 * count)..]))
    }

    /// Words of all pieces together.
    pub fn words(&self) -> usize {
        self.0.iter().map(|block| usize::from(block.words)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_low_word_of_an_address_comes_first() {
        let list = AddressList(vec![Block { address: 0x0001_0002, words: 3 }, Block { address: 4, words: 5 }]);
        let mut bytes = Vec::new();
        list.write(&mut bytes);
        assert_eq!(bytes, [0, 2, 0, 2, 0, 1, 0, 3, 0, 4, 0, 0, 0, 5]);
        bytes.extend(b"data");
        assert_eq!(AddressList::read(&bytes), Ok((list.clone(), &b"data"[..])));
        assert_eq!(list.words(), 8);
    }

    #[test]
    fn a_list_that_is_cut_off_is_a_bad_byte_count() {
        for bytes in [&[][..], &[0], &[0, 0], &[0, 1, 0, 2, 0, 1, 0], &[0, 65]] {
            assert_eq!(AddressList::read(bytes), Err(ParallelError::ByteCount), "{bytes:?}");
        }
    }
}
