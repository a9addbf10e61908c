//! Curves: B-splines and polynomials, plain and rational.

use super::Parser;
use crate::command::{
    error::{Fault, Problem},
    syntax::{Bspline, Polynomial},
    token::TokenKind,
    words::{self, Word},
};

/// One more than the highest order.
const ORDERS: i64 = Bspline::MAX_ORDER as i64 + 1;

impl Parser<'_> {
    /// All after BSPLINE; the options in any order, the vertices also without their word.
    pub(super) fn bspline(&mut self, rational: bool) -> Result<Bspline, Fault> {
        let (mut order, mut closed, mut periodic, mut estimate) = (None, false, None, None);
        let (mut vertices, mut knots, mut chords) = (None, None, None);
        loop {
            let word = if self.is_number() && vertices.is_none() {
                Word::Vertices
            } else {
                match self.accept_one_of(words::BSPLINE_OPTIONS) {
                    Some(word) => word,
                    None => break,
                }
            };
            match word {
                Word::Order => order = Some(self.equal_integer(1..ORDERS)? as u8),
                Word::Open => closed = false,
                Word::Closed => closed = true,
                Word::Periodic => periodic = Some(true),
                Word::NonPeriodic => periodic = Some(false),
                Word::Number => estimate = Some(self.equal_count()?),
                Word::Knots => knots = Some(self.knots()?),
                Word::Chords => chords = Some(self.chords()?),
                _ => {
                    self.accept(TokenKind::Equal);
                    vertices = Some(self.weighted(rational, [1.0, 1.0])?);
                }
            }
        }
        let order = order.ok_or_else(|| self.fail(&["ORDER"]))?;
        let (dimension, vertices) = vertices.ok_or_else(|| self.fail(&["VERTICES"]))?;
        let chords = chords.ok_or_else(|| self.fail(&["CHORDS"]))?;
        let periodic = periodic.unwrap_or(closed);
        Ok(Bspline { rational, order, closed, periodic, dimension, estimate, vertices, knots, chords })
    }

    /// `[=] t1, t2...`
    fn knots(&mut self) -> Result<Vec<f64>, Fault> {
        self.accept(TokenKind::Equal);
        let mut knots = vec![self.real()?];
        loop {
            let comma = self.accept(TokenKind::Comma);
            if !comma && !self.is_number() {
                return Ok(knots);
            }
            if knots.len() == Bspline::MAX_VERTICES {
                return Err(self.refuse(Problem::LongCurve));
            }
            knots.push(self.real()?);
        }
    }

    /// `[=] q`
    fn chords(&mut self) -> Result<u32, Fault> {
        Ok(self.equal_integer(1..i64::from(Bspline::MAX_CHORDS) + 1)? as u32)
    }

    /// Rows of `x,y[,z][,w]`, and 2 or 3. `weight`: the fourth component of a row, and of the last one, without w.
    fn weighted(&mut self, rational: bool, weight: [f64; 2]) -> Result<(u8, Vec<[f64; 4]>), Fault> {
        let extra = usize::from(rational);
        let (count, mut rows) = self.rows(2 + extra, 3 + extra)?;
        let dimension = count - extra;
        let last = rows.len() - 1;
        for (index, row) in rows.iter_mut().enumerate() {
            row[3] = if rational { row[dimension] } else { weight[usize::from(index == last)] };
            if dimension == 2 {
                row[2] = 0.0;
            }
        }
        Ok((dimension as u8, rows))
    }

    /// All after POLYNOMIAL: `[ORDER = i] COEFFICIENTS = rows CHORDS = q`.
    pub(super) fn polynomial(&mut self, rational: bool) -> Result<Polynomial, Fault> {
        let (mut order, mut rows, mut chords) = (None, None, None);
        while let Some(word) = self.accept_one_of(words::POLYNOMIAL_OPTIONS) {
            match word {
                Word::Order => order = Some(self.equal_integer(0..ORDERS)? as u8),
                Word::Chords => chords = Some(self.chords()?),
                _ => {
                    self.accept(TokenKind::Equal);
                    let place = self.token;
                    let (dimension, coefficients) = self.weighted(rational, [0.0, 1.0])?;
                    rows = Some((place, dimension, coefficients));
                }
            }
        }
        let (place, dimension, coefficients) = rows.ok_or_else(|| self.fail(&["COEFFICIENTS"]))?;
        let chords = chords.ok_or_else(|| self.fail(&["CHORDS"]))?;
        let limit = order.unwrap_or(Bspline::MAX_ORDER);
        let fits = if order.is_some() { coefficients.len() == usize::from(limit) + 1 } else { true };
        if !fits || coefficients.len() > usize::from(limit) + 1 {
            return Err(Fault { span: place.span(), problem: Problem::Rows { order: limit }, expected: &[] });
        }
        Ok(Polynomial { rational, order, dimension, coefficients, chords })
    }
}
