//! Functions of the plane between two parallel planes over a disc.

use glam::DVec2;
use std::ops::{Add, Mul};

/// What one operation may lose by rounding, as a part of what it gives, with room for several.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A function over a disc: `value + slope . d`, off by at most `error`, where d is the offset from the middle of the
/// disc.
/// Its gradient is `slope`, off by a vector of a length of at most `slope_error`.
///
/// # Source
/// Affine arithmetic with one error term (Messine 2002), with the gradient beside it; for rays in fractals: Gamito and
/// Maddock 2007.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    /// The function at the middle of the disc, about.
    pub value: f64,
    /// Its gradient there, about.
    pub slope: DVec2,
    /// The function is so far from the plane at the most.
    pub error: f64,
    /// The gradient is so far from `slope` at the most.
    pub slope_error: f64,
    /// Radius of the disc.
    pub radius: f64,
}

impl Enclosure {
    /// A number, over any disc.
    pub fn constant(value: f64, radius: f64) -> Enclosure {
        Enclosure { value, slope: DVec2::ZERO, error: 0.0, slope_error: 0.0, radius }
    }

    /// The most that its plane comes to over the disc.
    fn size(&self) -> f64 {
        self.value.abs() + self.slope.length() * self.radius
    }

    /// How far it goes from its value at the most.
    pub fn spread(&self) -> f64 {
        self.slope.length() * self.radius + self.error
    }

    /// Bounds of the function.
    pub fn range(&self) -> [f64; 2] {
        let spread = self.spread() + ROUNDING * self.value.abs();
        [self.value - spread, self.value + spread]
    }

    /// No gradient is longer.
    pub fn steepest(&self) -> f64 {
        self.slope.length() + self.slope_error
    }

    /// The product with a number.
    pub fn scaled(self, by: f64) -> Enclosure {
        let size = by.abs();
        Enclosure {
            value: self.value * by,
            slope: self.slope * by,
            error: (self.error + ROUNDING * self.size()) * size,
            slope_error: self.slope_error * size + ROUNDING * self.slope.length() * size,
            radius: self.radius,
        }
    }

    /// A function of it that bends once within its range, from one rate to another.
    ///
    /// - `ends`: the function at both ends of the range.
    /// - `rates`: its rates before and after the bend.
    fn bent(self, range: [f64; 2], ends: [f64; 2], rates: [f64; 2]) -> Enclosure {
        let width = range[1] - range[0];
        let chord = (ends[1] - ends[0]) / width;
        let change = rates[1] - rates[0];
        // The function leaves its chord to one side, most of all where it bends.
        let off = 0.5 * width * (rates[1] - chord) * (chord - rates[0]) / change;
        let value = ends[0] + chord * (self.value - range[0]) - off;
        Enclosure {
            value,
            slope: self.slope * chord,
            error: self.error * chord.abs() + off.abs() + ROUNDING * (ends[0].abs() + ends[1].abs() + width),
            slope_error: self.slope_error * chord.abs()
                + (rates[1] - chord).abs().max((chord - rates[0]).abs()) * self.steepest(),
            radius: self.radius,
        }
    }

    /// Its absolute value.
    pub fn abs(self) -> Enclosure {
        let [low, high] = self.range();
        if low >= 0.0 {
            self
        } else if high <= 0.0 {
            self.scaled(-1.0)
        } else {
            self.bent([low, high], [-low, high], [-1.0, 1.0])
        }
    }

    /// It, but not below `least`.
    pub fn at_least(self, least: f64) -> Enclosure {
        let [low, high] = self.range();
        if low >= least {
            self
        } else if high <= least {
            Enclosure::constant(least, self.radius)
        } else {
            self.bent([low, high], [least, high], [0.0, 1.0])
        }
    }

    /// It, but not above `most`.
    pub fn at_most(self, most: f64) -> Enclosure {
        let [low, high] = self.range();
        if high <= most {
            self
        } else if low >= most {
            Enclosure::constant(most, self.radius)
        } else {
            self.bent([low, high], [low, most], [1.0, 0.0])
        }
    }

    /// The narrower one: no wider than `low..=high`, where the function is known to lie with gradients up to
    /// `steepest`.
    pub fn within(self, [low, high]: [f64; 2], steepest: f64) -> Enclosure {
        let half = (high - low) * 0.5;
        if self.spread() <= half {
            return self;
        }
        let value = low + half;
        Enclosure {
            value,
            slope: DVec2::ZERO,
            error: half + ROUNDING * (value.abs() + half),
            slope_error: self.steepest().min(steepest),
            radius: self.radius,
        }
    }
}

impl Add for Enclosure {
    type Output = Enclosure;

    fn add(self, other: Enclosure) -> Enclosure {
        let value = self.value + other.value;
        Enclosure {
            value,
            slope: self.slope + other.slope,
            error: self.error + other.error + ROUNDING * (self.size() + other.size()),
            slope_error: self.slope_error + other.slope_error,
            radius: self.radius,
        }
    }
}

impl Mul for Enclosure {
    type Output = Enclosure;

    fn mul(self, other: Enclosure) -> Enclosure {
        let (one, two) = (self.slope.length(), other.slope.length());
        let radius = self.radius;
        // Products of the deviations from the values, and of what is off them, are what a plane does not hold.
        let error = one * two * radius * radius
            + self.error * (other.value.abs() + two * radius)
            + other.error * (self.value.abs() + one * radius)
            + self.error * other.error;
        let value = self.value * other.value;
        let slope_error = self.spread() * other.steepest()
            + self.value.abs() * other.slope_error
            + other.spread() * self.steepest()
            + other.value.abs() * self.slope_error;
        Enclosure {
            value,
            slope: other.slope * self.value + self.slope * other.value,
            error: error + ROUNDING * (self.size() * other.size() + error),
            slope_error,
            radius,
        }
    }
}
