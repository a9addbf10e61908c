//! Data nodes as words of memory, for the physical reads and writes of the parallel interface.
//!
//! The layout is ours; the machine had its own, in its block-normalized numbers. A vector list is nine words a vector:
//! x, y, z and intensity as IEEE singles of two words each, the high word first, then 0 for a move to the vector (P) or
//! 1 for a line (L). The marks of a list that is not itemized follow from its class and cannot be written. A RAWBLOCK
//! is its bytes, the first of a pair the high one; an odd byte at its end is out of reach.

use super::{Node, Structures};
use crate::port::ObjectId;
use protocol::command::{VectorClass, VectorList};

/// Words of a vector.
pub const VECTOR_WORDS: usize = 9;

/// The reason why memory was not read or written; nothing has changed then.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PhysicalFault {
    /// The object has no such words.
    #[error("there is no memory at words {0} to {1} of the object")]
    Outside(usize, usize),
    /// A component of a vector would be infinite or no number.
    #[error("vector {0} would not be finite")]
    NotFinite(usize),
    /// A mark that is neither 0 nor 1.
    #[error("the mark of vector {0} is neither 0 nor 1")]
    Mark(usize),
}

impl Structures {
    /// How many words the data of an object has; none if it has no memory that can be read.
    pub fn physical_words(&self, id: ObjectId) -> Option<usize> {
        match self.node(id)? {
            Node::Vectors(vectors) => Some(vectors.list.points.len() * VECTOR_WORDS),
            Node::RawBlock(bytes) => Some(bytes.len() / 2),
            _ => None,
        }
    }

    /// Reads words of the data of an object, from word `offset` on.
    ///
    /// # Errors
    /// [`PhysicalFault::Outside`].
    pub fn physical_read(&self, id: ObjectId, offset: usize, count: usize) -> Result<Vec<u16>, PhysicalFault> {
        self.check(id, offset, count)?;
        match self.node(id) {
            Some(Node::Vectors(vectors)) => Ok(read_vectors(&vectors.list, offset, count)),
            Some(Node::RawBlock(bytes)) => {
                let pairs = bytes[2 * offset..2 * (offset + count)].chunks_exact(2);
                Ok(pairs.map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect())
            }
            _ => Err(PhysicalFault::Outside(offset, offset + count)),
        }
    }

    /// Writes words of the data of an object, from word `offset` on: all of them, or none.
    ///
    /// # Errors
    /// [`PhysicalFault`].
    pub fn physical_write(&mut self, id: ObjectId, offset: usize, words: &[u16]) -> Result<(), PhysicalFault> {
        self.check(id, offset, words.len())?;
        match self.nodes.get_mut(id.index()).and_then(Option::as_mut) {
            Some(Node::Vectors(vectors)) => {
                write_vectors(&mut vectors.list, offset, words)?;
                if vectors.dashed.is_some() {
                    self.stale.insert(id);
                }
            }
            Some(Node::RawBlock(bytes)) => {
                for (pair, word) in bytes[2 * offset..].chunks_exact_mut(2).zip(words) {
                    pair.copy_from_slice(&word.to_be_bytes());
                }
            }
            _ => return Err(PhysicalFault::Outside(offset, offset + words.len())),
        }
        self.version += 1;
        Ok(())
    }

    fn check(&self, id: ObjectId, offset: usize, count: usize) -> Result<(), PhysicalFault> {
        let size = self.physical_words(id).unwrap_or(0);
        if offset > size || count > size - offset {
            return Err(PhysicalFault::Outside(offset, offset.saturating_add(count)));
        }
        Ok(())
    }
}

/// Words of a vector list, which has them.
fn read_vectors(list: &VectorList, offset: usize, count: usize) -> Vec<u16> {
    let vectors = offset / VECTOR_WORDS..(offset + count).div_ceil(VECTOR_WORDS);
    let words = vectors.flat_map(|index| {
        let bits = list.points[index].map(f32::to_bits);
        let mark = u16::from(list.is_line(index));
        bits.into_iter().flat_map(|bits| [(bits >> 16) as u16, bits as u16]).chain([mark])
    });
    words.skip(offset % VECTOR_WORDS).take(count).collect()
}

