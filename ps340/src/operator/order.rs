//! The orders of the operator: their table and their text form.

use super::{
    inspect::{self, Inspection},
    sight::{self, SightOrder},
};
use crate::example::{Example, example};
use crate::machine::{Key, KeyboardMode};
use clap::ValueEnum;

/// One row of the table of orders, from which `help` is made. Rows are the same if their words are.
#[derive(Clone, Copy, Debug)]
pub struct OrderRow {
    /// The first word.
    pub word: &'static str,
    /// What follows it.
    pub arguments: &'static str,
    /// What it does.
    pub summary: &'static str,
    pub(super) read: fn(&mut Words<'_>) -> Result<Order, OrderError>,
}

impl PartialEq for OrderRow {
    fn eq(&self, other: &OrderRow) -> bool {
        self.word == other.word
    }
}

/// Which of the two screens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screen {
    /// The calligraphic display.
    Vector,
    /// The raster display.
    Raster,
}

/// Something that a person does at the machine, or looks at.
#[derive(Clone, Debug, PartialEq)]
pub enum Order {
    /// Turns a dial (1..=8) by a number of turns, clockwise positive.
    Dial {
        /// 1..=8.
        dial: u8,
        /// 1.0 is a full turn.
        turns: f64,
    },
    /// Presses a function key: 1..=12, with SHIFT 13..=24, with CONTROL 25..=36.
    Key(u8),
    /// Presses a key of the keyboard that has a name.
    Press(Key),
    /// Lists the names of the keys.
    Keys,
    /// Gives the keyboard another mode, or says which it has.
    Mode(Option<KeyboardMode>),
    /// Presses a lighted button, 1..=32.
    Button(u8),
    /// Moves stylus or puck, -1..=1.
    PuckMove([f64; 2]),
    /// Presses puck buttons: 1, 2, 4, 8 or sums; the tip of the stylus is 1.
    PuckPress(u8),
    /// Lets all buttons go.
    PuckRelease,
    /// Takes stylus or puck off the tablet.
    PuckAway,
    /// Types characters on the keyboard.
    Type(Vec<u8>),
    /// Waits for so many frames.
    Frames(u64),
    /// Waits until nothing is left to do, for so many frames at most.
    Idle(u64),
    /// Waits for a message to the host, for so many frames at most.
    Message {
        /// Whether messages that came before the order do not count.
        fresh: bool,
        /// For how many frames at most.
        frames: u64,
    },
    /// The messages to the host that nobody took yet.
    Messages,
    /// How replies look on this operator line: with line ends as they are, or as `\n`.
    Lines(bool),
    /// Sets something at the display, or writes a picture of it.
    Sight(SightOrder),
    /// Describes an object.
    Show(String),
    /// The strokes of the latest update, the first so many.
    Strokes(usize),
    /// The strokes over the picture, the first so many.
    Overlay(usize),
    /// Counters of the machine.
    Counters,
    /// Labels of dials and keys, lights, message line, mode of the keyboard, switches of the screen.
    Panel,
    /// The text on the screen of the terminal emulator.
    Terminal,
    /// Looks into the network or the structure.
    Inspect(Inspection),
    /// The latest numbered messages of the machine.
    Log,
    /// Lists the orders, or says all about one.
    Help(Option<&'static OrderRow>),
    /// Runs a program that ships with the machine, or lists them.
    Example(Option<&'static Example>),
    /// Ends the machine.
    Quit,
}

impl Order {
    /// Whether it writes a file or ends the machine, which nobody expects of a file that is played.
    pub fn reaches_out(&self) -> bool {
        match self {
            Order::Quit | Order::Sight(SightOrder::Picture { .. }) => true,
            Order::Inspect(Inspection::Graph { file, .. }) => file.is_some(),
            _ => false,
        }
    }

    /// Whether somebody does something at the machine, rather than looks at it or waits for it.
    pub fn is_action(&self) -> bool {
        match self {
            Order::Dial { .. }
            | Order::Key(_)
            | Order::Press(_)
            | Order::Mode(Some(_))
            | Order::Button(_)
            | Order::PuckMove(_)
            | Order::PuckPress(_)
            | Order::PuckRelease
            | Order::PuckAway
            | Order::Example(Some(_))
            | Order::Type(_) => true,
            Order::Keys
            | Order::Mode(None)
            | Order::Frames(_)
            | Order::Idle(_)
            | Order::Message { .. }
            | Order::Messages
            | Order::Lines(_)
            | Order::Sight(_)
            | Order::Show(_)
            | Order::Strokes(_)
            | Order::Overlay(_)
            | Order::Counters
            | Order::Panel
            | Order::Terminal
            | Order::Inspect(_)
            | Order::Log
            | Order::Help(_)
            | Order::Example(None)
            | Order::Quit => false,
        }
    }
}

/// Why a line is no order.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OrderError {
    /// The first word is unknown.
    #[error("unknown order '{word}'; {hint}'help' lists them", word = .0, hint = meant(.0))]
    Unknown(String),
    /// Something is missing.
    #[error("{0} is missing")]
    Missing(&'static str),
    /// Something cannot be read, or is out of range.
    #[error("'{found}' is not {expected}")]
    Bad {
        /// What stands there.
        found: String,
        /// What should.
        expected: &'static str,
    },
    /// There is no such program.
    #[error("{0}")]
    Example(String),
    /// There is more on the line.
    #[error("'{0}' is too much")]
    TooMuch(String),
}

/// The order that a word is nearly.
fn meant(word: &str) -> String {
    let near = protocol::command::spelling::nearest(word, rows().map(|row| row.word));
    near.map_or(String::new(), |near| format!("did you mean '{near}'? "))
}

/// What is said of an order of a file that is played which reaches out.
pub(super) const REFUSED: &str = "a file that is played may not write files or end the machine without --orders";

/// Frames that `idle` and `message` wait for if the order does not say: ten seconds.
const PATIENCE: u64 = 600;

/// Strokes that `strokes` lists if the order does not say.
const STROKES: usize = 10_000;

/// Every order: what a person does at the machine, and what looks into it.
pub fn rows() -> impl Iterator<Item = &'static OrderRow> {
    ORDERS.iter().chain(sight::ROWS).chain(inspect::ROWS)
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
        read: |words| Ok(Order::Lines(inspect::on_or_off(words)?)),
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
    rows().find(|row| row.word.eq_ignore_ascii_case(word)).ok_or_else(|| OrderError::Unknown(word.into()))
}

fn help(words: &mut Words<'_>) -> Result<Order, OrderError> {
    Ok(Order::Help(words.next().map(row).transpose()?))
}

fn message(words: &mut Words<'_>) -> Result<Order, OrderError> {
    let fresh = words.rest.split_whitespace().next() == Some("new");
    if fresh {
        words.next();
    }
    Ok(Order::Message { fresh, frames: words.optional("'new' or a number of frames")?.unwrap_or(PATIENCE) })
}

/// What is left of the line.
pub(super) struct Words<'a> {
    pub(super) rest: &'a str,
}

