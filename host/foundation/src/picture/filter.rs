//! Reconstruction filters: how much light around a pixel's middle counts in it. One row each.
//!
//! Samples are drawn where a filter counts, in proportion to its absolute value, and each has the weight that makes their
//! mean the filtered light without bias, whatever their number.
//!
//! # Source
//! Ernst, Stamminger and Greiner 2006, filter importance sampling; as tables of Pharr, Jakob and Humphreys 2023, section 8.8.

use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// Steps of the table of a filter along one axis.
const STEPS: usize = 128;

/// How samples around a pixel become one value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Filter {
    /// The mean over the pixel.
    #[default]
    Box,
    /// A bell.
    Gaussian,
    /// A bell that falls to nothing smoothly.
    BlackmanHarris,
    /// Sharpens, with a little less of the light around.
    Mitchell,
}

/// A filter along one axis; that of the plane is the product of both.
struct Row {
    filter: Filter,
    word: &'static str,
    /// Beyond this distance from the middle it is 0, pixels.
    radius: f64,
    /// Its value at a distance from the middle, pixels; of any scale.
    value: fn(f64) -> f64,
}

const ROWS: &[Row] = &[
    Row { filter: Filter::Box, word: "box", radius: 0.5, value: |_| 1.0 },
    Row { filter: Filter::Gaussian, word: "gaussian", radius: 1.5, value: gaussian },
    Row { filter: Filter::BlackmanHarris, word: "blackman-harris", radius: 1.5, value: blackman_harris },
    Row { filter: Filter::Mitchell, word: "mitchell", radius: 2.0, value: mitchell },
];

/// A Gaussian of standard deviation one half, less its value at 1.5, so that it ends in 0.
fn gaussian(x: f64) -> f64 {
    let bell = |x: f64| (-2.0 * x * x).exp();
    bell(x) - bell(1.5)
}

/// # Source
/// Harris 1978, the minimum four-term window.
fn blackman_harris(x: f64) -> f64 {
    let angle = TAU * (x / 3.0 + 0.5);
    0.358_75 - 0.488_29 * angle.cos() + 0.141_28 * (2.0 * angle).cos() - 0.011_68 * (3.0 * angle).cos()
}

/// # Source
/// Mitchell and Netravali 1988, with B = C = 1/3.
fn mitchell(x: f64) -> f64 {
    let x = x.abs();
    if x < 1.0 { (7.0 * x - 12.0) * x * x + 16.0 / 3.0 } else { ((12.0 - 7.0 / 3.0 * x) * x - 20.0) * x + 32.0 / 3.0 }
}

/// A filter along one axis as a table to draw from.
struct Table {
    row: &'static Row,
    /// The part of the absolute filter up to the end of each step.
    cumulative: Vec<f64>,
    /// The integral of the filter.
    integral: f64,
}

impl Table {
    fn new(row: &'static Row) -> Table {
        let width = 2.0 * row.radius / STEPS as f64;
        // Means of steps by three points of Gauss, which are exact for polynomials of the fifth degree.
        let of_step = |step: usize, value: &dyn Fn(f64) -> f64| {
            let middle = (step as f64 + 0.5) * width - row.radius;
            let aside = 0.6f64.sqrt() / 2.0 * width;
            (5.0 * value(middle - aside) + 8.0 * value(middle) + 5.0 * value(middle + aside)) / 18.0
        };
        let integral = (0..STEPS).map(|step| of_step(step, &|x| (row.value)(x))).sum::<f64>() * width;
        let absolute: Vec<f64> = (0..STEPS).map(|step| of_step(step, &|x| (row.value)(x).abs())).collect();
        let sum: f64 = absolute.iter().sum();
        let running = absolute.iter().scan(0.0, |running, part| {
            *running += part / sum;
            Some(*running)
        });
        Table { row, cumulative: running.collect(), integral }
    }

    /// A distance from the middle, pixels, and its weight.
    fn sample(&self, uniform: f64) -> (f64, f64) {
        let step = self.cumulative.partition_point(|end| *end <= uniform).min(STEPS - 1);
        let begin = if step == 0 { 0.0 } else { self.cumulative[step - 1] };
        let part = self.cumulative[step] - begin;
        let width = 2.0 * self.row.radius / STEPS as f64;
        let x = (step as f64 + ((uniform - begin) / part).clamp(0.0, 1.0)) * width - self.row.radius;
        let pdf = part / width;
        (x, (self.row.value)(x) / (pdf * self.integral))
    }
}