/// Writes words of a vector list, which has them.
fn write_vectors(list: &mut VectorList, offset: usize, words: &[u16]) -> Result<(), PhysicalFault> {
    let first = offset / VECTOR_WORDS;
    let vectors = (offset + words.len()).div_ceil(VECTOR_WORDS) - first;
    let mut all = read_vectors(list, first * VECTOR_WORDS, vectors * VECTOR_WORDS);
    let before = offset - first * VECTOR_WORDS;
    all[before..before + words.len()].copy_from_slice(words);
    let itemized = list.class == VectorClass::Itemized;
    for (at, vector) in all.chunks_exact(VECTOR_WORDS).enumerate() {
        let finite = point(vector).iter().all(|component| component.is_finite());
        if !finite {
            return Err(PhysicalFault::NotFinite(first + at));
        }
        if itemized && vector[VECTOR_WORDS - 1] > 1 {
            return Err(PhysicalFault::Mark(first + at));
        }
    }
    for (at, vector) in all.chunks_exact(VECTOR_WORDS).enumerate() {
        let mut written = point(vector);
        if list.dimension == 2 {
            written[2] = 0.0;
        }
        list.points[first + at] = written;
        // Marks are read as they are drawn; only one that was written becomes what the list says.
        let mark = (first + at + 1) * VECTOR_WORDS - 1;
        if itemized
            && (offset..offset + words.len()).contains(&mark)
            && let Some(line) = list.lines.get_mut(first + at)
        {
            *line = vector[VECTOR_WORDS - 1] == 1;
        }
    }
    Ok(())
}

fn point(words: &[u16]) -> [f32; 4] {
    std::array::from_fn(|component| {
        let (high, low) = (words[2 * component], words[2 * component + 1]);
        f32::from_bits(u32::from(high) << 16 | u32::from(low))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vectors(text: &str) -> (Structures, ObjectId) {
        use protocol::command::{Command, Object, parse};
        let Ok(Command::Define { object: Object::VectorList(list), .. }) = parse(text.as_bytes()) else {
            panic!("{text} is no vector list")
        };
        let (mut structures, id) = (Structures::default(), ObjectId::new(3));
        structures.define(id, Node::Vectors(Box::new(list.into())));
        (structures, id)
    }

    #[test]
    fn a_vector_is_four_reals_and_a_mark() {
        let (structures, id) = vectors("V := VECTOR_LIST ITEMIZED P 1,2,-1 L 0.5,0,0 I=0.25;");
        assert_eq!(structures.physical_words(id), Some(18));
        let words = structures.physical_read(id, 0, 18).unwrap();
        // 1, 2, -1, 0.5 and 0.25 in the bits of IEEE 754.
        assert_eq!(words, [0x3f80, 0, 0x4000, 0, 0xbf80, 0, 0x3f80, 0, 0, 0x3f00, 0, 0, 0, 0, 0, 0x3e80, 0, 1]);
        for (offset, count) in [(0, 0), (18, 0), (5, 7), (17, 1)] {
            assert_eq!(structures.physical_read(id, offset, count).unwrap(), words[offset..offset + count]);
        }
        for (offset, count) in [(19, 0), (18, 1), (0, 19), (usize::MAX, 2)] {
            assert!(structures.physical_read(id, offset, count).is_err());
        }
        assert_eq!(structures.physical_words(ObjectId::new(0)), None);
    }

    #[test]
    fn words_in_the_middle_of_vectors_are_written() {
        let (mut structures, id) = vectors("V := VECTOR_LIST ITEMIZED P 1,2,3 L 4,5,6 P 7,8,9;");
        let version = structures.version();
        // The mark of vector 1, and x of vector 2.
        structures.physical_write(id, 17, &[0, 0xc000, 0]).unwrap();
        let Some(Node::Vectors(list)) = structures.node(id) else { panic!() };
        assert_eq!(list.list.points, [[1.0, 2.0, 3.0, 1.0], [4.0, 5.0, 6.0, 1.0], [-2.0, 8.0, 9.0, 1.0]]);
        assert!(!list.list.is_line(1) && structures.version() > version);
    }

    #[test]
    fn bad_words_change_nothing() {
        let (mut structures, id) = vectors("V := VECTOR_LIST ITEMIZED P 1,2,3 L 4,5,6;");
        let before = structures.node(id).cloned();
        let mut words = structures.physical_read(id, 0, 18).unwrap();
        words[9] = 0x7f80;
        assert_eq!(structures.physical_write(id, 0, &words), Err(PhysicalFault::NotFinite(1)));
        assert_eq!(structures.physical_write(id, 17, &[2]), Err(PhysicalFault::Mark(1)));
        assert_eq!(structures.physical_write(id, 17, &[1, 1]), Err(PhysicalFault::Outside(17, 19)));
        assert_eq!(structures.node(id).cloned(), before);
    }

    #[test]
    fn z_of_a_flat_list_and_marks_of_a_connected_one_stay() {
        let (mut structures, id) = vectors("V := VECTOR_LIST 1,2 3,4;");
        structures.physical_write(id, 9, &[0x4040, 0, 0x4080, 0, 0x3f80, 0, 0, 0, 7]).unwrap();
        let Some(Node::Vectors(list)) = structures.node(id) else { panic!() };
        assert_eq!((list.list.points[1], list.list.is_line(1)), ([3.0, 4.0, 0.0, 0.0], true));
    }
}
