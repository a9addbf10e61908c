//! The parser: recursive descent over the tokens of one statement.

pub(super) mod cursor;
mod curve;
pub(super) mod field;
mod network;
mod object;
mod polygon;
mod system;
mod value;
mod vector_list;
mod verb;

use super::{
    MAX_STATEMENT,
    error::{CommandError, Fault, Problem},
    syntax::{Command, Object},
    token::TokenKind,
};
use cursor::Parser;
use std::ops::Range;
pub(super) use system::is_plain_value;

/// Parses a text that is one command; the `;` at its end may be missing. What a
/// [`CommandReader`](super::CommandReader) would warn of is left out.
///
/// # Errors
/// [`CommandError`] with the position in `text`.
pub fn parse(text: &[u8]) -> Result<Command, CommandError> {
    whole(text).map_err(|fault| CommandError::new(text, fault))
}

fn whole(text: &[u8]) -> Result<Command, Fault> {
    if text.len() > MAX_STATEMENT {
        return Err(Fault { span: MAX_STATEMENT..MAX_STATEMENT + 1, problem: Problem::LongStatement, expected: &[] });
    }
    let mut parser = Parser::new(text, 0);
    let command = parser.command()?;
    parser.accept(TokenKind::Semicolon);
    if parser.token.kind == TokenKind::End { Ok(command) } else { Err(parser.fail(&["the end"])) }
}

/// What [`next_command`] found.
pub(super) struct ParsedCommand {
    pub(super) command: Command,
    /// Its bytes, from its first token to its last; without the `;`.
    pub(super) span: Range<usize>,
    /// What was left out of it.
    pub(super) warnings: Vec<Fault>,
    /// Where the next command of the same statement begins; the end of the text if there is none.
    pub(super) next: usize,
}

/// Parses the next command of a statement, from offset `at` on; none if nothing is left.
///
/// A statement holds several commands when a word that opens a bracket (BEGIN, BEGIN_STRUCTURE, BEGIN_FONT) stands in
/// it, which needs no `;`.
pub(super) fn next_command(text: &[u8], at: usize) -> Option<Result<ParsedCommand, Fault>> {
    let mut parser = Parser::new(text, at);
    if Parser::ends(parser.token.kind) {
        return None;
    }
    let start = parser.token.start;
    Some(parser.command().and_then(|command| {
        let span = start..parser.last_end;
        let begins = matches!(
            command,
            Command::Begin | Command::Define { object: Object::BeginStructure | Object::BeginFont, .. }
        );
        let next = match parser.token.kind {
            kind if Parser::ends(kind) => text.len(),
            _ if begins => parser.token.start,
            _ => return Err(parser.fail(&["`;`"])),
        };
        Ok(ParsedCommand { command, span, warnings: std::mem::take(&mut parser.warnings), next })
    }))
}

#[cfg(test)]
mod tests;
