//! Characters: strings taken apart, searched, mapped and edited byte by byte. Positions count from 1.

use super::{Example, FunctionRow, Source};
use crate::port::{
    Firing, KindSet,
    Literal::{B, I, R, S},
    PortSpec, Problem,
};
use protocol::{Value, value::MAX_STRING};

const TEXT: PortSpec = PortSpec::active(KindSet::STRING, "string");
/// The memory cell with what was gathered so far.
const GATHERED: u8 = 0;

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "TAKE_STRING",
        summary: "a part of a string",
        source: Source::manual("what lies behind the end is left out; a start outside the string is a fault: ours"),
        inputs: &[
            TEXT,
            PortSpec::active(KindSet::INTEGER, "first position, from 1"),
            PortSpec::active(KindSet::INTEGER, "number of characters"),
        ],
        outputs: &["string"],
        behaviour: |f| {
            let text = f.string(1)?;
            let start = position(f.integer(2)?, text.len() + 1).ok_or(Problem::Range(2))?;
            let count = usize::try_from(f.integer(3)?).map_err(|_| Problem::Range(3))?;
            let part = Value::string(&text[start..text.len().min(start.saturating_add(count))]);
            f.emit(1, part)
        },
        examples: &[
            Example::of(&[(1, S("WORLD.RX")), (2, I(7)), (3, I(2))], &[(1, S("RX"))]),
            Example::of(
                &[(1, S("AB")), (2, I(2)), (3, I(9)), (1, S("AB")), (2, I(3)), (3, I(1))],
                &[(1, S("B")), (1, S(""))],
            ),
            Example::of(&[(1, S("AB")), (2, I(0)), (3, I(1)), (1, S("AB")), (2, I(1)), (3, I(-1))], &[])
                .faults(&[6, 6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "PUT_STRING",
        summary: "a string with a part overwritten",
        source: Source::manual("a replacement that reaches behind the end makes the string longer: ours"),
        inputs: &[
            TEXT,
            PortSpec::active(KindSet::INTEGER, "first position, from 1"),
            PortSpec::active(KindSet::STRING, "replacement"),
        ],
        outputs: &["string"],
        behaviour: |f| {
            let mut text = f.string(1)?.to_vec();
            let start = position(f.integer(2)?, text.len() + 1).ok_or(Problem::Range(2))?;
            let new = f.string(3)?;
            let end = text.len().min(start + new.len());
            text.splice(start..end, new.iter().copied());
            emit_text(f, 1, text)
        },
        examples: &[
            Example::of(&[(1, S("ROT X")), (2, I(5)), (3, S("Y"))], &[(1, S("ROT Y"))]),
            Example::of(&[(1, S("AB")), (2, I(3)), (3, S("CD"))], &[(1, S("ABCD"))]),
            Example::of(&[(1, S("AB")), (2, I(4)), (3, S("X"))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "FIND_STRING",
        summary: "position of the first place where a string contains another, 0 if nowhere",
        source: Source::manual("an empty string is found at 1: ours"),
        inputs: &[TEXT, PortSpec::active(KindSet::STRING, "what is looked for")],
        outputs: &["position, from 1, or 0"],
        behaviour: |f| {
            let place = find(f.string(1)?, f.string(2)?).map_or(0, |place| place as i32 + 1);
            f.emit(1, Value::Integer(place))
        },
        examples: &[Example::of(
            &[(1, S("WORLD.RX")), (2, S(".")), (1, S("WORLD")), (2, S("X")), (1, S("A")), (2, S(""))],
            &[(1, I(6)), (1, I(0)), (1, I(1))],
        )],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SPLIT",
        summary: "what stands before and after the first separator",
        source: Source::manual("without the separator all goes to output 1 and nothing to output 2: ours"),
        inputs: &[TEXT, PortSpec::constant(KindSet::STRING, "separator")],
        outputs: &["string before", "string after"],
        behaviour: |f| {
            let (text, separator) = (f.string(1)?, f.string(2)?);
            if separator.is_empty() {
                return Err(Problem::Range(2));
            }
            match find(text, separator) {
                None => {
                    let whole = f.take(1);
                    f.emit(1, whole)
                }
                Some(place) => {
                    let before = Value::string(&text[..place]);
                    let after = Value::string(&text[place + separator.len()..]);
                    f.emit(1, before)?;
                    f.emit(2, after)
                }
            }
        },
        examples: &[
            Example::of(&[(2, S(",")), (1, S("1,2,3")), (1, S("4"))], &[(1, S("1")), (2, S("2,3")), (1, S("4"))]),
            Example::of(&[(2, S("")), (1, S("A"))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TRANS_STRING",
        summary: "a string with its characters mapped by a table",
        source: Source::manual("character n becomes that at place n of the table, from 0; one beyond it stays: ours"),
        inputs: &[TEXT, PortSpec::constant(KindSet::STRING, "table")],
        outputs: &["string"],
        behaviour: |f| {
            let table = f.string(2)?;
            let mapped: Vec<u8> =
                f.string(1)?.iter().map(|&b| table.get(usize::from(b)).copied().unwrap_or(b)).collect();
            emit_text(f, 1, mapped)
        },
        examples: &[Example::of(&[(2, S("0123456789ABCDEF")), (1, S("\u{1}\u{A}\u{F}Z"))], &[(1, S("1AFZ"))])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "COMP_STRING",
        summary: "how a string compares with a constant one, byte by byte",
        source: Source::manual("outputs 2 and 3 are uncertain"),
        inputs: &[TEXT, PortSpec::constant(KindSet::STRING, "other string")],
        outputs: &["whether equal", "whether <1> comes before <2>", "whether <1> comes after <2>"],
        behaviour: |f| {
            let order = f.string(1)?.cmp(f.string(2)?);
            f.emit(1, Value::Boolean(order.is_eq()))?;
            f.emit(2, Value::Boolean(order.is_lt()))?;
            f.emit(3, Value::Boolean(order.is_gt()))
        },
        examples: &[
            Example::of(&[(2, S("B")), (1, S("A"))], &[(1, B(false)), (2, B(true)), (3, B(false))]),
            Example::of(&[(2, S("B")), (1, S("B"))], &[(1, B(true)), (2, B(false)), (3, B(false))]),
            Example::of(&[(2, S("")), (1, S("B"))], &[(1, B(false)), (2, B(false)), (3, B(true))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "STRING_TO_NUM",
        summary: "the number that a string shows: an integer if it has only digits, else a real",
        source: Source::manual("a text that is no number is a fault: ours"),
        inputs: &[TEXT],
        outputs: &["number"],
        behaviour: |f| {
            let text = f.string(1)?.trim_ascii();
            let readable = text.iter().all(|b| b.is_ascii_digit() || b"+-.eE".contains(b));
            let text = std::str::from_utf8(text).ok().filter(|_| readable).ok_or(Problem::Range(1))?;
            let number = match text.parse::<i32>() {
                Ok(integer) => Value::Integer(integer),
                Err(_) => Value::Real(text.parse().map_err(|_| Problem::Range(1))?),
            };
            f.emit(1, number)
        },
        examples: &[
            Example::of(
                &[(1, S(" 12 ")), (1, S("-1.5E2")), (1, S("+7")), (1, S(".5"))],
                &[(1, I(12)), (1, R(-150.0)), (1, I(7)), (1, R(0.5))],
            ),
            Example::of(&[(1, S("TWO")), (1, S("")), (1, S("9999999999"))], &[(1, R(9_999_999_999.0))]).faults(&[6, 6]),
            Example::of(&[(1, S("1E999"))], &[]).faults(&[7]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CHARCONVERT",
        summary: "the codes of the characters of a string, one message each",
        source: Source::manual("further inputs are not known"),
        inputs: &[TEXT],
        outputs: &["integer, 0 to 255"],
        behaviour: |f| {
            let codes: Vec<u8> = f.string(1)?.to_vec();
            codes.into_iter().try_for_each(|code| f.emit(1, Value::Integer(code.into())))
        },
        examples: &[Example::of(&[(1, S("A0\r")), (1, S(""))], &[(1, I(65)), (1, I(48)), (1, I(13))])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CHARMASK",
        summary: "a string with a mask laid over each character, as to strip a parity bit",
        source: Source::manual(""),
        inputs: &[TEXT, PortSpec::constant(KindSet::INTEGER, "bits that stay, 0 to 255")],
        outputs: &["string"],
        behaviour: |f| {
            let mask = u8::try_from(f.integer(2)?).map_err(|_| Problem::Range(2))?;
            let masked = f.string(1)?.iter().map(|b| b & mask).collect();
            emit_text(f, 1, masked)
        },
        examples: &[
            Example::of(&[(2, I(0x5f)), (1, S("abc"))], &[(1, S("ABC"))]),
            Example::of(&[(2, I(256)), (1, S("A"))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CHANGEQTYPE",
        summary: "a string as another kind of packet; here the string as it is",
        source: Source::manual("long strings are one message here, so that packets and their continuations are alike"),
        inputs: &[TEXT, PortSpec::constant(KindSet::INTEGER, "code of the kind")],
        outputs: &["string"],
        behaviour: |f| {
            let text = f.take(1);
            f.emit(1, text)
        },
        examples: &[Example::of(&[(1, S("A")), (2, I(14))], &[(1, S("A"))])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "GATHER_STRING",
        summary: "characters gathered into lines",
        source: Source::manual("the terminator, RETURN at first, does not leave with the line: ours"),
        inputs: &[
            PortSpec::active(KindSet::STRING, "characters"),
            PortSpec::default(KindSet::STRING, S("\r"), "terminator"),
        ],
        outputs: &["line"],
        memory: 1,
        behaviour: gather,
        examples: &[
            Example::of(&[(1, S("O")), (1, S("K\rNEXT")), (1, S("\r\r"))], &[(1, S("OK")), (1, S("NEXT")), (1, S(""))]),
            Example::of(&[(2, S(";;")), (1, S("A;")), (1, S(";B"))], &[(1, S("A"))]),
            Example::of(&[(2, S("")), (1, S("A"))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "LINEEDITOR",
        summary: "lines from typed characters, with rubout and CTRL-U",
        source: Source::manual("CTRL-R shows the line again; other control characters are ignored: ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "characters")],
        outputs: &["finished line, without RETURN", "text to echo"],
        memory: 1,
        behaviour: edit,
        examples: &[
            Example::of(
                &[(1, S("AC")), (1, S("\u{7f}B\r"))],
                &[(2, S("AC")), (2, S("\u{8} \u{8}B\r\n")), (1, S("AB"))],
            ),
            Example::of(&[(1, S("\u{7f}NO\u{15}\r"))], &[(2, S("NO\u{8} \u{8}\u{8} \u{8}\r\n")), (1, S(""))]),
            Example::of(&[(1, S("A\u{12}\u{1}"))], &[(2, S("A\r\nA"))]),
        ],
        ..FunctionRow::PLAIN
    },
];

/// The place in a string of a position from 1; none outside `1..=end`.
fn position(position: i32, end: usize) -> Option<usize> {
    usize::try_from(position).ok()?.checked_sub(1).filter(|place| *place < end)
}

/// Where `text` contains `part` first.
fn find(text: &[u8], part: &[u8]) -> Option<usize> {
    if part.is_empty() {
        return Some(0);
    }
    // The first byte is found quickly; a hostile pair of strings costs no more than the product of two lengths.
    text.windows(part.len()).position(|window| window == part)
}

fn emit_text(f: &mut Firing, output: u16, text: Vec<u8>) -> Result<(), Problem> {
    if text.len() > MAX_STRING {
        return Err(Problem::TooLong);
    }
    f.emit(output, Value::String(text.into()))
}

fn gathered(f: &Firing) -> Vec<u8> {
    match f.memory(GATHERED) {
        Some(Value::String(text)) => text.to_vec(),
        _ => Vec::new(),
    }
}

fn gather(f: &mut Firing) -> Result<(), Problem> {
    let terminator = f.string(2)?.to_vec();
    if terminator.is_empty() {
        return Err(Problem::Range(2));
    }
    let mut text = gathered(f);
    text.extend_from_slice(f.string(1)?);
    let mut rest = text.as_slice();
    while let Some(place) = find(rest, &terminator) {
        f.emit(1, Value::string(&rest[..place]))?;
        rest = &rest[place + terminator.len()..];
    }
    if rest.len() > MAX_STRING {
        f.forget(GATHERED);
        return Err(Problem::TooLong);
    }
    f.remember(GATHERED, Value::string(rest));
    Ok(())
}

fn edit(f: &mut Firing) -> Result<(), Problem> {
    const RUBOUT: &[u8] = b"\x08 \x08";
    let mut line = gathered(f);
    let (mut echo, mut lines) = (Vec::new(), Vec::new());
    for &byte in f.string(1)? {
        match byte {
            b'\r' => {
                echo.extend_from_slice(b"\r\n");
                lines.push(std::mem::take(&mut line));
            }
            8 | 127 => {
                if line.pop().is_some() {
                    echo.extend_from_slice(RUBOUT);
                }
            }
            21 => line.drain(..).for_each(|_| echo.extend_from_slice(RUBOUT)),
            18 => {
                echo.extend_from_slice(b"\r\n");
                echo.extend_from_slice(&line);
            }
            0..32 => {}
            byte => {
                line.push(byte);
                echo.push(byte);
            }
        }
        if echo.len() > MAX_STRING {
            return Err(Problem::TooLong);
        }
    }
    if line.len() > MAX_STRING {
        f.forget(GATHERED);
        return Err(Problem::TooLong);
    }
    f.remember(GATHERED, Value::string(&line));
    if !echo.is_empty() {
        f.emit(2, Value::String(echo.into()))?;
    }
    lines.into_iter().try_for_each(|line| emit_text(f, 1, line))
}
