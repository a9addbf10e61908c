//! The set-up page of the terminal: features that a person flips with digits.
//!
//! The keyboard had a SETUP key \[M\]; what its page held is not known. The features are ours.

use super::Modes;
use std::fmt::Write;

struct Feature {
    digit: u8,
    name: &'static str,
    of: fn(&mut Modes) -> &mut bool,
}

const FEATURES: &[Feature] = &[
    Feature { digit: b'1', name: "wrap at the last column", of: |m| &mut m.wrap },
    Feature { digit: b'2', name: "new line: line feed returns too", of: |m| &mut m.new_line },
    Feature { digit: b'3', name: "local echo", of: |m| &mut m.local_echo },
    Feature { digit: b'4', name: "cursor visible", of: |m| &mut m.cursor_visible },
    Feature { digit: b'5', name: "application cursor keys", of: |m| &mut m.application_cursor },
    Feature { digit: b'6', name: "application keypad", of: |m| &mut m.application_keypad },
    Feature { digit: b'7', name: "framed screen", of: |m| &mut m.reverse_screen },
];

/// The page as lines of text.
pub(super) fn page(modes: &Modes) -> String {
    let mut modes = *modes;
    let mut text = String::from("SET-UP\n\n");
    for feature in FEATURES {
        let state = if *(feature.of)(&mut modes) { "on" } else { "off" };
        let _ = writeln!(text, "{}  {:<32} {state}", char::from(feature.digit), feature.name);
    }
    text.push_str("0  reset the terminal\n\nSETUP leaves this page.\n");
    text
}

/// Flips the feature of a digit; other characters do nothing.
pub(super) fn flip(modes: &mut Modes, digit: u8) {
    if let Some(feature) = FEATURES.iter().find(|f| f.digit == digit) {
        let state = (feature.of)(modes);
        *state = !*state;
    }
}
