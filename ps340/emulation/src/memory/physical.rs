//! Physical reads and writes of the parallel interface: the data of an object as words of memory.

use super::MassMemory;
use crate::{port::ObjectId, structure::PhysicalFault};

impl MassMemory {
    /// How many words of memory the data of an object has, for the parallel interface; 0 if they cannot be read.
    pub fn physical_words(&self, id: ObjectId) -> usize {
        self.structures.physical_words(id).unwrap_or(0)
    }

    /// Reads words of the data of an object, from word `offset` on.
    ///
    /// # Errors
    /// [`PhysicalFault`].
    pub fn physical_read(&self, id: ObjectId, offset: usize, count: usize) -> Result<Vec<u16>, PhysicalFault> {
        self.structures.physical_read(id, offset, count)
    }

    /// Writes words of the data of an object, from word `offset` on: all of them, or none.
    ///
    /// # Errors
    /// [`PhysicalFault`].
    pub fn physical_write(&mut self, id: ObjectId, offset: usize, words: &[u16]) -> Result<(), PhysicalFault> {
        self.structures.physical_write(id, offset, words)
    }
}
