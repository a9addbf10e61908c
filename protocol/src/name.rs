//! Names of objects: upper case, with dots for the parts of a structure.

use std::{borrow::Borrow, fmt, sync::Arc};

/// Longest name that is kept, in characters. \[S\]: the library and the driver of the time check 256;
/// 240 characters were significant in commands.
pub const MAX_NAME: usize = 256;

/// The name of an object: a letter, then letters, digits, `_`, `$` and `.`; always upper case.
///
/// `A.B` is the node `B` named inside the structure `A`. Cheap to clone.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Name(Arc<str>);

/// The reason why a text is not a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NameError {
    /// No characters at all.
    #[error("the name is empty")]
    Empty,
    /// More than [`MAX_NAME`] characters.
    #[error("the name is longer than {MAX_NAME} characters")]
    TooLong,
    /// The first character is not a letter.
    #[error("a name begins with a letter")]
    FirstCharacter,
    /// A character that is not a letter, a digit, `_`, `$` or `.`.
    #[error("{:?} cannot stand in a name, which has letters, digits, _, $ and .", char::from(*.0))]
    BadCharacter(u8),
}

impl Name {
    /// Reads a name; lower case becomes upper case.
    ///
    /// # Errors
    /// [`NameError`] says what is wrong with the text.
    pub fn new(text: impl AsRef<[u8]>) -> Result<Name, NameError> {
        let bytes = text.as_ref();
        if bytes.is_empty() {
            return Err(NameError::Empty);
        }
        if bytes.len() > MAX_NAME {
            return Err(NameError::TooLong);
        }
        if !bytes[0].is_ascii_alphabetic() {
            return Err(NameError::FirstCharacter);
        }
        if let Some(&bad) = bytes.iter().find(|&&b| !is_name_character(b)) {
            return Err(NameError::BadCharacter(bad));
        }
        let mut upper = [0; MAX_NAME];
        let upper = &mut upper[..bytes.len()];
        upper.copy_from_slice(bytes);
        upper.make_ascii_uppercase();
        match std::str::from_utf8(upper) {
            Ok(upper) => Ok(Name(upper.into())),
            Err(_) => Err(NameError::BadCharacter(bytes[0])), // not reached: all bytes are ASCII
        }
    }

    /// The characters, in upper case.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The node `inner` inside the structure `self`: `SELF.INNER`.
    ///
    /// # Errors
    /// [`NameError::TooLong`] when the whole is longer than [`MAX_NAME`].
    pub fn join(&self, inner: &Name) -> Result<Name, NameError> {
        if self.0.len() + 1 + inner.0.len() > MAX_NAME {
            return Err(NameError::TooLong);
        }
        Ok(Name(format!("{}.{}", self.0, inner.0).into()))
    }
}

/// Whether a byte may stand in a name after its first character.
pub const fn is_name_character(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'$' | b'.')
}

impl Borrow<str> for Name {
    fn borrow(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl fmt::Debug for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_upper_case_and_may_hold_dots_and_dollars() {
        assert_eq!(Name::new("r001.irx").unwrap().as_str(), "R001.IRX");
        assert_eq!(Name::new("K0$1_").unwrap().as_str(), "K0$1_");
    }

    #[test]
    fn bad_names_say_why() {
        assert_eq!(Name::new(""), Err(NameError::Empty));
        assert_eq!(Name::new("1A"), Err(NameError::FirstCharacter));
        assert_eq!(Name::new("A-B"), Err(NameError::BadCharacter(b'-')));
        assert_eq!(Name::new("A".repeat(257)), Err(NameError::TooLong));
        let long = Name::new("A".repeat(200)).unwrap();
        assert_eq!(long.join(&long), Err(NameError::TooLong));
    }
}
