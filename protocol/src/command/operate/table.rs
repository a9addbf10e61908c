//! The operate commands: one row each, from which their type, parser, printer, records, names and random ones are made.
//!
//! A row stands in the file of its family and reads:
//!
//! ```text
//! Variant(what: type = notation) "NAME" as "PRINTED WORDS" [Words] record 0x20 help { entry };
//! Variant { field: type = notation, ... } ...
//! ```
//!
//! - `what` names the only field of a variant in records; notations stand in `notation`, `number` and `setting`.
//! - `as` is left out if the first words are printed as the name of the entry in the command table.
//! - `[Words]`, words of the keyword table, begin the command; `, Form [Words] { field = notation, ... }` after them
//!   is another form that is read.
//! - `record` is the opcode, for a command that has a record of its own; others travel as text.
//! - `help` is left out if a row before it has the entry of that name.

use super::{
    attribute::{ON_OFF, SWITCH_INPUT, attribute_rows},
    condition::condition_rows,
    keyword_tree::KeywordTree,
    notation::{FieldLabel, Fields, Notation, OptionalAfter, OptionalNumber, after, equal, optional, unprinted},
    number::{
        BIT, COUNT, CharacterFactors, Factors, Interval, LEVEL, Matrix2, Matrix3, Matrix4, Matrix4x3, NextReal, Place,
        Real, SIGNED, Vector2, Vector3,
    },
    rendering::{RENDERING_INPUTS, rendering_rows},
    setting::{
        AxisLetter, ComparisonSign, DepthBoundaries, Flag, ObjectName, Orientation, PICKING, PhaseRate, SWITCH,
        ScreenWidth, Screens, SideOffset,
    },
    text::{MATRIX_2, text_rows},
    transformation::{MATRIX_3, transformation_rows},
    viewing::{DEPTH, LIMITS, MATRIX_4, viewing_rows},
};
use crate::{
    Name,
    command::{
        error::Fault,
        parse::cursor::Parser,
        print::printer::Printer,
        reference::row::{CommandRow, Confidence::*, PLAIN, input, option},
        syntax::{Axis, Boundaries, CharacterOrientation, Comparison, Rate, Scopes},
        words::Word,
    },
    record::{BinaryError, BinaryProblem, Reader, Witness, Writer},
};
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3};
#[cfg(any(test, feature = "proptest"))]
use proptest::{prelude::*, strategy::Union};

/// The default of something that a row may leave out.
macro_rules! or {
    ($default:expr,) => {
        $default
    };
    ($default:expr, $given:expr) => {
        $given
    };
}

/// The fields of a row in its record, if it has one.
macro_rules! record {
    (write [] $writer:ident $(($label:ident $field:tt $notation:expr))*) => {{
        $(let _ = $label;)*
    }};
    (write [$code:literal] $writer:ident $(($label:ident $field:tt $notation:expr))*) => {{
        $($notation.write($label, $writer);)*
    }};
    (read [] $reader:ident $variant:ident $($field:tt)*) => {
        Err($reader.error(1, "opcode", BinaryProblem::Unknown(0)))
    };
    (read [$code:literal] $reader:ident $variant:ident $(($label:ident $field:tt $notation:expr))*) => {
        Ok(Operate::$variant {
            $($field: $notation.read(
                FieldLabel { name: stringify!($label), given: concat!(stringify!($label), " given") },
                $reader,
            )?,)*
        })
    };
}

