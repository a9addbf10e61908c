//! Little-endian fields of binary records: their reader, their writer and their errors.
//!
//! One reader serves the decoders and the listing: every field that was read is reported to a [`Witness`].

use crate::{
    Name,
    name::{MAX_NAME, NameError},
    value::MAX_STRING,
};
use std::{fmt, ops::Range};

/// Largest binary record in bytes; what fits into one packet. Ours.
pub const MAX_RECORD: usize = 1 << 20;

/// The reason why a binary record could not be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("byte {offset}, {field}: {problem}")]
pub struct BinaryError {
    /// Where the field begins, in bytes from the start of the packet body.
    pub offset: usize,
    /// The field.
    pub field: &'static str,
    /// What is wrong with it.
    pub problem: BinaryProblem,
}

/// What can be wrong with a field.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BinaryProblem {
    /// The packet ends inside the field.
    #[error("the packet ends {missing} bytes too early")]
    Truncated {
        /// How many bytes are not there.
        missing: usize,
    },
    /// A code that means nothing.
    #[error("{0} has no meaning here")]
    Unknown(i64),
    /// A real that is infinite or not a number.
    #[error("the number is not finite")]
    NotFinite,
    /// A name that is none.
    #[error(transparent)]
    Name(#[from] NameError),
    /// More than a limit allows.
    #[error("{found} is more than the limit {limit}")]
    TooMany {
        /// The amount that was requested.
        found: usize,
        /// What is allowed.
        limit: usize,
    },
    /// A command as text that cannot be read; its message with the position in the text.
    #[error("{0}")]
    Text(String),
    /// A part or an end of a vector list that was never begun (or was given up).
    #[error("no vector list is open")]
    NotOpen,
    /// Another record while a vector list or a text is open; what was open is given up.
    #[error("a vector list or a text is open, and only its parts and its end may follow")]
    StillOpen,
    /// The end of a vector list that is not as long as it announced; the list is given up.
    #[error("{announced} vectors were announced and {received} received")]
    Count {
        /// The length that the first record of the list announced.
        announced: usize,
        /// What came.
        received: usize,
    },
}

/// The reason why a command has no binary form.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}: {found} is more than the limit {limit}")]
pub struct EncodeError {
    /// The part of the command.
    pub what: &'static str,
    /// Its size.
    pub found: usize,
    /// The largest size.
    pub limit: usize,
}

/// Fails when `found` exceeds `limit`.
///
/// # Errors
/// [`EncodeError`] naming `what`.
pub fn within(what: &'static str, found: usize, limit: usize) -> Result<(), EncodeError> {
    if found > limit { Err(EncodeError { what, found, limit }) } else { Ok(()) }
}

/// A receiver of every field that a [`Reader`] reads.
pub trait Witness {
    /// The bytes `place` are the field `label` and mean `meaning`.
    fn field(&mut self, place: Range<usize>, label: &'static str, meaning: fmt::Arguments<'_>);
}

/// A witness that ignores what is reported.
impl Witness for () {
    #[inline(always)]
    fn field(&mut self, _: Range<usize>, _: &'static str, _: fmt::Arguments<'_>) {}
}

/// Reads fields from the body of a packet.
pub struct Reader<'b, 'w, W: Witness> {
    bytes: &'b [u8],
    at: usize,
    witness: &'w mut W,
}

impl<'b, 'w, W: Witness> Reader<'b, 'w, W> {
    /// A reader of `bytes` from `at` on.
    pub fn new(bytes: &'b [u8], at: usize, witness: &'w mut W) -> Self {
        Reader { bytes, at: at.min(bytes.len()), witness }
    }

    /// The offset of the next field.
    pub fn at(&self) -> usize {
        self.at
    }

    /// How many bytes are left.
    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// The error that `problem` is in a field of `length` bytes that was just read.
    pub fn error(&self, length: usize, field: &'static str, problem: BinaryProblem) -> BinaryError {
        BinaryError { offset: self.at.saturating_sub(length), field, problem }
    }