static TABLES: LazyLock<Vec<Table>> = LazyLock::new(|| ROWS.iter().map(Table::new).collect());

impl Filter {
    /// The words for all of them.
    pub const WORDS: [&str; ROWS.len()] = words!(ROWS);

    /// All of them, each with its word.
    pub const NAMED: [(&'static str, Filter); ROWS.len()] = named!(ROWS, filter);

    /// The one that a word names.
    pub fn of_word(word: &str) -> Option<Filter> {
        ROWS.iter().find(|row| row.word == word).map(|row| row.filter)
    }

    /// Where in the picture a sample of a pixel lies, pixels from the pixel's left upper corner, and what its light is
    /// multiplied with: the mean of that over all samples is 1.
    ///
    /// - `uniform`: a point of the unit square.
    pub fn sample(self, uniform: [f64; 2]) -> ([f64; 2], f64) {
        if self == Filter::Box {
            return (uniform, 1.0);
        }
        let table = TABLES.iter().find(|table| table.row.filter == self).unwrap_or(&TABLES[0]);
        let [(x, a), (y, b)] = uniform.map(|uniform| table.sample(uniform));
        ([x + 0.5, y + 0.5], a * b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean of a function of the distance from the middle over many even samples along one axis.
    fn mean(row: &'static Row, of: impl Fn(f64) -> f64) -> f64 {
        let (table, count) = (Table::new(row), 1 << 20);
        let sum: f64 = (0..count)
            .map(|i| {
                let (x, weight) = table.sample((f64::from(i) + 0.5) / f64::from(count));
                weight * of(x)
            })
            .sum();
        sum / f64::from(count)
    }

    #[test]
    fn weights_have_the_mean_one_and_samples_lie_where_the_filter_does() {
        for row in ROWS {
            assert_eq!(Filter::of_word(row.word), Some(row.filter));
            let all = mean(row, |_| 1.0);
            assert!((all - 1.0).abs() < 1e-5, "{}: {all}", row.word);
            let beyond = mean(row, |x| f64::from(u8::from(x.abs() > row.radius + 1e-12)));
            assert_eq!(beyond, 0.0, "{}", row.word);
            let ([x, y], weight) = row.filter.sample([0.5; 2]);
            assert!((x - 0.5).abs() < 1e-9 && x == y && weight > 0.9, "{}: {x} {weight}", row.word);
        }
        assert_eq!(Filter::of_word("tent"), None);
    }

    #[test]
    fn moments_are_those_of_the_filters() {
        // Second moments along one axis by Simpson's rule over the definitions.
        for row in ROWS {
            let steps = 20_000;
            let x = |i: usize| (2.0 * i as f64 / steps as f64 - 1.0) * row.radius;
            let simpson = |of: &dyn Fn(f64) -> f64| -> f64 {
                (0..=steps)
                    .map(|i| {
                        of(x(i))
                            * if i == 0 || i == steps {
                                1.0
                            } else if i % 2 == 1 {
                                4.0
                            } else {
                                2.0
                            }
                    })
                    .sum()
            };
            let expected = simpson(&|x| x * x * (row.value)(x)) / simpson(&|x| (row.value)(x));
            let found = mean(row, |x| x * x);
            assert!((found - expected).abs() < 1e-5, "{}: {found} {expected}", row.word);
        }
    }

    #[test]
    fn pieces_of_mitchell_meet_and_the_bells_end_in_nothing() {
        assert!((mitchell(1.0 - 1e-9) - mitchell(1.0)).abs() < 1e-7 && mitchell(2.0).abs() < 1e-12);
        assert!((mitchell(0.0) - 16.0 / 3.0).abs() < 1e-12 && mitchell(1.5) < 0.0);
        assert!(
            gaussian(1.5) == 0.0 && blackman_harris(1.5).abs() < 1e-4 && (blackman_harris(0.0) - 1.0).abs() < 1e-12
        );
    }
}
