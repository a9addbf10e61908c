//! The printer: the end of a text, and how numbers and words are put there.

use crate::command::words::Word;
use std::{fmt, io::Write};

/// A number that is written so that it reads back equal.
pub(in crate::command) struct Number<T>(pub(in crate::command) T);

impl<T: fmt::Display + fmt::UpperExp + Copy + Into<f64>> fmt::Display for Number<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size: f64 = self.0.into();
        if size == 0.0 || (1e-5..1e16).contains(&size.abs()) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:E}", self.0)
        }
    }
}

/// Numbers with commas between them.
pub(in crate::command) struct List<'n>(pub(in crate::command) &'n [f64]);

impl fmt::Display for List<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, number) in self.0.iter().enumerate() {
            if index > 0 {
                f.write_str(",")?;
            }
            Number(*number).fmt(f)?;
        }
        Ok(())
    }
}

/// Commands as text at the end of a buffer.
pub(in crate::command) struct Printer<'o> {
    out: &'o mut Vec<u8>,
}

impl<'o> Printer<'o> {
    /// A printer at the end of `out`.
    pub(in crate::command) fn new(out: &'o mut Vec<u8>) -> Self {
        Printer { out }
    }

    /// Puts a formatted text.
    pub(in crate::command) fn put(&mut self, text: fmt::Arguments<'_>) {
        self.out.write_fmt(text).expect("a vector takes all bytes");
    }

    /// Puts a text.
    pub(in crate::command) fn text(&mut self, text: &str) {
        self.out.extend_from_slice(text.as_bytes());
    }

    /// Puts a byte.
    pub(in crate::command) fn byte(&mut self, byte: u8) {
        self.out.push(byte);
    }

    /// Puts a word, whole and in capitals.
    pub(in crate::command) fn word(&mut self, word: Word) {
        self.text(word.capitals());
    }
}
