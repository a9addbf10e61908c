//! How operator commands are read.

use super::{OperatorCommand, OperatorCommandError, word_reader::WordReader};
use crate::machine::{Key, KeyboardMode};
use clap::ValueEnum;

/// Frames that `idle` and `message` wait for by default: ten seconds.
pub(super) const DEFAULT_WAIT_FRAMES: u64 = 600;

pub(super) fn message(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let fresh = words.rest.split_whitespace().next() == Some("new");
    if fresh {
        words.next();
    }
    Ok(OperatorCommand::Message {
        fresh,
        frames: words.optional("'new' or a number of frames")?.unwrap_or(DEFAULT_WAIT_FRAMES),
    })
}

pub(super) fn dial(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let dial = words.integer(1, 8, "a dial, 1 to 8")?;
    Ok(OperatorCommand::Dial { dial, turns: words.real(-1e6, 1e6, "a number of turns")? })
}

pub(super) fn key(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    if let Some(named) = words.rest.split_whitespace().next().and_then(Key::named) {
        words.next();
        return Ok(OperatorCommand::Press(named));
    }
    let key = words.integer(1, 12, "a function key, 1 to 12, or a key of the list 'keys'")?;
    match words.next() {
        None => Ok(OperatorCommand::Key(key)),
        Some("shift") => Ok(OperatorCommand::Key(key + 12)),
        Some("control") => Ok(OperatorCommand::Key(key + 24)),
        Some(other) => Err(OperatorCommandError::Bad { found: other.into(), expected: "'shift' or 'control'" }),
    }
}

pub(super) fn button(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    Ok(OperatorCommand::Button(words.integer(1, 32, "a button, 1 to 32")?))
}

pub(super) fn puck(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let expected = "'move', 'press', 'release' or 'away'";
    match words.required(expected)? {
        "move" => puck_move(words),
        "press" => {
            let code = words.optional("a sum of the button codes 1, 2, 4 and 8")?.unwrap_or(1);
            if (1..=15).contains(&code) {
                Ok(OperatorCommand::PuckPress(code))
            } else {
                Err(OperatorCommandError::Bad {
                    found: code.to_string(),
                    expected: "a sum of the button codes 1, 2, 4 and 8",
                })
            }
        }
        "release" => Ok(OperatorCommand::PuckRelease),
        "away" => Ok(OperatorCommand::PuckAway),
        other => Err(OperatorCommandError::Bad { found: other.into(), expected }),
    }
}

pub(super) fn stylus(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let expected = "'move', 'down', 'up' or 'away'";
    match words.required(expected)? {
        "move" => puck_move(words),
        "down" => Ok(OperatorCommand::PuckPress(1)),
        "up" => Ok(OperatorCommand::PuckRelease),
        "away" => Ok(OperatorCommand::PuckAway),
        other => Err(OperatorCommandError::Bad { found: other.into(), expected }),
    }
}

fn puck_move(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let mut coordinate = || words.real(-1.0, 1.0, "a coordinate, -1 to 1");
    Ok(OperatorCommand::PuckMove([coordinate()?, coordinate()?]))
}

pub(super) fn mode(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let Some(word) = words.next() else { return Ok(OperatorCommand::Mode(None)) };
    let expected = "'terminal', 'command' or 'interactive'";
    let read = KeyboardMode::from_str(word, true);
    Ok(OperatorCommand::Mode(Some(read.map_err(|_| OperatorCommandError::Bad { found: word.into(), expected })?)))
}

pub(super) fn type_text(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let text = std::mem::take(&mut words.rest);
    if text.is_empty() {
        return Err(OperatorCommandError::Missing("the text"));
    }
    Ok(OperatorCommand::Type(unescape(text)))
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

pub(super) fn frames(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    Ok(OperatorCommand::Frames(
        words.optional("a number of frames")?.ok_or(OperatorCommandError::Missing("a number of frames"))?,
    ))
}
