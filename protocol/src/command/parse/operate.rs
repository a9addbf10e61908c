//! Operate nodes: transformations and viewing.

use super::Parser;
use crate::command::{
    error::Fault,
    syntax::{Axis, Boundaries, Operate},
    token::TokenKind,
    words::Word,
};
use glam::DVec3;

impl Parser<'_> {
    /// The operate node whose first word was just taken.
    pub(super) fn operate(&mut self, word: Word) -> Result<Operate, Fault> {
        Ok(match word {
            Word::Rotate => self.rotate()?,
            Word::Scale => {
                self.accept_word(Word::By);
                Operate::Scale(match self.up_to_three()? {
                    ([s, ..], 1) => DVec3::splat(s),
                    ([x, y, _], 2) => DVec3::new(x, y, 1.0),
                    (factors, _) => DVec3::from_array(factors),
                })
            }
            Word::Translate => {
                self.accept_word(Word::By);
                Operate::Translate(DVec3::from_array(self.point()?))
            }
            Word::Matrix2 => Operate::Matrix2(self.matrix2()?),
            Word::Matrix3 => Operate::Matrix3(self.matrix3()?),
            Word::Matrix4x3 => Operate::Matrix4x3(self.matrix4x3()?),
            Word::Matrix4 => Operate::Matrix4(self.matrix4()?),
            Word::Look => self.look()?,
            Word::Window => {
                let x = self.limits(Word::X, &["X"])?;
                let y = self.limits(Word::Y, &["Y"])?;
                Operate::Window { x, y, boundaries: self.boundaries()? }
            }
            Word::FieldOfView => Operate::FieldOfView { angle: self.real()?, boundaries: self.boundaries()? },
            Word::Eye => self.eye()?,
            Word::Viewport => self.viewport(false)?,
            Word::Load => {
                self.expect_word(Word::Viewport, &["VIEWPORT"])?;
                self.viewport(true)?
            }
            Word::Font => Operate::CharacterFont(self.name()?),
            Word::Standard => {
                self.expect_word(Word::Font, &["FONT"])?;
                Operate::StandardFont
            }
            Word::Text => {
                self.expect_word(Word::Size, &["SIZE"])?;
                Operate::TextSize(self.real()?)
            }
            Word::Xform => match self.expect_one_of(&[Word::Matrix, Word::Vector], &["MATRIX", "VECTOR"])? {
                Word::Matrix => Operate::XformMatrix,
                _ => Operate::XformVector,
            },
            Word::Cancel => {
                self.expect_word(Word::Xform, &["XFORM"])?;
                Operate::CancelXform
            }
            Word::WriteBack => Operate::WriteBack,
            Word::SurfaceRendering => Operate::SurfaceRendering,
            Word::SolidRendering => Operate::SolidRendering,
            Word::SectioningPlane => Operate::SectioningPlane,
            Word::Increment => {
                self.expect_word(Word::LevelOfDetail, &["LEVEL_OF_DETAIL"])?;
                Operate::IncrementLevelOfDetail
            }
            Word::Decrement => {
                self.expect_word(Word::LevelOfDetail, &["LEVEL_OF_DETAIL"])?;
                Operate::DecrementLevelOfDetail
            }
            Word::If => self.condition()?,
            _ => self.set()?,
        })
    }

    fn rotate(&mut self) -> Result<Operate, Fault> {
        self.accept_word(Word::In);
        let axis = match self.accept_one_of(&[Word::X, Word::Y, Word::Z]) {
            Some(Word::X) => Axis::X,
            Some(Word::Y) => Axis::Y,
            Some(_) => Axis::Z,
            None => return Err(self.fail(&["X", "Y", "Z"])),
        };
        Ok(Operate::Rotate { axis, angle: self.real()? })
    }

    /// `AT a FROM f [UP u]` or `FROM f AT a [UP u]`
    fn look(&mut self) -> Result<Operate, Fault> {
        let first = self.expect_one_of(&[Word::At, Word::From], &["AT", "FROM"])?;
        let first_point = DVec3::from_array(self.reals()?);
        let (at, from) = if first == Word::At {
            self.expect_word(Word::From, &["FROM"])?;
            (first_point, DVec3::from_array(self.reals()?))
        } else {
            self.expect_word(Word::At, &["AT"])?;
            (DVec3::from_array(self.reals()?), first_point)
        };
        let up = if self.accept_word(Word::Up) { Some(DVec3::from_array(self.reals()?)) } else { None };
        Ok(Operate::Look { at, from, up })
    }

    /// `word [=] lo:hi`
    fn limits(&mut self, word: Word, expected: &'static [&'static str]) -> Result<[f64; 2], Fault> {
        self.expect_word(word, expected)?;
        self.accept(TokenKind::Equal);
        self.range()
    }

    /// `FRONT [BOUNDARY] [=] f BACK [BOUNDARY] [=] b`, if it stands here.
    fn boundaries(&mut self) -> Result<Option<Boundaries>, Fault> {
        if !self.is(Word::Front) {
            return Ok(None);
        }
        let front = self.boundary(Word::Front, &["FRONT"])?;
        Ok(Some(Boundaries { front, back: self.boundary(Word::Back, &["BACK"])? }))
    }

    fn boundary(&mut self, word: Word, expected: &'static [&'static str]) -> Result<f64, Fault> {
        self.expect_word(word, expected)?;
        self.accept_word(Word::Boundary);
        self.accept(TokenKind::Equal);
        self.real()
    }

    /// `HORIZONTAL [=] a:b VERTICAL [=] c:d [INTENSITY [=] e:f]`
    fn viewport(&mut self, load: bool) -> Result<Operate, Fault> {
        let horizontal = self.limits(Word::Horizontal, &["HORIZONTAL"])?;
        let vertical = self.limits(Word::Vertical, &["VERTICAL"])?;
        let intensity =
            if self.is(Word::Intensity) { Some(self.limits(Word::Intensity, &["INTENSITY"])?) } else { None };
        Ok(if load {
            Operate::LoadViewport { horizontal, vertical, intensity }
        } else {
            Operate::Viewport { horizontal, vertical, intensity }
        })
    }

    /// `BACK z [LEFT|RIGHT x] [UP|DOWN y] [FROM SCREEN AREA] w [WIDE] [FRONT = f BACK = b]`
    fn eye(&mut self) -> Result<Operate, Fault> {
        self.expect_word(Word::Back, &["BACK"])?;
        let back = self.real()?;
        let right = match self.accept_one_of(&[Word::Left, Word::Right]) {
            Some(Word::Left) => -self.real()?,
            Some(_) => self.real()?,
            None => 0.0,
        };
        let up = match self.accept_one_of(&[Word::Up, Word::Down]) {
            Some(Word::Up) => self.real()?,
            Some(_) => -self.real()?,
            None => 0.0,
        };
        self.accept_word(Word::From);
        self.accept_word(Word::Screen);
        self.accept_word(Word::Area);
        if !self.is_number() {
            return Err(self.fail(&["FROM SCREEN AREA and its width"]));
        }
        let width = self.real()?;
        self.accept_word(Word::Wide);
        Ok(Operate::Eye { back, right, up, width, boundaries: self.boundaries()? })
    }
}
