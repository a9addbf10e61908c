//! Any function as a distribution: sampled to a table, normalised, and with a stated error.

use super::measure::{checked, light_at};
use super::{Distribution, DistributionError};
use crate::numeric::sampling::{RandomStream, sphere};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Least and most steps of a table: it holds as many numbers as twice the cube of its steps.
const STEPS: std::ops::RangeInclusive<usize> = 4..=96;
/// Random pairs of directions at which the error is measured.
const MEASURED: u64 = 4000;
/// Seed of those pairs.
const SEED: u64 = 1988;

/// How well a table stands for its function.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TableAccuracy {
    /// Root of the mean square of the error, over that of the function, at random directions.
    pub rms: f64,
    /// Greatest error there, over the greatest value of the function there.
    pub greatest: f64,
    /// The least integral of the function over the hemisphere, before it was normalised, over all incidences.
    pub least_share: f64,
    /// The greatest.
    pub greatest_share: f64,
}

/// A distribution made from any function of the angles of light and viewer and the azimuth between them.
///
/// The table has `steps` + 1 angles of the light, `steps` rings of cells for the viewer and 2 `steps` cells in each
/// ring. D / (N·V) is linear between the angles of the light and between the middles of the cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Plain")]
pub struct Tabulated {
    name: String,
    steps: usize,
    /// For each angle of the light, ring and sector: D / (N·V) in the middle of the cell, 1/sr.
    values: Vec<f64>,
    /// For each angle of the light: the part of what is emitted up to each cell.
    below: Vec<f64>,
    accuracy: TableAccuracy,
}

/// A table as it is stored; checked when it is read.
#[derive(Deserialize)]
struct Plain {
    name: String,
    steps: usize,
    values: Vec<f64>,
    below: Vec<f64>,
    accuracy: TableAccuracy,
}

impl TryFrom<Plain> for Tabulated {
    type Error = DistributionError;

    fn try_from(Plain { name, steps, values, below, accuracy }: Plain) -> Result<Tabulated, DistributionError> {
        if !STEPS.contains(&steps) {
            return Err(DistributionError::Resolution(steps));
        }
        let cells = 2 * steps * steps;
        let problem = if values.len() != (steps + 1) * cells || below.len() != values.len() {
            "it has not one number for each cell"
        } else if values.iter().any(|value| !(*value >= 0.0 && value.is_finite())) {
            "a value is negative or not finite"
        } else if below.chunks(cells).any(|row| !rises_to_one(row)) {
            "its sums do not rise to 1"
        } else {
            return Ok(Tabulated { name, steps, values, below, accuracy });
        };
        Err(DistributionError::Table { name, problem })
    }
}

/// Whether sums of parts rise from 0 or more to 1, but for rounding.
fn rises_to_one(sums: &[f64]) -> bool {
    let starts = sums.first().is_some_and(|first| *first >= 0.0);
    starts && sums.is_sorted() && sums.last().is_some_and(|last| (last - 1.0).abs() < 1e-9)
}

impl Tabulated {
    /// Samples a function, an isotropic D in 1/sr, and scales it at every incidence so that its integral is 1.
    ///
    /// - `name`: for tables and messages.
    /// - `steps`: 4..=96. A lobe should be several times as wide as 90 degrees over `steps`; [`Tabulated::accuracy`]
    ///   tells whether it was.
    /// - `function`: D for light and viewer, both above the horizon in the frame of the element, the light in the plane
    ///   of x and z.
    ///
    /// # Errors
    /// [`DistributionError::Resolution`]; [`DistributionError::Negative`] or [`DistributionError::NotFinite`] with the
    /// directions in which the function is so; [`DistributionError::Nothing`] if it is 0 everywhere for a light.
    pub fn new(
        name: impl Into<String>,
        steps: usize,
        function: impl Fn(DVec3, DVec3) -> f64,
    ) -> Result<Tabulated, DistributionError> {
        if !STEPS.contains(&steps) {
            return Err(DistributionError::Resolution(steps));
        }
        let accuracy = TableAccuracy { rms: 0.0, greatest: 0.0, least_share: f64::INFINITY, greatest_share: 0.0 };
        let mut made = Tabulated { name: name.into(), steps, values: Vec::new(), below: Vec::new(), accuracy };
        let mut scales = Vec::new();
        for row in 0..=steps {
            scales.push(made.add_row(made.light(row), &function)?);
        }
        made.measure(&scales, &function)?;
        Ok(made)
    }

