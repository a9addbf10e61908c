//! Curves: B-splines and polynomials, evaluated to the points of their chords when they are defined.
//!
//! # Source
//! The commands BSPLINE and POLYNOMIAL and their rational forms, as remembered; de Boor 1972 for the
//! evaluation of splines; Graillat, Langlois and Louvet 2009 for that of polynomials.
//! Not modelled: the curve as one entity after its definition. It is a list of q + 1 points from then on, as
//! on the machine; what is kept beside it is the range of its parameter, for coordinate picking.

mod bspline;
mod polynomial;

pub use bspline::bspline;
pub use polynomial::polynomial;

/// Highest order (degree + 1) of a B-spline.
pub const MAX_ORDER: u8 = 10;
/// Highest degree of a polynomial.
pub const MAX_DEGREE: usize = 10;
/// Most rows of coefficients.
const MAX_ROWS: usize = MAX_DEGREE + 1;
/// Most vertices of a B-spline.
pub const MAX_VERTICES: usize = 1 << 20;
/// Most chords of a curve; their points take 16 bytes each.
pub const MAX_CHORDS: u32 = 1 << 20;

/// A curve as the points of its chords.
#[derive(Clone, Debug, PartialEq)]
pub struct Expanded {
    /// x, y, z and the intensity 1 of each of the q + 1 points, connected in this order.
    pub points: Vec<[f32; 4]>,
    /// The parameter at the first and at the last point; it grows evenly from point to point.
    pub parameters: [f64; 2],
}

/// The reason why a curve has no points.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CurveFault {
    /// An order outside of 1..=[`MAX_ORDER`].
    #[error("the order of a B-spline is 1 to {MAX_ORDER}, not {0}")]
    Order(u8),
    /// A polynomial without coefficients, or of a degree above [`MAX_DEGREE`].
    #[error("a polynomial has 1 to {MAX_ROWS} rows of coefficients, not {0}")]
    Coefficients(usize),
    /// Not one row of coefficients more than ORDER says.
    #[error("a polynomial of order {order} has {} rows of coefficients, not {found}", u16::from(*order) + 1)]
    Rows {
        /// The degree.
        order: u8,
        /// The number of rows that were given.
        found: usize,
    },
    /// Chords outside of 1..=[`MAX_CHORDS`].
    #[error("a curve has 1 to {MAX_CHORDS} chords, not {0}")]
    Chords(u32),
    /// Fewer vertices than one span of the curve needs, or more than [`MAX_VERTICES`].
    #[error("this B-spline needs {least} to {MAX_VERTICES} vertices and has {found}")]
    Vertices {
        /// The least number that the order allows.
        least: usize,
        /// The number that was given.
        found: usize,
    },
    /// A vertex or a row of coefficients that is not finite. Counted from 1.
    #[error("value {0} of the curve is not finite")]
    NotFinite(usize),
    /// A wrong number of knots.
    #[error("this B-spline needs {needed} knots and has {found}")]
    KnotCount {
        /// The number that order, vertices and closure ask for.
        needed: usize,
        /// The number that was given.
        found: usize,
    },
    /// A knot that is not finite, or less than the one before. Counted from 1.
    #[error("knot {0} is not a number at or above the one before it")]
    KnotOrder(usize),
    /// More equal knots than the order. The first of them, counted from 1.
    #[error("knot {0} is repeated more often than the order allows")]
    KnotMultiplicity(usize),
    /// The parameter has no range between the knots that count, or one beyond what numbers hold.
    #[error("the knots leave no range for the parameter")]
    NoRange,
    /// The denominator of a rational curve is zero at a point, or has changed its sign since the point before.
    /// Counted from 1.
    #[error("the rational curve goes through infinity at point {0}")]
    Infinity(usize),
    /// A point beyond what vectors hold. Counted from 1.
    #[error("point {0} of the curve is too large")]
    TooLarge(usize),
}

/// The parameter of point `index` of `chords` + 1 points, evenly from `range[0]` to `range[1]`, both exact.
fn parameter(range: [f64; 2], index: u32, chords: u32) -> f64 {
    let [low, high] = range;
    // One division, last: parameters that are whole numbers come out exact, and so do both ends.
    ((low * f64::from(chords - index) + high * f64::from(index)) / f64::from(chords)).clamp(low, high)
}

/// Checks that all values of the rows are finite.
fn finite(rows: &[[f64; 4]]) -> Result<(), CurveFault> {
    match rows.iter().position(|row| row.iter().any(|value| !value.is_finite())) {
        Some(index) => Err(CurveFault::NotFinite(index + 1)),
        None => Ok(()),
    }
}

/// Turns homogeneous values along the curve into points, and refuses those that have no place.
#[derive(Clone, Debug)]
struct Projection {
    rational: bool,
    dimension: u8,
    /// Sign of the denominator so far: it may not change.
    negative: Option<bool>,
    points: Vec<[f32; 4]>,
}

impl Projection {
    fn new(rational: bool, dimension: u8, chords: u32) -> Result<Projection, CurveFault> {
        if !(1..=MAX_CHORDS).contains(&chords) {
            return Err(CurveFault::Chords(chords));
        }
        Ok(Projection { rational, dimension, negative: None, points: Vec::with_capacity(chords as usize + 1) })
    }

    /// Appends the point of x, y, z and denominator `value`.
    fn push(&mut self, value: [f64; 4]) -> Result<(), CurveFault> {
        let number = self.points.len() + 1;
        let denominator = if self.rational { value[3] } else { 1.0 };
        let negative = denominator < 0.0;
        // A denominator that is negative all along draws the same curve as its opposite.
        if denominator == 0.0 || *self.negative.get_or_insert(negative) != negative {
            return Err(CurveFault::Infinity(number));
        }
        let z = if self.dimension == 2 { 0.0 } else { value[2] };
        let [x, y, z] = [value[0], value[1], z].map(|c| (c / denominator) as f32);
        if ![x, y, z].iter().all(|c| c.is_finite()) {
            return Err(CurveFault::TooLarge(number));
        }
        self.points.push([x, y, z, 1.0]);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
