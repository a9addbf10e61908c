//! The inputs of the machine, and the settings that are chosen before.

use super::{Event, KeyboardMode, PlainText};
use crate::line::LineId;

/// What comes into the machine.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A host line opens.
    Attach(LineId),
    /// A host line opens that carries the words of the parallel interface.
    AttachParallel(LineId),
    /// Bytes from a host.
    Bytes(LineId, Vec<u8>),
    /// A host line closes.
    Detach(LineId),
    /// Something that a person does.
    Event(Event),
}

/// Settings that do not change while the machine runs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Settings {
    /// Who gets text that arrives outside packets.
    pub plain_text: PlainText,
    /// The mode of the keyboard at the start.
    pub keyboard: KeyboardMode,
}
