//! What the machine shows around its screens: labels, lights, and the text of the message line.

use crate::port::{Effect, Label};
use std::fmt;

/// Characters over one dial or key.
const LABEL: usize = Label::Key(1).width();
/// Characters of the strip over the twelve function keys.
const STRIP: usize = Label::Strip.width();

/// Labels over dials and keys, lights of the buttons, and the message line.
///
/// The labels of the function keys are parts of one strip, which FLABEL0 writes as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Panel {
    dials: [[u8; LABEL]; 8],
    strip: [u8; STRIP],
    /// Whether the strip was last written as a whole.
    is_whole: bool,
    /// Bit n-1 is the light of button n.
    lights: u32,
    message: Vec<u8>,
}

impl Default for Panel {
    fn default() -> Panel {
        Panel { dials: [[b' '; LABEL]; 8], strip: [b' '; STRIP], is_whole: false, lights: 0, message: Vec::new() }
    }
}

impl Panel {
    /// The text of a label without blanks at its end; empty if it is blank, or there is no such label.
    pub fn label(&self, label: Label) -> &[u8] {
        let index = |n: u8| usize::from(n).wrapping_sub(1);
        let text = match label {
            Label::Dial(n) => self.dials.get(index(n)).map(|text| &text[..]),
            Label::Key(n) => self.strip.chunks(LABEL).nth(index(n)),
            Label::Strip => Some(&self.strip[..]),
        };
        text.unwrap_or(&[]).trim_ascii_end()
    }

    fn label_mut(&mut self, label: Label) -> &mut [u8] {
        let index = |n: u8| usize::from(n).wrapping_sub(1);
        match label {
            Label::Dial(n) => self.dials.get_mut(index(n)).map_or(&mut [], |text| &mut text[..]),
            Label::Key(n) => self.strip.chunks_mut(LABEL).nth(index(n)).unwrap_or(&mut []),
            Label::Strip => &mut self.strip,
        }
    }

    /// Whether the light of a button (1..=32) is on.
    pub fn light(&self, button: u8) -> bool {
        (1..=32).contains(&button) && self.lights >> (button - 1) & 1 == 1
    }

    /// The message line.
    pub fn message(&self) -> &[u8] {
        &self.message
    }

    /// Carries out an effect that changes the panel; others change nothing.
    pub(super) fn carry(&mut self, effect: Effect) {
        match effect {
            Effect::Label { label, text } => {
                if !matches!(label, Label::Dial(_)) {
                    self.is_whole = label == Label::Strip;
                }
                let place = self.label_mut(label);
                place.fill(b' ');
                place.iter_mut().zip(&*text).for_each(|(place, character)| *place = *character);
            }
            Effect::ClearLabels => {
                self.dials = [[b' '; LABEL]; 8];
                self.strip = [b' '; STRIP];
            }
            Effect::Light { button: 0, on } => self.lights = if on { u32::MAX } else { 0 },
            Effect::Light { button, on } => {
                let bit = 1_u32.checked_shl(u32::from(button) - 1).unwrap_or(0);
                self.lights = if on { self.lights | bit } else { self.lights & !bit };
            }
            Effect::Message(text) => self.message = text.into_vec(),
            _ => {}
        }
    }
}

impl fmt::Display for Panel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let dials = (1..=8).map(|n| (format!("dial {n}"), self.label(Label::Dial(n))));
        let keys = (1..=12).map(|n| (format!("key {n}"), self.label(Label::Key(n)))).filter(|_| !self.is_whole);
        let strip = self.is_whole.then(|| ("keys".to_string(), self.label(Label::Strip)));
        for (place, text) in dials.chain(keys).chain(strip).filter(|(_, text)| !text.is_empty()) {
            writeln!(f, "{place}: {}", String::from_utf8_lossy(text))?;
        }
        let lit: Vec<String> = (1..=32).filter(|b| self.light(*b)).map(|b| b.to_string()).collect();
        writeln!(f, "lights: {}", lit.join(" "))?;
        write!(f, "message: {}", String::from_utf8_lossy(&self.message))
    }
}
