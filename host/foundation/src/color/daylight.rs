//! Daylight of a correlated colour temperature.

use super::{ColorError, Spectrum, shipped};
use glam::DVec2;

/// The lowest correlated colour temperature of daylight, K.
pub const LEAST_KELVIN: f64 = 4000.0;
/// The highest correlated colour temperature of daylight, K.
pub const MOST_KELVIN: f64 = 25_000.0;

/// The chromaticity x, y of daylight.
///
/// - `kelvin`: correlated colour temperature, 4000..=25000 K. That of D65 is 6504 K: 6500 times 1.4388/1.4380, since a
///   constant of radiation was changed after the standard had been made.
///
/// # Errors
/// [`ColorError::Temperature`].
///
/// # Source
/// CIE 15:2004, section 3.1.
pub fn chromaticity(kelvin: f64) -> Result<DVec2, ColorError> {
    if !(LEAST_KELVIN..=MOST_KELVIN).contains(&kelvin) {
        return Err(ColorError::Temperature { kelvin, least: LEAST_KELVIN, most: MOST_KELVIN });
    }
    let t = 1000.0 / kelvin;
    let x = if kelvin <= 7000.0 {
        ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244_063
    } else {
        ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237_040
    };
    Ok(DVec2::new(x, (-3.0 * x + 2.870) * x - 0.275))
}

/// Relative power of daylight, 100 at 560 nm, from 300 to 830 nm.
///
/// - `kelvin`: correlated colour temperature, 4000..=25000 K.
///
/// # Errors
/// [`ColorError::Temperature`].
///
/// # Source
/// CIE 15:2004, section 3.1; the weights of the two vectors are rounded to three decimals, as is prescribed there.
pub fn spectrum(kelvin: f64) -> Result<Spectrum, ColorError> {
    let DVec2 { x, y } = chromaticity(kelvin)?;
    let below = 0.0241 + 0.2562 * x - 0.7341 * y;
    let rounded = |weight: f64| (weight * 1000.0).round() / 1000.0;
    let first = rounded((-1.3515 - 1.7703 * x + 5.9114 * y) / below);
    let second = rounded((0.0300 - 31.4424 * x + 30.0717 * y) / below);
    let [mean, one, two] = &*shipped::DAYLIGHT;
    mean.plus(&one.scaled(first))?.plus(&two.scaled(second))
}

#[cfg(test)]
mod tests {
    use super::super::observer;
    use super::*;

    /// The temperature of an illuminant of the D series by its name.
    fn nominal(kelvin: f64) -> f64 {
        kelvin * 1.4388 / 1.4380
    }

    #[test]
    fn daylight_of_6504_kelvin_is_d65_as_tabulated() {
        let made = spectrum(nominal(6500.0)).expect("daylight");
        for (wavelength, power) in shipped::D65.samples() {
            assert!((made.at(wavelength) - power).abs() < 6e-3, "{wavelength}: {} {power}", made.at(wavelength));
        }
    }

    #[test]
    fn other_daylight_follows_its_table() {
        // CIE 15:2004, table T.1, at 300, 400, 550 and 780 nm.
        for (kelvin, table) in [(5500.0, [0.024, 60.949, 102.968, 71.818]), (7500.0, [0.043, 101.929, 104.904, 58.324])]
        {
            let made = spectrum(nominal(kelvin)).expect("daylight");
            for (wavelength, power) in [300.0, 400.0, 550.0, 780.0].into_iter().zip(table) {
                assert!((made.at(wavelength) - power).abs() < 6e-3, "{kelvin} {wavelength}: {}", made.at(wavelength));
            }
        }
    }

    #[test]
    fn the_spectrum_has_the_chromaticity_of_its_temperature() {
        for kelvin in [4000.0, 5003.0, 6999.0, 7001.0, 12_000.0, 25_000.0] {
            let wanted = chromaticity(kelvin).expect("daylight");
            let light = observer::tristimulus(&spectrum(kelvin).expect("daylight"));
            let found = observer::chromaticity(light).expect("light");
            assert!((wanted - found).length() < 3e-4, "{kelvin}: {wanted} {found}");
        }
        assert!(spectrum(3999.0).is_err() && spectrum(f64::NAN).is_err());
    }
}
