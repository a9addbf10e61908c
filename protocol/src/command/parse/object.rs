//! Definitions: what a name can be.

use super::Parser;
use crate::command::{
    error::Fault,
    syntax::{Characters, Object},
    token::TokenKind,
    words::{self, Word},
};
use glam::{DVec2, DVec3};

impl Parser<'_> {
    /// The object that is defined here; none if the current token begins none.
    pub(super) fn object(&mut self) -> Result<Option<Object>, Fault> {
        if self.is(Word::Function) && self.ahead() == TokenKind::Colon {
            return self.function().map(Some);
        }
        let Some(word) = self.accept_one_of(words::OBJECTS) else {
            return Ok(None);
        };
        Ok(Some(match word {
            Word::Nil => Object::Nil,
            Word::BeginStructure => Object::BeginStructure,
            Word::Instance => self.instance()?,
            Word::Characters => Object::Characters(self.characters()?),
            Word::VectorList => Object::VectorList(self.vector_list()?),
            word => Object::Operate { operate: self.operate(word)?, applied_to: self.applied_to()? },
        }))
    }

    /// `[OF] [name1 [, name2...]]`; a lone NIL is no name here, unless a comma follows it.
    fn instance(&mut self) -> Result<Object, Fault> {
        if self.is(Word::Of) && matches!(self.ahead(), TokenKind::Name | TokenKind::Semicolon | TokenKind::End) {
            self.advance();
        }
        if self.token.kind != TokenKind::Name {
            return Ok(Object::Instance(Vec::new()));
        }
        if self.is(Word::Nil) && self.ahead() != TokenKind::Comma {
            self.advance();
            return Ok(Object::Instance(Vec::new()));
        }
        Ok(Object::Instance(self.names()?))
    }

    /// `[x,y[,z]] [STEP dx,dy] 'text'`
    fn characters(&mut self) -> Result<Characters, Fault> {
        let mut position = DVec3::ZERO;
        if let TokenKind::Number(_) = self.token.kind {
            let (at, count) = self.up_to_three()?;
            if count < 2 {
                return Err(self.fail(&["the y component"]));
            }
            position = DVec3::from_array(at);
        }
        let step = if self.accept_word(Word::Step) { DVec2::from_array(self.reals()?) } else { DVec2::X };
        Ok(Characters { position, step, text: self.string()? })
    }
}