    /// The next `length` bytes, without reporting them to the witness.
    ///
    /// # Errors
    /// [`BinaryProblem::Truncated`].
    pub fn take(&mut self, length: usize, field: &'static str) -> Result<&'b [u8], BinaryError> {
        let left = &self.bytes[self.at..];
        if left.len() < length {
            let problem = BinaryProblem::Truncated { missing: length - left.len() };
            return Err(BinaryError { offset: self.at, field, problem });
        }
        self.at += length;
        Ok(&left[..length])
    }

    /// Reports to the witness what the last `length` bytes mean.
    #[inline(always)]
    pub fn report(&mut self, length: usize, field: &'static str, meaning: fmt::Arguments<'_>) {
        self.witness.field(self.at - length..self.at, field, meaning);
    }

    /// Reports to the witness what `length` bytes from offset `at` on mean.
    #[inline(always)]
    pub fn report_at(&mut self, at: usize, length: usize, field: &'static str, meaning: fmt::Arguments<'_>) {
        self.witness.field(at..at + length, field, meaning);
    }

    fn array<const N: usize>(&mut self, field: &'static str) -> Result<[u8; N], BinaryError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N, field)?);
        Ok(array)
    }

    /// One byte.
    ///
    /// # Errors
    /// [`BinaryProblem::Truncated`].
    pub fn u8(&mut self, field: &'static str) -> Result<u8, BinaryError> {
        let value = self.array::<1>(field)?[0];
        self.report(1, field, format_args!("{value}"));
        Ok(value)
    }

    /// Two bytes, unsigned.
    ///
    /// # Errors
    /// [`BinaryProblem::Truncated`].
    pub fn u16(&mut self, field: &'static str) -> Result<u16, BinaryError> {
        let value = u16::from_le_bytes(self.array(field)?);
        self.report(2, field, format_args!("{value}"));
        Ok(value)
    }

    /// Four bytes, unsigned.
    ///
    /// # Errors
    /// [`BinaryProblem::Truncated`].
    pub fn u32(&mut self, field: &'static str) -> Result<u32, BinaryError> {
        let value = u32::from_le_bytes(self.array(field)?);
        self.report(4, field, format_args!("{value}"));
        Ok(value)
    }

    /// Four bytes, signed.
    ///
    /// # Errors
    /// [`BinaryProblem::Truncated`].
    pub fn i32(&mut self, field: &'static str) -> Result<i32, BinaryError> {
        let value = i32::from_le_bytes(self.array(field)?);
        self.report(4, field, format_args!("{value}"));
        Ok(value)
    }

    /// Eight bytes, signed.
    ///
    /// # Errors
    /// [`BinaryProblem::Truncated`].
    pub fn i64(&mut self, field: &'static str) -> Result<i64, BinaryError> {
        let value = i64::from_le_bytes(self.array(field)?);
        self.report(8, field, format_args!("{value}"));
        Ok(value)
    }

    /// A double-precision real, eight bytes.
    ///
    /// # Errors
    /// Truncated, or not finite.
    pub fn f64(&mut self, field: &'static str) -> Result<f64, BinaryError> {
        let value = f64::from_le_bytes(self.array(field)?);
        if !value.is_finite() {
            return Err(self.error(8, field, BinaryProblem::NotFinite));
        }
        self.report(8, field, format_args!("{value}"));
        Ok(value)
    }

    /// `N` reals.
    ///
    /// # Errors
    /// Truncated, or not finite.
    pub fn reals<const N: usize>(&mut self, field: &'static str) -> Result<[f64; N], BinaryError> {
        let mut reals = [0.0; N];
        for real in &mut reals {
            *real = self.f64(field)?;
        }
        Ok(reals)
    }

    /// A Boolean: one byte, 0 or 1.
    ///
    /// # Errors
    /// Truncated, or another value.
    pub fn boolean(&mut self, field: &'static str) -> Result<bool, BinaryError> {
        match self.u8(field)? {
            0 => Ok(false),
            1 => Ok(true),
            other => Err(self.error(1, field, BinaryProblem::Unknown(other.into()))),
        }
    }

    /// Red, green and blue, a byte each.
    ///
    /// # Errors
    /// [`BinaryProblem::Truncated`].
    pub fn color(&mut self, field: &'static str) -> Result<[u8; 3], BinaryError> {
        let color: [u8; 3] = self.array(field)?;
        self.report(3, field, format_args!("red {}, green {}, blue {}", color[0], color[1], color[2]));
        Ok(color)
    }

    /// A string: its length in two bytes, then its bytes.
    ///
    /// # Errors
    /// [`BinaryProblem::Truncated`].
    pub fn string(&mut self, field: &'static str) -> Result<&'b [u8], BinaryError> {
        let length = u16::from_le_bytes(self.array(field)?).into();
        let bytes = self.take(length, field)?;
        self.report(length + 2, field, format_args!("{length} bytes, \"{}\"", bytes.escape_ascii()));
        Ok(bytes)
    }

    /// A name as a string; none if the length is 0.
    ///
    /// # Errors
    /// Truncated, or not a name.
    pub fn optional_name(&mut self, field: &'static str) -> Result<Option<Name>, BinaryError> {
        let bytes = self.string(field)?;
        if bytes.is_empty() {
            return Ok(None);
        }
        match Name::new(bytes) {
            Ok(name) => Ok(Some(name)),
            Err(why) => Err(self.error(bytes.len() + 2, field, why.into())),
        }
    }

    /// A name as a string.
    ///
    /// # Errors
    /// Truncated, or not a name.
    pub fn name(&mut self, field: &'static str) -> Result<Name, BinaryError> {
        let name = self.optional_name(field)?;
        name.ok_or_else(|| self.error(2, field, NameError::Empty.into()))
    }
}

/// Writes fields at the end of a buffer.
pub struct Writer<'o> {
    out: &'o mut Vec<u8>,
}

impl<'o> Writer<'o> {
    /// A writer at the end of `out`.
    pub fn new(out: &'o mut Vec<u8>) -> Self {
        Writer { out }
    }

