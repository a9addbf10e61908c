//! Values as bytes that are kept in files: the only place that names the crate which makes them.
//!
//! The crate, bincode, is no longer maintained: another one, with a version of its own in what it writes, would change
//! this file alone. Every file begins with a name or a version of its format, in plain bytes before those of this
//! module, and is refused where that is another.

use bincode::config::standard;
use bincode::error::{DecodeError, EncodeError};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io::{self, Read, Write};

/// How integers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integers {
    /// Small ones in fewer bytes.
    Compact,
    /// All in the bytes of their type, lowest first.
    Fixed,
}

/// A fault that keeps a value from being written or read.
#[derive(Debug, thiserror::Error)]
pub enum EncodingError {
    /// The file cannot be written or read.
    #[error(transparent)]
    File(io::Error),
    /// The file ends within the value.
    #[error("it is cut off")]
    CutOff,
    /// The bytes are no such value, or are more than may be read.
    #[error("{0}")]
    Malformed(String),
}

impl From<EncodeError> for EncodingError {
    fn from(error: EncodeError) -> EncodingError {
        match error {
            EncodeError::Io { inner, .. } => EncodingError::File(inner),
            other => EncodingError::Malformed(other.to_string()),
        }
    }
}

impl From<DecodeError> for EncodingError {
    fn from(error: DecodeError) -> EncodingError {
        match error {
            DecodeError::Io { inner, .. } if inner.kind() == io::ErrorKind::UnexpectedEof => EncodingError::CutOff,
            DecodeError::Io { inner, .. } => EncodingError::File(inner),
            other => EncodingError::Malformed(other.to_string()),
        }
    }
}

/// The bytes of a value.
///
/// # Errors
/// [`EncodingError::Malformed`], for a value that has no such form.
pub fn encode(value: &impl Serialize, integers: Integers) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    encode_into(value, integers, &mut bytes)?;
    Ok(bytes)
}

/// Writes the bytes of a value.
///
/// # Errors
/// [`EncodingError`].
pub fn encode_into(value: &impl Serialize, integers: Integers, file: &mut impl Write) -> Result<(), EncodingError> {
    match integers {
        Integers::Compact => bincode::serde::encode_into_std_write(value, file, standard())?,
        Integers::Fixed => bincode::serde::encode_into_std_write(value, file, standard().with_fixed_int_encoding())?,
    };
    Ok(())
}

/// The value that bytes begin with, and how many bytes it has.
///
/// - `MOST`: bytes that are read at the most: what claims to be longer takes no memory.
///
/// # Errors
/// [`EncodingError::Malformed`].
pub fn decode<T: DeserializeOwned, const MOST: usize>(
    bytes: &[u8],
    integers: Integers,
) -> Result<(T, usize), EncodingError> {
    let limited = standard().with_limit::<MOST>();
    Ok(match integers {
        Integers::Compact => bincode::serde::decode_from_slice(bytes, limited)?,
        Integers::Fixed => bincode::serde::decode_from_slice(bytes, limited.with_fixed_int_encoding())?,
    })
}

/// Reads a value.
///
/// # Errors
/// [`EncodingError`].
pub fn decode_from<T: DeserializeOwned>(file: &mut impl Read, integers: Integers) -> Result<T, EncodingError> {
    Ok(match integers {
        Integers::Compact => bincode::serde::decode_from_std_read(file, standard())?,
        Integers::Fixed => bincode::serde::decode_from_std_read(file, standard().with_fixed_int_encoding())?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_back_and_what_is_cut_off_or_too_long_is_an_error() {
        let value = (7_u64, String::from("cup"), vec![0.5, 2.0]);
        for integers in [Integers::Compact, Integers::Fixed] {
            let bytes = encode(&value, integers).expect("plain data");
            let (found, used) = decode::<(u64, String, Vec<f64>), 1000>(&bytes, integers).expect("whole");
            assert!(found == value && used == bytes.len());
            let mut cut = &bytes[..bytes.len() - 1];
            let error = decode_from::<(u64, String, Vec<f64>)>(&mut cut, integers).expect_err("cut");
            assert!(matches!(error, EncodingError::CutOff), "{error}");
            assert!(decode::<(u64, String, Vec<f64>), 10>(&bytes, integers).is_err());
        }
        assert_eq!(encode(&1_u32, Integers::Fixed).expect("a number"), [1, 0, 0, 0]);
        assert_eq!(encode(&1_u32, Integers::Compact).expect("a number"), [1]);
    }
}
