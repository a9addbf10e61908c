//! The parser: recursive descent over the tokens of one statement.

mod network;
mod object;
mod operate;
mod value;
mod vector_list;

use super::{
    MAX_STATEMENT,
    error::{CommandError, Fault, Problem},
    syntax::{Command, Initialize, Input, NamePattern, Object},
    token::{Lexer, Token, TokenKind},
    words::{self, Word},
};
use crate::Name;
use std::ops::Range;

/// Parses a text that is one command; the `;` at its end may be missing.
///
/// # Errors
/// [`CommandError`] with the place in `text`.
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
pub(super) struct Found {
    pub(super) command: Command,
    /// Its bytes, from its first token to its last; without the `;`.
    pub(super) span: Range<usize>,
    /// Where the next command of the same statement begins; the end of the text if there is none.
    pub(super) next: usize,
}

/// Parses the next command of a statement, from offset `at` on; none if nothing is left.
///
/// A statement holds several commands when BEGIN_STRUCTURE, which has no `;`, stands in it.
pub(super) fn next_command(text: &[u8], at: usize) -> Option<Result<Found, Fault>> {
    let mut parser = Parser::new(text, at);
    if matches!(parser.token.kind, TokenKind::Semicolon | TokenKind::End) {
        return None;
    }
    let start = parser.token.start;
    Some(parser.command().and_then(|command| {
        let span = start..parser.last_end;
        let begins = matches!(command, Command::Define { object: Object::BeginStructure, .. });
        match parser.token.kind {
            TokenKind::Semicolon | TokenKind::End => Ok(Found { command, span, next: text.len() }),
            _ if begins => Ok(Found { command, span, next: parser.token.start }),
            _ => Err(parser.fail(&["`;`"])),
        }
    }))
}

/// The tokens of one statement, with one token of sight ahead.
struct Parser<'t> {
    lexer: Lexer<'t>,
    token: Token,
    last_end: usize,
}

impl<'t> Parser<'t> {
    fn new(text: &'t [u8], at: usize) -> Self {
        let mut lexer = Lexer::new(text, at);
        let token = lexer.token();
        Parser { lexer, token, last_end: at }
    }

    /// Takes the current token.
    fn advance(&mut self) -> Token {
        self.last_end = self.token.end;
        std::mem::replace(&mut self.token, self.lexer.token())
    }

    /// Continues at offset `at` of the text.
    fn jump(&mut self, at: usize) {
        self.last_end = at;
        self.lexer = Lexer::new(self.lexer.text(), at);
        self.token = self.lexer.token();
    }

    /// The token after the current one.
    fn ahead(&self) -> TokenKind {
        { self.lexer }.token().kind
    }

