//! Strings: joined and measured.

use super::{Example, Family, FunctionRow, Source};
use crate::port::{
    Firing, KindSet,
    Literal::{I, S},
    PortSpec, Problem,
};
use protocol::{Value, value::MAX_STRING};

const FIRST: &str = "first part";
const SECOND: &str = "second part";

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "CONCATENATE",
        summary: "two strings joined",
        source: Source::confirmed("clients pair the two messages of a press of the puck with it"),
        inputs: &[PortSpec::active(KindSet::STRING, FIRST), PortSpec::active(KindSet::STRING, SECOND)],
        outputs: &["<1> then <2>"],
        behaviour: |f| join(f, 2),
        examples: &[
            Example::of(&[(1, S("1")), (2, S("V 0.25,-0.125"))], &[(1, S("1V 0.25,-0.125"))]),
            Example::of(&[(2, S("")), (2, S("B")), (1, S("")), (1, S("A"))], &[(1, S("")), (1, S("AB"))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CONCATENATEC",
        summary: "a string and a constant one joined",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::STRING, FIRST), PortSpec::constant(KindSet::STRING, SECOND)],
        outputs: &["<1> then <2>"],
        behaviour: |f| join(f, 2),
        examples: &[Example::of(&[(2, S(" mm")), (1, S("3")), (1, S("4"))], &[(1, S("3 mm")), (1, S("4 mm"))])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CCONCATENATE",
        summary: "a constant string and another joined",
        source: Source::manual(""),
        inputs: &[PortSpec::constant(KindSet::STRING, FIRST), PortSpec::active(KindSet::STRING, SECOND)],
        outputs: &["<1> then <2>"],
        behaviour: |f| join(f, 2),
        examples: &[Example::of(&[(1, S("X=")), (2, S("3")), (2, S("4"))], &[(1, S("X=3")), (1, S("X=4"))])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "MCAT_STRING",
        summary: "n strings joined",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::STRING, "part")],
        outputs: &["the parts in order"],
        family: Family::Inputs,
        behaviour: |f| join(f, f.size()),
        examples: &[Example::of(&[(3, S("C")), (1, S("A")), (2, S("B"))], &[(1, S("ABC"))]).sized(3)],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "MCONCATENATE",
        summary: "n strings joined, as F:MCAT_STRING",
        source: Source::manual("another name of the same function"),
        inputs: &[PortSpec::active(KindSet::STRING, "part")],
        outputs: &["the parts in order"],
        family: Family::Inputs,
        behaviour: |f| join(f, f.size()),
        examples: &[Example::of(&[(2, S("B")), (1, S("A"))], &[(1, S("AB"))]).sized(2)],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "LENGTH_STRING",
        summary: "number of bytes of a string",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::STRING, "string")],
        outputs: &["integer"],
        behaviour: |f| {
            let length = i32::try_from(f.string(1)?.len()).map_err(|_| Problem::TooLong)?;
            f.emit(1, Value::Integer(length))
        },
        examples: &[Example::of(&[(1, S("PERIS")), (1, S(""))], &[(1, I(5)), (1, I(0))])],
        ..FunctionRow::PLAIN
    },
];

/// Joins the strings at inputs 1 to `count`.
fn join(f: &mut Firing, count: u16) -> Result<(), Problem> {
    let mut whole = Vec::new();
    for input in 1..=count {
        whole.extend_from_slice(f.string(input)?);
        if whole.len() > MAX_STRING {
            return Err(Problem::TooLong);
        }
    }
    f.emit(1, Value::String(whole.into()))
}