    /// The light of a row, a little above the horizon at the most.
    fn light(&self, row: usize) -> DVec3 {
        light_at((FRAC_PI_2 * row as f64 / self.steps as f64).min(FRAC_PI_2 - 1e-6))
    }

    /// Samples the function for one light; gives the integral by which it was divided.
    fn add_row(&mut self, light: DVec3, function: &impl Fn(DVec3, DVec3) -> f64) -> Result<f64, DistributionError> {
        let first = self.values.len();
        for ring in 0..self.steps {
            let middle = (ring as f64 + 0.5) / self.steps as f64 * FRAC_PI_2;
            for sector in 0..2 * self.steps {
                let azimuth = (sector as f64 + 0.5) / self.steps as f64 * PI;
                let view = DVec3::new(middle.sin() * azimuth.cos(), middle.sin() * azimuth.sin(), middle.cos());
                let value = checked(&self.name, function(light, view), light, view)?;
                self.values.push(value / view.z);
            }
        }
        let sectors = 2 * self.steps;
        let flux = |cell: usize| self.values[first + cell] * self.projected(cell / sectors) / sectors as f64;
        let all: f64 = (0..self.steps * sectors).map(flux).sum();
        if !(all > 0.0 && all.is_finite()) {
            return Err(DistributionError::Nothing { name: self.name.clone(), light });
        }
        let mut sum = 0.0;
        let below: Vec<f64> = (0..self.steps * sectors)
            .map(|cell| {
                sum += flux(cell) / all;
                sum
            })
            .collect();
        self.below.extend(below);
        self.values[first..].iter_mut().for_each(|value| *value /= all);
        Ok(all)
    }

    /// Integral of the cosine over a ring, sr.
    fn projected(&self, ring: usize) -> f64 {
        let square = |edge: usize| (FRAC_PI_2 * edge as f64 / self.steps as f64).sin().powi(2);
        PI * (square(ring + 1) - square(ring))
    }

    fn measure(&mut self, scales: &[f64], function: &impl Fn(DVec3, DVec3) -> f64) -> Result<(), DistributionError> {
        let (mut errors, mut squares, mut greatest, mut highest) = (0.0, 0.0, 0.0_f64, 0.0_f64);
        for index in 0..MEASURED {
            let mut stream = RandomStream::new(SEED, index);
            let mut above = || {
                let direction = sphere(stream.point());
                direction.truncate().extend(direction.z.abs().max(1e-3)).normalize()
            };
            let (light, view) = (light_at(above().z.acos()), above());
            let (row, part) = self.between(light.z);
            let scale = scales[row] * (1.0 - part) + scales[row + 1] * part;
            let exact = checked(&self.name, function(light, view), light, view)? / scale;
            let error = (self.density(light, view) - exact).abs();
            errors += error * error;
            squares += exact * exact;
            (greatest, highest) = (greatest.max(error), highest.max(exact));
        }
        let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { f64::INFINITY };
        self.accuracy = TableAccuracy {
            rms: ratio(errors, squares).sqrt(),
            greatest: ratio(greatest, highest),
            least_share: scales.iter().copied().fold(f64::INFINITY, f64::min),
            greatest_share: scales.iter().copied().fold(0.0, f64::max),
        };
        Ok(())
    }

    /// How well the table stands for its function.
    pub fn accuracy(&self) -> TableAccuracy {
        self.accuracy
    }

