//! Polynomial curves and their rational form.

use super::{CurveFault, Expanded, MAX_ROWS, Projection, finite, parameter};
use protocol::command::Polynomial;

/// Evaluates a polynomial curve at equal steps of t = 0..=1.
///
/// Coefficients of powers may cancel: (t - 1)^10 is 0 at t = 1 as a sum of terms of up to 252. The compensated
/// scheme of Horner adds up what rounding took from each step, and so gives the result of twice the precision,
/// rounded once; it needs no other basis, into which the coefficients would have to be rounded first.
///
/// # Errors
/// Wrong counts, values that are not finite, a zero or a change of sign of the denominator, points that are too
/// large for a vector.
///
/// # Source
/// Graillat, Langlois and Louvet 2009, algorithm CompHorner.
pub fn polynomial(curve: &Polynomial) -> Result<Expanded, CurveFault> {
    let rows = curve.coefficients.len();
    if !(1..=MAX_ROWS).contains(&rows) {
        return Err(CurveFault::Coefficients(rows));
    }
    if let Some(order) = curve.order.filter(|order| usize::from(*order) + 1 != rows) {
        return Err(CurveFault::Rows { order, found: rows });
    }
    finite(&curve.coefficients)?;
    let range = [0.0, 1.0];
    let mut projection = Projection::new(curve.rational, curve.dimension, curve.chords)?;
    for index in 0..=curve.chords {
        let t = parameter(range, index, curve.chords);
        projection.push([0, 1, 2, 3].map(|axis| horner(curve.coefficients.iter().map(|row| row[axis]), t)))?;
    }
    Ok(Expanded { points: projection.points, parameters: range })
}

/// The polynomial of `coefficients` (highest power first) at `t`, by the compensated scheme of Horner.
fn horner(coefficients: impl Iterator<Item = f64>, t: f64) -> f64 {
    let (mut sum, mut error) = (0.0_f64, 0.0_f64);
    for coefficient in coefficients {
        let product = sum * t;
        let product_error = sum.mul_add(t, -product);
        let next = product + coefficient;
        // What rounding took from product + coefficient, exactly (Knuth's TwoSum).
        let part = next - product;
        let sum_error = (product - (next - part)) + (coefficient - part);
        error = error * t + (product_error + sum_error);
        sum = next;
    }
    sum + error
}
