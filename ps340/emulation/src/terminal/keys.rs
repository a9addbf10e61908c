//! The keys that are no characters: what each sends to the host, and its code at SPECKEYS.
//!
//! # Source
//! Sequences: the VT100. The code at SPECKEYS is unknown; ours is the final byte of the key's sequence in application
//! mode, so that one table serves both.

use super::Modes;

/// A key of the arrows or of the numeric keypad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpecialKey {
    /// Its name in operator commands.
    pub name: &'static str,
    /// The one character that SPECKEYS sends for it.
    pub code: u8,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Arrow,
    /// On the keypad, with the character that it types.
    Keypad(u8),
    /// PF1 to PF4.
    Function,
}

const fn key(name: &'static str, code: u8, kind: Kind) -> SpecialKey {
    SpecialKey { name, code, kind }
}

/// Every special key.
pub const SPECIAL_KEYS: &[SpecialKey] = &[
    key("up", b'A', Kind::Arrow),
    key("down", b'B', Kind::Arrow),
    key("right", b'C', Kind::Arrow),
    key("left", b'D', Kind::Arrow),
    key("pf1", b'P', Kind::Function),
    key("pf2", b'Q', Kind::Function),
    key("pf3", b'R', Kind::Function),
    key("pf4", b'S', Kind::Function),
    key("enter", b'M', Kind::Keypad(b'\r')),
    key("keypad,", b'l', Kind::Keypad(b',')),
    key("keypad-", b'm', Kind::Keypad(b'-')),
    key("keypad.", b'n', Kind::Keypad(b'.')),
    key("keypad0", b'p', Kind::Keypad(b'0')),
    key("keypad1", b'q', Kind::Keypad(b'1')),
    key("keypad2", b'r', Kind::Keypad(b'2')),
    key("keypad3", b's', Kind::Keypad(b'3')),
    key("keypad4", b't', Kind::Keypad(b'4')),
    key("keypad5", b'u', Kind::Keypad(b'5')),
    key("keypad6", b'v', Kind::Keypad(b'6')),
    key("keypad7", b'w', Kind::Keypad(b'7')),
    key("keypad8", b'x', Kind::Keypad(b'8')),
    key("keypad9", b'y', Kind::Keypad(b'9')),
];

impl SpecialKey {
    /// The bytes that the key sends to the host.
    pub fn sequence(&self, modes: &Modes) -> Vec<u8> {
        match self.kind {
            Kind::Arrow if modes.application_cursor => vec![0x1b, b'O', self.code],
            Kind::Arrow => vec![0x1b, b'[', self.code],
            Kind::Keypad(character) if !modes.application_keypad => vec![character],
            Kind::Keypad(_) | Kind::Function => vec![0x1b, b'O', self.code],
        }
    }

    /// The character that the key types where sequences mean nothing.
    pub fn character(&self) -> Option<u8> {
        match self.kind {
            Kind::Keypad(character) => Some(character),
            Kind::Arrow | Kind::Function => None,
        }
    }
}
