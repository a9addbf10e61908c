//! Operate nodes: transformations, viewing and attributes.

use super::Parser;
use crate::{
    Name,
    command::{
        error::Fault,
        syntax::{Axis, Boundaries, Operate},
        token::TokenKind,
        words::{self, Word},
    },
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
                let (by, count) = self.up_to_three()?;
                if count < 2 {
                    return Err(self.fail(&["the y component"]));
                }
                Operate::Translate(DVec3::from_array(by))
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
            Word::Viewport => {
                let horizontal = self.limits(Word::Horizontal, &["HORIZONTAL"])?;
                let vertical = self.limits(Word::Vertical, &["VERTICAL"])?;
                let intensity =
                    if self.is(Word::Intensity) { Some(self.limits(Word::Intensity, &["INTENSITY"])?) } else { None };
                Operate::Viewport { horizontal, vertical, intensity }
            }
            Word::Set => self.set()?,
            _ => {
                self.expect_word(Word::Matrix, &["MATRIX"])?;
                Operate::XformMatrix
            }
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
        let first = self.accept_one_of(&[Word::At, Word::From]).ok_or_else(|| self.fail(&["AT", "FROM"]))?;
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

    fn set(&mut self) -> Result<Operate, Fault> {
        match self.accept_one_of(words::SETTINGS) {
            Some(Word::Color) => {
                let [hue, saturation] = self.reals()?;
                Ok(Operate::SetColor { hue, saturation })
            }
            Some(Word::Intensity) => Ok(Operate::SetIntensity { on: self.on_or_off()?, range: self.range()? }),
            Some(_) => Ok(Operate::SetDepthClipping(self.on_or_off()?)),
            None => Err(self.fail(&["COLOR", "INTENSITY", "DEPTH_CLIPPING"])),
        }
    }

    /// `APPLIED [TO] name` or `THEN name`, if it stands here.
    pub(super) fn applied_to(&mut self) -> Result<Option<Name>, Fault> {
        if self.accept_word(Word::Applied) {
            self.skip_before_name(Word::To);
        } else if !self.accept_word(Word::Then) {
            return Ok(None);
        }
        self.name().map(Some)
    }
}