    /// The row before the angle of a light, and how far it is to the next, 0..=1.
    fn between(&self, cosine: f64) -> (usize, f64) {
        let place = cosine.clamp(0.0, 1.0).acos() / FRAC_PI_2 * self.steps as f64;
        let row = (place as usize).min(self.steps - 1);
        (row, place - row as f64)
    }

    /// Ring and sector of a viewer as fractions of cells; the azimuth is that from the light.
    fn place(&self, light: DVec3, view: DVec3) -> [f64; 2] {
        let azimuth = view.y.atan2(view.x) - light.y.atan2(light.x);
        let ring = view.z.clamp(0.0, 1.0).acos() / FRAC_PI_2 * self.steps as f64;
        [ring, azimuth.rem_euclid(TAU) / PI * self.steps as f64]
    }

    /// D / (N·V) of a row, linear between the middles of the cells.
    fn value(&self, row: usize, [ring, sector]: [f64; 2]) -> f64 {
        let sectors = 2 * self.steps;
        let at = |ring: usize, sector: usize| self.values[(row * self.steps + ring) * sectors + sector % sectors];
        let inward = (ring - 0.5).clamp(0.0, self.steps as f64 - 1.0);
        let around = sector - 0.5 + sectors as f64;
        let (r, s) = ((inward as usize).min(self.steps - 2), around as usize);
        let (x, y) = (inward - r as f64, around - s as f64);
        (at(r, s) * (1.0 - y) + at(r, s + 1) * y) * (1.0 - x) + (at(r + 1, s) * (1.0 - y) + at(r + 1, s + 1) * y) * x
    }
}

impl Distribution for Tabulated {
    fn name(&self) -> &str {
        &self.name
    }

    fn density(&self, light: DVec3, view: DVec3) -> f64 {
        let (row, part) = self.between(light.z);
        let place = self.place(light, view);
        (self.value(row, place) * (1.0 - part) + self.value(row + 1, place) * part) * view.z
    }

    fn sample(&self, light: DVec3, point: [f64; 2]) -> Option<DVec3> {
        // The first coordinate chooses one of two rows, then a cell, and what is left of it the place in the cell.
        let (row, part) = self.between(light.z);
        let (row, uniform) =
            if point[0] < part { (row + 1, point[0] / part) } else { (row, (point[0] - part) / (1.0 - part)) };
        let cells = 2 * self.steps * self.steps;
        let below = &self.below[row * cells..(row + 1) * cells];
        let cell = below.partition_point(|below| *below <= uniform).min(cells - 1);
        let before = if cell == 0 { 0.0 } else { below[cell - 1] };
        let inside = ((uniform - before) / (below[cell] - before)).clamp(0.0, 1.0);
        let (ring, sector) = (cell / (2 * self.steps), cell % (2 * self.steps));
        let square = |edge: usize| (FRAC_PI_2 * edge as f64 / self.steps as f64).sin().powi(2);
        // Even in the square of the sine is a pdf with the cosine.
        let sine = (square(ring) + (square(ring + 1) - square(ring)) * inside).clamp(0.0, 1.0);
        let azimuth = (sector as f64 + point[1]) / self.steps as f64 * PI + light.y.atan2(light.x);
        let (sin, cos) = azimuth.sin_cos();
        let radius = sine.sqrt();
        Some(DVec3::new(radius * cos, radius * sin, (1.0 - sine).sqrt())).filter(|view| view.z > 0.0)
    }

    fn pdf(&self, light: DVec3, view: DVec3) -> f64 {
        let (row, part) = self.between(light.z);
        let [ring, sector] = self.place(light, view).map(|place| place as usize);
        let cell = ring.min(self.steps - 1) * 2 * self.steps + sector.min(2 * self.steps - 1);
        let value = |row: usize| self.values[row * 2 * self.steps * self.steps + cell];
        (value(row) * (1.0 - part) + value(row + 1) * part) * view.z
    }
}
