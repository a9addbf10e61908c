//! Logic: and, or, exclusive or and not of Booleans.

use super::{FunctionExample, FunctionRow, Source};
use crate::port::{
    Firing, KindSet,
    Literal::{B, I},
    PortSpec, Problem,
};
use protocol::Value;

const BOTH: &[PortSpec] = &[PortSpec::active(KindSet::BOOLEAN, "first"), PortSpec::active(KindSet::BOOLEAN, "second")];
const FIRST: &[PortSpec] =
    &[PortSpec::active(KindSet::BOOLEAN, "first"), PortSpec::constant(KindSet::BOOLEAN, "second")];
const LOGICAL: FunctionRow = FunctionRow { outputs: &["Boolean"], source: Source::manual(""), ..FunctionRow::PLAIN };

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "AND",
        summary: "TRUE if both are TRUE",
        inputs: BOTH,
        behaviour: |f| combine(f, |a, b| a && b),
        examples: &[
            FunctionExample::of(
                &[(1, B(true)), (2, B(true)), (1, B(true)), (2, B(false))],
                &[(1, B(true)), (1, B(false))],
            ),
            FunctionExample::of(
                &[(1, B(true)), (1, B(false)), (2, I(1)), (2, B(true)), (2, B(true))],
                &[(1, B(true)), (1, B(false))],
            )
            .faults(&[5]),
        ],
        ..LOGICAL
    },
    FunctionRow {
        name: "ANDC",
        summary: "TRUE if both are TRUE, the second a constant",
        inputs: FIRST,
        behaviour: |f| combine(f, |a, b| a && b),
        examples: &[
            FunctionExample::of(&[(2, B(true)), (1, B(true)), (1, B(false))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(
                &[(2, B(false)), (1, B(true)), (2, B(true)), (1, B(true))],
                &[(1, B(false)), (1, B(true))],
            ),
        ],
        ..LOGICAL
    },
    FunctionRow {
        name: "OR",
        summary: "TRUE if one is TRUE",
        inputs: BOTH,
        behaviour: |f| combine(f, |a, b| a || b),
        examples: &[
            FunctionExample::of(
                &[(1, B(false)), (2, B(true)), (2, B(false)), (1, B(false))],
                &[(1, B(true)), (1, B(false))],
            ),
            FunctionExample::of(
                &[(1, B(true)), (1, B(false)), (2, I(1)), (2, B(true)), (2, B(true))],
                &[(1, B(true)), (1, B(true))],
            )
            .faults(&[5]),
        ],
        ..LOGICAL
    },
    FunctionRow {
        name: "ORC",
        summary: "TRUE if one is TRUE, the second a constant",
        inputs: FIRST,
        behaviour: |f| combine(f, |a, b| a || b),
        examples: &[
            FunctionExample::of(&[(2, B(false)), (1, B(true)), (1, B(false))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(
                &[(2, B(true)), (1, B(false)), (2, B(false)), (1, B(false))],
                &[(1, B(true)), (1, B(false))],
            ),
        ],
        ..LOGICAL
    },
    FunctionRow {
        name: "XOR",
        summary: "TRUE if exactly one is TRUE",
        inputs: BOTH,
        behaviour: |f| combine(f, |a, b| a != b),
        examples: &[
            FunctionExample::of(
                &[(1, B(true)), (2, B(true)), (1, B(true)), (2, B(false))],
                &[(1, B(false)), (1, B(true))],
            ),
            FunctionExample::of(
                &[(1, B(true)), (1, B(false)), (2, I(1)), (2, B(true)), (2, B(true))],
                &[(1, B(false)), (1, B(true))],
            )
            .faults(&[5]),
        ],
        ..LOGICAL
    },
    FunctionRow {
        name: "XORC",
        summary: "TRUE if exactly one is TRUE, the second a constant",
        inputs: FIRST,
        behaviour: |f| combine(f, |a, b| a != b),
        examples: &[
            FunctionExample::of(&[(2, B(true)), (1, B(true)), (1, B(false))], &[(1, B(false)), (1, B(true))]),
            FunctionExample::of(
                &[(2, B(false)), (1, B(true)), (2, B(true)), (1, B(true))],
                &[(1, B(true)), (1, B(false))],
            ),
        ],
        ..LOGICAL
    },
    FunctionRow {
        name: "NOT",
        summary: "TRUE for FALSE, FALSE for TRUE",
        inputs: &[PortSpec::active(KindSet::BOOLEAN, "Boolean")],
        behaviour: |f| {
            let opposite = !f.boolean(1)?;
            f.emit(1, Value::Boolean(opposite))
        },
        examples: &[
            FunctionExample::of(&[(1, B(true)), (1, B(false))], &[(1, B(false)), (1, B(true))]),
            FunctionExample::of(&[(1, I(0)), (1, B(false))], &[(1, B(true))]).faults(&[5]),
        ],
        ..LOGICAL
    },
];

fn combine(f: &mut Firing, operation: fn(bool, bool) -> bool) -> Result<(), Problem> {
    let result = operation(f.boolean(1)?, f.boolean(2)?);
    f.emit(1, Value::Boolean(result))
}