macro_rules! operates {
    ({} $($family:ident { $(
        $(#[$doc:meta])*
        $variant:ident
            $(($one:ident: $one_type:ty = $one_notation:expr))?
            $({ $($(#[$field_doc:meta])* $field:ident: $type:ty = $notation:expr,)* })?
            $name:literal $(as $printed:literal)? [$($word:ident)*]
            $(, $other:ident [$($other_word:ident)*] { $($other_field:tt = $other_notation:expr,)* })?
            $(record $code:literal)?
            $(help { $($entry:tt)* })?;
    )* })*) => {
        /// What an operate node does to the state of its descendant.
        ///
        /// Matrices follow [`Value`](crate::Value): row `i` of the machine is column `i` of the glam matrix.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Operate {
            $($($(#[$doc])* $variant $(($one_type))? $({ $($(#[$field_doc])* $field: $type,)* })?,)*)*
        }

        /// The kind of an operate command, without its values.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum OperateKind {
            $($($(#[$doc])* $variant,)*)*
        }

        /// A form that is read: a command, or another way to begin it.
        #[derive(Clone, Copy)]
        enum Form {
            $($($variant, $($other,)?)*)*
        }

        const FORMS: &[Form] = &[$($(Form::$variant, $(Form::$other,)?)*)*];

        /// The words that each form begins with.
        pub(super) const BEGINNINGS: &[&[Word]] =
            &[$($(&[$(Word::$word),*], $(&[$(Word::$other_word),*],)?)*)*];

        $(
            #[doc = concat!("The rows of the command table, ", stringify!($family), ".")]
            pub(in crate::command) const $family: &[CommandRow] =
                &[$($(CommandRow { name: $name, $($entry)* },)?)*];
        )*

        impl OperateKind {
            /// Every operate command, in the order of the command table.
            pub const ALL: &[OperateKind] = &[$($(OperateKind::$variant,)*)*];

            /// The name of its row in the command table.
            pub const fn name(self) -> &'static str {
                match self {
                    $($(OperateKind::$variant => $name,)*)*
                }
            }

            /// The opcode of its record; none for a command that travels as text.
            pub const fn code(self) -> Option<u8> {
                match self {
                    $($(OperateKind::$variant => or!(None, $(Some($code))?),)*)*
                }
            }

            /// The command whose record has an opcode.
            pub const fn from_code(code: u8) -> Option<OperateKind> {
                match code {
                    $($($($code => Some(OperateKind::$variant),)?)*)*
                    _ => None,
                }
            }

            /// Reads the fields of a record.
            ///
            /// # Errors
            /// Truncated, or a field that means nothing.
            pub(in crate::command) fn decode<W: Witness>(
                self,
                reader: &mut Reader<'_, '_, W>,
            ) -> Result<Operate, BinaryError> {
                match self {
                    $($(OperateKind::$variant => record!(
                        read [$($code)?] reader $variant
                        $(($one 0 $one_notation))? $($(($field $field $notation))*)?
                    ),)*)*
                }
            }

            /// Random commands of this kind.
            #[cfg(any(test, feature = "proptest"))]
            pub fn any(self) -> BoxedStrategy<Operate> {
                match self {
                    $($(OperateKind::$variant => {
                        (Just(()), $($one_notation.any(),)? $($($notation.any(),)*)?)
                            .prop_map(|((), $($one,)? $($($field,)*)?)| Operate::$variant {
                                $(0: $one,)? $($($field,)*)?
                            })
                            .boxed()
                    })*)*
                }
            }
        }

        impl Operate {
            /// The kind of the command.
            pub const fn kind(&self) -> OperateKind {
                match self {
                    $($(Operate::$variant { .. } => OperateKind::$variant,)*)*
                }
            }

            /// Reads the command whose first word was just taken.
            ///
            /// # Errors
            /// [`Fault`] says what was expected.
            pub(in crate::command) fn parse(first: Word, parser: &mut Parser<'_>) -> Result<Operate, Fault> {
                Ok(match FORMS[KEYWORD_TREE.follow(first, parser)?] {
                    $($(
                        Form::$variant => Operate::$variant {
                            $(0: $one_notation.parse(parser)?,)? $($($field: $notation.parse(parser)?,)*)?
                        },
                        $(Form::$other => Operate::$variant {
                            $($other_field: $other_notation.parse(parser)?,)*
                        },)?
                    )*)*
                })
            }

            /// Prints the command, without what it is applied to.
            pub(in crate::command) fn print(&self, printer: &mut Printer<'_>) {
                match self {
                    $($(Operate::$variant { $(0: $one,)? $($($field,)*)? } => {
                        printer.text(or!($name, $($printed)?));
                        $($one_notation.print($one, printer);)?
                        $($($notation.print($field, printer);)*)?
                    })*)*
                }
            }

            /// Writes the fields of its record; nothing for a command that travels as text.
            pub(in crate::command) fn encode(&self, writer: &mut Writer<'_>) {
                match self {
                    $($(Operate::$variant { $(0: $one,)? $($($field,)*)? } => record!(
                        write [$($code)?] writer
                        $(($one 0 $one_notation))? $($(($field $field $notation))*)?
                    ),)*)*
                }
            }
        }
    };
}

text_rows! { { transformation_rows viewing_rows attribute_rows condition_rows rendering_rows operates } }

static KEYWORD_TREE: KeywordTree = KeywordTree::new(BEGINNINGS);

/// The words that operate commands have after a first word.
pub(in crate::command) fn words_after(first: Word) -> &'static [Word] {
    KEYWORD_TREE.after(first)
}

/// Random operate nodes of every kind.
#[cfg(any(test, feature = "proptest"))]
pub fn operates() -> impl Strategy<Value = Operate> {
    Union::new(OperateKind::ALL.iter().map(|kind| kind.any()))
}
