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

/// Fewest bytes of text that a vector takes; the most memory that a text can need.
const SHORTEST_VECTOR: usize = 4;

/// Constant or growing y and z: `Y = y DY = dy Z = z DZ = dz`.
#[derive(Clone, Copy, Default)]
pub(super) struct Defaults {
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

/// The letter of the fourth component, and what the component is where it is not given.
#[derive(Clone, Copy)]
pub(super) struct FourthLetter {
    letter: u8,
    absent: f32,
}

impl FourthLetter {
    /// No fourth component is allowed.
    pub(super) const NONE: FourthLetter = FourthLetter { letter: 0, absent: 1.0 };

    fn of(fourth: Fourth) -> FourthLetter {
        let letter = match fourth {
            Fourth::Intensity => Word::IntensityOfPoint,
            Fourth::Hue => Word::HueOfPoint,
            Fourth::Table => Word::TableOfPoint,
        };
        FourthLetter { letter: letter.form().as_bytes()[0], absent: fourth.absent() }
    }
}

/// How the vectors of a list are written.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    /// Each vector begins with P or L.
    pub(super) itemized: bool,
    pub(super) fourth: FourthLetter,
    /// How many numbers each vector has; none if the first one says it.
    pub(super) components: Option<usize>,
    pub(super) defaults: Defaults,
}

impl Default for Layout {
    fn default() -> Layout {
        let fourth = FourthLetter::of(Fourth::Intensity);
        Layout { itemized: false, fourth, components: None, defaults: Defaults::default() }
    }
}

impl Parser<'_> {
    /// All after VECTOR_LIST.
    pub(super) fn vector_list(&mut self) -> Result<VectorList, Fault> {
        let (mut block_normalized, mut internal_units, mut estimate) = (false, false, None);
        let (mut class, mut fourth, mut defaults) = (None, Fourth::Intensity, Defaults::default());
        while let Some(word) = self.accept_one_of(words::VECTOR_OPTIONS) {
            match word {
                Word::BlockNormalized => block_normalized = true,
                Word::Color => fourth = Fourth::Hue,
                Word::Connected => class = Some(VectorClass::Connected),
                Word::Dots => class = Some(VectorClass::Dots),
                Word::Itemized => class = Some(VectorClass::Itemized),
                Word::Separate => class = Some(VectorClass::Separate),
                Word::Tabulated => {
                    fourth = Fourth::Table;
                    class = Some(VectorClass::Itemized);
                }
                Word::InternalUnits => internal_units = true,
                Word::Number => estimate = Some(self.equal_count()?),
                Word::Y => defaults.y = Some(self.equal_real()?),
                Word::Dy => defaults.dy = self.equal_real()?,
                Word::Z => defaults.z = Some(self.equal_real()?),
                _ => defaults.dz = self.equal_real()?,
            }
        }
        let class = class.unwrap_or(if internal_units { VectorClass::Itemized } else { VectorClass::Connected });
        let layout = Layout {
            itemized: class == VectorClass::Itemized,
            fourth: FourthLetter::of(fourth),
            components: defaults.components(),
            defaults,
        };
        let vectors = self.vectors(layout, estimate)?;
        let given = vectors.layout.components.unwrap_or(0);
        let dimension = if given == 3 || defaults.z.is_some() { 3 } else { 2 };
        let Vectors { points, lines, .. } = vectors;
        Ok(VectorList { block_normalized, class, dimension, estimate, fourth, internal_units, points, lines })
    }

    /// The vectors from here to the end of the statement.
    pub(super) fn vectors(&mut self, layout: Layout, estimate: Option<u32>) -> Result<Vectors<'_>, Fault> {
        let text = self.lexer.text();
        let room = (text.len() - self.token.start) / SHORTEST_VECTOR + 1;
        let room = estimate.map_or(0, |n| n as usize).min(room).min(MAX_POINTS);
        let points = Vec::with_capacity(room);
        let lines = Vec::with_capacity(if layout.itemized { room } else { 0 });
        let mut vectors = Vectors { text, at: self.token.start, layout, points, lines };
        vectors.read()?;
        if vectors.at != self.token.start {
            self.jump(vectors.at);
        }
        match self.token.kind {
            kind if Parser::ends(kind) => Ok(vectors),
            _ if layout.itemized => Err(self.fail(&["P", "L", "`;`"])),
            _ => Err(self.fail(&["a vector", "`;`"])),
        }
    }
}

/// The vectors of a list, byte by byte.
pub(super) struct Vectors<'t> {
    text: &'t [u8],
    at: usize,
    layout: Layout,
    pub(super) points: Vec<[f32; 4]>,
    /// Whether each vector is marked L; empty if they have no marks.
    pub(super) lines: Vec<bool>,
}

impl Vectors<'_> {
    /// Reads vectors up to the first byte that begins none.
    fn read(&mut self) -> Result<(), Fault> {
        let itemized = self.layout.itemized;
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
            if self.points.len() == MAX_POINTS {
                return Err(self.fault(Problem::TooManyPoints, &[]));
            }
            let mut point = [0.0, 0.0, 0.0, self.layout.fourth.absent];
            match self.layout.components {
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
                    self.layout.defaults.complete(self.points.len(), &mut point);
                }
                None => self.layout.components = Some(self.first(itemized, &mut point)?),
            }
            self.fourth(&mut point)?;
            if !(point[1].is_finite() && point[2].is_finite()) {
                return Err(self.fault(Problem::OutOfRange, &[]));
            }
            self.points.push(point);
            if let Some(line) = mark {
                self.lines.push(line);
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

    /// `I = i` (or with the letter of another fourth component), if it stands here.
    #[inline]
    fn fourth(&mut self, point: &mut [f32; 4]) -> Result<(), Fault> {
        if self.skip().is_none_or(|byte| byte.to_ascii_uppercase() != self.layout.fourth.letter) {
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
