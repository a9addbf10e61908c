//! What the machine shows around its screens: labels, lights, message line, terminal text.

use crate::port::{Effect, Label};
use std::{collections::BTreeMap, fmt};

/// Bytes of terminal text that are kept, the latest ones.
const TERMINAL_BYTES: usize = 64 << 10;

/// Labels over dials and keys, lights of the buttons, the message line and the text of the terminal emulator.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Panel {
    labels: BTreeMap<Label, Vec<u8>>,
    /// Bit n-1 is the light of button n.
    lights: u32,
    message: Vec<u8>,
    terminal: Vec<u8>,
}

impl Panel {
    /// The text of a label; empty if it is blank.
    pub fn label(&self, label: Label) -> &[u8] {
        self.labels.get(&label).map_or(&[], Vec::as_slice)
    }

    /// Whether the light of a button (1..=32) is on.
    pub fn light(&self, button: u8) -> bool {
        (1..=32).contains(&button) && self.lights >> (button - 1) & 1 == 1
    }

    /// The message line.
    pub fn message(&self) -> &[u8] {
        &self.message
    }

    /// What the terminal emulator was sent, the latest bytes.
    pub fn terminal(&self) -> &[u8] {
        &self.terminal
    }

    /// Carries out an effect that changes the panel; others change nothing.
    pub(super) fn carry(&mut self, effect: Effect) {
        match effect {
            Effect::Label { label, text } => {
                self.labels.insert(label, text.into_vec());
            }
            Effect::ClearLabels => self.labels.clear(),
            Effect::Light { button: 0, on } => self.lights = if on { u32::MAX } else { 0 },
            Effect::Light { button, on } => {
                let bit = 1_u32.checked_shl(u32::from(button) - 1).unwrap_or(0);
                self.lights = if on { self.lights | bit } else { self.lights & !bit };
            }
            Effect::Message(text) => self.message = text.into_vec(),
            Effect::Terminal(text) => self.type_text(&text),
            // There is no static picture yet that would have darkened the display.
            Effect::TurnOnDisplay => {}
            Effect::Deliver { .. }
            | Effect::Fault { .. }
            | Effect::Host { .. }
            | Effect::RequestTransform { .. }
            | Effect::Restart
            | Effect::ReportMemory { .. } => {}
        }
    }

    /// Adds characters to the text of the terminal emulator.
    pub(super) fn type_text(&mut self, text: &[u8]) {
        self.terminal.extend_from_slice(text);
        let excess = self.terminal.len().saturating_sub(TERMINAL_BYTES);
        self.terminal.drain(..excess);
    }
}

impl fmt::Display for Panel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (label, text) in &self.labels {
            let place = match label {
                Label::Dial(n) => format!("dial {n}"),
                Label::Key(n) => format!("key {n}"),
                Label::Strip => "keys".to_string(),
            };
            writeln!(f, "{place}: {}", String::from_utf8_lossy(text))?;
        }
        let lit: Vec<String> = (1..=32).filter(|b| self.light(*b)).map(|b| b.to_string()).collect();
        writeln!(f, "lights: {}", lit.join(" "))?;
        write!(f, "message: {}", String::from_utf8_lossy(&self.message))
    }
}