    fn text(&self, token: Token) -> &'t [u8] {
        &self.lexer.text()[token.span()]
    }

    /// The fault that the current token is not what was expected.
    fn fail(&self, expected: &'static [&'static str]) -> Fault {
        let problem = match self.token.kind {
            TokenKind::Bad(problem) => problem,
            _ => Problem::Unexpected,
        };
        Fault { span: self.token.span(), problem, expected }
    }

    fn accept(&mut self, kind: TokenKind) -> bool {
        let found = self.token.kind == kind;
        if found {
            self.advance();
        }
        found
    }

    fn expect(&mut self, kind: TokenKind, expected: &'static [&'static str]) -> Result<(), Fault> {
        if self.accept(kind) { Ok(()) } else { Err(self.fail(expected)) }
    }

    /// Whether the current token is a word.
    fn is(&self, word: Word) -> bool {
        self.token.kind == TokenKind::Name && word.accepts(self.text(self.token))
    }

    fn accept_word(&mut self, word: Word) -> bool {
        let found = self.is(word);
        if found {
            self.advance();
        }
        found
    }

    fn expect_word(&mut self, word: Word, expected: &'static [&'static str]) -> Result<(), Fault> {
        if self.accept_word(word) { Ok(()) } else { Err(self.fail(expected)) }
    }

    /// Takes the current token if it is one of some words.
    fn accept_one_of(&mut self, words: &[Word]) -> Option<Word> {
        if self.token.kind != TokenKind::Name {
            return None;
        }
        let word = Word::find(words, self.text(self.token))?;
        self.advance();
        Some(word)
    }

    /// Skips a word without meaning before a name; it is itself the name if none follows.
    fn skip_before_name(&mut self, word: Word) {
        if self.is(word) && matches!(self.ahead(), TokenKind::Name | TokenKind::Less) {
            self.advance();
        }
    }

    fn name(&mut self) -> Result<Name, Fault> {
        if self.token.kind != TokenKind::Name {
            return Err(self.fail(&["a name"]));
        }
        match Name::new(self.text(self.token)) {
            Ok(name) => {
                self.advance();
                Ok(name)
            }
            Err(why) => Err(Fault { span: self.token.span(), problem: why.into(), expected: &[] }),
        }
    }

    /// Names with commas between them; a comma may follow the last.
    fn names(&mut self) -> Result<Vec<Name>, Fault> {
        let mut names = vec![self.name()?];
        while self.accept(TokenKind::Comma) && self.token.kind == TokenKind::Name {
            names.push(self.name()?);
        }
        Ok(names)
    }

    fn real(&mut self) -> Result<f64, Fault> {
        let TokenKind::Number(decimal) = self.token.kind else {
            return Err(self.fail(&["a number"]));
        };
        match decimal.to_f64(self.text(self.token)) {
            Some(real) => {
                self.advance();
                Ok(real)
            }
            None => Err(Fault { span: self.token.span(), problem: Problem::OutOfRange, expected: &[] }),
        }
    }

    /// `N` numbers; commas between them may be missing.
    fn reals<const N: usize>(&mut self) -> Result<[f64; N], Fault> {
        let mut reals = [0.0; N];
        for (index, real) in reals.iter_mut().enumerate() {
            if index > 0 {
                self.accept(TokenKind::Comma);
            }
            *real = self.real()?;
        }
        Ok(reals)
    }

    /// Up to three numbers, and how many there were.
    fn up_to_three(&mut self) -> Result<([f64; 3], usize), Fault> {
        let mut reals = [self.real()?, 0.0, 0.0];
        for count in 1..3 {
            let comma = self.accept(TokenKind::Comma);
            if !comma && !matches!(self.token.kind, TokenKind::Number(_)) {
                return Ok((reals, count));
            }
            reals[count] = self.real()?;
        }
        Ok((reals, 3))
    }

    /// `lo:hi`
    fn range(&mut self) -> Result<[f64; 2], Fault> {
        let low = self.real()?;
        self.expect(TokenKind::Colon, &["`:`"])?;
        Ok([low, self.real()?])
    }

    /// A whole number in a range.
    fn integer(&mut self, range: Range<i64>) -> Result<i64, Fault> {
        let TokenKind::Number(decimal) = self.token.kind else {
            return Err(self.fail(&["a whole number"]));
        };
        if !decimal.is_whole() {
            return Err(self.fail(&["a whole number"]));
        }
        match decimal.to_integer().filter(|integer| range.contains(integer)) {
            Some(integer) => {
                self.advance();
                Ok(integer)
            }
            None => Err(Fault { span: self.token.span(), problem: Problem::OutOfRange, expected: &[] }),
        }
    }

    /// `ON` or `OFF`
    fn on_or_off(&mut self) -> Result<bool, Fault> {
        match self.accept_one_of(&[Word::On, Word::Off]) {
            Some(word) => Ok(word == Word::On),
            None => Err(self.fail(&["ON", "OFF"])),
        }
    }

    /// One command, up to its `;` or to what follows BEGIN_STRUCTURE.
    fn command(&mut self) -> Result<Command, Fault> {
        if self.token.kind == TokenKind::Name && self.ahead() == TokenKind::Assign {
            let name = self.name()?;
            self.advance();
            let object = self.object()?.ok_or_else(|| self.fail(&["what the name is to be (such as VECTOR_LIST)"]))?;
            return Ok(Command::Define { name: Some(name), object });
        }
        if let Some(word) = self.accept_one_of(words::COMMANDS) {
            return self.verb(word);
        }
        match self.object()? {
            Some(object) => Ok(Command::Define { name: None, object }),
            None => Err(self.fail(&["a command", "`name :=`"])),
        }
    }

    /// The command whose first word was just taken.
    fn verb(&mut self, word: Word) -> Result<Command, Fault> {
        Ok(match word {
            Word::EndStructure => Command::EndStructure,
            Word::Display => Command::Display(self.name()?),
            Word::Forget => Command::Forget(self.name()?),
            Word::Remove => {
                let name = self.name()?;
                if self.token.kind != TokenKind::Name {
                    return Ok(Command::Remove(name));
                }
                self.expect_word(Word::From, &["FROM", "`;`"])?;
                Command::RemoveFrom { name, from: self.name()? }
            }
            Word::Include => {
                let name = self.name()?;
                self.skip_before_name(Word::In);
                Command::Include { name, into: self.name()? }
            }
            Word::Delete => Command::Delete(self.patterns()?),
            Word::Initialize => {
                let what = self.accept_one_of(words::INITIALIZE);
                Command::Initialize(match what {
                    Some(Word::Connections) => Initialize::Connections,
                    Some(Word::Displays) => Initialize::Displays,
                    Some(_) => Initialize::Names,
                    None => Initialize::All,
                })
            }
            Word::Connect => self.connect()?,
            Word::Disconnect => self.disconnect()?,
            _ => self.send()?,
        })
    }

    /// Names, or prefixes with a `*` directly behind them.
    fn patterns(&mut self) -> Result<Vec<NamePattern>, Fault> {
        let mut patterns = Vec::new();
        loop {
            if self.accept(TokenKind::Star) {
                patterns.push(NamePattern::Prefix(String::new()));
            } else {
                let end = self.token.end;
                let name = self.name()?;
                if self.token.kind == TokenKind::Star && self.token.start == end {
                    self.advance();
                    patterns.push(NamePattern::Prefix(name.as_str().to_owned()));
                } else {
                    patterns.push(NamePattern::Name(name));
                }
            }
            if !self.accept(TokenKind::Comma) {
                return Ok(patterns);
            }
        }
    }

    /// `<i>`
    fn input(&mut self) -> Result<Input, Fault> {
        const EXPECTED: &[&str] =
            &["the number of an input", "append, delete, clear, step, position, last, substitute"];
        self.expect(TokenKind::Less, &["`<`"])?;
        let input = match self.token.kind {
            TokenKind::Number(_) => Input::Number(self.integer(1..i64::from(u32::MAX) + 1)? as u32),
            TokenKind::Name => {
                let text = self.text(self.token);
                let row = Input::WORDS.iter().find(|row| row.1.as_bytes().eq_ignore_ascii_case(text));
                let input = row.ok_or_else(|| self.fail(EXPECTED))?.0;
                self.advance();
                input
            }
            _ => return Err(self.fail(EXPECTED)),
        };
        self.expect(TokenKind::Greater, &["`>`"])?;
        Ok(input)
    }
}

#[cfg(test)]
mod tests;
