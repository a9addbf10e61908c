//! What is open on one line: structures, fonts, BEGIN, configure mode.

use super::draft::Draft;
use crate::memory::MassMemory;
use protocol::{Name, command::FontCharacter};
use std::collections::BTreeMap;

/// How deep BEGIN may nest. Ours.
pub const MAX_BEGINS: u32 = 1000;

/// The command interpreter of one line: it holds what is open there.
#[derive(Debug, Default)]
pub struct Interpreter {
    pub(super) structure: Option<Draft>,
    pub(super) font: Option<FontDraft>,
    /// How many BEGIN wait for their END.
    pub(super) begun: u32,
    /// Between OPTIMIZE STRUCTURE and END OPTIMIZE. Nothing is built in another way there.
    pub(super) optimizing: bool,
    /// Between CONFIGURE and FINISH CONFIGURATION.
    pub(super) privileged: bool,
}

/// A font between BEGIN_FONT and END_FONT.
#[derive(Debug)]
pub(super) struct FontDraft {
    pub(super) name: Option<Name>,
    pub(super) characters: BTreeMap<u8, FontCharacter>,
}

impl Interpreter {
    /// Gives up what is open, as when the line closes. Returns what that was, if anything.
    pub fn abandon(&mut self, memory: &mut MassMemory) -> Option<String> {
        let font = self.font.take().map(|font| font.name.map_or_else(|| "BEGIN_FONT".into(), |name| name.to_string()));
        let structure = self.structure.take().map(|draft| draft.title());
        let begun = std::mem::take(&mut self.begun);
        if begun > 0 {
            memory.structures.release();
        }
        self.optimizing = false;
        structure.or(font).or((begun > 0).then(|| "BEGIN".into()))
    }
}