impl<'a> Words<'a> {
    pub(super) fn next(&mut self) -> Option<&'a str> {
        let (word, rest) = self.rest.split_once(char::is_whitespace).unwrap_or((self.rest, ""));
        self.rest = rest.trim_start();
        (!word.is_empty()).then_some(word)
    }

    pub(super) fn required(&mut self, what: &'static str) -> Result<&'a str, OrderError> {
        self.next().ok_or(OrderError::Missing(what))
    }

    pub(super) fn optional<T: std::str::FromStr>(&mut self, expected: &'static str) -> Result<Option<T>, OrderError> {
        let word = self.next();
        word.map(|w| w.parse().map_err(|_| OrderError::Bad { found: w.into(), expected })).transpose()
    }

    pub(super) fn integer<T: std::str::FromStr + PartialOrd>(
        &mut self,
        low: T,
        high: T,
        expected: &'static str,
    ) -> Result<T, OrderError> {
        let word = self.required(expected)?;
        let read = word.parse().ok().filter(|n| (low..=high).contains(n));
        read.ok_or_else(|| OrderError::Bad { found: word.into(), expected })
    }

    pub(super) fn real(&mut self, low: f64, high: f64, expected: &'static str) -> Result<f64, OrderError> {
        let word = self.required(expected)?;
        let read = word.parse().ok().filter(|x| (low..=high).contains(x));
        read.ok_or_else(|| OrderError::Bad { found: word.into(), expected })
    }
}

fn dial(words: &mut Words<'_>) -> Result<Order, OrderError> {
    let dial = words.integer(1, 8, "a dial, 1 to 8")?;
    Ok(Order::Dial { dial, turns: words.real(-1e6, 1e6, "a number of turns")? })
}

