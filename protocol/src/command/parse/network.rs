//! Function instances, connections and messages.

use super::Parser;
use crate::command::{
    error::Fault,
    syntax::{Arc, Command, Destination, Object},
    token::TokenKind,
    words::Word,
};

/// One more than the largest number of an output, and of a family such as ROUTE(n).
const NUMBERS: i64 = u16::MAX as i64 + 1;

impl Parser<'_> {
    /// `F:type` or `F:type(n)`, from the `F` on.
    pub(super) fn function(&mut self) -> Result<Object, Fault> {
        self.advance();
        self.expect(TokenKind::Colon, &["`:`"])?;
        let function = self.name()?;
        let size = if self.accept(TokenKind::Open) {
            let size = self.integer(0..NUMBERS)? as u16;
            self.expect(TokenKind::Close, &["`)`"])?;
            Some(size)
        } else {
            None
        };
        Ok(Object::Function { function, size })
    }

    /// `<i>`, an output.
    fn output(&mut self) -> Result<u16, Fault> {
        self.expect(TokenKind::Less, &["`<`"])?;
        let output = self.integer(1..NUMBERS)? as u16;
        self.expect(TokenKind::Greater, &["`>`"])?;
        Ok(output)
    }

    /// `<j>name`
    fn destination(&mut self) -> Result<Destination, Fault> {
        Ok(Destination { input: self.input()?, name: self.name()? })
    }

    /// `name1<i>:<j>name2`
    pub(super) fn connect(&mut self) -> Result<Command, Fault> {
        let source = self.name()?;
        let output = self.output()?;
        self.expect(TokenKind::Colon, &["`:`"])?;
        Ok(Command::Connect(Arc { source, output, destination: self.destination()? }))
    }

    /// `name1[<i>][:<j>name2]` or `name1:ALL`
    pub(super) fn disconnect(&mut self) -> Result<Command, Fault> {
        let source = self.name()?;
        let output = if self.token.kind == TokenKind::Less { Some(self.output()?) } else { None };
        let destination = if !self.accept(TokenKind::Colon) || self.accept_word(Word::All) {
            None
        } else if self.token.kind == TokenKind::Less {
            Some(self.destination()?)
        } else {
            return Err(self.fail(&["`<`", "ALL"]));
        };
        Ok(Command::Disconnect { source, output, destination })
    }

    /// `value TO <j>name`
    pub(super) fn send(&mut self) -> Result<Command, Fault> {
        let value = self.value()?;
        self.accept_word(Word::To);
        if self.token.kind != TokenKind::Less {
            return Err(self.fail(&["TO", "`<`"]));
        }
        Ok(Command::Send { value, destination: self.destination()? })
    }
}
