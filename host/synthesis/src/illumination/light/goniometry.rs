//! Intensities of a luminaire over the directions, and the files in which laboratories give them.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Most entries of a table.
const MOST_ENTRIES: usize = 1 << 22;

/// Intensities of a luminaire over vertical and horizontal angles (type C of IES), linear between its entries.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Plain", into = "Plain")]
pub struct Goniometry {
    /// Angles from straight down, degrees, rising.
    vertical: Vec<f64>,
    /// Angles about the axis, degrees, rising from 0.
    horizontal: Vec<f64>,
    /// Candelas: for each horizontal angle one for each vertical angle.
    candelas: Vec<f64>,
}

/// A reason for which a table of intensities cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GoniometryError {
    /// A line of the file.
    #[error("line {line}: {problem}")]
    Line {
        /// The number of the line, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
    /// The file ends too early.
    #[error("the file ends where {0} is expected")]
    Ends(&'static str),
    /// Angles or candelas that make no table.
    #[error("{0}")]
    Table(String),
}

/// A table as it is stored; checked when it is read.
#[derive(Serialize, Deserialize)]
struct Plain {
    vertical: Vec<f64>,
    horizontal: Vec<f64>,
    candelas: Vec<f64>,
}

impl From<Goniometry> for Plain {
    fn from(Goniometry { vertical, horizontal, candelas }: Goniometry) -> Plain {
        Plain { vertical, horizontal, candelas }
    }
}

impl TryFrom<Plain> for Goniometry {
    type Error = GoniometryError;

    fn try_from(Plain { vertical, horizontal, candelas }: Plain) -> Result<Goniometry, GoniometryError> {
        Goniometry::new(vertical, horizontal, candelas)
    }
}

/// Numbers of a file, with the lines where they stand.
struct Numbers<'a> {
    rest: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
}

impl Numbers<'_> {
    fn next(&mut self, what: &'static str) -> Result<f64, GoniometryError> {
        let (line, word) = self.rest.next().ok_or(GoniometryError::Ends(what))?;
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| GoniometryError::Line { line, problem: format!("{what} is \"{word}\", not a number") })
    }

    fn count(&mut self, what: &'static str) -> Result<usize, GoniometryError> {
        let number = self.next(what)?;
        let possible = number.fract() == 0.0 && (1.0..=MOST_ENTRIES as f64).contains(&number);
        let problem = || GoniometryError::Table(format!("{what} is {number}: it must be a whole number from 1"));
        possible.then_some(number as usize).ok_or_else(problem)
    }

    fn list(&mut self, count: usize, what: &'static str) -> Result<Vec<f64>, GoniometryError> {
        (0..count).map(|_| self.next(what)).collect()
    }
}

impl Goniometry {
    /// A table.
    ///
    /// - `vertical`: degrees from straight down, rising within 0..=180. `horizontal`: degrees, rising from 0 to 0, 90,
    ///   180 or 360; what is missing of the circle is the mirror image of what is there.
    /// - `candelas`: for each horizontal angle one for each vertical angle.
    ///
    /// # Errors
    /// [`GoniometryError::Table`].
    pub fn new(vertical: Vec<f64>, horizontal: Vec<f64>, candelas: Vec<f64>) -> Result<Goniometry, GoniometryError> {
        let failed = |problem: &str| Err(GoniometryError::Table(problem.into()));
        let rises = |angles: &[f64]| angles.windows(2).all(|pair| pair[0] < pair[1]);
        let within = |angles: &[f64], most: f64| angles.iter().all(|angle| (0.0..=most).contains(angle));
        if vertical.is_empty() || !rises(&vertical) || !within(&vertical, 180.0) {
            return failed("the vertical angles do not rise within 0 to 180 degrees (type C)");
        }
        let ends = |last: f64| [0.0, 90.0, 180.0, 360.0].contains(&last);
        let is_round = horizontal.first() == Some(&0.0) && horizontal.last().is_some_and(|last| ends(*last));
        if !is_round || !rises(&horizontal) {
            return failed("the horizontal angles do not rise from 0 to 0, 90, 180 or 360 degrees (type C)");
        }
        if vertical.len().checked_mul(horizontal.len()) != Some(candelas.len()) {
            return failed("there is not one intensity for each pair of angles");
        }
        if candelas.iter().any(|candela| !(*candela >= 0.0 && candela.is_finite())) {
            return failed("an intensity is negative or not finite");
        }
        Ok(Goniometry { vertical, horizontal, candelas })
    }

