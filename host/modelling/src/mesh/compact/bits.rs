//! Bits, and numbers of few bits, most significant bit first.

use super::super::MeshProblem;

/// The longest quotient of a Rice number; longer ones are written plainly.
const MAX_QUOTIENT: u32 = 20;
/// Bits of a number that is written plainly.
const PLAIN_BITS: u32 = 20;
const ENDS: MeshProblem = MeshProblem::Ends("a bit");

#[derive(Default)]
pub(super) struct BitWriter {
    bytes: Vec<u8>,
    free: u32,
}

impl BitWriter {
    /// Writes the `count` lowest bits of `value`.
    pub fn put(&mut self, value: u64, count: u32) {
        for position in (0..count).rev() {
            if self.free == 0 {
                self.bytes.push(0);
                self.free = 8;
            }
            self.free -= 1;
            if let Some(last) = self.bytes.last_mut() {
                *last |= ((value >> position & 1) as u8) << self.free;
            }
        }
    }

    /// Writes `count` ones and, below `limit`, a zero.
    pub fn ones(&mut self, count: u32, limit: u32) {
        self.put(u64::MAX, count);
        if count < limit {
            self.put(0, 1);
        }
    }

    /// Writes a number of at least 1 in Elias' gamma code.
    pub fn gamma(&mut self, value: u32) {
        let width = value.ilog2();
        self.put(0, width);
        self.put(value.into(), width + 1);
    }

    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}

pub(super) struct BitReader<'a> {
    bytes: &'a [u8],
    bit: usize,
}

impl<'a> BitReader<'a> {
    pub fn new(bytes: &'a [u8]) -> BitReader<'a> {
        BitReader { bytes, bit: 0 }
    }

    /// The byte that holds the next bit.
    pub fn byte(&self) -> usize {
        self.bit / 8
    }

    fn bit(&mut self) -> Result<u32, MeshProblem> {
        let byte = *self.bytes.get(self.bit / 8).ok_or(ENDS)?;
        let bit = byte >> (7 - self.bit % 8) & 1;
        self.bit += 1;
        Ok(bit.into())
    }

    fn take(&mut self, count: u32) -> Result<u64, MeshProblem> {
        let mut value = 0;
        for _ in 0..count {
            value = value << 1 | u64::from(self.bit()?);
        }
        Ok(value)
    }

    /// Counts ones up to a zero or to `limit`.
    pub fn ones(&mut self, limit: u32) -> Result<u32, MeshProblem> {
        let mut count = 0;
        while count < limit && self.bit()? == 1 {
            count += 1;
        }
        Ok(count)
    }

    /// Reads a number of at least 1 in Elias' gamma code.
    pub fn gamma(&mut self) -> Result<u32, MeshProblem> {
        let mut width = 0;
        while self.bit()? == 0 {
            width += 1;
            if width > 31 {
                return Err(MeshProblem::Unsuited("a number has more than 32 bits"));
            }
        }
        Ok(1 << width | self.take(width)? as u32)
    }
}

/// Golomb-Rice numbers of either sign whose parameter follows the mean of those before.
#[derive(Default)]
pub(super) struct Rice {
    /// Sixteen times the running mean of the folded numbers.
    mean: u64,
}

impl Rice {
    fn parameter(&self) -> u32 {
        (self.mean / 16).max(1).ilog2()
    }

    fn learn(&mut self, folded: u64) {
        self.mean += folded.min(1 << PLAIN_BITS);
        self.mean -= self.mean / 16;
    }

    pub fn write(&mut self, value: i64, bits: &mut BitWriter) {
        let folded = (value << 1 ^ value >> 63) as u64;
        let parameter = self.parameter();
        let quotient = folded >> parameter;
        if quotient < u64::from(MAX_QUOTIENT) {
            bits.ones(quotient as u32, MAX_QUOTIENT);
            bits.put(folded, parameter);
        } else {
            bits.ones(MAX_QUOTIENT, MAX_QUOTIENT);
            bits.put(folded, PLAIN_BITS);
        }
        self.learn(folded);
    }

    pub fn read(&mut self, bits: &mut BitReader<'_>) -> Result<i64, MeshProblem> {
        let parameter = self.parameter();
        let folded = match bits.ones(MAX_QUOTIENT)? {
            MAX_QUOTIENT => bits.take(PLAIN_BITS)?,
            quotient => u64::from(quotient) << parameter | bits.take(parameter)?,
        };
        self.learn(folded);
        Ok((folded >> 1) as i64 ^ -((folded & 1) as i64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back() {
        let values: Vec<i64> = (0..2000).map(|i: i64| (i * i * 37 % 4001 - 2000) * (1 + i % 7 * 20)).collect();
        let (mut writer, mut rice) = (BitWriter::default(), Rice::default());
        for &value in &values {
            rice.write(value, &mut writer);
            writer.gamma(value.unsigned_abs() as u32 + 1);
        }
        let bytes = writer.into_bytes();
        let (mut reader, mut rice) = (BitReader::new(&bytes), Rice::default());
        for &value in &values {
            assert_eq!(rice.read(&mut reader).unwrap(), value);
            assert_eq!(reader.gamma().unwrap(), value.unsigned_abs() as u32 + 1);
        }
        assert!(reader.take(8).is_err());
    }
}
