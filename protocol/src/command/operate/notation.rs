//! How a field of a command is written: read, printed, carried in a record, made at random; and what stands around it.

use crate::{
    command::{error::Fault, parse::cursor::Parser, print::printer::Printer, token::TokenKind, words::Word},
    record::{BinaryError, Reader, Witness, Writer},
};
#[cfg(any(test, feature = "proptest"))]
use proptest::prelude::*;
use std::fmt::Debug;

/// A way to write values of one kind in a command.
pub(super) trait Notation {
    /// What is written.
    type Value: Clone + Debug + 'static;

    /// Reads a value.
    ///
    /// # Errors
    /// [`Fault`] says what was expected.
    fn parse(&self, parser: &mut Parser<'_>) -> Result<Self::Value, Fault>;

    /// Prints a value with what separates it from the words before; nothing if the value is the one that is left out.
    fn print(&self, value: &Self::Value, printer: &mut Printer<'_>);

    /// Random values.
    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<Self::Value>;
}

/// A notation whose values also travel in records.
pub(super) trait Fields: Notation {
    /// Writes the fields of a value.
    fn write(&self, value: &Self::Value, writer: &mut Writer<'_>);

    /// Reads the fields of a value.
    ///
    /// # Errors
    /// [`BinaryError`] names the field.
    fn read<W: Witness>(&self, label: FieldLabel, reader: &mut Reader<'_, '_, W>) -> Result<Self::Value, BinaryError>;
}

/// What a field is called in the listing of records and in errors.
#[derive(Clone, Copy)]
pub(super) struct FieldLabel {
    /// The field.
    pub name: &'static str,
    /// Whether the field is given.
    pub given: &'static str,
}

/// What stands before a value.
enum Prefix {
    /// A keyword that must be there.
    Word(Word),
    /// An optional keyword, which is printed.
    Optional(Word),
    /// An optional keyword, which is not printed.
    Unprinted(Word),
    /// An optional `=`, which is printed.
    Equal,
}

/// A value after a keyword or a sign.
pub(super) struct Prefixed<N>(Prefix, N);

/// A value after a keyword that must be there.
pub(super) const fn after<N>(word: Word, notation: N) -> Prefixed<N> {
    Prefixed(Prefix::Word(word), notation)
}

/// A value after an optional keyword, which is printed.
pub(super) const fn optional<N>(word: Word, notation: N) -> Prefixed<N> {
    Prefixed(Prefix::Optional(word), notation)
}

/// A value after an optional keyword, which is not printed.
pub(super) const fn unprinted<N>(word: Word, notation: N) -> Prefixed<N> {
    Prefixed(Prefix::Unprinted(word), notation)
}

/// A value after an optional `=`, which is printed.
pub(super) const fn equal<N>(notation: N) -> Prefixed<N> {
    Prefixed(Prefix::Equal, notation)
}

impl<N: Notation> Notation for Prefixed<N> {
    type Value = N::Value;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<N::Value, Fault> {
        match self.0 {
            Prefix::Word(word) => parser.expect_word(word, word.expected())?,
            Prefix::Optional(word) | Prefix::Unprinted(word) => {
                parser.accept_word(word);
            }
            Prefix::Equal => {
                parser.accept(TokenKind::Equal);
            }
        }
        self.1.parse(parser)
    }

    fn print(&self, value: &N::Value, printer: &mut Printer<'_>) {
        match self.0 {
            Prefix::Word(word) | Prefix::Optional(word) => {
                printer.text(" ");
                printer.word(word);
            }
            Prefix::Unprinted(_) => {}
            Prefix::Equal => printer.text(" ="),
        }
        self.1.print(value, printer);
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<N::Value> {
        self.1.any()
    }
}

impl<N: Fields> Fields for Prefixed<N> {
    fn write(&self, value: &N::Value, writer: &mut Writer<'_>) {
        self.1.write(value, writer);
    }

    fn read<W: Witness>(&self, label: FieldLabel, reader: &mut Reader<'_, '_, W>) -> Result<N::Value, BinaryError> {
        self.1.read(label, reader)
    }
}

/// An optional value after a keyword: it is given if the keyword is there.
pub(super) struct OptionalAfter<N>(pub Word, pub N);

impl<N: Notation> Notation for OptionalAfter<N> {
    type Value = Option<N::Value>;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<Option<N::Value>, Fault> {
        if parser.accept_word(self.0) { self.1.parse(parser).map(Some) } else { Ok(None) }
    }

    fn print(&self, value: &Option<N::Value>, printer: &mut Printer<'_>) {
        if let Some(value) = value {
            printer.text(" ");
            printer.word(self.0);
            self.1.print(value, printer);
        }
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<Option<N::Value>> {
        prop::option::of(self.1.any()).boxed()
    }
}

impl<N: Fields> Fields for OptionalAfter<N> {
    fn write(&self, value: &Option<N::Value>, writer: &mut Writer<'_>) {
        writer.u8(value.is_some().into());
        if let Some(value) = value {
            self.1.write(value, writer);
        }
    }

    fn read<W: Witness>(
        &self,
        label: FieldLabel,
        reader: &mut Reader<'_, '_, W>,
    ) -> Result<Option<N::Value>, BinaryError> {
        if reader.boolean(label.given)? { self.1.read(label, reader).map(Some) } else { Ok(None) }
    }
}

/// An optional number; a comma before it may be missing and is not printed.
pub(super) struct OptionalNumber<N>(pub N);

impl<N: Notation> Notation for OptionalNumber<N> {
    type Value = Option<N::Value>;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<Option<N::Value>, Fault> {
        parser.accept(TokenKind::Comma);
        if parser.is_number() { self.0.parse(parser).map(Some) } else { Ok(None) }
    }

    fn print(&self, value: &Option<N::Value>, printer: &mut Printer<'_>) {
        if let Some(value) = value {
            self.0.print(value, printer);
        }
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<Option<N::Value>> {
        prop::option::of(self.0.any()).boxed()
    }
}
