//! Comparison: two values in, a Boolean out.
//!
//! Integers and reals compare by value. EQ and NE also compare Booleans, strings, vectors and matrices of the same
//! kind; values of different kinds are a fault.

use super::{Behaviour, FunctionExample, FunctionRow, Source};
use crate::port::{
    Firing, KindSet,
    Literal::{B, I, R, S, V2, V3},
    PortSpec, Problem,
};
use protocol::Value;
use std::cmp::Ordering;

const EQUATABLE: KindSet = KindSet::ANY;
const ORDERED: KindSet = KindSet::NUMBER;

/// Two active inputs, or the first or second a constant.
const fn pair(kinds: KindSet, constant: u16) -> [PortSpec; 2] {
    [
        if constant == 1 { PortSpec::constant(kinds, "first") } else { PortSpec::active(kinds, "first") },
        if constant == 2 { PortSpec::constant(kinds, "second") } else { PortSpec::active(kinds, "second") },
    ]
}

/// The row of an ordering: its name, summary, which input is constant, its behaviour and examples.
const fn ordering(
    name: &'static str,
    summary: &'static str,
    constant: u16,
    behaviour: Behaviour,
    examples: &'static [FunctionExample],
) -> FunctionRow {
    const FORMS: [&[PortSpec]; 3] = [&pair(ORDERED, 0), &pair(ORDERED, 1), &pair(ORDERED, 2)];
    FunctionRow {
        name,
        summary,
        source: Source::manual(""),
        inputs: FORMS[constant as usize],
        outputs: &["Boolean"],
        behaviour,
        examples,
        ..FunctionRow::PLAIN
    }
}

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "EQ",
        summary: "whether two values are equal",
        source: Source::manual("values of different kinds are a fault: ours"),
        inputs: &pair(EQUATABLE, 0),
        outputs: &["Boolean"],
        behaviour: |f| equate(f, true),
        examples: &[
            FunctionExample::of(&[(1, I(2)), (2, R(2.0)), (1, S("A")), (2, S("a"))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(&[(1, V2([1.0, 2.0])), (2, V3([1.0, 2.0, 0.0])), (2, V2([1.0, 2.0]))], &[(1, B(true))])
                .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "EQC",
        summary: "whether a value equals a constant",
        source: Source::manual(""),
        inputs: &pair(EQUATABLE, 2),
        outputs: &["Boolean"],
        behaviour: |f| equate(f, true),
        examples: &[
            FunctionExample::of(&[(2, B(true)), (1, B(true)), (1, B(false))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(&[(2, S("A")), (1, S("A")), (1, I(1)), (1, S("B"))], &[(1, B(true)), (1, B(false))])
                .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "NE",
        summary: "whether two values differ",
        source: Source::manual(""),
        inputs: &pair(EQUATABLE, 0),
        outputs: &["Boolean"],
        behaviour: |f| equate(f, false),
        examples: &[
            FunctionExample::of(&[(1, V2([1.0, 2.0])), (2, V2([1.0, 2.5]))], &[(1, B(true))]),
            FunctionExample::of(&[(1, S("A")), (2, I(1)), (2, S("A"))], &[(1, B(false))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "NEC",
        summary: "whether a value differs from a constant",
        source: Source::manual(""),
        inputs: &pair(EQUATABLE, 2),
        outputs: &["Boolean"],
        behaviour: |f| equate(f, false),
        examples: &[
            FunctionExample::of(&[(2, S("X")), (1, S("X")), (1, S("Y"))], &[(1, B(false)), (1, B(true))]),
            FunctionExample::of(&[(2, I(2)), (1, R(2.0)), (1, B(true))], &[(1, B(false))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    ordering(
        "GT",
        "whether <1> is greater than <2>",
        0,
        |f| compare_ordered(f, Ordering::is_gt),
        &[
            FunctionExample::of(&[(1, I(3)), (2, R(2.5)), (1, I(2)), (2, I(2))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(&[(1, S("A")), (1, R(-0.0)), (2, I(0))], &[(1, B(false))]).faults(&[5]),
        ],
    ),
    ordering(
        "GTC",
        "whether <1> is greater than the constant <2>",
        2,
        |f| compare_ordered(f, Ordering::is_gt),
        &[
            FunctionExample::of(&[(2, R(0.0)), (1, R(0.5)), (1, R(-0.5))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(
                &[(2, I(0)), (1, R(-0.0)), (1, B(true)), (1, R(1e300))],
                &[(1, B(false)), (1, B(true))],
            )
            .faults(&[5]),
        ],
    ),
    ordering(
        "CGT",
        "whether the constant <1> is greater than <2>",
        1,
        |f| compare_ordered(f, Ordering::is_gt),
        &[
            FunctionExample::of(&[(1, R(0.0)), (2, R(0.5)), (2, R(-0.5))], &[(1, B(false)), (1, B(true))]),
            FunctionExample::of(
                &[(1, I(0)), (2, R(-0.0)), (2, B(true)), (2, R(1e300))],
                &[(1, B(false)), (1, B(false))],
            )
            .faults(&[5]),
        ],
    ),
    ordering(
        "GE",
        "whether <1> is not less than <2>",
        0,
        |f| compare_ordered(f, Ordering::is_ge),
        &[
            FunctionExample::of(&[(1, I(2)), (2, I(2)), (1, I(1)), (2, I(2))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(&[(1, S("A")), (1, R(-0.0)), (2, I(0))], &[(1, B(true))]).faults(&[5]),
        ],
    ),
    ordering(
        "GEC",
        "whether <1> is not less than the constant <2>",
        2,
        |f| compare_ordered(f, Ordering::is_ge),
        &[
            FunctionExample::of(&[(2, I(1)), (1, I(1)), (1, I(0))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(&[(2, I(0)), (1, R(-0.0)), (1, B(true)), (1, R(1e300))], &[(1, B(true)), (1, B(true))])
                .faults(&[5]),
        ],
    ),
    ordering(
        "CGE",
        "whether the constant <1> is not less than <2>",
        1,
        |f| compare_ordered(f, Ordering::is_ge),
        &[
            FunctionExample::of(&[(1, I(1)), (2, I(1)), (2, I(2))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(
                &[(1, I(0)), (2, R(-0.0)), (2, B(true)), (2, R(1e300))],
                &[(1, B(true)), (1, B(false))],
            )
            .faults(&[5]),
        ],
    ),
    ordering(
        "LT",
        "whether <1> is less than <2>",
        0,
        |f| compare_ordered(f, Ordering::is_lt),
        &[
            FunctionExample::of(&[(1, I(2)), (2, I(2)), (1, I(1)), (2, I(2))], &[(1, B(false)), (1, B(true))]),
            FunctionExample::of(&[(1, S("A")), (1, R(-0.0)), (2, I(0))], &[(1, B(false))]).faults(&[5]),
        ],
    ),
    ordering(
        "LTC",
        "whether <1> is less than the constant <2>",
        2,
        |f| compare_ordered(f, Ordering::is_lt),
        &[
            FunctionExample::of(&[(2, I(1)), (1, I(1)), (1, I(0))], &[(1, B(false)), (1, B(true))]),
            FunctionExample::of(
                &[(2, I(0)), (1, R(-0.0)), (1, B(true)), (1, R(1e300))],
                &[(1, B(false)), (1, B(false))],
            )
            .faults(&[5]),
        ],
    ),
    ordering(
        "CLT",
        "whether the constant <1> is less than <2>",
        1,
        |f| compare_ordered(f, Ordering::is_lt),
        &[
            FunctionExample::of(&[(1, I(1)), (2, I(1)), (2, I(2))], &[(1, B(false)), (1, B(true))]),
            FunctionExample::of(
                &[(1, I(0)), (2, R(-0.0)), (2, B(true)), (2, R(1e300))],
                &[(1, B(false)), (1, B(true))],
            )
            .faults(&[5]),
        ],
    ),
    ordering(
        "LE",
        "whether <1> is not greater than <2>",
        0,
        |f| compare_ordered(f, Ordering::is_le),
        &[
            FunctionExample::of(&[(1, I(2)), (2, I(2)), (1, I(3)), (2, I(2))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(&[(1, S("A")), (1, R(-0.0)), (2, I(0))], &[(1, B(true))]).faults(&[5]),
        ],
    ),
    ordering(
        "LEC",
        "whether <1> is not greater than the constant <2>",
        2,
        |f| compare_ordered(f, Ordering::is_le),
        &[
            FunctionExample::of(&[(2, I(1)), (1, I(1)), (1, I(2))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(
                &[(2, I(0)), (1, R(-0.0)), (1, B(true)), (1, R(1e300))],
                &[(1, B(true)), (1, B(false))],
            )
            .faults(&[5]),
        ],
    ),
    ordering(
        "CLE",
        "whether the constant <1> is not greater than <2>",
        1,
        |f| compare_ordered(f, Ordering::is_le),
        &[
            FunctionExample::of(&[(1, I(1)), (2, I(1)), (2, I(0))], &[(1, B(true)), (1, B(false))]),
            FunctionExample::of(&[(1, I(0)), (2, R(-0.0)), (2, B(true)), (2, R(1e300))], &[(1, B(true)), (1, B(true))])
                .faults(&[5]),
        ],
    ),
];

fn equate(f: &mut Firing, wanted: bool) -> Result<(), Problem> {
    let (a, b) = (f.value(1), f.value(2));
    let equal = match (a.number(), b.number()) {
        (Some(a), Some(b)) => a == b,
        _ if a.kind() == b.kind() => a == b,
        _ => return Err(Problem::Mismatch),
    };
    f.emit(1, Value::Boolean(equal == wanted))
}

fn compare_ordered(f: &mut Firing, holds: fn(Ordering) -> bool) -> Result<(), Problem> {
    let ordering = f.number(1)?.partial_cmp(&f.number(2)?).ok_or(Problem::Overflow)?;
    f.emit(1, Value::Boolean(holds(ordering)))
}
