//! Strings: joined, measured, cut, searched, compared, translated, and read as numbers. Positions count from 1.

use super::{Family, FunctionExample, FunctionRow, Source};
use crate::port::{
    Firing, KindSet,
    Literal::{B, I, R, S},
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
            FunctionExample::of(&[(1, S("1")), (2, S("V 0.25,-0.125"))], &[(1, S("1V 0.25,-0.125"))]),
            FunctionExample::of(&[(2, S("")), (2, S("B")), (1, S("")), (1, S("A"))], &[(1, S("")), (1, S("AB"))]),
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
        examples: &[
            FunctionExample::of(&[(2, S(" mm")), (1, S("3")), (1, S("4"))], &[(1, S("3 mm")), (1, S("4 mm"))]),
            FunctionExample::of(&[(2, S("X")), (2, S("")), (1, S("A")), (1, I(1))], &[(1, S("A"))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CCONCATENATE",
        summary: "a constant string and another joined",
        source: Source::manual(""),
        inputs: &[PortSpec::constant(KindSet::STRING, FIRST), PortSpec::active(KindSet::STRING, SECOND)],
        outputs: &["<1> then <2>"],
        behaviour: |f| join(f, 2),
        examples: &[
            FunctionExample::of(&[(1, S("X=")), (2, S("3")), (2, S("4"))], &[(1, S("X=3")), (1, S("X=4"))]),
            FunctionExample::of(&[(1, S("")), (2, S("")), (1, S("X")), (2, S("Y"))], &[(1, S("")), (1, S("XY"))]),
        ],
        ..FunctionRow::PLAIN
    },
    MCAT_STRING,
    FunctionRow {
        name: "MCONCATENATE",
        summary: "n strings joined; another name of F:MCAT_STRING",
        source: Source::uncertain("whether both names existed"),
        ..MCAT_STRING
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
        examples: &[
            FunctionExample::of(&[(1, S("PERIS")), (1, S(""))], &[(1, I(5)), (1, I(0))]),
            FunctionExample::of(&[(1, I(5)), (1, S("\r"))], &[(1, I(1))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TAKE_STRING",
        summary: "a part of a string",
        source: Source::manual("what lies beyond the end is left out: ours"),
        inputs: &[
            PortSpec::active(KindSet::STRING, "string"),
            PortSpec::active(KindSet::INTEGER, "position of the first character"),
            PortSpec::active(KindSet::INTEGER, "how many"),
        ],
        outputs: &["part"],
        behaviour: take,
        examples: &[
            FunctionExample::of(&[(1, S("I00F")), (2, I(2)), (3, I(3))], &[(1, S("00F"))]),
            FunctionExample::of(
                &[(1, S("ABC")), (2, I(3)), (3, I(i32::MAX)), (1, S("ABC")), (2, I(9)), (3, I(1))],
                &[(1, S("C")), (1, S(""))],
            ),
            FunctionExample::of(&[(1, S("A")), (2, I(0)), (3, I(1)), (1, S("A")), (2, I(1)), (3, I(-1))], &[])
                .faults(&[6, 6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "PUT_STRING",
        summary: "a string with another written over it",
        source: Source::manual("the string grows at its end if need be, but gets no gaps: ours"),
        inputs: &[
            PortSpec::active(KindSet::STRING, "string"),
            PortSpec::active(KindSet::INTEGER, "position of the first character that is replaced"),
            PortSpec::active(KindSet::STRING, "replacement"),
        ],
        outputs: &["string"],
        behaviour: put,
        examples: &[
            FunctionExample::of(&[(1, S("X=?.")), (2, I(3)), (3, S("5"))], &[(1, S("X=5."))]),
            FunctionExample::of(
                &[(1, S("AB")), (2, I(2)), (3, S("XYZ")), (1, S("")), (2, I(1)), (3, S("A"))],
                &[(1, S("AXYZ")), (1, S("A"))],
            ),
            FunctionExample::of(&[(1, S("AB")), (2, I(4)), (3, S("X")), (1, S("AB")), (2, I(0)), (3, S("X"))], &[])
                .faults(&[6, 6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "FIND_STRING",
        summary: "where a string first contains another; 0 if it does not",
        source: Source::manual("an empty string is found at 1: ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "string"), PortSpec::active(KindSet::STRING, "what is looked for")],
        outputs: &["position"],
        behaviour: |f| {
            let at = find(f.string(1)?, f.string(2)?).map_or(0, |at| at + 1);
            f.emit(1, Value::Integer(i32::try_from(at).map_err(|_| Problem::TooLong)?))
        },
        examples: &[
            FunctionExample::of(
                &[(1, S("ABABAC")), (2, S("ABAC")), (1, S("ABC")), (2, S("D"))],
                &[(1, I(3)), (1, I(0))],
            ),
            FunctionExample::of(
                &[(1, S("A")), (2, S("")), (1, S("")), (2, S("A")), (1, S("abc")), (2, S("C"))],
                &[(1, I(1)), (1, I(0)), (1, I(0))],
            ),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SPLIT",
        summary: "a string cut in two where it first contains a separator",
        source: Source::manual("the separator goes; a string without it leaves whole from output 1: ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "string"), PortSpec::constant(KindSet::STRING, "separator")],
        outputs: &["before the separator", "after it"],
        behaviour: split,
        examples: &[
            FunctionExample::of(&[(2, S(",")), (1, S("A,B,C"))], &[(1, S("A")), (2, S("B,C"))]),
            FunctionExample::of(
                &[(2, S(", ")), (1, S("A,B")), (1, S(", "))],
                &[(1, S("A,B")), (2, S("")), (1, S("")), (2, S(""))],
            ),
            FunctionExample::of(&[(2, S("")), (1, S("A"))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TRANS_STRING",
        summary: "each character replaced by another, by a table",
        source: Source::manual("character c becomes number c of the table, from 0, or stays if there is none: ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "string"), PortSpec::constant(KindSet::STRING, "table")],
        outputs: &["string"],
        behaviour: |f| {
            let table = f.string(2)?;
            let new = |byte: &u8| table.get(usize::from(*byte)).copied().unwrap_or(*byte);
            let translated: Vec<u8> = f.string(1)?.iter().map(new).collect();
            f.emit(1, Value::String(translated.into()))
        },
        examples: &[
            FunctionExample::of(&[(2, S("0123456789")), (1, S("\u{1}\u{9}A"))], &[(1, S("19A"))]),
            FunctionExample::of(&[(2, S("")), (1, S("AB")), (1, S(""))], &[(1, S("AB")), (1, S(""))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "STRING_TO_NUM",
        summary: "the number that a string says: an integer, or a real if there is a point or an exponent",
        source: Source::manual("blanks around it do not matter, and what is no number is a fault: ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "string")],
        outputs: &["integer or real"],
        behaviour: |f| {
            let number = number(f.string(1)?).ok_or(Problem::Range(1))?;
            f.emit(1, number)
        },
        examples: &[
            FunctionExample::of(
                &[(1, S(" -17 ")), (1, S("2.50")), (1, S("1E3")), (1, S("+.5D-1"))],
                &[(1, I(-17)), (1, R(2.5)), (1, R(1000.0)), (1, R(0.05))],
            ),
            FunctionExample::of(
                &[(1, S("2147483647")), (1, S("2147483648"))],
                &[(1, I(i32::MAX)), (1, R(2147483648.0))],
            ),
            FunctionExample::of(
                &[(1, S("")), (1, S("1 2")), (1, S("INF")), (1, S("1E")), (1, S(".")), (1, S("1E999"))],
                &[],
            )
            .faults(&[6, 6, 6, 6, 6, 6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "COMP_STRING",
        summary: "how a string compares with a constant one, by the codes of the characters",
        source: Source::manual("the outputs are uncertain; all three speak each time: ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "string"), PortSpec::constant(KindSet::STRING, "constant")],
        outputs: &["whether they are equal", "whether <1> comes before <2>", "whether <1> comes after <2>"],
        behaviour: |f| {
            let order = f.string(1)?.cmp(f.string(2)?);
            let answers = [order.is_eq(), order.is_lt(), order.is_gt()];
            (1..).zip(answers).try_for_each(|(output, answer)| f.emit(output, Value::Boolean(answer)))
        },
        examples: &[
            FunctionExample::of(
                &[(2, S("B")), (1, S("B")), (1, S("AZ"))],
                &[(1, B(true)), (2, B(false)), (3, B(false)), (1, B(false)), (2, B(true)), (3, B(false))],
            ),
            FunctionExample::of(
                &[(2, S("B")), (1, S("b")), (1, S(""))],
                &[(1, B(false)), (2, B(false)), (3, B(true)), (1, B(false)), (2, B(true)), (3, B(false))],
            ),
        ],
        ..FunctionRow::PLAIN
    },
];

const MCAT_STRING: FunctionRow = FunctionRow {
    name: "MCAT_STRING",
    summary: "n strings joined",
    source: Source::manual(""),
    inputs: &[PortSpec::active(KindSet::STRING, "part")],
    outputs: &["the parts in order"],
    family: Family::Inputs,
    behaviour: |f| join(f, f.size()),
    examples: &[
        FunctionExample::of(&[(3, S("C")), (1, S("A")), (2, S("B"))], &[(1, S("ABC"))]).sized(3),
        FunctionExample::of(&[(1, S("A")), (1, I(1)), (1, S("B"))], &[(1, S("A")), (1, S("B"))]).sized(1).faults(&[5]),
    ],
    ..FunctionRow::PLAIN
};

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

fn take(f: &mut Firing) -> Result<(), Problem> {
    let text = f.string(1)?;
    let from = usize::try_from(f.integer(2)?).ok().and_then(|at| at.checked_sub(1)).ok_or(Problem::Range(2))?;
    let count = usize::try_from(f.integer(3)?).map_err(|_| Problem::Range(3))?;
    let rest = text.get(from..).unwrap_or(&[]);
    let part = Value::string(&rest[..count.min(rest.len())]);
    f.emit(1, part)
}

fn put(f: &mut Firing) -> Result<(), Problem> {
    let mut text = f.string(1)?.to_vec();
    let from = usize::try_from(f.integer(2)?).ok().and_then(|at| at.checked_sub(1)).ok_or(Problem::Range(2))?;
    let new = f.string(3)?;
    if from > text.len() {
        return Err(Problem::Range(2));
    }
    if from + new.len() > MAX_STRING {
        return Err(Problem::TooLong);
    }
    let end = (from + new.len()).min(text.len());
    text.splice(from..end, new.iter().copied());
    f.emit(1, Value::String(text.into()))
}

fn split(f: &mut Firing) -> Result<(), Problem> {
    let (text, separator) = (f.string(1)?, f.string(2)?);
    if separator.is_empty() {
        return Err(Problem::Range(2));
    }
    let (before, after) = match find(text, separator) {
        Some(at) => (&text[..at], &text[at + separator.len()..]),
        None => (text, &[][..]),
    };
    let (before, after) = (Value::string(before), Value::string(after));
    f.emit(1, before)?;
    f.emit(2, after)
}

/// Where a text first contains another, from 0. Takes time in proportion to both lengths.
///
/// # Source
/// Knuth, Morris, Pratt 1977.
pub(super) fn find(text: &[u8], wanted: &[u8]) -> Option<usize> {
    // How long an end of what matched so far is a beginning of `wanted`.
    let mut borders = vec![0; wanted.len()];
    let advance = |borders: &[usize], mut matched: usize, byte: u8| {
        while matched > 0 && wanted.get(matched) != Some(&byte) {
            matched = borders[matched - 1];
        }
        matched + usize::from(wanted.get(matched) == Some(&byte))
    };
    for i in 1..wanted.len() {
        borders[i] = advance(&borders, borders[i - 1], wanted[i]);
    }
    let mut matched = 0;
    if wanted.is_empty() {
        return Some(0);
    }
    text.iter()
        .position(|&byte| {
            matched = advance(&borders, matched, byte);
            matched == wanted.len()
        })
        .map(|last| last + 1 - wanted.len())
}

/// The number that a text says; the exponent may begin with `D`, as FORTRAN writes it.
fn number(text: &[u8]) -> Option<Value> {
    let text = std::str::from_utf8(text.trim_ascii()).ok()?;
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    if !digits.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return None;
    }
    if digits.bytes().all(|byte| byte.is_ascii_digit())
        && let Ok(integer) = text.parse()
    {
        return Some(Value::Integer(integer));
    }
    let real: f64 = text.replace(['D', 'd'], "E").parse().ok()?;
    real.is_finite().then_some(Value::Real(real))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_text_is_found_where_the_first_window_equals_it(text in "[AB]{0,40}", wanted in "[AB]{1,6}") {
            let slow = text.as_bytes().windows(wanted.len()).position(|window| window == wanted.as_bytes());
            prop_assert_eq!(find(text.as_bytes(), wanted.as_bytes()), slow);
        }
    }
}
