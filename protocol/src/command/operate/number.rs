//! Notations of numbers: reals, integers, vectors, factors, matrices, ranges.

use super::notation::{FieldLabel, Fields, Notation};
use crate::{
    command::{
        error::Fault,
        matrix::{four_by_three, from_four_by_three},
        parse::{cursor::Parser, field::NUMBERS},
        print::printer::{List, Number, Printer},
        token::TokenKind,
    },
    record::{BinaryError, Reader, Witness, Writer},
};
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3};
use std::{marker::PhantomData, ops::Range};
#[cfg(any(test, feature = "proptest"))]
use {
    crate::command::strategy::basic::{
        limits, matrices2, matrices3, matrices4, matrices4x3, reals, vectors2, vectors3,
    },
    proptest::prelude::*,
};

/// A real.
pub(super) struct Real;

impl Notation for Real {
    type Value = f64;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<f64, Fault> {
        parser.real()
    }

    fn print(&self, value: &f64, printer: &mut Printer<'_>) {
        printer.put(format_args!(" {}", Number(*value)));
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<f64> {
        reals().boxed()
    }
}

impl Fields for Real {
    fn write(&self, value: &f64, writer: &mut Writer<'_>) {
        writer.reals(&[*value]);
    }

    fn read<W: Witness>(&self, label: FieldLabel, reader: &mut Reader<'_, '_, W>) -> Result<f64, BinaryError> {
        reader.f64(label.name)
    }
}

/// A real that goes on a list: the comma before it may be missing.
pub(super) struct NextReal;

impl Notation for NextReal {
    type Value = f64;

    fn parse(&self, parser: &mut Parser<'_>) -> Result<f64, Fault> {
        parser.accept(TokenKind::Comma);
        parser.real()
    }

    fn print(&self, value: &f64, printer: &mut Printer<'_>) {
        printer.put(format_args!(",{}", Number(*value)));
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<f64> {
        reals().boxed()
    }
}

impl Fields for NextReal {
    fn write(&self, value: &f64, writer: &mut Writer<'_>) {
        Real.write(value, writer);
    }

