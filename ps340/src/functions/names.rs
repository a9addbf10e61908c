//! Functions that refer to objects by name.

use super::{Example, FunctionRow, Source};
use crate::port::{
    Effect, Firing, KindSet,
    Literal::{B, I, S},
    PortSpec, Problem,
};
use protocol::{Name, command::Input};

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "FETCH",
        summary: "the value of a VARIABLE, whenever a trigger arrives",
        source: Source::manual(""),
        inputs: &[
            PortSpec::active(KindSet::ANY, "trigger"),
            PortSpec::constant(KindSet::STRING, "name of the variable"),
        ],
        outputs: &["value"],
        behaviour: |f| {
            let name = name(f, 2)?;
            f.effect(Effect::Fetch { function: f.object(), name });
            Ok(())
        },
        examples: &[Example::of(&[(2, S("NO NAME")), (1, B(true))], &[]).faults(&[6])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SEND",
        summary: "a message to an input of an object that is named by a message",
        source: Source::manual(
            "0 to -6 at <3> are append, delete, clear, step, position, last, substitute, as in the library of the time",
        ),
        inputs: &[
            PortSpec::active(KindSet::ANY, "message"),
            PortSpec::active(KindSet::STRING, "name of the destination"),
            PortSpec::active(KindSet::INTEGER, "number of its input"),
        ],
        outputs: &[],
        behaviour: |f| {
            let name = name(f, 2)?;
            let input = Input::from_code(f.integer(3)?.into()).ok_or(Problem::Range(3))?;
            let value = f.take(1);
            f.effect(Effect::SendTo { name, input, value });
            Ok(())
        },
        examples: &[
            Example::of(&[(1, B(true)), (2, S("A")), (3, I(-7))], &[]).faults(&[6]),
            Example::of(&[(1, B(true)), (2, S("")), (3, I(1))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
];

/// The name at an input.
pub(super) fn name(f: &Firing, input: u16) -> Result<Name, Problem> {
    Name::new(f.string(input)?.trim_ascii()).map_err(|_| Problem::Range(input))
}
