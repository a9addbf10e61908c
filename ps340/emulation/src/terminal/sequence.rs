//! Control sequences out of bytes, however these are cut, and whatever they are.
//!
//! # Source
//! ANSI X3.64: `ESC`, intermediate bytes 32 to 47, a final byte; `ESC [`, parameters 48 to 63, intermediate bytes, a
//! final byte 64 to 126; `ESC P ] ^ _` begin strings, which end with `ESC \` or BEL. As on a VT100, control characters
//! act inside sequences, CAN and SUB end one, and ESC begins another.

/// Parameters that a sequence keeps; more are dropped.
const MAX_PARAMETERS: usize = 16;
/// Largest parameter; larger ones count as this.
const MAX_PARAMETER: u16 = 9999;

const BEL: u8 = 7;
const CAN: u8 = 24;
const SUB: u8 = 26;
const ESC: u8 = 27;
const DEL: u8 = 127;

/// What a byte completes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Action {
    /// Nothing yet.
    Nothing,
    /// A character, 32 to 126, or above 127.
    Print(u8),
    /// A control character below 32.
    Control(u8),
    /// `ESC`, an intermediate byte if any, and a final byte.
    Escape(Option<u8>, u8),
    /// A control sequence.
    Sequence(Sequence),
}

/// A control sequence: `ESC [` ...
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Sequence {
    /// One of `<=>?` before the parameters.
    pub(super) private: Option<u8>,
    /// The parameters; an empty one is 0.
    pub(super) parameters: Vec<u16>,
    /// The byte before the final one.
    pub(super) intermediate: Option<u8>,
    /// What it does.
    pub(super) last: u8,
}

impl Sequence {
    /// A parameter by its index from 0; `default` if it is missing or 0.
    pub(super) fn or(&self, place: usize, default: u16) -> usize {
        let given = self.parameters.get(place).copied().filter(|p| *p != 0);
        usize::from(given.unwrap_or(default))
    }

    /// The first parameter as a choice; 0 if it is missing.
    pub(super) fn choice(&self) -> u16 {
        self.parameters.first().copied().unwrap_or(0)
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Ground,
    Escape,
    Sequence,
    /// A sequence that makes no sense, up to its end.
    Broken,
    Text,
    /// ESC inside a string.
    TextEscape,
}

/// The reader of sequences.
#[derive(Debug, Default)]
pub(super) struct Sequences {
    state: State,
    intermediate: Option<u8>,
    sequence: Sequence,
}

impl Sequences {
    /// Takes one byte.
    pub(super) fn push(&mut self, byte: u8) -> Action {
        match (self.state, byte) {
            (_, CAN | SUB) => self.end(Action::Control(byte)),
            (State::Text | State::TextEscape, _) => self.inside_text(byte),
            (_, ESC) => {
                self.state = State::Escape;
                self.intermediate = None;
                Action::Nothing
            }
            (_, 0..32) => Action::Control(byte),
            (_, DEL) => Action::Nothing,
            (State::Ground, _) => Action::Print(byte),
            (State::Escape, _) => self.after_escape(byte),
            (State::Sequence, _) => self.inside_sequence(byte),
            (State::Broken, 64..=126) => self.end(Action::Nothing),
            (State::Broken, _) => Action::Nothing,
        }
    }

    fn end(&mut self, action: Action) -> Action {
        self.state = State::Ground;
        action
    }

    fn inside_text(&mut self, byte: u8) -> Action {
        match (self.state, byte) {
            (_, BEL) | (State::TextEscape, b'\\') => self.end(Action::Nothing),
            (_, ESC) => {
                self.state = State::TextEscape;
                Action::Nothing
            }
            // Another sequence began without an end of the string.
            (State::TextEscape, _) => {
                self.state = State::Escape;
                self.intermediate = None;
                self.push(byte)
            }
            _ => Action::Nothing,
        }
    }

    fn after_escape(&mut self, byte: u8) -> Action {
        match byte {
            b'[' if self.intermediate.is_none() => {
                self.state = State::Sequence;
                self.sequence = Sequence::default();
                Action::Nothing
            }
            b'P' | b']' | b'^' | b'_' if self.intermediate.is_none() => {
                self.state = State::Text;
                Action::Nothing
            }
            32..48 => {
                self.intermediate = Some(byte);
                Action::Nothing
            }
            48..=126 => {
                let intermediate = self.intermediate.take();
                self.end(Action::Escape(intermediate, byte))
            }
            _ => self.end(Action::Nothing),
        }
    }

    fn inside_sequence(&mut self, byte: u8) -> Action {
        let Sequence { private, parameters, intermediate, last } = &mut self.sequence;
        match byte {
            b'0'..=b'9' if intermediate.is_none() => {
                if parameters.is_empty() {
                    parameters.push(0);
                }
                if let Some(parameter) = parameters.last_mut() {
                    *parameter = parameter.saturating_mul(10).saturating_add(u16::from(byte - b'0')).min(MAX_PARAMETER);
                }
            }
            b';' if intermediate.is_none() => {
                if parameters.is_empty() {
                    parameters.push(0);
                }
                if parameters.len() < MAX_PARAMETERS {
                    parameters.push(0);
                }
            }
            b'<'..=b'?' if intermediate.is_none() && parameters.is_empty() && private.is_none() => {
                *private = Some(byte);
            }
            32..48 => *intermediate = Some(byte),
            64..=126 => {
                *last = byte;
                let sequence = std::mem::take(&mut self.sequence);
                return self.end(Action::Sequence(sequence));
            }
            _ => self.state = State::Broken,
        }
        Action::Nothing
    }
}
