//! Function instances, connections and messages.

use super::Parser;
use crate::command::{
    error::Fault,
    syntax::{Arc, Command, Destination, Input, Object},
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
        self.expect(TokenKind::Less, &["an output such as `<1>`"])?;
        let output = self.integer(1..NUMBERS)? as u16;
        self.expect(TokenKind::Greater, &["`>`"])?;
        Ok(output)
    }

    /// `<j>name`
    pub(super) fn destination(&mut self) -> Result<Destination, Fault> {
        Ok(Destination { input: self.input()?, name: self.name()? })
    }

    /// `name1<i>:<j>name2[,<k>name3...]`
    pub(super) fn connect(&mut self) -> Result<Command, Fault> {
        let source = self.name()?;
        let output = self.output()?;
        self.expect(TokenKind::Colon, &["`:`"])?;
        let destination = self.destination()?;
        if self.token.kind != TokenKind::Comma {
            return Ok(Command::Connect(Arc { source, output, destination }));
        }
        let mut destinations = vec![destination];
        while self.accept(TokenKind::Comma) {
            destinations.push(self.destination()?);
        }
        Ok(Command::ConnectSeveral { source, output, destinations })
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
            return Err(self.fail(&["an input such as `<1>`", "ALL"]));
        };
        Ok(Command::Disconnect { source, output, destination })
    }

    /// `value TO <j>name`, `VALUE(name) TO ...`, `VL(name) TO ...` or `number*P TO ...`
    pub(super) fn send(&mut self) -> Result<Command, Fault> {
        if let Some(variable) = self.call(Word::VariableValue)? {
            return Ok(Command::SendVariable { variable, destination: self.destination_after_to()? });
        }
        if let Some(list) = self.call(Word::ListValue)? {
            return Ok(Command::SendVectors { list, destination: self.destination_after_to()? });
        }
        if self.is_number() && self.ahead().kind == TokenKind::Star {
            let count = self.count()?;
            self.advance();
            let mark = self.expect_one_of(&[Word::PositionMark, Word::LineMark], &["P", "L"])?;
            let lines = mark == Word::LineMark;
            return Ok(Command::SendMarks { count, lines, destination: self.destination_after_to()? });
        }
        Ok(Command::Send { value: self.value()?, destination: self.destination_after_to()? })
    }

    /// `value IN name`: SEND to input 1.
    pub(super) fn store(&mut self) -> Result<Command, Fault> {
        if let Some(variable) = self.call(Word::VariableValue)? {
            return Ok(Command::SendVariable { variable, destination: self.destination_after_in()? });
        }
        Ok(Command::Send { value: self.value()?, destination: self.destination_after_in()? })
    }

    /// `word(name)`, if it stands here.
    fn call(&mut self, word: Word) -> Result<Option<crate::Name>, Fault> {
        if !self.accept_word(word) {
            return Ok(None);
        }
        self.expect(TokenKind::Open, &["`(`"])?;
        let name = self.name()?;
        self.expect(TokenKind::Close, &["`)`"])?;
        Ok(Some(name))
    }

    /// `[TO] <j>name`
    fn destination_after_to(&mut self) -> Result<Destination, Fault> {
        if !self.accept_word(Word::To) && self.token.kind != TokenKind::Less {
            return Err(self.fail(&["TO", "an input such as `<1>`"]));
        }
        self.destination()
    }

    /// `[IN] name`
    fn destination_after_in(&mut self) -> Result<Destination, Fault> {
        self.skip_before_name(Word::In);
        Ok(Destination { input: Input::Number(1), name: self.name()? })
    }
}
