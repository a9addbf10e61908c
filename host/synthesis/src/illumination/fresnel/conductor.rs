//! The surface of a metal.

use super::{IndexError, Polarised, checked, cosine_of};
use crate::color::shipped::ComplexIndex;

/// An interface between a transparent medium and one that absorbs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    outside: f64,
    n: f64,
    k: f64,
}

/// A complex number.
#[derive(Clone, Copy)]
struct Complex {
    real: f64,
    imaginary: f64,
}

impl Complex {
    fn plus(self, real: f64) -> Complex {
        Complex { real: self.real + real, ..self }
    }

    fn times(self, factor: f64) -> Complex {
        Complex { real: self.real * factor, imaginary: self.imaginary * factor }
    }

    fn square(self) -> f64 {
        self.real * self.real + self.imaginary * self.imaginary
    }

    /// The root in the first quadrant, of a number in the upper half plane.
    fn root(self) -> Complex {
        // No index is so great or small that its square is lost.
        let larger = ((self.square().sqrt() + self.real.abs()) / 2.0).sqrt();
        let smaller = if larger > 0.0 { self.imaginary / (2.0 * larger) } else { 0.0 };
        let (real, imaginary) = if self.real >= 0.0 { (larger, smaller) } else { (smaller, larger) };
        Complex { real, imaginary }
    }
}

impl Conductor {
    /// The interface from a medium of index `outside` to one of index n + ik.
    ///
    /// With k = 0 it is a [`super::Dielectric`].
    ///
    /// # Errors
    /// [`IndexError`] for an index outside 1e-6..=1e6 or a negative part.
    pub fn new(outside: f64, n: f64, k: f64) -> Result<Conductor, IndexError> {
        let (outside, _) = checked(outside, 0.0)?;
        let (n, k) = checked(n, k)?;
        Ok(Conductor { outside, n, k })
    }

    /// The surface of a metal in vacuum or air.
    ///
    /// - `wavelength`: nm.
    ///
    /// # Errors
    /// [`IndexError`].
    pub fn of_metal(metal: &ComplexIndex, wavelength: f64) -> Result<Conductor, IndexError> {
        Conductor::new(1.0, metal.n.at(wavelength), metal.k.at(wavelength))
    }

    /// η² − 1, c, and q of the module's text; none if the two media are the same.
    fn terms(self, cosine: f64) -> Option<(Complex, f64, Complex)> {
        let Conductor { outside, n, k } = self;
        let relative = k / outside;
        let real = (n - outside) / outside * ((n + outside) / outside) - relative * relative;
        let excess = Complex { real, imaginary: 2.0 * n / outside * relative };
        let c = cosine_of(cosine);
        (excess.square() > 0.0).then(|| (excess, c, excess.plus(c * c).root()))
    }

    /// The reflected part of light that comes from outside.
    ///
    /// - `cosine`: of the angle between light and normal, 0..=1.
    pub fn reflectance(self, cosine: f64) -> Polarised {
        let Some((excess, c, q)) = self.terms(cosine) else {
            return Polarised { perpendicular: 0.0, parallel: 0.0 };
        };
        let dense = excess.plus(1.0).times(c);
        let sum = Complex { real: dense.real + q.real, imaginary: dense.imaginary + q.imaginary };
        let brewster = excess.plus(2.0).times(c * c).plus(-1.0);
        Polarised {
            perpendicular: excess.square() / q.plus(c).square().powi(2),
            parallel: excess.square() * brewster.square() / sum.square().powi(2),
        }
    }

    /// The part of light from outside that goes in, and is absorbed there; small parts have all their digits.
    ///
    /// - `cosine`: of the angle between light and normal, 0..=1.
    pub fn absorptance(self, cosine: f64) -> Polarised {
        let Some((excess, c, q)) = self.terms(cosine) else {
            return Polarised { perpendicular: 1.0, parallel: 1.0 };
        };
        let dense = excess.plus(1.0).times(c);
        let sum = Complex { real: dense.real + q.real, imaginary: dense.imaginary + q.imaginary };
        Polarised {
            perpendicular: 4.0 * c * q.real / q.plus(c).square(),
            parallel: 4.0 * (dense.real * q.real + dense.imaginary * q.imaginary) / sum.square(),
        }
    }
}