    /// Reads a file of the Illuminating Engineering Society.
    ///
    /// # Errors
    /// [`GoniometryError`], with the line where it is known.
    ///
    /// # Source
    /// ANSI/IES LM-63-2002; also its predecessors of 1986, 1991 and 1995. Only type C, without a tilt.
    pub fn parse(text: &str) -> Result<Goniometry, GoniometryError> {
        let mut lines = text.lines().enumerate();
        let is_tilt = |line: &str| line.trim_start().to_ascii_uppercase().starts_with("TILT");
        let (number, tilt) = lines.find(|(_, line)| is_tilt(line)).ok_or(GoniometryError::Ends("TILT=NONE"))?;
        if tilt.split('=').nth(1).map(|word| word.trim().to_ascii_uppercase()).as_deref() != Some("NONE") {
            let problem = format!("\"{}\": only TILT=NONE is known", tilt.trim());
            return Err(GoniometryError::Line { line: number + 1, problem });
        }
        let words = lines.flat_map(|(number, line)| {
            line.split([' ', '\t', ',', '\r']).filter(|word| !word.is_empty()).map(move |word| (number + 1, word))
        });
        let mut numbers = Numbers { rest: Box::new(words) };
        numbers.next("the number of lamps")?;
        numbers.next("the lumens of a lamp")?;
        let multiplier = numbers.next("the multiplier")?;
        let vertical = numbers.count("the number of vertical angles")?;
        let horizontal = numbers.count("the number of horizontal angles")?;
        let kind = numbers.next("the type of photometry")?;
        if kind != 1.0 {
            return Err(GoniometryError::Table(format!("photometry of type {kind}: only type C (1) is known")));
        }
        for what in ["the unit of length", "the width", "the length", "the height"] {
            numbers.next(what)?;
        }
        let ballast = numbers.next("the ballast factor")?;
        numbers.next("the number for later use")?;
        numbers.next("the watts")?;
        let count = vertical.checked_mul(horizontal).filter(|count| *count <= MOST_ENTRIES);
        let count = count.ok_or_else(|| GoniometryError::Table("there are too many angles".into()))?;
        let vertical = numbers.list(vertical, "a vertical angle")?;
        let horizontal = numbers.list(horizontal, "a horizontal angle")?;
        let candelas = numbers.list(count, "an intensity")?;
        let candelas = candelas.into_iter().map(|candela| candela * multiplier * ballast).collect();
        Goniometry::new(vertical, horizontal, candelas)
    }

    /// Intensity in a direction, cd; 0 beyond the vertical angles.
    ///
    /// - `direction`: unit length; −z is down (0 degrees), x is where the horizontal angle is 0.
    pub fn candelas(&self, direction: DVec3) -> f64 {
        let vertical = direction.truncate().length().atan2(-direction.z).to_degrees();
        let around = direction.y.atan2(direction.x).rem_euclid(TAU).to_degrees();
        let around = match self.horizontal.last().copied().unwrap_or(0.0) {
            90.0 => {
                let half = if around > 180.0 { 360.0 - around } else { around };
                if half > 90.0 { 180.0 - half } else { half }
            }
            180.0 if around > 180.0 => 360.0 - around,
            0.0 => 0.0,
            _ => around,
        };
        let (Some(low), Some(high)) = (self.vertical.first(), self.vertical.last()) else { return 0.0 };
        // A direction along the axis is off by rounding.
        let slack = 1e-9;
        if vertical < low - slack || vertical > high + slack {
            return 0.0;
        }
        let (row, down) = between(&self.vertical, vertical);
        let (column, aside) = between(&self.horizontal, around);
        let rows = self.vertical.len();
        let at =
            |column: usize, row: usize| self.candelas[column.min(self.horizontal.len() - 1) * rows + row.min(rows - 1)];
        let along = |column: usize| at(column, row) * (1.0 - down) + at(column, row + 1) * down;
        along(column) * (1.0 - aside) + along(column + 1) * aside
    }

    /// The greatest intensity, cd.
    pub fn greatest(&self) -> f64 {
        self.candelas.iter().copied().fold(0.0, f64::max)
    }
}

/// Between which entries a value lies, and where.
fn between(entries: &[f64], value: f64) -> (usize, f64) {
    let above = entries.partition_point(|entry| *entry <= value);
    let index = above.saturating_sub(1);
    match entries.get(index + 1) {
        Some(next) => (index, ((value - entries[index]) / (next - entries[index])).clamp(0.0, 1.0)),
        None => (index, 0.0),
    }
}
