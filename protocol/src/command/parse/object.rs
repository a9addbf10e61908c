//! Definitions: what a name can be.

use super::{
    Parser,
    vector_list::{FourthLetter, Layout},
};
use crate::command::{
    error::{Fault, Problem},
    operate::words_after,
    syntax::{Characters, FontCharacter, LabelText, Labels, Object, Operate, Pattern},
    token::TokenKind,
    words::{self, Word},
};
use glam::{DVec2, DVec3};

impl Parser<'_> {
    /// What stands after `name :=`.
    pub(super) fn definition(&mut self) -> Result<Object, Fault> {
        // A lone name is another name for its object, unless the word is a whole object.
        if self.token.kind == TokenKind::Name {
            let next = self.ahead().kind;
            let lone = Parser::ends(next) && self.find(words::COMPLETE).is_none();
            if lone || next == TokenKind::Comma {
                let other = self.name()?;
                self.accept(TokenKind::Comma);
                return Ok(Object::Alias(other));
            }
        }
        self.object()?.ok_or_else(|| self.fail(&["what the name is to be (such as VECTOR_LIST)"]))
    }

    /// The object that is defined here; none if the current token begins none.
    pub(super) fn object(&mut self) -> Result<Option<Object>, Fault> {
        if self.is(Word::Function) && self.ahead().kind == TokenKind::Colon {
            return self.function().map(Some);
        }
        let Some(word) = self.accept_one_of(words::OBJECTS) else {
            return Ok(None);
        };
        Ok(Some(match word {
            Word::Nil => Object::Nil,
            Word::BeginStructure => Object::BeginStructure,
            Word::BeginFont => Object::BeginFont,
            Word::Instance => self.instance()?,
            Word::Characters if self.find(words_after(word)).is_none() => Object::Characters(self.characters()?),
            Word::Labels => Object::Labels(self.labels()?),
            Word::VectorList => Object::VectorList(self.vector_list()?),
            Word::Polygon | Word::With | Word::Outline => Object::Polygons(self.polygons(word)?),
            Word::Attributes => Object::Attributes(self.attributes()?),
            Word::Illumination => Object::Illumination(self.illumination()?),
            Word::Bspline => Object::Bspline(self.bspline(false)?),
            Word::Polynomial => Object::Polynomial(self.polynomial(false)?),
            Word::Rational => {
                match self.expect_one_of(&[Word::Bspline, Word::Polynomial], &["BSPLINE", "POLYNOMIAL"])? {
                    Word::Bspline => Object::Bspline(self.bspline(true)?),
                    _ => Object::Polynomial(self.polynomial(true)?),
                }
            }
            Word::Pattern => Object::Pattern(self.pattern()?),
            Word::RawBlock => Object::RawBlock(self.count()?),
            Word::Copy => self.copy()?,
            word => Object::Operate { operate: Operate::parse(word, self)?, applied_to: self.applied_to()? },
        }))
    }

    /// `[OF] [name1 [, name2...]]`; a lone NIL is no name here, unless a comma follows it.
    fn instance(&mut self) -> Result<Object, Fault> {
        let next = self.ahead().kind;
        if self.is(Word::Of) && (next == TokenKind::Name || Parser::ends(next)) {
            self.advance();
        }
        if self.token.kind != TokenKind::Name {
            return Ok(Object::Instance(Vec::new()));
        }
        if self.is(Word::Nil) && self.ahead().kind != TokenKind::Comma {
            self.advance();
            return Ok(Object::Instance(Vec::new()));
        }
        Ok(Object::Instance(self.names()?))
    }

    /// `name [START [=]] i [,] [COUNT [=]] n`
    fn copy(&mut self) -> Result<Object, Fault> {
        let source = self.name()?;
        self.accept_word(Word::Start);
        let start = self.equal_integer(1..super::field::NUMBERS)? as u32;
        self.accept(TokenKind::Comma);
        self.accept_word(Word::Count);
        Ok(Object::Copy { source, start, count: self.equal_count()? })
    }

    /// `[x,y[,z]] [STEP dx,dy] 'text'`
    fn characters(&mut self) -> Result<Characters, Fault> {
        let position = if self.is_number() { self.point()? } else { [0.0; 3] };
        let step = if self.accept_word(Word::Step) { DVec2::from_array(self.reals()?) } else { DVec2::X };
        Ok(Characters { position: DVec3::from_array(position), step, text: self.string()? })
    }

    /// `x,y[,z] 'text'`, once or more.
    fn labels(&mut self) -> Result<Labels, Fault> {
        let mut labels = Vec::new();
        while labels.is_empty() || self.is_number() {
            let position = DVec3::from_array(self.point()?);
            labels.push(LabelText { position, text: self.string()? });
            self.accept(TokenKind::Comma);
        }
        Ok(Labels { labels })
    }

    /// `i [i...] [AROUND_CORNERS] [MATCH | NOMATCH] LENGTH [=] r`
    fn pattern(&mut self) -> Result<Pattern, Fault> {
        let mut segments = vec![self.real()?];
        loop {
            let comma = self.accept(TokenKind::Comma);
            if !comma && !self.is_number() {
                break;
            }
            if segments.len() == Pattern::MAX_SEGMENTS {
                return Err(self.refuse(Problem::LongPattern));
            }
            segments.push(self.real()?);
        }
        let (mut around_corners, mut matched, mut length) = (false, true, None);
        while let Some(word) = self.accept_one_of(words::PATTERN_OPTIONS) {
            match word {
                Word::AroundCorners => around_corners = true,
                Word::Match => matched = true,
                Word::NoMatch => matched = false,
                _ => length = Some(self.equal_real()?),
            }
        }
        match length {
            Some(length) => Ok(Pattern { segments, around_corners, matched, length }),
            None => Err(self.fail(&["LENGTH", "AROUND_CORNERS", "MATCH", "NOMATCH"])),
        }
    }

    /// `C[code]: [N = n] P x,y L x,y...`, inside BEGIN_FONT.
    pub(super) fn font_character(&mut self) -> Result<FontCharacter, Fault> {
        self.advance();
        self.expect(TokenKind::OpenBracket, &["`[`"])?;
        let code = self.integer(0..128)? as u8;
        self.expect(TokenKind::CloseBracket, &["`]`"])?;
        self.expect(TokenKind::Colon, &["`:`"])?;
        let estimate = if self.accept_word(Word::Number) { Some(self.equal_count()?) } else { None };
        let layout = Layout { itemized: true, fourth: FourthLetter::NONE, components: Some(2), ..Layout::default() };
        let vectors = self.vectors(layout, estimate)?;
        let mark = |index: usize| index > 0 && vectors.lines[index];
        let points = vectors.points.iter().enumerate().map(|(index, p)| ([p[0], p[1]], mark(index))).collect();
        Ok(FontCharacter { code, estimate, points })
    }
}
