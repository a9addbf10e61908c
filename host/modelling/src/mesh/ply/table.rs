//! The numbers of the tables, whatever their encoding.

use super::super::error::shortened;
use super::super::{Fault, FaultLocation, MeshProblem};
use super::header::{Property, Scalar};

/// A stream of numbers. Every type of the format fits into `f64` without loss.
pub(super) trait Table {
    /// The next number.
    fn number(&mut self, scalar: Scalar) -> Result<f64, Fault>;

    /// Where the next number stands.
    fn location(&self) -> FaultLocation;

    /// Bytes from here to the end.
    fn bytes_left(&self) -> u64;

    /// The fewest bytes that a number of this type takes.
    fn scalar_bytes(&self, scalar: Scalar) -> u64;

    /// The fewest bytes that a property takes in a row.
    fn least_bytes(&self, property: &Property) -> u64 {
        self.scalar_bytes(property.length.unwrap_or(property.scalar))
    }

    /// The next number as the length of a list.
    fn count(&mut self, scalar: Scalar) -> Result<u64, Fault> {
        let place = self.location();
        let value = self.number(scalar)?;
        if value >= 0.0 && value.fract() == 0.0 && value <= self.bytes_left() as f64 {
            return Ok(value as u64);
        }
        Err(place.fault(MeshProblem::Expected { expected: "the length of a list", found: value.to_string() }))
    }

    /// Reads past a property.
    fn skip(&mut self, property: &Property) -> Result<(), Fault> {
        let count = match property.length {
            Some(length) => self.count(length)?,
            None => 1,
        };
        for _ in 0..count {
            self.number(property.scalar)?;
        }
        Ok(())
    }
}

/// Numbers between white space.
pub(super) struct Text<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Text<'a> {
    /// The numbers of `rest`, which follows `lines` lines of the file.
    pub fn new(rest: &'a [u8], lines: usize) -> Text<'a> {
        let mut text = Text { rest, line: lines + 1 };
        text.skip_space();
        text
    }

    fn skip_space(&mut self) {
        let end = self.rest.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(self.rest.len());
        let (space, rest) = self.rest.split_at(end);
        self.line += space.iter().filter(|&&byte| byte == b'\n').count();
        self.rest = rest;
    }
}

impl Table for Text<'_> {
    fn number(&mut self, _: Scalar) -> Result<f64, Fault> {
        if self.rest.is_empty() {
            return Err(self.location().fault(MeshProblem::Ends("a number")));
        }
        let end = self.rest.iter().position(u8::is_ascii_whitespace).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        let value = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        let found = || MeshProblem::Expected { expected: "a number", found: shortened(&String::from_utf8_lossy(word)) };
        let value = value.ok_or_else(|| self.location().fault(found()))?;
        self.rest = rest;
        self.skip_space();
        Ok(value)
    }

    fn location(&self) -> FaultLocation {
        FaultLocation::Line(self.line)
    }

    fn bytes_left(&self) -> u64 {
        // The last number needs no space behind it.
        self.rest.len() as u64 + 1
    }

    fn scalar_bytes(&self, _: Scalar) -> u64 {
        2
    }
}

/// Numbers of fixed size.
pub(super) struct Binary<'a> {
    rest: &'a [u8],
    end: usize,
    is_big_endian: bool,
}

impl<'a> Binary<'a> {
    /// The numbers of `rest`, which begins at byte `begin` of the file.
    pub fn new(rest: &'a [u8], begin: usize, is_big_endian: bool) -> Binary<'a> {
        Binary { rest, end: begin + rest.len(), is_big_endian }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let ends = self.location().fault(MeshProblem::Ends("a number"));
        let (field, rest) = self.rest.split_first_chunk::<N>().ok_or(ends)?;
        self.rest = rest;
        let mut field = *field;
        if self.is_big_endian {
            field.reverse();
        }
        Ok(field)
    }
}

impl Table for Binary<'_> {
    fn number(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(self.take()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.take()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.take()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.take()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.take()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.take()?).into(),
            Scalar::F32 => f32::from_le_bytes(self.take()?).into(),
            Scalar::F64 => f64::from_le_bytes(self.take()?),
        })
    }

    fn location(&self) -> FaultLocation {
        FaultLocation::Byte(self.end - self.rest.len())
    }

    fn bytes_left(&self) -> u64 {
        self.rest.len() as u64
    }

    fn scalar_bytes(&self, scalar: Scalar) -> u64 {
        match scalar {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }
}
