//! Keys and modes of the keyboard.

use crate::terminal::{SPECIAL_KEYS, SpecialKey};

/// Where typed characters go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum KeyboardMode {
    /// To the host, as from a terminal.
    Terminal,
    /// To the machine's own command interpreter, line by line.
    Command,
    /// To KEYBOARD, SPECKEYS and KBHANDLER.
    #[default]
    Interactive,
}

impl KeyboardMode {
    /// The mode's word.
    pub fn word(self) -> &'static str {
        match self {
            KeyboardMode::Terminal => "terminal",
            KeyboardMode::Command => "command",
            KeyboardMode::Interactive => "interactive",
        }
    }
}

/// A key with a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Chooses a mode.
    Mode(KeyboardMode),
    /// Switches the graphics off and on.
    Graph,
    /// Switches the terminal's text off and on.
    Term,
    /// Opens and closes the set-up page.
    Setup,
    /// Types a character.
    Character(u8),
    /// An arrow, or a key of the keypad.
    Special(SpecialKey),
}

/// The keys with names, but for the special ones of the terminal.
const KEYS: &[(&str, Key)] = &[
    ("host", Key::Mode(KeyboardMode::Terminal)),
    ("local", Key::Mode(KeyboardMode::Interactive)),
    ("command", Key::Mode(KeyboardMode::Command)),
    ("graph", Key::Graph),
    ("term", Key::Term),
    ("setup", Key::Setup),
    ("return", Key::Character(b'\r')),
    ("linefeed", Key::Character(b'\n')),
    ("tab", Key::Character(b'\t')),
    ("backspace", Key::Character(8)),
    ("delete", Key::Character(127)),
    ("escape", Key::Character(27)),
];

impl Key {
    /// The key of a name, in either case of letters.
    pub fn named(name: &str) -> Option<Key> {
        let plain = KEYS.iter().find(|(n, _)| n.eq_ignore_ascii_case(name)).map(|(_, key)| *key);
        let special = || SPECIAL_KEYS.iter().find(|k| k.name.eq_ignore_ascii_case(name)).map(|k| Key::Special(*k));
        plain.or_else(special)
    }

    /// The names of all keys.
    pub fn names() -> impl Iterator<Item = &'static str> {
        KEYS.iter().map(|(name, _)| *name).chain(SPECIAL_KEYS.iter().map(|k| k.name))
    }
}