fn key(words: &mut Words<'_>) -> Result<Order, OrderError> {
    if let Some(named) = words.rest.split_whitespace().next().and_then(Key::named) {
        words.next();
        return Ok(Order::Press(named));
    }
    let key = words.integer(1, 12, "a function key, 1 to 12, or a key of the list 'keys'")?;
    match words.next() {
        None => Ok(Order::Key(key)),
        Some("shift") => Ok(Order::Key(key + 12)),
        Some("control") => Ok(Order::Key(key + 24)),
        Some(other) => Err(OrderError::Bad { found: other.into(), expected: "'shift' or 'control'" }),
    }
}

fn button(words: &mut Words<'_>) -> Result<Order, OrderError> {
    Ok(Order::Button(words.integer(1, 32, "a button, 1 to 32")?))
}

fn puck(words: &mut Words<'_>) -> Result<Order, OrderError> {
    let expected = "'move', 'press', 'release' or 'away'";
    match words.required(expected)? {
        "move" => place(words),
        "press" => {
            let code = words.optional("a sum of the button codes 1, 2, 4 and 8")?.unwrap_or(1);
            if (1..=15).contains(&code) {
                Ok(Order::PuckPress(code))
            } else {
                Err(OrderError::Bad { found: code.to_string(), expected: "a sum of the button codes 1, 2, 4 and 8" })
            }
        }
        "release" => Ok(Order::PuckRelease),
        "away" => Ok(Order::PuckAway),
        other => Err(OrderError::Bad { found: other.into(), expected }),
    }
}

fn stylus(words: &mut Words<'_>) -> Result<Order, OrderError> {
    let expected = "'move', 'down', 'up' or 'away'";
    match words.required(expected)? {
        "move" => place(words),
        "down" => Ok(Order::PuckPress(1)),
        "up" => Ok(Order::PuckRelease),
        "away" => Ok(Order::PuckAway),
        other => Err(OrderError::Bad { found: other.into(), expected }),
    }
}

fn place(words: &mut Words<'_>) -> Result<Order, OrderError> {
    let mut coordinate = || words.real(-1.0, 1.0, "a coordinate, -1 to 1");
    Ok(Order::PuckMove([coordinate()?, coordinate()?]))
}

fn mode(words: &mut Words<'_>) -> Result<Order, OrderError> {
    let Some(word) = words.next() else { return Ok(Order::Mode(None)) };
    let expected = "'terminal', 'command' or 'interactive'";
    let read = KeyboardMode::from_str(word, true);
    Ok(Order::Mode(Some(read.map_err(|_| OrderError::Bad { found: word.into(), expected })?)))
}

fn type_text(words: &mut Words<'_>) -> Result<Order, OrderError> {
    let text = std::mem::take(&mut words.rest);
    if text.is_empty() {
        return Err(OrderError::Missing("the text"));
    }
    Ok(Order::Type(unescape(text)))
}

/// The characters that a text with backslashes stands for, as in `type`; a backslash before anything else stands for
/// itself.
pub fn unescape(text: &str) -> Vec<u8> {
    let mut typed = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let digit = |byte: u8| char::from(byte).to_digit(16).and_then(|d| u8::try_from(d).ok());
        let hexadecimal = |a: u8, b: u8| Some(digit(a)? * 16 + digit(b)?);
        let (character, length) = match (first, after) {
            (b'\\', [b'r', ..]) => (b'\r', 2),
            (b'\\', [b'n', ..]) => (b'\n', 2),
            (b'\\', [b't', ..]) => (b'\t', 2),
            (b'\\', [b'b', ..]) => (8, 2),
            (b'\\', [b'e', ..]) => (27, 2),
            (b'\\', [b'd', ..]) => (127, 2),
            (b'\\', [b'\\', ..]) => (b'\\', 2),
            (b'\\', [b'x', a, b, ..]) => hexadecimal(*a, *b).map_or((b'\\', 1), |code| (code, 4)),
            _ => (*first, 1),
        };
        typed.push(character);
        rest = &rest[length..];
    }
    typed
}

fn frames(words: &mut Words<'_>) -> Result<Order, OrderError> {
    Ok(Order::Frames(words.optional("a number of frames")?.ok_or(OrderError::Missing("a number of frames"))?))
}
