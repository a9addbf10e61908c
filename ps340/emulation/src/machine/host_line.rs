//! What the machine keeps for one host line: the readers of its bytes, and what is open on it.

use crate::{interpreter::Interpreter, line::LineId, memory::MassMemory};
use protocol::{
    command::{BinaryDecoder, CommandReader},
    wire::FrameDecoder,
};

/// Characters of a command that never ended that are shown.
const SHOWN_CHARACTERS: usize = 40;

/// Who gets text that arrives outside packets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum PlainText {
    /// The command interpreter. Ours, so that a line typed with `nc` is a command.
    #[default]
    Commands,
    /// The terminal emulator, as the standard configuration of the machine did.
    Terminal,
}

/// What the machine keeps for each host.
#[derive(Debug)]
pub(super) struct HostLine {
    pub(super) frames: FrameDecoder,
    pub(super) decoders: Decoders,
}

/// The readers behind the frames, one for each route.
#[derive(Debug)]
pub(super) struct Decoders {
    pub(super) line: LineId,
    pub(super) plain_text: PlainText,
    pub(super) text: CommandReader,
    pub(super) binary: BinaryDecoder,
    pub(super) interpreter: Interpreter,
}

impl HostLine {
    /// A line on which nothing has been sent.
    pub(super) fn new(line: LineId, plain_text: PlainText) -> HostLine {
        HostLine {
            frames: FrameDecoder::default(),
            decoders: Decoders {
                line,
                plain_text,
                text: CommandReader::default(),
                binary: BinaryDecoder::default(),
                interpreter: Interpreter::default(),
            },
        }
    }

    /// Everything that was begun on the line is forgotten: the machine starts again.
    pub(super) fn restart(&mut self) {
        self.decoders.interpreter = Interpreter::default();
    }

    /// What is open, for a prompt; `...` after it for a command without its `;`.
    pub(super) fn open(&self) -> String {
        let open = self.decoders.interpreter.open().unwrap_or_default();
        let unfinished = if self.decoders.text.is_unfinished() { "..." } else { "" };
        format!("{open}{unfinished}")
    }

    /// Gives up what is open. Returns what that was.
    pub(super) fn abandon(&mut self, memory: &mut MassMemory) -> Option<String> {
        let Decoders { text, interpreter, .. } = &mut self.decoders;
        let open = interpreter.abandon(memory);
        let unfinished = text.is_unfinished().then(|| {
            let begin = text.unfinished().trim_ascii().escape_ascii().map(char::from).take(SHOWN_CHARACTERS);
            format!("the command '{}'", begin.collect::<String>())
        });
        text.reset();
        open.or(unfinished)
    }
}
