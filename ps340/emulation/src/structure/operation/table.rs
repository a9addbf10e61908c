//! The operations: one row each, from which their type, the way from a command, inputs, effect and text are made.
//!
//! A row stands in the file of its family and reads:
//!
//! ```text
//! Variant(what: type) = {
//!     named "WORDS";
//!     from Operate::Command(what), in context => Operation::Variant(what);
//!     odd Operate::Command(what) => text of a doubt, or none;
//!     at FIRST takes kinds, given => what a message does;
//!     admits state => whether the walk goes on below;
//!     below state => what becomes of the state;
//!     asks Asked::Something;
//!     shows text;
//! }
//! ```
//!
//! - `named` is the command that makes such a node; for a matrix, that of the matrix.
//! - `from` stands once for each command that makes the operation. [`Degenerate`] refuses it; `in context` is left out
//!   if the command says all.
//! - `odd` is for numbers that are taken and probably not meant, and says what becomes of them.
//! - `at` stands once for each input, with the kinds that it takes.
//! - `admits`, `below`, `asks` and `shows` are left out by an operation that always lets the walk through, leaves the
//!   state as it is, asks nothing of the walk, or has no values.

use super::{
    asked::Asked,
    attribute::{DEFAULT_PICK_SIZE, attribute_rows},
    condition::condition_rows,
    doubt::{both, clamped, doubtful_limits, endless, wrapped},
    given::Given,
    making::{Context, Degenerate, checked_bit, checked_level},
    printed::{limits, oriented, rows, screens, switch},
    rendering::rendering_rows,
    text::text_rows,
    transformation::transformation_rows,
    viewing::{depth, viewing_rows},
};
use crate::{
    hue::rgb,
    matrices,
    port::{KindSet, ObjectId},
    structure::{
        NodeFault,
        state::{ALL_SCOPES, MAX_LEVEL, State, inside},
        value::{FIRST, FOURTH, POSITION, SECOND, THIRD},
    },
};
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3};
use protocol::{
    Kind, Name, Value,
    command::{CharacterOrientation, Comparison, Input, Operate, Rate, Scopes},
};

const MATRIX_2: KindSet = KindSet::of(&[Kind::Matrix2]);
const MATRIX_3: KindSet = KindSet::of(&[Kind::Matrix3]);
const MATRIX_4: KindSet = KindSet::of(&[Kind::Matrix4]);
const MATRIX_4X3: KindSet = KindSet::of(&[Kind::Matrix4x3]);

/// What a row says in the place of something that it may leave out.
macro_rules! or {
    ($default:expr,) => {
        $default
    };
    ($default:expr, $given:expr) => {
        $given
    };
}

macro_rules! operations {
    ({} $(
        $(#[$doc:meta])*
        $variant:ident
            $(($one:ident: $one_type:ty))?
            $({ $($(#[$field_doc:meta])* $field:ident: $type:ty,)* })?
        = {
            named $word:expr;
            $(from $command:pat $(, in $context:ident)? => $made:expr;)*
            $(odd $odd:pat => $doubt:expr;)*
            $(at $input:ident takes $kinds:expr, $given:ident => $message:expr;)*
            $(admits $at:ident => $admits:expr;)?
            $(below $state:ident => $below:expr;)?
            $(asks $asked:expr;)?
            $(shows $shown:expr;)?
        }
    )*) => {
        /// What an operate node does to the state. Matrices are in the glam form of [`protocol::Value`].
        #[derive(Clone, Debug, PartialEq)]
        pub enum Operation {
            $($(#[$doc])* $variant $(($one_type))? $({ $($(#[$field_doc])* $field: $type,)* })?,)*
        }

        impl Operation {
            /// The operation of a command.
            ///
            /// - `font`: what the name in CHARACTER FONT means.
            /// - `since`: the frame from which SET RATE counts.
            ///
            /// # Errors
            /// [`Degenerate`] says what is wrong: an empty window, an angle outside 0..180, a LOOK whose eye and centre
            /// coincide, a bit or a level that does not exist.
            pub fn new(operate: &Operate, font: Option<ObjectId>, since: u64) -> Result<Operation, Degenerate> {
                let around = Context { font, since };
                Ok(match *operate {
                    $($($command => {
                        $(let $context = around;)?
                        $made
                    })*)*
                })
            }

            /// What to say about the numbers of a command; none if nothing is odd about them.
            pub fn doubt(operate: &Operate) -> Option<String> {
                match *operate {
                    $($($odd => $doubt,)*)*
                    _ => None,
                }
            }

            /// The command that makes such a node; for those that keep but a matrix, that of the matrix.
            pub fn word(&self) -> &'static str {
                match self {
                    $(Operation::$variant { $(0: $one,)? $($($field,)*)? } => {
                        $(let _ = $one;)?
                        $($(let _ = $field;)*)?
                        $word
                    })*
                }
            }

            /// The values, matrices row by row as the machine has them; empty for an operation without values.
            pub fn values(&self) -> String {
                match self {
                    $(Operation::$variant { $(0: $one,)? $($($field,)*)? } => {
                        $(let _ = $one;)?
                        $($(let _ = $field;)*)?
                        or!(String::new(), $($shown)?)
                    })*
                }
            }

            /// The kinds that an input takes; none if there is no such input.
            pub fn takes(&self, input: Input) -> KindSet {
                match self {
                    $(Operation::$variant { .. } => {
                        $(if input == $input {
                            return $kinds;
                        })*
                    })*
                }
                KindSet::NONE
            }

            /// Takes a message.
            ///
            /// # Errors
            /// A fault if there is no such input, or it does not take that value; nothing changes then.
            pub fn accept(&mut self, message: Given<'_>) -> Result<(), NodeFault> {
                match self {
                    $(Operation::$variant { $(0: $one,)? $($($field,)*)? } => {
                        $(let _ = &$one;)?
                        $($(let _ = &$field;)*)?
                        $(if message.input == $input {
                            let $given = message;
                            $message;
                            return Ok(());
                        })*
                    })*
                }
                Err(NodeFault::NoSuchInput { input: message.input })
            }

            /// Whether it lets a walk through; those without a condition always do.
            pub fn admits(&self, state: &State) -> bool {
                match self {
                    $(Operation::$variant { $(0: $one,)? $($($field,)*)? } => {
                        $(let _ = $one;)?
                        $($(let _ = $field;)*)?
                        $(let $at = state;)?
                        or!(true, $($admits)?)
                    })*
                }
            }

            /// Makes of the state above the node that below it. Returns what else a walk has to do.
            pub fn apply(&self, state: &mut State) -> Asked<'_> {
                match self {
                    $(Operation::$variant { $(0: $one,)? $($($field,)*)? } => {
                        $(let _ = $one;)?
                        $($(let _ = $field;)*)?
                        $(
                            let $state = state;
                            $below;
                        )?
                        or!(Asked::Nothing, $($asked)?)
                    })*
                }
            }
        }
    };
}

text_rows! { { transformation_rows viewing_rows attribute_rows condition_rows rendering_rows operations } }
