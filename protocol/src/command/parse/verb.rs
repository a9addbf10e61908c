//! Commands that define nothing: display, editing of structures, names.

use super::Parser;
use crate::{
    Name,
    command::{
        error::{Fault, Problem},
        syntax::{Command, Initialize, NamePattern, Object},
        token::{Lexer, Token, TokenKind},
        words::{self, Word},
    },
};

impl Parser<'_> {
    /// One command, up to its `;` or to what follows a word such as BEGIN_STRUCTURE.
    pub(super) fn command(&mut self) -> Result<Command, Fault> {
        let first = self.token;
        self.any_command().map_err(|fault| self.misnamed(first, &fault).unwrap_or(fault))
    }

    /// What is wrong with a definition whose name cannot be one (`A-B := ...`), or whose sign is not `:=`; none if the
    /// statement is no such definition.
    ///
    /// - `first`: the first token.
    /// - `fault`: what was found to be wrong.
    fn misnamed(&mut self, first: Token, fault: &Fault) -> Option<Fault> {
        self.jump(first.start);
        let rest = &self.lexer.text()[first.start..];
        let ends = |at: &usize| rest[*at] <= b' ' || rest[*at..].starts_with(b":=") || b"';{".contains(&rest[*at]);
        let length = (0..rest.len()).find(ends).unwrap_or(rest.len());
        let assigned = Lexer::new(rest, length).token().kind == TokenKind::Assign;
        if let Some(why) = Name::new(&rest[..length]).err().filter(|_| assigned) {
            return Some(Fault { span: first.start..first.start + length, problem: why.into(), expected: &[] });
        }
        let next = self.ahead();
        let unread = fault.span == first.span() && first.kind == TokenKind::Name;
        let nearly = unread && matches!(next.kind, TokenKind::Equal | TokenKind::Colon);
        nearly.then(|| Fault { span: next.span(), problem: Problem::Unexpected, expected: &["`:=`"] })
    }

    fn any_command(&mut self) -> Result<Command, Fault> {
        match (self.token.kind, self.ahead().kind) {
            (TokenKind::Name, TokenKind::Assign) => {
                let name = self.name()?;
                self.advance();
                let object = self.definition()?;
                return Ok(Command::Define { name: Some(name), object });
            }
            (TokenKind::Name, TokenKind::OpenBracket) if self.is(Word::CodeOfCharacter) => {
                return self.font_character().map(Command::FontCharacter);
            }
            (TokenKind::Name, TokenKind::Name) if self.accept_word(Word::Pattern) => return self.pattern_with(),
            (TokenKind::Bang, _) => {
                self.advance();
                self.expect_word(Word::Reset, &["RESET"])?;
                return Ok(Command::Reset);
            }
            _ => {}
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
            Word::EndFont => Command::EndFont,
            Word::Begin => Command::Begin,
            Word::End if self.accept_word(Word::Optimize) => Command::EndOptimize,
            Word::End => Command::End,
            Word::Display => Command::Display(self.name()?),
            Word::Forget => self.forget()?,
            Word::Remove => self.remove()?,
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
            Word::Prefix | Word::Follow => self.insertion(word)?,
            Word::Erase => {
                self.expect_word(Word::Pattern, &["PATTERN"])?;
                self.skip_before_name(Word::From);
                Command::ErasePattern(self.name()?)
            }
            Word::Connect => self.connect()?,
            Word::Disconnect => self.disconnect()?,
            Word::Send => self.send()?,
            Word::Store => self.store()?,
            Word::Variable => Command::Variable(self.names()?),
            word => self.system(word)?,
        })
    }

    /// `name` or `(unit)`
    fn forget(&mut self) -> Result<Command, Fault> {
        if !self.accept(TokenKind::Open) {
            return Ok(Command::Forget(self.name()?));
        }
        let unit = self.name()?;
        self.expect(TokenKind::Close, &["`)`"])?;
        Ok(Command::ForgetUnit(unit))
    }

    /// `name`, `name FROM name`, `PREFIX [OF] name` or `FOLLOWER [OF] name`
    fn remove(&mut self) -> Result<Command, Fault> {
        let what = self.find(&[Word::Prefix, Word::Follower]);
        let next = self.ahead();
        let from = next.kind == TokenKind::Name && Word::From.accepts(self.text(next));
        let Some(word) = what.filter(|_| next.kind == TokenKind::Name && !from) else {
            let name = self.name()?;
            if self.token.kind != TokenKind::Name {
                return Ok(Command::Remove(name));
            }
            self.expect_word(Word::From, &["FROM", "`;`"])?;
            return Ok(Command::RemoveFrom { name, from: self.name()? });
        };
        self.advance();
        self.skip_before_name(Word::Of);
        let name = self.name()?;
        Ok(if word == Word::Prefix { Command::RemovePrefix(name) } else { Command::RemoveFollower(name) })
    }

    /// `name WITH operate`, of PREFIX and FOLLOW.
    fn insertion(&mut self, word: Word) -> Result<Command, Fault> {
        const EXPECTED: &[&str] = &["an operate command (such as ROTATE)"];
        let name = self.name()?;
        self.expect_word(Word::With, &["WITH"])?;
        let first = self.token;
        let object = self.object()?.ok_or_else(|| self.fail(EXPECTED))?;
        match object {
            Object::Operate { operate, applied_to: None } if word == Word::Prefix => {
                Ok(Command::Prefix { name, operate })
            }
            Object::Operate { operate, applied_to: None } => Ok(Command::Follow { name, operate }),
            Object::Operate { .. } => {
                self.jump(first.start);
                Err(self.fail(&["an operate command without APPLIED TO"]))
            }
            _ => {
                self.jump(first.start);
                Err(self.fail(EXPECTED))
            }
        }
    }

    /// `name WITH pattern`, after PATTERN.
    fn pattern_with(&mut self) -> Result<Command, Fault> {
        let name = self.name()?;
        self.expect_word(Word::With, &["WITH"])?;
        Ok(Command::PatternWith { name, pattern: self.name()? })
    }

    /// Names, or prefixes with a `*` directly after them.
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
}
