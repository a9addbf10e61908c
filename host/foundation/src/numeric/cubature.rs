//! Integrals over the unit square, with an estimate of their error.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Points of Gauss and Legendre's rule of four points in 0..1, and their weights.
pub const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Cells along each side of the square at the start.
const START: u32 = 8;

/// An integral.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral {
    /// Its value.
    pub value: f64,
    /// How far off it is likely to be at the most: the sum, over all cells, of what their last division changed.
    pub error: f64,
    /// How often the function was asked.
    pub evaluations: u32,
}

/// A rectangular part of the unit square.
struct Cell {
    corner: [f64; 2],
    size: [f64; 2],
    value: f64,
    /// The axis along which the function bends more.
    axis: usize,
    /// How far off its value is likely to be at the most.
    error: f64,
}

impl PartialEq for Cell {
    fn eq(&self, other: &Cell) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cell {}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Cell) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Cell {
    fn cmp(&self, other: &Cell) -> Ordering {
        self.error.total_cmp(&other.error).then_with(|| other.corner[0].total_cmp(&self.corner[0]))
    }
}

/// The cell, by Gauss and Legendre's rule of four points a side.
fn cell(f: &dyn Fn([f64; 2]) -> f64, corner: [f64; 2], size: [f64; 2]) -> Cell {
    let mut values = [[0.0; 4]; 4];
    let (mut sum, mut bends) = (0.0, [0.0; 2]);
    for (row, (y, of_y)) in values.iter_mut().zip(GAUSS) {
        for (value, (x, of_x)) in row.iter_mut().zip(GAUSS) {
            *value = f([corner[0] + x * size[0], corner[1] + y * size[1]]);
            sum += of_x * of_y * *value;
        }
    }
    // Second and third differences along each axis.
    let bend = |v: [f64; 4]| (v[0] - v[1] - v[2] + v[3]).abs() + (v[0] - 3.0 * v[1] + 3.0 * v[2] - v[3]).abs();
    for (i, row) in values.iter().enumerate() {
        bends[0] += bend(*row);
        bends[1] += bend(values.map(|row| row[i]));
    }
    Cell { corner, size, value: sum * size[0] * size[1], axis: usize::from(bends[1] > bends[0]), error: 0.0 }
}

/// A division that changes little may have been made across the wrong axis: the error falls no faster than by this.
const SLOWEST: f64 = 1.0 / 8.0;

/// The two halves of a cell. Their error is half of what the division changed.
fn halves(f: &dyn Fn([f64; 2]) -> f64, whole: &Cell) -> [Cell; 2] {
    let mut size = whole.size;
    size[whole.axis] /= 2.0;
    let mut cells = [0.0, size[whole.axis]].map(|offset| {
        let mut corner = whole.corner;
        corner[whole.axis] += offset;
        cell(f, corner, size)
    });
    let change = (cells[0].value + cells[1].value - whole.value).abs();
    cells.iter_mut().for_each(|cell| cell.error = (change / 2.0).max(whole.error * SLOWEST));
    cells
}

/// The quarters of a cell. Their error is a quarter of what the divisions changed.
fn quarters(f: &dyn Fn([f64; 2]) -> f64, whole: &Cell) -> Vec<Cell> {
    let mut cells: Vec<Cell> = Vec::with_capacity(4);
    let half = whole.size.map(|side| side / 2.0);
    for i in 0..4 {
        let corner = [whole.corner[0] + half[0] * f64::from(i & 1), whole.corner[1] + half[1] * f64::from(i >> 1)];
        cells.push(cell(f, corner, half));
    }
    let change = (cells.iter().map(|cell| cell.value).sum::<f64>() - whole.value).abs();
    cells.iter_mut().for_each(|cell| cell.error = change / 4.0);
    cells
}

/// 0..1 to 0..1, flat at both ends.
fn gather(x: f64) -> f64 {
    x * x * x * (10.0 - x * (15.0 - 6.0 * x))
}

/// The derivative of [`gather`].
fn gather_slope(x: f64) -> f64 {
    30.0 * (x * (1.0 - x)).powi(2)
}

/// The integral of a function over the unit square.
///
/// The cell with the largest error is halved, across the axis along which the function bends more, until the errors add
/// up to no more than `tolerance`, or `most` values of the function have been asked for. Kinks and steps are found and
/// followed; a peak narrower than a thirtieth of the square may be missed: map it away.
///
/// Points gather at the border of the square, where maps from it to directions have their rare ones.
///
/// - `f`: finite everywhere inside the square; it is not asked on the border.
pub fn unit_square(f: impl Fn([f64; 2]) -> f64, tolerance: f64, most: u32) -> Integral {
    // Not copied into each of the places that ask it: these are many, and it may be long.
    let f: &dyn Fn([f64; 2]) -> f64 = &|[x, y]| gather_slope(x) * gather_slope(y) * f([gather(x), gather(y)]);
    let side = 1.0 / f64::from(START);
    let mut cells = BinaryHeap::new();
    for i in 0..START * START {
        let corner = [f64::from(i % START) * side, f64::from(i / START) * side];
        cells.extend(quarters(f, &cell(f, corner, [side; 2])));
    }
    let mut evaluations = START * START * 5 * 16;
    let mut error: f64 = cells.iter().map(|cell| cell.error).sum();
    while error > tolerance && evaluations + 32 <= most {
        let Some(worst) = cells.pop() else { break };
        let parts = halves(f, &worst);
        error += parts.iter().map(|cell| cell.error).sum::<f64>() - worst.error;
        cells.extend(parts);
        evaluations += 32;
    }
    // Added up anew and in an order of its own: the running sum has collected rounding errors.
    let mut cells = cells.into_vec();
    cells.sort_by(|a, b| a.value.total_cmp(&b.value));
    let sum = |of: fn(&Cell) -> f64| cells.iter().map(of).sum::<f64>();
    Integral { value: sum(|cell| cell.value), error: sum(|cell| cell.error), evaluations }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{E, PI};

    #[test]
    fn smooth_functions_need_little_work() {
        let found = unit_square(|[x, y]| (x + y).exp(), 1e-6, 20_000);
        assert!((found.value - (E - 1.0).powi(2)).abs() < 1e-8 && found.evaluations < 6000, "{found:?}");
    }

    #[test]
    fn kinks_and_steps_are_followed_within_the_stated_error() {
        let kink = unit_square(|[x, y]| (x * x + y * y - 0.5).max(0.0), 1e-6, 1_000_000);
        // All of the square, less the quarter of a disc where the function is cut off.
        let exact = 2.0 / 3.0 - 0.5 + PI / 32.0;
        assert!((kink.value - exact).abs() < 1e-6 && kink.error < 1e-6, "{kink:?} {exact}");
        let step = unit_square(|[x, y]| if x * x + y * y < 1.0 { 1.0 } else { 0.0 }, 1e-3, 1_000_000);
        assert!((step.value - PI / 4.0).abs() < step.error && step.error < 1e-3, "{step:?}");
    }

    #[test]
    fn the_work_is_bounded() {
        let found = unit_square(|[x, _]| 1.0 / (x + 1e-12), 1e-9, 9000);
        assert!(found.evaluations <= 9000 && found.error > 1e-9);
    }
}
