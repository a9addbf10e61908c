//! The table of all orders, and how a line is read by it.

use super::{
    Inspection, Order, OrderError, OrderRow,
    inspect::INSPECTION_ROWS,
    reading::{PATIENCE, button, dial, frames, key, message, mode, puck, stylus, type_text},
    sight::SIGHT_ROWS,
    words::Words,
};
use crate::example::example;

/// Strokes that `strokes` lists if the order does not say.
const STROKES: usize = 10_000;

/// Every order: what a person does at the machine, and what looks into it.
pub fn rows() -> impl Iterator<Item = &'static OrderRow> {
    ORDERS.iter().chain(SIGHT_ROWS).chain(INSPECTION_ROWS)
}

/// The orders of a person at the machine.
const ORDERS: &[OrderRow] = &[
    OrderRow {
        word: "dial",
        arguments: "1..8 TURNS",
        summary: "turn a dial; the machine reads it at the next frame, see 'frames'",
        read: dial,
    },
    OrderRow {
        word: "key",
        arguments: "1..12 [shift|control] | NAME",
        summary: "press a function key, or a key of the list 'keys'",
        read: key,
    },
    OrderRow { word: "keys", arguments: "", summary: "names of keys", read: |_| Ok(Order::Keys) },
    OrderRow { word: "button", arguments: "1..32", summary: "press a lighted button", read: button },
    OrderRow {
        word: "puck",
        arguments: "move X Y | press [1|2|4|8] | release | away",
        summary: "use the tablet with the puck, -1..1",
        read: puck,
    },
    OrderRow {
        word: "stylus",
        arguments: "move X Y | down | up | away",
        summary: "use the tablet with the stylus, -1..1",
        read: stylus,
    },
    OrderRow {
        word: "type",
        arguments: "TEXT",
        summary: "type on the keyboard (\\r RETURN, \\n, \\t, \\b, \\e ESC, \\d DEL, \\\\, \\xHH)",
        read: type_text,
    },
    OrderRow {
        word: "mode",
        arguments: "[terminal|command|interactive]",
        summary: "where typed characters go: to the host, the command interpreter, the network",
        read: mode,
    },
    OrderRow { word: "frames", arguments: "N", summary: "wait for N frames (60 a second)", read: frames },
    OrderRow {
        word: "idle",
        arguments: "[N]",
        summary: "wait until nothing is left to do, N frames at most",
        read: |w| Ok(Order::Idle(w.optional("a number of frames")?.unwrap_or(PATIENCE))),
    },
    OrderRow {
        word: "message",
        arguments: "[new] [N]",
        summary: "the oldest message to the host that nobody took; wait N frames at most. new: one that is still to come",
        read: message,
    },
    OrderRow {
        word: "messages",
        arguments: "",
        summary: "all messages to the host that nobody took yet",
        read: |_| Ok(Order::Messages),
    },
    OrderRow {
        word: "show",
        arguments: "NAME",
        summary: "describe an object",
        read: |w| Ok(Order::Show(w.required("a name")?.to_ascii_uppercase())),
    },
    OrderRow {
        word: "strokes",
        arguments: "[N]",
        summary: "what the latest update drew: x y x y, intensities, red green blue of each stroke, N at most",
        read: |w| Ok(Order::Strokes(w.optional("a number of strokes")?.unwrap_or(STROKES))),
    },
    OrderRow {
        word: "overlay",
        arguments: "[N]",
        summary: "the same of what is drawn over the picture: terminal, message line, cursor",
        read: |w| Ok(Order::Overlay(w.optional("a number of strokes")?.unwrap_or(STROKES))),
    },
    OrderRow {
        word: "counters",
        arguments: "[NAME]",
        summary: "counters of the machine, or of a function after 'count on'",
        read: |w| {
            Ok(w.next().map_or(Order::Counters, |n| Order::Inspect(Inspection::Activity(n.to_ascii_uppercase()))))
        },
    },
    OrderRow {
        word: "panel",
        arguments: "",
        summary: "labels of dials and keys, lights, message line, switches",
        read: |_| Ok(Order::Panel),
    },
    OrderRow {
        word: "terminal",
        arguments: "",
        summary: "the text on the screen of the terminal",
        read: |_| Ok(Order::Terminal),
    },
    OrderRow { word: "log", arguments: "", summary: "the latest messages of the machine", read: |_| Ok(Order::Log) },
    OrderRow {
        word: "lines",
        arguments: "[on|off]",
        summary: "replies on this operator line as lines of text, and no longer with \\n in one line",
        read: |words| Ok(Order::Lines(words.on_or_off()?)),
    },
    OrderRow {
        word: "example",
        arguments: "[NAME]",
        summary: "run a program that ships with the machine; alone: list them",
        read: |words| Ok(Order::Example(words.next().map(example).transpose().map_err(OrderError::Example)?)),
    },
    OrderRow { word: "help", arguments: "[ORDER]", summary: "this list, or one order", read: help },
    OrderRow { word: "quit", arguments: "", summary: "end the machine", read: |_| Ok(Order::Quit) },
];

/// The order that a word is nearly.
fn meant(word: &str) -> String {
    let near = protocol::command::spelling::nearest(word, rows().map(|row| row.word));
    near.map_or(String::new(), |near| format!("did you mean '{near}'? "))
}

/// Reads one line.
///
/// # Errors
/// [`OrderError`] names the word that is wrong.
pub fn parse(line: &str) -> Result<Order, OrderError> {
    let mut words = Words { rest: line.trim() };
    let word = words.required("an order")?;
    let order = (row(word)?.read)(&mut words)?;
    if words.rest.is_empty() { Ok(order) } else { Err(OrderError::TooMuch(words.rest.into())) }
}

/// The row of an order.
fn row(word: &str) -> Result<&'static OrderRow, OrderError> {
    rows()
        .find(|row| row.word.eq_ignore_ascii_case(word))
        .ok_or_else(|| OrderError::Unknown { word: word.into(), hint: meant(word) })
}

fn help(words: &mut Words<'_>) -> Result<Order, OrderError> {
    Ok(Order::Help(words.next().map(row).transpose()?))
}
