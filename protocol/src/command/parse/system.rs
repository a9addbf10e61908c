//! Commands to the system: optimising, set-up, passwords, diagnosis.

use super::{Parser, field::NUMBERS};
use crate::{
    Name,
    command::{
        MAX_TEXT,
        error::{Fault, Problem},
        syntax::Command,
        token::{TokenKind, unquoted},
        words::{self, Word},
    },
};

impl Parser<'_> {
    /// The command to the system whose first word was just taken.
    pub(super) fn system(&mut self, word: Word) -> Result<Command, Fault> {
        Ok(match word {
            Word::Optimize => match self.expect_one_of(&[Word::Structure, Word::Memory], &["STRUCTURE", "MEMORY"])? {
                Word::Structure => Command::OptimizeStructure,
                _ => Command::OptimizeMemory,
            },
            Word::ReserveWorkingStorage => Command::ReserveWorkingStorage(self.integer(0..NUMBERS)? as u32),
            Word::Setup => match self.expect_one_of(words::SETUP, &["CNESS", "PASSWORD", "INTERFACE"])? {
                Word::Cness => {
                    let word = self.expect_one_of(&[Word::True, Word::False], &["TRUE", "FALSE"])?;
                    Command::SetupCness { constant: word == Word::True, destination: self.destination()? }
                }
                Word::Password => Command::SetupPassword(self.name()?),
                _ => self.setup_interface()?,
            },
            Word::Show => match self.expect_one_of(words::SHOW, &["INTERFACE", "INTERRUPTS"])? {
                Word::Interface => Command::ShowInterface(self.name()?),
                _ => Command::ShowInterrupts,
            },
            Word::Command => {
                self.expect_word(Word::Status, &["STATUS"])?;
                Command::CommandStatus
            }
            Word::Configure => Command::Configure(self.name()?),
            Word::Finish => {
                self.expect_word(Word::Configuration, &["CONFIGURATION"])?;
                Command::FinishConfiguration
            }
            Word::Reboot => Command::Reboot(self.name()?),
            Word::GiveUpCpu => Command::GiveUpCpu,
            _ => Command::AllowVecnorm,
        })
    }

    /// `port/option[=value]...`
    fn setup_interface(&mut self) -> Result<Command, Fault> {
        let port = self.name()?;
        let mut options = Vec::new();
        while self.accept(TokenKind::Slash) {
            let option = self.name()?;
            let value = if self.accept(TokenKind::Equal) { self.option_value()? } else { String::new() };
            options.push((option, value));
        }
        Ok(Command::SetupInterface { port, options })
    }

    /// A word, a number or a text.
    fn option_value(&mut self) -> Result<String, Fault> {
        let text = match self.token.kind {
            TokenKind::Name => return Ok(self.name()?.as_str().to_owned()),
            TokenKind::Number(_) => self.text(self.token).to_vec(),
            TokenKind::String => self.quoted(),
            _ => return Err(self.fail(&["a word", "a number", "a text in quotes"])),
        };
        let text = String::from_utf8(text).map_err(|_| self.refuse(Problem::BadCharacter))?;
        self.advance();
        Ok(text)
    }

    /// The bytes of the text in quotes that stands here; what is too much is cut off.
    pub(super) fn quoted(&mut self) -> Vec<u8> {
        let mut text = unquoted(self.text(self.token)).into_vec();
        if text.len() > MAX_TEXT {
            text.truncate(MAX_TEXT);
            self.warnings.push(self.refuse(Problem::LongString));
        }
        text
    }
}

/// Whether a value of an option can stand without quotes and reads back as it is.
pub(in crate::command) fn is_plain_value(value: &str) -> bool {
    let digits = !value.is_empty() && value.bytes().all(|b| b.is_ascii_digit());
    digits || Name::new(value).is_ok_and(|name| name.as_str() == value)
}