    fn read<W: Witness>(&self, label: FieldLabel, reader: &mut Reader<'_, '_, W>) -> Result<f64, BinaryError> {
        Real.read(label, reader)
    }
}

/// An integer in a range.
pub(super) struct IntegerIn<T> {
    range: Range<i64>,
    of: PhantomData<T>,
}

impl<T> IntegerIn<T> {
    const fn of(range: Range<i64>) -> Self {
        IntegerIn { range, of: PhantomData }
    }
}

/// A level of detail.
pub(super) const LEVEL: IntegerIn<u16> = IntegerIn::of(0..32_768);
/// The number of a conditional bit.
pub(super) const BIT: IntegerIn<u8> = IntegerIn::of(0..15);
/// A count of 32 bits.
pub(super) const COUNT: IntegerIn<u32> = IntegerIn::of(0..NUMBERS);
/// An integer of 32 bits with sign.
pub(super) const SIGNED: IntegerIn<i32> = IntegerIn::of(i32::MIN as i64..i32::MAX as i64 + 1);

/// Integers of a type that holds every number of its range.
macro_rules! whole {
    ($($type:ident)*) => {
        $(impl Notation for IntegerIn<$type> {
            type Value = $type;

            fn parse(&self, parser: &mut Parser<'_>) -> Result<$type, Fault> {
                Ok(parser.integer(self.range.clone())? as $type)
            }

            fn print(&self, value: &$type, printer: &mut Printer<'_>) {
                printer.put(format_args!(" {value}"));
            }

            #[cfg(any(test, feature = "proptest"))]
            fn any(&self) -> BoxedStrategy<$type> {
                (self.range.start as $type..=(self.range.end - 1) as $type).boxed()
            }
        })*
    };
}

whole! { u8 u16 u32 i32 }

/// Vectors and matrices: the count of their numbers, how these are read, how they make the value and come from it, and
/// random values.
macro_rules! lists {
    ($($(#[$doc:meta])* $name:ident($type:ident, $count:literal $(, $label:literal)?): $parse:expr, $from:expr, $numbers:expr, $any:expr;)*) => {
        $(
            $(#[$doc])*
            pub(super) struct $name;

            impl $name {
                const PARSE: fn(&mut Parser<'_>) -> Result<[f64; $count], Fault> = $parse;
                const FROM: fn([f64; $count]) -> $type = $from;
                const NUMBERS: fn(&$type) -> [f64; $count] = $numbers;
                /// What the numbers are called in records, if not as the field.
                const LABEL: &[&str] = &[$($label)?];
            }

            impl Notation for $name {
                type Value = $type;

                fn parse(&self, parser: &mut Parser<'_>) -> Result<$type, Fault> {
                    Self::PARSE(parser).map(Self::FROM)
                }

                fn print(&self, value: &$type, printer: &mut Printer<'_>) {
                    printer.put(format_args!(" {}", List(&Self::NUMBERS(value))));
                }

                #[cfg(any(test, feature = "proptest"))]
                fn any(&self) -> BoxedStrategy<$type> {
                    $any().boxed()
                }
            }

            impl Fields for $name {
                fn write(&self, value: &$type, writer: &mut Writer<'_>) {
                    writer.reals(&Self::NUMBERS(value));
                }

                fn read<W: Witness>(
                    &self,
                    label: FieldLabel,
                    reader: &mut Reader<'_, '_, W>,
                ) -> Result<$type, BinaryError> {
                    reader.reals(Self::LABEL.first().unwrap_or(&label.name)).map(Self::FROM)
                }
            }
        )*
    };
}

lists! {
    /// Two reals.
    Vector2(DVec2, 2): |parser| parser.reals(), DVec2::from_array, DVec2::to_array, vectors2;
    /// Three reals.
    Vector3(DVec3, 3): |parser| parser.reals(), DVec3::from_array, DVec3::to_array, vectors3;
    /// Two or three reals; z is 0 if it is not given.
    Place(DVec3, 3): |parser| parser.point(), DVec3::from_array, DVec3::to_array, vectors3;
    /// One factor for all axes, two for x and y, or three.
    Factors(DVec3, 3): factors, DVec3::from_array, DVec3::to_array, vectors3;
    /// One factor for both axes, or two.
    CharacterFactors(DVec2, 2): character_factors, DVec2::from_array, DVec2::to_array, vectors2;
    /// A 2x2 matrix, row by row of the machine.
    Matrix2(DMat2, 4, "row by row"): |parser| parser.reals(), |m| DMat2::from_cols_array(&m), DMat2::to_cols_array, matrices2;
    /// A 3x3 matrix, row by row of the machine.
    Matrix3(DMat3, 9, "row by row"): |parser| parser.reals(), |m| DMat3::from_cols_array(&m), DMat3::to_cols_array, matrices3;
    /// A 4x3 matrix, row by row of the machine, the last row the translation.
    Matrix4x3(DMat4, 12, "row by row"): |parser| parser.reals(), |m| from_four_by_three(&m), four_by_three, matrices4x3;
    /// A 4x4 matrix, row by row of the machine.
    Matrix4(DMat4, 16, "row by row"): |parser| parser.reals(), |m| DMat4::from_cols_array(&m), DMat4::to_cols_array, matrices4;
}

fn factors(parser: &mut Parser<'_>) -> Result<[f64; 3], Fault> {
    Ok(match parser.up_to_three()? {
        ([s, ..], 1) => [s; 3],
        ([x, y, _], 2) => [x, y, 1.0],
        (factors, _) => factors,
    })
}

fn character_factors(parser: &mut Parser<'_>) -> Result<[f64; 2], Fault> {
    match parser.up_to_three()? {
        ([s, ..], 1) => Ok([s; 2]),
        ([x, y, _], 2) => Ok([x, y]),
        _ => Err(parser.fail(&["one or two factors"])),
    }
}

/// An interval: two ends with a colon between them.
pub(super) struct Interval;

impl Notation for Interval {
    type Value = [f64; 2];

    fn parse(&self, parser: &mut Parser<'_>) -> Result<[f64; 2], Fault> {
        parser.range()
    }

    fn print(&self, [low, high]: &[f64; 2], printer: &mut Printer<'_>) {
        printer.put(format_args!(" {}:{}", Number(*low), Number(*high)));
    }

    #[cfg(any(test, feature = "proptest"))]
    fn any(&self) -> BoxedStrategy<[f64; 2]> {
        limits().boxed()
    }
}

impl Fields for Interval {
    fn write(&self, value: &[f64; 2], writer: &mut Writer<'_>) {
        writer.reals(value);
    }

    fn read<W: Witness>(&self, label: FieldLabel, reader: &mut Reader<'_, '_, W>) -> Result<[f64; 2], BinaryError> {
        reader.reals(label.name)
    }
}
