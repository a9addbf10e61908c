//! Attributes (SET) and conditions (IF).

use super::{Parser, field::NUMBERS};
use crate::command::{
    error::Fault,
    syntax::{CharacterOrientation, Comparison, Operate, Rate, Scopes},
    token::TokenKind,
    words::{self, Word},
};
use glam::DVec2;

/// One more than the highest level of detail.
const LEVELS: i64 = 32_768;
/// One more than the highest conditional bit.
const BITS: i64 = 15;
/// One more than the highest number of a screen.
const SCOPES: i64 = 4;

impl Parser<'_> {
    /// All after SET.
    pub(super) fn set(&mut self) -> Result<Operate, Fault> {
        Ok(match self.expect_one_of(words::SETTINGS, &["a setting (such as COLOR)"])? {
            Word::Color if self.accept_word(Word::Blending) => Operate::SetColorBlending(self.real()?),
            Word::Color => {
                let [hue, saturation] = self.reals()?;
                Operate::SetColor { hue, saturation }
            }
            Word::Intensity => Operate::SetIntensity { on: self.on_or_off()?, range: self.range()? },
            Word::Contrast => {
                self.accept_word(Word::To);
                Operate::SetContrast(self.real()?)
            }
            Word::Csm => Operate::SetCsm(self.on_or_off()?),
            Word::DepthClipping => Operate::SetDepthClipping(self.on_or_off()?),
            Word::Displays => {
                let scopes = self.scopes()?;
                Operate::SetDisplays { scopes, on: self.on_or_off()? }
            }
            Word::Characters => Operate::SetCharacters(self.orientation()?),
            Word::Picking => self.picking()?,
            Word::LevelOfDetail => {
                self.accept_word(Word::To);
                Operate::SetLevelOfDetail(self.integer(0..LEVELS)? as u16)
            }
            Word::ConditionalBit => {
                let bit = self.integer(0..BITS)? as u8;
                Operate::SetConditionalBit { bit, on: self.on_or_off()? }
            }
            Word::Rate => self.rate()?,
            Word::Blinking if self.accept_word(Word::Rate) => Operate::SetBlinkRate(self.count()?),
            Word::Blinking => Operate::SetBlinking(self.on_or_off()?),
            Word::Plotter => Operate::SetPlotter(self.on_or_off()?),
            Word::Priority => Operate::SetPriority(self.integer(i32::MIN.into()..i64::from(i32::MAX) + 1)? as i32),
            _ => {
                let around_corners = self.accept_word(Word::AroundCorners);
                Operate::SetLineTexture { around_corners, texture: self.count()? }
            }
        })
    }

    /// `ALL` or `n[,m...]`
    fn scopes(&mut self) -> Result<Scopes, Fault> {
        if self.accept_word(Word::All) {
            return Ok(Scopes::All);
        }
        if !self.is_number() {
            return Err(self.fail(&["ALL", "the number of a screen"]));
        }
        let mut bits = 0;
        while self.is_number() {
            bits |= 1 << self.integer(0..SCOPES)?;
            self.accept(TokenKind::Comma);
        }
        Ok(Scopes::Some(bits))
    }

    /// `WORLD_ORIENTED` or `SCREEN_ORIENTED[/FIXED]`
    fn orientation(&mut self) -> Result<CharacterOrientation, Fault> {
        const EXPECTED: &[&str] = &["WORLD_ORIENTED", "SCREEN_ORIENTED", "SCREEN_ORIENTED/FIXED"];
        if self.expect_one_of(&[Word::WorldOriented, Word::ScreenOriented], EXPECTED)? == Word::WorldOriented {
            return Ok(CharacterOrientation::World);
        }
        if !self.accept(TokenKind::Slash) {
            return Ok(CharacterOrientation::Screen);
        }
        self.expect_word(Word::Fixed, &["FIXED"])?;
        Ok(CharacterOrientation::ScreenFixed)
    }

    /// `ON|OFF`, `IDENTIFIER [=] id` or `LOCATION [=] x,y [sx,sy]`
    fn picking(&mut self) -> Result<Operate, Fault> {
        const EXPECTED: &[&str] = &["ON", "OFF", "IDENTIFIER", "LOCATION"];
        Ok(match self.expect_one_of(&[Word::On, Word::Off, Word::Identifier, Word::Location], EXPECTED)? {
            Word::Identifier => {
                self.accept(TokenKind::Equal);
                Operate::SetPickingIdentifier(self.name()?)
            }
            Word::Location => {
                self.accept(TokenKind::Equal);
                let center = DVec2::from_array(self.reals()?);
                self.accept(TokenKind::Comma);
                let size = if self.is_number() { Some(DVec2::from_array(self.reals()?)) } else { None };
                Operate::SetPickingLocation { center, size }
            }
            word => Operate::SetPicking(word == Word::On),
        })
    }

    /// `on off [ON|OFF] [delay]` or `EXTERNAL`
    fn rate(&mut self) -> Result<Operate, Fault> {
        if self.accept_word(Word::External) {
            return Ok(Operate::SetRateExternal);
        }
        if !self.is_number() {
            return Err(self.fail(&["EXTERNAL", "the frames of the ON phase"]));
        }
        let on = self.count()?;
        self.accept(TokenKind::Comma);
        let off = self.count()?;
        self.accept(TokenKind::Comma);
        let initial = self.accept_one_of(&[Word::On, Word::Off]) != Some(Word::Off);
        self.accept(TokenKind::Comma);
        let delay = if self.is_number() { self.integer(0..NUMBERS)? as u32 } else { 0 };
        Ok(Operate::SetRate(Rate { on, off, initial, delay }))
    }

    /// All after IF.
    pub(super) fn condition(&mut self) -> Result<Operate, Fault> {
        const EXPECTED: &[&str] = &["CONDITIONAL_BIT", "LEVEL_OF_DETAIL", "PHASE"];
        Ok(match self.expect_one_of(words::CONDITIONS, EXPECTED)? {
            Word::ConditionalBit => {
                let bit = self.integer(0..BITS)? as u8;
                self.accept_word(Word::Is);
                Operate::IfConditionalBit { bit, on: self.on_or_off()? }
            }
            Word::LevelOfDetail => {
                let comparison = self.comparison()?;
                Operate::IfLevelOfDetail { comparison, level: self.integer(0..LEVELS)? as u16 }
            }
            _ => {
                self.accept_word(Word::Is);
                Operate::IfPhase(self.on_or_off()?)
            }
        })
    }

    /// `<`, `<=`, `=`, `<>`, `>=` or `>`
    fn comparison(&mut self) -> Result<Comparison, Fault> {
        Ok(if self.accept(TokenKind::Equal) {
            Comparison::Equal
        } else if self.accept(TokenKind::Less) {
            if self.accept(TokenKind::Equal) {
                Comparison::LessEqual
            } else if self.accept(TokenKind::Greater) {
                Comparison::NotEqual
            } else {
                Comparison::Less
            }
        } else if self.accept(TokenKind::Greater) {
            if self.accept(TokenKind::Equal) { Comparison::GreaterEqual } else { Comparison::Greater }
        } else {
            return Err(self.fail(&["`<`", "`<=`", "`=`", "`<>`", "`>=`", "`>`"]));
        })
    }
}
