//! Characters: codes, masks, and lines gathered from what comes in pieces.

use super::{FunctionExample, FunctionRow, Source, strings::find};
use crate::port::{
    Firing, KindSet,
    Literal::{I, S},
    PortSpec, Problem,
};
use protocol::{Value, value::MAX_STRING};

/// Longest line that waits for its end in F:GATHER_STRING and F:LINEEDITOR, in bytes. Ours.
pub const MAX_GATHERED: usize = 4_096;

/// The memory cell with the line that is not yet complete.
const LINE: u8 = 0;

const RETURN: u8 = 13;
const BACKSPACE: u8 = 8;
const RUBOUT: u8 = 127;
/// Control-U: the whole line goes.
const KILL: u8 = 21;
/// What a terminal is sent to wipe one character out.
const WIPE: &[u8] = b"\x08 \x08";

const STRING: PortSpec = PortSpec::active(KindSet::STRING, "string");

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "CHARCONVERT",
        summary: "the codes of the characters of a string, one message each",
        source: Source::manual("codes are 0 to 255; other inputs, if there were any, are unknown"),
        inputs: &[STRING],
        outputs: &["integers"],
        behaviour: |f| {
            let Value::String(text) = f.take(1) else { return Err(Problem::Kind(1)) };
            text.iter().try_for_each(|&byte| f.emit(1, Value::Integer(byte.into())))
        },
        examples: &[
            FunctionExample::of(&[(1, S("AB\r"))], &[(1, I(65)), (1, I(66)), (1, I(13))]),
            FunctionExample::of(&[(1, S("")), (1, S("0"))], &[(1, I(48))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CHARMASK",
        summary: "each character combined with a mask by a logical and; 127 strips parity",
        source: Source::manual("the mask is 0 to 255, 127 at first: ours"),
        inputs: &[STRING, PortSpec::default(KindSet::INTEGER, I(127), "mask")],
        outputs: &["string"],
        behaviour: |f| {
            let mask = u8::try_from(f.integer(2)?).map_err(|_| Problem::Range(2))?;
            let masked: Vec<u8> = f.string(1)?.iter().map(|byte| byte & mask).collect();
            f.emit(1, Value::String(masked.into()))
        },
        examples: &[
            FunctionExample::of(&[(1, S("\u{c1}")), (2, I(95)), (1, S("abc"))], &[(1, S("C\u{1}")), (1, S("ABC"))]),
            FunctionExample::of(&[(2, I(256)), (1, S("A"))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CHANGEQTYPE",
        summary: "a string as another kind of block",
        source: Source::manual("a string is one message of any length here, so it passes whatever the code: ours"),
        inputs: &[STRING, PortSpec::constant(KindSet::INTEGER, "code of the kind of block")],
        outputs: &["string"],
        behaviour: |f| {
            let text = f.take(1);
            f.emit(1, text)
        },
        examples: &[
            FunctionExample::of(&[(2, I(1)), (1, S("A")), (1, S(""))], &[(1, S("A")), (1, S(""))]),
            FunctionExample::of(&[(2, I(1)), (1, I(65))], &[]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "GATHER_STRING",
        summary: "whole lines from characters that come in pieces",
        source: Source::manual(
            "the end is RETURN at first and does not leave with the line; a line longer than 4096 that has no end yet is a \
             fault: ours",
        ),
        inputs: &[
            PortSpec::active(KindSet::STRING, "characters"),
            PortSpec::optional(KindSet::STRING, "what ends a line, RETURN at first"),
        ],
        outputs: &["line"],
        memory: 1,
        behaviour: gather,
        examples: &[
            FunctionExample::of(
                &[(1, S("HE")), (1, S("LLO\rWOR")), (1, S("LD\r"))],
                &[(1, S("HELLO")), (1, S("WORLD"))],
            ),
            FunctionExample::of(
                &[(2, S("--")), (1, S("A-")), (1, S("-----B"))],
                &[(1, S("A")), (1, S("")), (1, S(""))],
            ),
            FunctionExample::of(&[(2, S("")), (1, S("A"))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "LINEEDITOR",
        summary: "whole lines from typed characters, with corrections, and what a terminal is to show of them",
        source: Source::manual(
            "RETURN ends, rubout and backspace take the last character, control-U the line; other control characters are \
             left out: ours",
        ),
        inputs: &[PortSpec::active(KindSet::STRING, "characters")],
        outputs: &["line, without RETURN", "echo"],
        memory: 1,
        behaviour: edit,
        examples: &[
            FunctionExample::of(
                &[(1, S("A")), (1, S("X")), (1, S("\u{7f}")), (1, S("B")), (1, S("\r"))],
                &[(2, S("A")), (2, S("X")), (2, S("\u{8} \u{8}")), (2, S("B")), (1, S("AB")), (2, S("\r\n"))],
            ),
            FunctionExample::of(
                &[(1, S("\u{7f}")), (1, S("ABC\u{15}D\rE\r\u{7}"))],
                &[(1, S("D")), (1, S("E")), (2, S("ABC\u{8} \u{8}\u{8} \u{8}\u{8} \u{8}D\r\nE\r\n"))],
            ),
        ],
        ..FunctionRow::PLAIN
    },
];

/// The line that is not yet complete.
fn line(f: &Firing) -> Vec<u8> {
    match f.memory(LINE) {
        Some(Value::String(text)) => text.to_vec(),
        _ => Vec::new(),
    }
}

fn append_line(f: &mut Firing, line: &[u8]) {
    if line.is_empty() {
        f.forget(LINE);
    } else {
        f.remember(LINE, Value::string(line));
    }
}

fn gather(f: &mut Firing) -> Result<(), Problem> {
    let end = match f.optional(2) {
        Some(_) => f.string(2)?.to_vec(),
        None => vec![RETURN],
    };
    if end.is_empty() {
        return Err(Problem::Range(2));
    }
    let mut text = line(f);
    text.extend_from_slice(f.string(1)?);
    let mut rest = &text[..];
    let mut lines = Vec::new();
    while let Some(at) = find(rest, &end) {
        lines.push(&rest[..at]);
        rest = &rest[at + end.len()..];
    }
    if rest.len() > MAX_GATHERED || lines.iter().any(|line| line.len() > MAX_STRING) {
        return Err(Problem::TooLong);
    }
    append_line(f, rest);
    lines.into_iter().try_for_each(|line| f.emit(1, Value::string(line)))
}

fn edit(f: &mut Firing) -> Result<(), Problem> {
    let (mut line, mut lines, mut echo) = (line(f), Vec::new(), Vec::new());
    for &byte in f.string(1)? {
        match byte {
            RETURN => {
                lines.push(std::mem::take(&mut line));
                echo.extend_from_slice(b"\r\n");
            }
            RUBOUT | BACKSPACE if line.pop().is_some() => echo.extend_from_slice(WIPE),
            KILL => echo.extend(line.drain(..).flat_map(|_| WIPE.iter().copied())),
            b' '..RUBOUT | 128.. => {
                if line.len() >= MAX_GATHERED {
                    return Err(Problem::TooLong);
                }
                line.push(byte);
                echo.push(byte);
            }
            _ => {}
        }
    }
    append_line(f, &line);
    lines.into_iter().try_for_each(|line| f.emit(1, Value::String(line.into())))?;
    for part in echo.chunks(MAX_STRING) {
        f.emit(2, Value::string(part))?;
    }
    Ok(())
}
