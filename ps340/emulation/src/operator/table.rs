//! The table of all operator commands, and how a line is read by it.

use super::{
    Inspection, OperatorCommand, OperatorCommandError, OperatorCommandRow,
    display::DISPLAY_ROWS,
    inspect::INSPECTION_ROWS,
    reading::{DEFAULT_WAIT_FRAMES, button, dial, frames, key, message, mode, puck, stylus, type_text},
    word_reader::WordReader,
};
use crate::example::example;

/// Strokes that `strokes` lists by default.
const STROKES: usize = 10_000;

/// Every operator command: what a person does at the machine, and what looks into it.
pub fn rows() -> impl Iterator<Item = &'static OperatorCommandRow> {
    COMMANDS.iter().chain(DISPLAY_ROWS).chain(INSPECTION_ROWS)
}

/// The operator commands of a person at the machine.
const COMMANDS: &[OperatorCommandRow] = &[
    OperatorCommandRow {
        word: "dial",
        arguments: "1..8 TURNS",
        summary: "turn a dial; the machine reads it at the next frame, see 'frames'",
        read: dial,
    },
    OperatorCommandRow {
        word: "key",
        arguments: "1..12 [shift|control] | NAME",
        summary: "press a function key, or a key of the list 'keys'",
        read: key,
    },
    OperatorCommandRow { word: "keys", arguments: "", summary: "names of keys", read: |_| Ok(OperatorCommand::Keys) },
    OperatorCommandRow { word: "button", arguments: "1..32", summary: "press a lighted button", read: button },
    OperatorCommandRow {
        word: "puck",
        arguments: "move X Y | press [1|2|4|8] | release | away",
        summary: "use the tablet with the puck, -1..1",
        read: puck,
    },
    OperatorCommandRow {
        word: "stylus",
        arguments: "move X Y | down | up | away",
        summary: "use the tablet with the stylus, -1..1",
        read: stylus,
    },
    OperatorCommandRow {
        word: "type",
        arguments: "TEXT",
        summary: "type on the keyboard (\\r RETURN, \\n, \\t, \\b, \\e ESC, \\d DEL, \\\\, \\xHH)",
        read: type_text,
    },
    OperatorCommandRow {
        word: "mode",
        arguments: "[terminal|command|interactive]",
        summary: "where typed characters go: to the host, the command interpreter, the network",
        read: mode,
    },
    OperatorCommandRow { word: "frames", arguments: "N", summary: "wait for N frames (60 a second)", read: frames },
    OperatorCommandRow {
        word: "idle",
        arguments: "[N]",
        summary: "wait until nothing is left to do, N frames at most",
        read: |w| Ok(OperatorCommand::Idle(w.optional("a number of frames")?.unwrap_or(DEFAULT_WAIT_FRAMES))),
    },
    OperatorCommandRow {
        word: "message",
        arguments: "[new] [N]",
        summary: "the oldest message to the host that nobody took; wait N frames at most. new: one that is still to come",
        read: message,
    },
    OperatorCommandRow {
        word: "messages",
        arguments: "",
        summary: "all messages to the host that nobody took yet",
        read: |_| Ok(OperatorCommand::Messages),
    },
    OperatorCommandRow {
        word: "show",
        arguments: "NAME",
        summary: "describe an object",
        read: |w| Ok(OperatorCommand::Show(w.required("a name")?.to_ascii_uppercase())),
    },
    OperatorCommandRow {
        word: "strokes",
        arguments: "[N]",
        summary: "what the latest update drew: x y x y, intensities, red green blue of each stroke, N at most",
        read: |w| Ok(OperatorCommand::Strokes(w.optional("a number of strokes")?.unwrap_or(STROKES))),
    },
    OperatorCommandRow {
        word: "overlay",
        arguments: "[N]",
        summary: "the same of what is drawn over the picture: terminal, message line, cursor",
        read: |w| Ok(OperatorCommand::Overlay(w.optional("a number of strokes")?.unwrap_or(STROKES))),
    },
    OperatorCommandRow {
        word: "counters",
        arguments: "[NAME]",
        summary: "counters of the machine, or of a function after 'count on'",
        read: |w| {
            Ok(w.next().map_or(OperatorCommand::Counters, |n| {
                OperatorCommand::Inspect(Inspection::Activity(n.to_ascii_uppercase()))
            }))
        },
    },
    OperatorCommandRow {
        word: "panel",
        arguments: "",
        summary: "labels of dials and keys, lights, message line, switches",
        read: |_| Ok(OperatorCommand::Panel),
    },
    OperatorCommandRow {
        word: "terminal",
        arguments: "",
        summary: "the text on the screen of the terminal",
        read: |_| Ok(OperatorCommand::Terminal),
    },
    OperatorCommandRow {
        word: "log",
        arguments: "",
        summary: "the latest messages of the machine",
        read: |_| Ok(OperatorCommand::Log),
    },
    OperatorCommandRow {
        word: "lines",
        arguments: "[on|off]",
        summary: "replies on this operator line as lines of text, and no longer with \\n in one line",
        read: |words| Ok(OperatorCommand::Lines(words.on_or_off()?)),
    },
    OperatorCommandRow {
        word: "example",
        arguments: "[NAME]",
        summary: "run a program that ships with the machine; alone: list them",
        read: |words| {
            Ok(OperatorCommand::Example(words.next().map(example).transpose().map_err(OperatorCommandError::Example)?))
        },
    },
    OperatorCommandRow { word: "help", arguments: "[ORDER]", summary: "this list, or one order", read: help },
    OperatorCommandRow { word: "quit", arguments: "", summary: "end the machine", read: |_| Ok(OperatorCommand::Quit) },
];

/// The operator command that a word is nearly.
fn meant(word: &str) -> String {
    let near = protocol::command::spelling::nearest(word, rows().map(|row| row.word));
    near.map_or(String::new(), |near| format!("did you mean '{near}'? "))
}

/// Reads one line.
///
/// # Errors
/// [`OperatorCommandError`] names the word that is wrong.
pub fn parse(line: &str) -> Result<OperatorCommand, OperatorCommandError> {
    let mut words = WordReader { rest: line.trim() };
    let word = words.required("an order")?;
    let order = (row(word)?.read)(&mut words)?;
    if words.rest.is_empty() { Ok(order) } else { Err(OperatorCommandError::TooMuch(words.rest.into())) }
}

/// The row of an operator command.
fn row(word: &str) -> Result<&'static OperatorCommandRow, OperatorCommandError> {
    rows()
        .find(|row| row.word.eq_ignore_ascii_case(word))
        .ok_or_else(|| OperatorCommandError::Unknown { word: word.into(), hint: meant(word) })
}

fn help(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    Ok(OperatorCommand::Help(words.next().map(row).transpose()?))
}