    /// Raw bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.out.extend_from_slice(bytes);
    }

    /// One byte.
    pub fn u8(&mut self, value: u8) {
        self.out.push(value);
    }

    /// Two bytes.
    pub fn u16(&mut self, value: u16) {
        self.bytes(&value.to_le_bytes());
    }

    /// Four bytes.
    pub fn u32(&mut self, value: u32) {
        self.bytes(&value.to_le_bytes());
    }

    /// Reals, eight bytes each.
    pub fn reals(&mut self, values: &[f64]) {
        for value in values {
            self.bytes(&value.to_le_bytes());
        }
    }

    /// A string with its length.
    ///
    /// # Errors
    /// Longer than [`MAX_STRING`].
    pub fn string(&mut self, what: &'static str, bytes: &[u8]) -> Result<(), EncodeError> {
        within(what, bytes.len(), MAX_STRING)?;
        self.u16(bytes.len() as u16);
        self.bytes(bytes);
        Ok(())
    }

    /// A name as a string.
    pub fn name(&mut self, name: &Name) {
        const { assert!(MAX_NAME <= u16::MAX as usize) };
        self.u16(name.as_str().len() as u16);
        self.bytes(name.as_str().as_bytes());
    }

    /// A name, or the empty string for none.
    pub fn optional_name(&mut self, name: Option<&Name>) {
        match name {
            Some(name) => self.name(name),
            None => self.u16(0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_truncated_field_says_where_and_how_much_is_missing() {
        let mut nobody = ();
        let mut reader = Reader::new(&[1, 2, 3], 0, &mut nobody);
        assert_eq!(reader.u16("a"), Ok(0x0201));
        let error = reader.u32("b").unwrap_err();
        assert_eq!(error, BinaryError { offset: 2, field: "b", problem: BinaryProblem::Truncated { missing: 3 } });
        assert_eq!(error.to_string(), "byte 2, b: the packet ends 3 bytes too early");
    }

    #[test]
    fn reals_must_be_finite() {
        let bytes = f64::NAN.to_le_bytes();
        let mut nobody = ();
        let error = Reader::new(&bytes, 0, &mut nobody).f64("angle").unwrap_err();
        assert_eq!(error.problem, BinaryProblem::NotFinite);
        assert_eq!(error.offset, 0);
    }

    #[test]
    fn a_witness_hears_of_every_byte_once() {
        struct RecordedFields(Vec<(Range<usize>, String)>);
        impl Witness for RecordedFields {
            fn field(&mut self, place: Range<usize>, label: &'static str, meaning: fmt::Arguments<'_>) {
                self.0.push((place, format!("{label}: {meaning}")));
            }
        }
        let mut out = Vec::new();
        let mut writer = Writer::new(&mut out);
        writer.name(&Name::new("cube").unwrap());
        writer.u8(7);
        let mut places = RecordedFields(Vec::new());
        let mut reader = Reader::new(&out, 0, &mut places);
        assert_eq!(reader.name("name").unwrap().as_str(), "CUBE");
        assert_eq!(reader.u8("class"), Ok(7));
        assert_eq!(places.0, [(0..6, "name: 4 bytes, \"CUBE\"".into()), (6..7, "class: 7".into())]);
    }
}
