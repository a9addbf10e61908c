//! Piecewise linear spectra over regular or irregular samples, and exact integrals of their products.

use super::ColorError;
use serde::{Deserialize, Serialize};

/// The extrapolation of a spectrum beyond its first and last sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Extrapolation {
    /// Zero, as for light and for the functions of an observer.
    Zero,
    /// The value of the nearest sample, as for reflectances and indices of refraction.
    Held,
}

/// The wavelengths of the samples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Grid {
    Regular { first: f64, step: f64 },
    Irregular(Vec<f64>),
}

/// A quantity over the wavelength, linear between its samples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Plain", into = "Plain")]
pub struct Spectrum {
    grid: Grid,
    values: Vec<f64>,
    beyond: Extrapolation,
}

/// A spectrum as it is stored; checked when it is read.
#[derive(Serialize, Deserialize)]
struct Plain {
    grid: Grid,
    values: Vec<f64>,
    beyond: Extrapolation,
}

impl From<Spectrum> for Plain {
    fn from(Spectrum { grid, values, beyond }: Spectrum) -> Plain {
        Plain { grid, values, beyond }
    }
}

impl TryFrom<Plain> for Spectrum {
    type Error = ColorError;

    fn try_from(Plain { grid, values, beyond }: Plain) -> Result<Spectrum, ColorError> {
        match grid {
            Grid::Regular { first, step } => Spectrum::regular(first, step, values, beyond),
            Grid::Irregular(wavelengths) if wavelengths.len() == values.len() => {
                Spectrum::irregular(&wavelengths.into_iter().zip(values).collect::<Vec<_>>(), beyond)
            }
            Grid::Irregular(_) => Err(ColorError::TooFew(values.len())),
        }
    }
}

impl Spectrum {
    /// A spectrum of samples at `first`, `first + step`, and so on, nm.
    ///
    /// # Errors
    /// [`ColorError`] for fewer than two values, a step or start that is not positive, or a value that is not finite.
    pub fn regular(first: f64, step: f64, values: Vec<f64>, beyond: Extrapolation) -> Result<Spectrum, ColorError> {
        for (index, wavelength) in [first, first + step].into_iter().enumerate() {
            if !(wavelength.is_finite() && first > 0.0 && step > 0.0) {
                return Err(ColorError::Wavelength { index, wavelength });
            }
        }
        Spectrum { grid: Grid::Regular { first, step }, values, beyond }.checked()
    }

    /// A spectrum of pairs of wavelength, nm, and value, with rising wavelengths.
    ///
    /// # Errors
    /// [`ColorError`] for fewer than two samples, wavelengths that do not rise, or a value that is not finite.
    pub fn irregular(samples: &[(f64, f64)], beyond: Extrapolation) -> Result<Spectrum, ColorError> {
        let mut before = 0.0;
        for (index, &(wavelength, _)) in samples.iter().enumerate() {
            if !(wavelength > before && wavelength.is_finite()) {
                return Err(ColorError::Wavelength { index, wavelength });
            }
            before = wavelength;
        }
        let (wavelengths, values) = samples.iter().copied().unzip();
        Spectrum { grid: Grid::Irregular(wavelengths), values, beyond }.checked()
    }

    fn checked(self) -> Result<Spectrum, ColorError> {
        if self.values.len() < 2 {
            return Err(ColorError::TooFew(self.values.len()));
        }
        match self.values.iter().position(|value| !value.is_finite()) {
            Some(index) => Err(ColorError::NotFinite { wavelength: self.wavelength(index) }),
            None => Ok(self),
        }
    }

    /// How many samples there are.
    pub fn count(&self) -> usize {
        self.values.len()
    }

    /// The wavelength of a sample, nm.
    fn wavelength(&self, index: usize) -> f64 {
        match &self.grid {
            Grid::Regular { first, step } => first + step * index as f64,
            Grid::Irregular(wavelengths) => wavelengths[index],
        }
    }

    /// The samples: wavelength, nm, and value.
    pub fn samples(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.values.iter().enumerate().map(|(index, value)| (self.wavelength(index), *value))
    }

    /// The first and the last wavelength, nm.
    pub fn range(&self) -> (f64, f64) {
        (self.wavelength(0), self.wavelength(self.values.len() - 1))
    }

    /// The value at a wavelength, nm; 0 for one that is not a number.
    pub fn at(&self, wavelength: f64) -> f64 {
        let (first, last) = self.range();
        let end = self.values.len() - 1;
        if !(first..=last).contains(&wavelength) {
            return match self.beyond {
                Extrapolation::Held if wavelength < first => self.values[0],
                Extrapolation::Held if wavelength > last => self.values[end],
                _ => 0.0,
            };
        }
        let index = match &self.grid {
            Grid::Regular { first, step } => (((wavelength - first) / step) as usize).min(end - 1),
            Grid::Irregular(all) => (all.partition_point(|w| *w <= wavelength) - 1).min(end - 1),
        };
        let (from, to) = (self.wavelength(index), self.wavelength(index + 1));
        let part = ((wavelength - from) / (to - from)).clamp(0.0, 1.0);
        self.values[index] * (1.0 - part) + self.values[index + 1] * part
    }

    /// The spectrum times a number.
    pub fn scaled(&self, factor: f64) -> Spectrum {
        Spectrum { values: self.values.iter().map(|value| value * factor).collect(), ..self.clone() }
    }

    /// The sum of two spectra at the wavelengths of both; exact where both have samples.
    ///
    /// Beyond its samples the sum is what this spectrum says; where one of the two ends with a jump to zero between
    /// samples of the other, the sum falls over the interval to the next sample.
    ///
    /// # Errors
    /// [`ColorError`] if a sum is not finite.
    pub fn plus(&self, other: &Spectrum) -> Result<Spectrum, ColorError> {
        self.combined(other, |a, b| a + b)
    }

