//! Vector lists. The vectors are read straight from the bytes: the one place where the language is long.

use super::Parser;
use crate::command::{
    MAX_POINTS,
    error::{Fault, Problem},
    number::Decimal,
    syntax::{Fourth, VectorClass, VectorList},
    token::{TokenKind, blanks},
    words::{self, Word},
};

/// Fewest bytes of text that a vector takes; how much room a text can need at most.
const SHORTEST_VECTOR: usize = 4;

/// Constant or growing y and z: `Y = y DY = dy Z = z DZ = dz`.
#[derive(Clone, Copy, Default)]
struct Defaults {
    y: Option<f64>,
    dy: f64,
    z: Option<f64>,
    dz: f64,
}

impl Defaults {
    /// How many components the vectors must have, if that is known from the defaults.
    fn components(self) -> Option<usize> {
        (self.y.is_some() || self.z.is_some()).then(|| if self.y.is_some() { 1 } else { 2 })
    }

    /// Fills in the components that have a default; `index` counts from 0.
    fn complete(self, index: usize, point: &mut [f32; 4]) {
        if let Some(y) = self.y {
            point[1] = (y + index as f64 * self.dy) as f32;
        }
        if let Some(z) = self.z {
            point[2] = (z + index as f64 * self.dz) as f32;
        }
    }
}

impl Parser<'_> {
    /// All after VECTOR_LIST.
    pub(super) fn vector_list(&mut self) -> Result<VectorList, Fault> {
        let mut list = VectorList {
            block_normalized: false,
            fourth: Fourth::Intensity,
            internal_units: false,
            class: VectorClass::Connected,
            dimension: 2,
            estimate: None,
            points: Vec::new(),
            lines: Vec::new(),
        };
        let mut defaults = Defaults::default();
        while let Some(word) = self.accept_one_of(words::VECTOR_OPTIONS) {
            match word {
                Word::BlockNormalized => list.block_normalized = true,
                Word::Connected => list.class = VectorClass::Connected,
                Word::Dots => list.class = VectorClass::Dots,
                Word::Itemized => list.class = VectorClass::Itemized,
                Word::Separate => list.class = VectorClass::Separate,
                Word::Number => {
                    self.accept(TokenKind::Equal);
                    list.estimate = Some(self.integer(0..i64::from(u32::MAX) + 1)? as u32);
                }
                Word::Y => defaults.y = Some(self.default_number()?),
                Word::Dy => defaults.dy = self.default_number()?,
                Word::Z => defaults.z = Some(self.default_number()?),
                _ => defaults.dz = self.default_number()?,
            }
        }
        let text = self.lexer.text();
        let room = (text.len() - self.token.start) / SHORTEST_VECTOR + 1;
        list.points.reserve(list.estimate.map_or(0, |n| n as usize).min(room).min(MAX_POINTS));
        let mut vectors = Vectors { text, at: self.token.start, defaults, components: defaults.components() };
        vectors.read(&mut list)?;
        let given = vectors.components.unwrap_or(0);
        list.dimension = if given == 3 || defaults.z.is_some() { 3 } else { 2 };
        self.jump(vectors.at);
        match self.token.kind {
            TokenKind::Semicolon | TokenKind::End => Ok(list),
            _ if list.class == VectorClass::Itemized => Err(self.fail(&["P", "L", "`;`"])),
            _ => Err(self.fail(&["a vector", "`;`"])),
        }
    }

    /// `[=] number`
    fn default_number(&mut self) -> Result<f64, Fault> {
        self.accept(TokenKind::Equal);
        self.real()
    }
}

/// The vectors of a list, byte by byte.
struct Vectors<'t> {
    text: &'t [u8],
    at: usize,
    defaults: Defaults,
    /// How many numbers each vector has; none before the first.
    components: Option<usize>,
}

