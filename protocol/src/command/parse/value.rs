//! The forms of a value in SEND.

use super::Parser;
use crate::{
    Value,
    command::{
        error::Fault,
        matrix::from_four_by_three,
        token::TokenKind,
        words::{self, Word},
    },
};
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};

impl Parser<'_> {
    pub(super) fn value(&mut self) -> Result<Value, Fault> {
        const EXPECTED: &[&str] =
            &["a number", "a text", "TRUE", "FALSE", "FIX(i)", "CHAR(n)", "V3D(x,y,z)", "the like"];
        match self.token.kind {
            TokenKind::Number(_) => return Ok(Value::Real(self.real()?)),
            TokenKind::String => return Ok(Value::String(self.string()?)),
            _ => {}
        }
        let word = self.expect_one_of(words::VALUES, EXPECTED)?;
        match word {
            Word::True => return Ok(Value::Boolean(true)),
            Word::False => return Ok(Value::Boolean(false)),
            _ => {}
        }
        self.expect(TokenKind::Open, &["`(`"])?;
        let value = match word {
            Word::Fix => Value::Integer(self.integer(i32::MIN.into()..i64::from(i32::MAX) + 1)? as i32),
            Word::Char => Value::string([self.integer(0..256)? as u8]),
            Word::Vector2Value => Value::Vector2(DVec2::from_array(self.reals()?)),
            Word::Vector3Value => Value::Vector3(DVec3::from_array(self.reals()?)),
            Word::Vector4Value => Value::Vector4(DVec4::from_array(self.reals()?)),
            Word::Matrix2Value => Value::Matrix2(Box::new(self.matrix2()?)),
            Word::Matrix3Value => Value::Matrix3(Box::new(self.matrix3()?)),
            Word::Matrix4x3Value => Value::Matrix4x3(Box::new(self.matrix4x3()?)),
            Word::Matrix4Value => Value::Matrix4(Box::new(self.matrix4()?)),
            Word::TransformValue => Value::Transform(Box::new(self.matrix4()?)),
            // VALUE and VL are commands of their own and no values.
            _ => return Err(self.fail(EXPECTED)),
        };
        self.expect(TokenKind::Close, &["`)`"])?;
        Ok(value)
    }

    /// A text in quotes.
    pub(super) fn string(&mut self) -> Result<Box<[u8]>, Fault> {
        if self.token.kind != TokenKind::String {
            return Err(self.fail(&["a text in quotes"]));
        }
        let text = self.quoted();
        self.advance();
        Ok(text.into())
    }

    // The numbers come row by row, and a row of the machine is a column of glam.

    pub(super) fn matrix2(&mut self) -> Result<DMat2, Fault> {
        Ok(DMat2::from_cols_array(&self.reals()?))
    }

    pub(super) fn matrix3(&mut self) -> Result<DMat3, Fault> {
        Ok(DMat3::from_cols_array(&self.reals()?))
    }

    /// Four rows of three, completed with 0, 0, 0, 1.
    pub(in crate::command) fn matrix4x3(&mut self) -> Result<DMat4, Fault> {
        Ok(from_four_by_three(&self.reals()?))
    }

    pub(super) fn matrix4(&mut self) -> Result<DMat4, Fault> {
        Ok(DMat4::from_cols_array(&self.reals()?))
    }
}
