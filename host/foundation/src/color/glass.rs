//! Refractive indices of transparent solids and liquids by Sellmeier's formula.

use serde::{Deserialize, Serialize};

use super::ColorError;

/// A transparent solid or a liquid: n² = 1 + Σ B w² / (w² − C), w the wavelength in micrometres.
///
/// # Source
/// Sellmeier 1871; coefficients as the files `data/color/glasses.txt` and `data/color/liquids.txt` state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Glass {
    /// The name of the solid or liquid.
    pub name: String,
    /// The shortest wavelength for which the coefficients hold, nm.
    pub from: f64,
    /// The longest, nm.
    pub to: f64,
    /// B, without unit, and C, square micrometres, of each term.
    pub terms: Vec<[f64; 2]>,
}

impl Glass {
    /// The refractive index at a wavelength, nm.
    ///
    /// # Errors
    /// [`ColorError::OutOfRange`] where the coefficients do not hold.
    pub fn index(&self, wavelength: f64) -> Result<f64, ColorError> {
        let square = (wavelength / 1000.0).powi(2);
        let n = (1.0 + self.terms.iter().map(|[b, c]| b * square / (square - c)).sum::<f64>()).sqrt();
        if (self.from..=self.to).contains(&wavelength) && n.is_finite() {
            return Ok(n);
        }
        Err(ColorError::OutOfRange { name: self.name.clone(), wavelength, from: self.from, to: self.to })
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`ColorError::Formula`] for a range that is empty, or numbers that are not finite.
    pub fn check(&self) -> Result<(), ColorError> {
        let possible = self.from > 0.0 && self.from <= self.to && self.to.is_finite();
        let finite = self.terms.iter().flatten().all(|term| term.is_finite());
        if possible && finite { Ok(()) } else { Err(ColorError::Formula { name: self.name.clone() }) }
    }

    /// Abbe's number (n_d − 1) / (n_F − n_C): the less, the more the glass disperses.
    ///
    /// # Errors
    /// [`ColorError::OutOfRange`] if the coefficients do not hold from 486 to 656 nm.
    pub fn abbe_number(&self) -> Result<f64, ColorError> {
        Ok((self.index(587.5618)? - 1.0) / (self.index(486.1327)? - self.index(656.2725)?))
    }
}

#[cfg(test)]
mod tests {
    use super::super::shipped::{glass, liquid};
    use super::Glass;

    #[test]
    fn indices_and_dispersion_are_those_of_the_catalogues() {
        // n_d and Abbe's number of the Schott data sheets; silica from Malitson's table; diamond from Peter.
        // Sapphire, fluorite and
        // acrylic: handbooks.
        for (name, n_d, abbe) in [
            ("BK7", 1.51680, 64.17),
            ("BAK4", 1.56883, 55.98),
            ("N-F2", 1.62005, 36.43),
            ("SF6", 1.80518, 25.43),
            ("SF11", 1.78472, 25.76),
            ("silica", 1.45846, 67.82),
            ("diamond", 2.4175, 55.3),
            ("sapphire", 1.76823, 72.3),
            ("fluorite", 1.43385, 95.0),
            ("acrylic", 1.4906, 53.2),
        ] {
            let glass = glass(name).expect("a glass");
            assert!((glass.index(587.5618).expect("an index") - n_d).abs() < 6e-5 * n_d, "{name}");
            assert!((glass.abbe_number().expect("a number") / abbe - 1.0).abs() < 5e-3, "{name}");
        }
    }

    #[test]
    fn liquids_have_the_indices_of_handbooks() {
        // Water over a vacuum: 1.33299 times the index of air.
        for (name, n_d, error) in [
            ("water", 1.33335, 3e-5),
            ("ethanol", 1.3614, 1e-3),
            ("glycerol", 1.4722, 2e-3),
            ("acetone", 1.3588, 5e-4),
            ("toluene", 1.4969, 3e-3),
        ] {
            let index = liquid(name).expect("a liquid").index(589.3).expect("an index");
            assert!((index - n_d).abs() < error, "{name} {index}");
        }
        assert!((glass("ice").expect("ice").index(589.3).expect("an index") - 1.3097).abs() < 2e-4);
    }

    #[test]
    fn a_range_that_is_turned_round_is_an_error() {
        let diamond = glass("diamond").expect("a glass");
        assert!(diamond.check().is_ok());
        assert!(Glass { from: 800.0, to: 300.0, ..diamond.clone() }.check().is_err());
        assert!(Glass { terms: vec![[f64::NAN, 1.0]], ..diamond }.check().is_err());
    }

    #[test]
    fn a_wavelength_outside_is_an_error() {
        let diamond = glass("diamond").expect("a glass");
        assert!(diamond.index(800.0).is_err() && diamond.index(f64::NAN).is_err());
        assert!(diamond.index(226.0).is_ok_and(|n| n > 2.6));
    }
}
