//! The parts that commands have in common: names, numbers, ranges, switches, tuples.

use super::cursor::Parser;
use crate::{
    Name,
    command::{
        error::{Fault, Problem},
        syntax::{Bspline, Input},
        token::TokenKind,
        words::Word,
    },
};
use std::ops::Range;

/// One more than the largest whole number of 32 bits.
pub(in crate::command) const NUMBERS: i64 = u32::MAX as i64 + 1;

impl Parser<'_> {
    pub(in crate::command) fn name(&mut self) -> Result<Name, Fault> {
        if self.token.kind != TokenKind::Name {
            return Err(self.fail(&["a name"]));
        }
        match Name::new(self.text(self.token)) {
            Ok(name) => {
                self.advance();
                Ok(name)
            }
            Err(why) => Err(self.refuse(why.into())),
        }
    }

    /// Names with commas between them; a comma may follow the last.
    pub(super) fn names(&mut self) -> Result<Vec<Name>, Fault> {
        let mut names = vec![self.name()?];
        while self.accept(TokenKind::Comma) && self.token.kind == TokenKind::Name {
            names.push(self.name()?);
        }
        Ok(names)
    }

    pub(in crate::command) fn is_number(&self) -> bool {
        matches!(self.token.kind, TokenKind::Number(_))
    }

    pub(in crate::command) fn real(&mut self) -> Result<f64, Fault> {
        let TokenKind::Number(decimal) = self.token.kind else {
            return Err(self.fail(&["a number"]));
        };
        match decimal.to_f64(self.text(self.token)) {
            Some(real) => {
                self.advance();
                Ok(real)
            }
            None => Err(self.refuse(Problem::OutOfRange)),
        }
    }

    pub(super) fn single(&mut self) -> Result<f32, Fault> {
        let TokenKind::Number(decimal) = self.token.kind else {
            return Err(self.fail(&["a number"]));
        };
        match decimal.to_f32(self.text(self.token)) {
            Some(real) => {
                self.advance();
                Ok(real)
            }
            None => Err(self.refuse(Problem::OutOfRange)),
        }
    }

    /// `[=] number`
    pub(super) fn equal_real(&mut self) -> Result<f64, Fault> {
        self.accept(TokenKind::Equal);
        self.real()
    }

    /// `[=] number`, whole.
    pub(super) fn equal_integer(&mut self, range: Range<i64>) -> Result<i64, Fault> {
        self.accept(TokenKind::Equal);
        self.integer(range)
    }

    /// `N` numbers; commas between them may be missing.
    pub(in crate::command) fn reals<const N: usize>(&mut self) -> Result<[f64; N], Fault> {
        let mut reals = [0.0; N];
        for (index, real) in reals.iter_mut().enumerate() {
            if index > 0 {
                self.accept(TokenKind::Comma);
            }
            *real = self.real()?;
        }
        Ok(reals)
    }

    /// Three numbers of single precision.
    pub(super) fn single_point(&mut self) -> Result<[f32; 3], Fault> {
        let mut point = [0.0; 3];
        for (index, component) in point.iter_mut().enumerate() {
            if index > 0 {
                self.accept(TokenKind::Comma);
            }
            *component = self.single()?;
        }
        Ok(point)
    }

    /// Up to three numbers, and how many there were.
    pub(in crate::command) fn up_to_three(&mut self) -> Result<([f64; 3], usize), Fault> {
        let mut reals = [self.real()?, 0.0, 0.0];
        for count in 1..3 {
            let comma = self.accept(TokenKind::Comma);
            if !comma && !self.is_number() {
                return Ok((reals, count));
            }
            reals[count] = self.real()?;
        }
        Ok((reals, 3))
    }

    /// Two or three numbers; z is 0 if not given.
    pub(in crate::command) fn point(&mut self) -> Result<[f64; 3], Fault> {
        let (point, count) = self.up_to_three()?;
        if count < 2 { Err(self.fail(&["the y component"])) } else { Ok(point) }
    }

    /// Rows of `least` to `most` numbers, as many in each row as the commas in the first say. Gives that count; the
    /// rest of a row is 0.
    pub(super) fn rows(&mut self, least: usize, most: usize) -> Result<(usize, Vec<[f64; 4]>), Fault> {
        let mut first = [self.real()?, 0.0, 0.0, 0.0];
        let mut count = 1;
        while count < most && self.accept(TokenKind::Comma) {
            first[count] = self.real()?;
            count += 1;
        }
        if count < least {
            let unclear = count == 1 && self.is_number();
            return Err(if unclear { self.refuse(Problem::UnclearVector) } else { self.fail(&["`,`"]) });
        }
        let mut rows = vec![first];
        while self.is_number() {
            if rows.len() == Bspline::MAX_VERTICES {
                return Err(self.refuse(Problem::LongCurve));
            }
            let mut row = [0.0; 4];
            for (index, component) in row[..count].iter_mut().enumerate() {
                if index > 0 {
                    self.accept(TokenKind::Comma);
                }
                *component = self.real()?;
            }
            rows.push(row);
        }
        Ok((count, rows))
    }

    /// `lo:hi`
    pub(in crate::command) fn range(&mut self) -> Result<[f64; 2], Fault> {
        let low = self.real()?;
        self.expect(TokenKind::Colon, &["`:`"])?;
        Ok([low, self.real()?])
    }

    /// A whole number in a range.
    pub(in crate::command) fn integer(&mut self, range: Range<i64>) -> Result<i64, Fault> {
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
            None => Err(self.refuse(Problem::Outside { least: range.start, most: range.end - 1 })),
        }
    }

    /// A whole number of 32 bits without sign.
    pub(in crate::command) fn count(&mut self) -> Result<u32, Fault> {
        Ok(self.integer(0..NUMBERS)? as u32)
    }

    /// `[=] n`, such as the estimate of a length.
    pub(super) fn equal_count(&mut self) -> Result<u32, Fault> {
        self.accept(TokenKind::Equal);
        self.count()
    }

    /// `<i>`: the number of an input, or the word or the number (0 to -6) of a special one.
    pub(super) fn input(&mut self) -> Result<Input, Fault> {
        const EXPECTED: &[&str] =
            &["the number of an input", "append, delete, clear, step, position, last, substitute"];
        self.expect(TokenKind::Less, &["an input such as `<1>`"])?;
        let input = match self.token.kind {
            TokenKind::Number(_) => {
                let code = self.integer(Input::Substitute.code()..NUMBERS)?;
                Input::from_code(code).ok_or_else(|| self.fail(EXPECTED))?
            }
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

    /// `APPLIED [TO] name`, `THEN name` or `-> name`, if it stands here.
    pub(super) fn applied_to(&mut self) -> Result<Option<Name>, Fault> {
        if self.accept_word(Word::Applied) {
            self.skip_before_name(Word::To);
        } else if !self.accept_word(Word::Then) && !self.accept(TokenKind::Arrow) {
            return Ok(None);
        }
        self.name().map(Some)
    }
}