impl Vectors<'_> {
    /// Reads vectors up to the first byte that begins none.
    fn read(&mut self, list: &mut VectorList) -> Result<(), Fault> {
        let itemized = list.class == VectorClass::Itemized;
        loop {
            let byte = self.skip();
            let mark = if itemized {
                match self.mark(byte) {
                    Some(line) => Some(line),
                    None => return Ok(()),
                }
            } else if byte.is_some_and(Decimal::begins_with) {
                None
            } else {
                return Ok(());
            };
            if list.points.len() == MAX_POINTS {
                return Err(self.fault(Problem::TooManyPoints, &[]));
            }
            let mut point = [0.0, 0.0, 0.0, 1.0];
            match self.components {
                Some(3) => {
                    point[0] = self.number()?;
                    self.skip_comma();
                    point[1] = self.number()?;
                    self.skip_comma();
                    point[2] = self.number()?;
                }
                Some(count) => {
                    for (index, component) in point.iter_mut().enumerate().take(count) {
                        if index > 0 {
                            self.skip_comma();
                        }
                        *component = self.number()?;
                    }
                    self.defaults.complete(list.points.len(), &mut point);
                }
                None => self.components = Some(self.first(itemized, &mut point)?),
            }
            self.intensity(&mut point)?;
            if !(point[1].is_finite() && point[2].is_finite()) {
                return Err(self.fault(Problem::OutOfRange, &[]));
            }
            list.points.push(point);
            if let Some(line) = mark {
                list.lines.push(line);
            }
        }
    }

    /// P or L, if it stands here: TRUE for L.
    #[inline]
    fn mark(&mut self, byte: Option<u8>) -> Option<bool> {
        let line = match byte {
            Some(b'P' | b'p') => false,
            Some(b'L' | b'l') => true,
            _ => return None,
        };
        // A longer word is none; but digits or a point are the number that belongs to the mark.
        if self.text.get(self.at + 1).is_some_and(|b| b.is_ascii_alphabetic() || matches!(b, b'_' | b'$')) {
            return None;
        }
        self.at += 1;
        Some(line)
    }

    /// Reads the first vector, which says how many components all have.
    fn first(&mut self, itemized: bool, point: &mut [f32; 4]) -> Result<usize, Fault> {
        point[0] = self.number()?;
        let mut count = 1;
        while count < 3 {
            let comma = self.skip() == Some(b',');
            if comma {
                self.at += 1;
            } else if !self.skip().is_some_and(Decimal::begins_with) {
                break;
            } else if !itemized {
                // Numbers follow without a comma: the next vector, unless no comma came at all.
                if count > 1 {
                    break;
                }
                return Err(self.fault(Problem::UnclearVector, &[]));
            }
            point[count] = self.number()?;
            count += 1;
        }
        if count == 1 {
            return Err(self.fault(Problem::Unexpected, &["the y component"]));
        }
        Ok(count)
    }

    /// `I = i`, if it stands here.
    #[inline]
    fn intensity(&mut self, point: &mut [f32; 4]) -> Result<(), Fault> {
        if !matches!(self.skip(), Some(b'I' | b'i')) {
            return Ok(());
        }
        let after = self.text.get(self.at + 1);
        if after.is_some_and(|b| b.is_ascii_alphabetic() || matches!(b, b'_' | b'$')) {
            return Ok(());
        }
        self.at += 1;
        if self.skip() == Some(b'=') {
            self.at += 1;
        }
        point[3] = self.number()?;
        Ok(())
    }

    /// Skips blanks and comments and gives the next byte.
    #[inline]
    fn skip(&mut self) -> Option<u8> {
        match self.text.get(self.at) {
            Some(&byte) if byte > b' ' && byte < b'{' => Some(byte),
            _ => match blanks(self.text, self.at) {
                Ok(at) => {
                    self.at = at;
                    self.text.get(at).copied()
                }
                Err(_) => None,
            },
        }
    }

    #[inline]
    fn skip_comma(&mut self) {
        if self.skip() == Some(b',') {
            self.at += 1;
        }
    }

    #[inline]
    fn number(&mut self) -> Result<f32, Fault> {
        self.skip();
        let start = self.at;
        let Some((decimal, end)) = Decimal::scan(self.text, start) else {
            return Err(self.fault(Problem::Unexpected, &["a number"]));
        };
        self.at = end;
        match decimal.to_f32(&self.text[start..end]) {
            Some(number) => Ok(number),
            None => Err(Fault { span: start..end, problem: Problem::OutOfRange, expected: &[] }),
        }
    }

    /// A fault at the token that begins here.
    #[cold]
    fn fault(&self, problem: Problem, expected: &'static [&'static str]) -> Fault {
        let token = crate::command::token::Lexer::new(self.text, self.at).token();
        let problem = match (problem, token.kind) {
            (Problem::Unexpected, TokenKind::Bad(bad)) => bad,
            _ => problem,
        };
        Fault { span: token.span(), problem, expected }
    }
}
