//! Polygons, what they look like, and lights.

use super::Parser;
use crate::{
    Name,
    command::{
        error::{Fault, Problem},
        syntax::{Attributes, CornerColor, Illumination, Polygon, PolygonVertex, SurfaceColor},
        token::TokenKind,
        words::{self, Word},
    },
};
use glam::DVec3;

impl Parser<'_> {
    /// `[WITH [ATTRIBUTES] name] [[WITH] OUTLINE hue] POLYGON [COPLANAR] vertex...`, once or more; the first word was
    /// taken. Attributes and an outline after the last polygon are left out.
    pub(super) fn polygons(&mut self, first: Word) -> Result<Vec<Polygon>, Fault> {
        let mut polygons = Vec::new();
        let mut next = Some(first);
        while next.is_some() {
            let (mut attributes, mut outline) = (None, None);
            let place = self.last_start;
            loop {
                match next {
                    Some(Word::With) if self.is(Word::Outline) && self.ahead_is_number() => {
                        self.advance();
                        outline = Some(self.real()?);
                    }
                    Some(Word::With) => attributes = Some(self.attributes_name()?),
                    Some(Word::Outline) => outline = Some(self.real()?),
                    Some(_) => break,
                    None if Parser::ends(self.token.kind) && !polygons.is_empty() => {
                        let span = place..self.last_end;
                        self.warnings.push(Fault { span, problem: Problem::NoPolygon, expected: &[] });
                        return Ok(polygons);
                    }
                    None => return Err(self.fail(&["POLYGON", "WITH", "OUTLINE"])),
                }
                next = self.accept_one_of(words::POLYGON_OPTIONS);
            }
            let coplanar = self.accept_word(Word::Coplanar);
            polygons.push(Polygon { attributes, outline, coplanar, vertices: self.vertices()? });
            next = self.accept_one_of(words::POLYGON_OPTIONS);
        }
        Ok(polygons)
    }

    fn ahead_is_number(&self) -> bool {
        matches!(self.ahead().kind, TokenKind::Number(_))
    }

    /// `[ATTRIBUTES] name`; the word may be the name itself.
    fn attributes_name(&mut self) -> Result<Name, Fault> {
        if self.is(Word::Attributes) {
            let mut lexer = self.lexer;
            let (next, after) = (lexer.token(), lexer.token());
            let is_option = |token| Word::find(words::POLYGON_OPTIONS, self.text(token)).is_some();
            let name_follows = next.kind == TokenKind::Name;
            if name_follows && (!is_option(next) || after.kind == TokenKind::Name && is_option(after)) {
                self.advance();
            }
        }
        self.name()
    }

    /// `[S] x,y,z [N nx,ny,nz] [C h[,s[,i]] [AND h[,s[,i]]]]`, 3 to 250 of them.
    fn vertices(&mut self) -> Result<Vec<PolygonVertex>, Fault> {
        let mut vertices: Vec<PolygonVertex> = Vec::new();
        loop {
            let soft = self.accept_letter(Word::SoftMark);
            if !soft && !self.is_number() {
                if vertices.len() < 3 {
                    let few = !vertices.is_empty();
                    return Err(if few {
                        self.refuse(Problem::FewVertices)
                    } else {
                        self.fail(&["a vertex", "COPLANAR"])
                    });
                }
                return Ok(vertices);
            }
            if vertices.len() == Polygon::MAX_VERTICES {
                return Err(self.refuse(Problem::ManyVertices));
            }
            let position = self.single_point()?;
            let place = self.token;
            let normal = if self.accept_letter(Word::Number) { Some(self.single_point()?) } else { None };
            if vertices.first().is_some_and(|first| first.normal.is_some() != normal.is_some()) {
                return Err(Fault { span: place.span(), problem: Problem::MixedNormals, expected: &[] });
            }
            let place = self.token;
            let color = self.corner_color()?;
            if vertices.first().is_some_and(|first| first.color.is_some() != color.is_some()) {
                return Err(Fault { span: place.span(), problem: Problem::MixedColors, expected: &[] });
            }
            vertices.push(PolygonVertex { soft, position, normal, color });
        }
    }

    /// `[C h[,s[,i]] [AND h[,s[,i]]]]`
    fn corner_color(&mut self) -> Result<Option<CornerColor>, Fault> {
        if !self.accept_letter(Word::CodeOfCharacter) {
            return Ok(None);
        }
        let front = self.single_color()?;
        let back = if self.accept_word(Word::And) { Some(self.single_color()?) } else { None };
        Ok(Some(CornerColor { front, back }))
    }

    /// `h[,s[,i]]` with its commas, since numbers without one are the next vertex; saturation and intensity are 1 if
    /// not given.
    fn single_color(&mut self) -> Result<[f32; 3], Fault> {
        let mut color = [self.single()?, 1.0, 1.0];
        for part in &mut color[1..] {
            if !self.accept(TokenKind::Comma) {
                break;
            }
            *part = self.single()?;
        }
        Ok(color)
    }

    /// `[COLOR h[,s[,i]]] [DIFFUSE d] [SPECULAR s] [OPAQUE t] [AND ...]`
    pub(super) fn attributes(&mut self) -> Result<Attributes, Fault> {
        let front = self.side()?;
        let back = if self.accept_word(Word::And) { Some(self.side()?) } else { None };
        Ok(Attributes { front, back })
    }

    fn side(&mut self) -> Result<SurfaceColor, Fault> {
        let mut side = SurfaceColor::default();
        while let Some(word) = self.accept_one_of(words::SURFACE_OPTIONS) {
            match word {
                Word::Color => side.color = self.color()?,
                Word::Diffuse => side.diffuse = self.equal_real()?,
                Word::Specular => side.specular = self.equal_integer(0..11)? as u8,
                _ => side.opaque = self.equal_real()?,
            }
        }
        Ok(side)
    }

    /// `h[,s[,i]]`; saturation and intensity are 1 if not given.
    fn color(&mut self) -> Result<[f64; 3], Fault> {
        Ok(match self.up_to_three()? {
            ([hue, ..], 1) => [hue, 1.0, 1.0],
            ([hue, saturation, _], 2) => [hue, saturation, 1.0],
            (color, _) => color,
        })
    }

    /// `x,y,z [COLOR h[,s[,i]]] [AMBIENT a]`
    pub(super) fn illumination(&mut self) -> Result<Illumination, Fault> {
        let direction = DVec3::from_array(self.reals()?);
        let mut light = Illumination { direction, color: SurfaceColor::default().color, ambient: 1.0 };
        while let Some(word) = self.accept_one_of(words::LIGHT_OPTIONS) {
            match word {
                Word::Color => light.color = self.color()?,
                _ => light.ambient = self.equal_real()?,
            }
        }
        Ok(light)
    }
}