    /// The product of two spectra at the wavelengths of both; linear between them, so that it is exact at the samples
    /// only. [`integral`] of the factors has no such error.
    ///
    /// # Errors
    /// [`ColorError`] if a product is not finite.
    pub fn times(&self, other: &Spectrum) -> Result<Spectrum, ColorError> {
        self.combined(other, |a, b| a * b)
    }

    fn combined(&self, other: &Spectrum, of: impl Fn(f64, f64) -> f64) -> Result<Spectrum, ColorError> {
        let knots = knots(&[self, other], 0.0, f64::INFINITY);
        let samples: Vec<(f64, f64)> = knots.into_iter().map(|w| (w, of(self.at(w), other.at(w)))).collect();
        Spectrum::irregular(&samples, self.beyond)
    }
}

/// All wavelengths of samples strictly between two, in order, each once.
fn knots(spectra: &[&Spectrum], from: f64, to: f64) -> Vec<f64> {
    let inside = |w: &f64| *w > from && *w < to;
    let mut all: Vec<f64> = spectra.iter().flat_map(|s| s.samples().map(|(w, _)| w).filter(inside)).collect();
    all.sort_unstable_by(f64::total_cmp);
    all.dedup();
    all
}

/// The integral of the product of spectra over wavelengths from `from` to `to`, in the product of their units times nm.
///
/// Simpson's rule between neighbouring samples of any factor: exact, but for rounding, for up to three factors.
/// Without factors, or for an empty range, it is 0.
pub fn integral(factors: &[&Spectrum], from: f64, to: f64) -> f64 {
    let (mut from, mut to) = (from, to);
    for factor in factors.iter().filter(|factor| factor.beyond == Extrapolation::Zero) {
        let (first, last) = factor.range();
        (from, to) = (from.max(first), to.min(last));
    }
    if factors.is_empty() || from >= to || !(to - from).is_finite() {
        return 0.0;
    }
    let product = |wavelength: f64| factors.iter().map(|factor| factor.at(wavelength)).product::<f64>();
    let mut sum = 0.0;
    let (mut left, mut at_left) = (from, product(from));
    for right in knots(factors, from, to).into_iter().chain([to]) {
        let at_right = product(right);
        sum += (right - left) / 6.0 * (at_left + 4.0 * product((left + right) / 2.0) + at_right);
        (left, at_left) = (right, at_right);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Spectrum {
        Spectrum::regular(400.0, 100.0, vec![0.0, 1.0, 1.0], Extrapolation::Held).expect("a spectrum")
    }

    #[test]
    fn values_are_linear_between_samples_and_held_or_zero_beyond() {
        let held = ramp();
        assert_eq!([450.0, 500.0, 599.0, 700.0].map(|w| held.at(w)), [0.5, 1.0, 1.0, 1.0]);
        let light =
            Spectrum::irregular(&[(400.0, 2.0), (450.0, 4.0), (600.0, 1.0)], Extrapolation::Zero).expect("a spectrum");
        assert_eq!([399.9, 400.0, 425.0, 525.0, 600.0, 600.1].map(|w| light.at(w)), [0.0, 2.0, 3.0, 2.5, 1.0, 0.0]);
        assert_eq!(light.at(f64::NAN), 0.0);
    }

    #[test]
    fn integrals_of_three_factors_are_exact() {
        // The cube of a ramp of 100 nm, then a plateau: 100/4 + 100.
        let ramp = ramp();
        assert!((integral(&[&ramp, &ramp, &ramp], 400.0, 600.0) - 125.0).abs() < 1e-12);
        // A light that ends at 550 nm cuts the plateau.
        let light = Spectrum::irregular(&[(300.0, 1.0), (550.0, 1.0)], Extrapolation::Zero).expect("a spectrum");
        assert!((integral(&[&ramp, &light], 0.0, 1e4) - 100.0).abs() < 1e-12);
        assert_eq!(integral(&[&ramp], 500.0, 400.0), 0.0);
        assert_eq!(integral(&[], 400.0, 500.0), 0.0);
    }

    #[test]
    fn sums_are_exact_and_products_exact_at_the_samples() {
        let other = Spectrum::irregular(&[(450.0, 2.0), (550.0, 6.0)], Extrapolation::Held).expect("a spectrum");
        let (sum, product) = (ramp().plus(&other).expect("a sum"), ramp().times(&other).expect("a product"));
        for w in [420.0, 450.0, 475.0, 500.0, 533.0, 580.0] {
            assert!((sum.at(w) - ramp().at(w) - other.at(w)).abs() < 1e-12);
        }
        assert_eq!([450.0, 500.0, 550.0].map(|w| product.at(w)), [1.0, 4.0, 6.0]);
        assert_eq!(ramp().scaled(3.0).at(450.0), 1.5);
    }

    #[test]
    fn wrong_samples_are_named() {
        assert_eq!(Spectrum::irregular(&[(400.0, 1.0)], Extrapolation::Zero), Err(ColorError::TooFew(1)));
        let turned = Spectrum::irregular(&[(400.0, 1.0), (400.0, 1.0)], Extrapolation::Zero);
        assert_eq!(turned, Err(ColorError::Wavelength { index: 1, wavelength: 400.0 }));
        let value = Spectrum::regular(400.0, 5.0, vec![1.0, f64::NAN], Extrapolation::Zero);
        assert_eq!(value, Err(ColorError::NotFinite { wavelength: 405.0 }));
        for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Spectrum::regular(400.0, step, vec![1.0, 1.0], Extrapolation::Zero).is_err());
        }
    }
}
