//! Light of a black body.

use super::{ColorError, Extrapolation, Spectrum};

/// Planck's constant, J s; exact in the SI of 2019.
const PLANCK: f64 = 6.626_070_15e-34;
/// Speed of light, m/s; exact.
const LIGHT_SPEED: f64 = 299_792_458.0;
/// Boltzmann's constant, J/K; exact in the SI of 2019.
const BOLTZMANN: f64 = 1.380_649e-23;

/// The lowest temperature of [`spectrum()`], K: below it nothing is to be seen.
pub const LEAST_KELVIN: f64 = 100.0;
/// The highest temperature of [`spectrum()`], K.
pub const MOST_KELVIN: f64 = 1e9;

/// hc / (w k T) at the wavelength of the highest radiance: x = 5 (1 − exp(−x)).
const PEAK: f64 = 4.965_114_231_744_276;

/// hc / (w k T), without unit.
fn ratio(wavelength: f64, kelvin: f64) -> f64 {
    PLANCK * LIGHT_SPEED / (wavelength * 1e-9 * BOLTZMANN * kelvin)
}

/// The wavelength at which a black body is brightest, nm (Wien's law).
///
/// - `kelvin`: its temperature, above 0.
pub fn peak(kelvin: f64) -> f64 {
    PLANCK * LIGHT_SPEED / (PEAK * BOLTZMANN * kelvin) * 1e9
}

/// Spectral radiance of a black body, W/(m² sr nm).
///
/// 2 h c² / w⁵ / (exp(hc / (w k T)) − 1)
///
/// - `wavelength`: nm, above 0. `kelvin`: temperature, above 0.
///
/// # Source
/// Planck 1900; constants of the SI, CODATA 2018.
pub fn radiance(wavelength: f64, kelvin: f64) -> f64 {
    let metres = wavelength * 1e-9;
    2.0 * PLANCK * LIGHT_SPEED * LIGHT_SPEED / metres.powi(5) / ratio(wavelength, kelvin).exp_m1() * 1e-9
}

/// The radiance of a black body as a part of that at its brightest wavelength, 0..=1.
///
/// - `wavelength`: nm, above 0. `kelvin`: temperature, above 0.
pub fn normalised(wavelength: f64, kelvin: f64) -> f64 {
    let x = ratio(wavelength, kelvin);
    (x / PEAK).powi(5) * PEAK.exp_m1() / x.exp_m1()
}

/// The radiance of a black body over what an eye sees, 360 to 830 nm, in steps of 1 nm, W/(m² sr nm).
///
/// # Errors
/// [`ColorError::Temperature`] outside [`LEAST_KELVIN`]..=[`MOST_KELVIN`].
pub fn spectrum(kelvin: f64) -> Result<Spectrum, ColorError> {
    if !(LEAST_KELVIN..=MOST_KELVIN).contains(&kelvin) {
        return Err(ColorError::Temperature { kelvin, least: LEAST_KELVIN, most: MOST_KELVIN });
    }
    Spectrum::regular(360.0, 1.0, (360..=830).map(|w| radiance(f64::from(w), kelvin)).collect(), Extrapolation::Zero)
}

#[cfg(test)]
mod tests {
    use super::super::observer::{chromaticity, tristimulus};
    use super::*;

    #[test]
    fn the_whole_radiance_follows_stefan_and_boltzmann() {
        for kelvin in [300.0, 2856.0, 6500.0] {
            // Simpson's rule over the logarithm of the wavelength, a hundredth to a thousand times the brightest.
            let (from, to, cells) = ((peak(kelvin) / 100.0).ln(), (peak(kelvin) * 1000.0).ln(), 2000);
            let step = (to - from) / f64::from(cells);
            let value = |i: f64| {
                let w = (from + i * step).exp();
                radiance(w, kelvin) * w
            };
            let cell = |i: u32| {
                let i = f64::from(i);
                (value(i) + 4.0 * value(i + 0.5) + value(i + 1.0)) * step / 6.0
            };
            let exitance = std::f64::consts::PI * (0..cells).map(cell).sum::<f64>();
            // Stefan and Boltzmann's constant, CODATA 2018, W/(m² K⁴).
            assert!((exitance / (5.670_374_419e-8 * kelvin.powi(4)) - 1.0).abs() < 1e-8, "{kelvin}: {exitance}");
        }
    }

    #[test]
    fn the_brightest_wavelength_follows_wien() {
        for kelvin in [100.0, 5772.0, 1e5] {
            // Wien's constant, CODATA 2018, nm K.
            assert!((peak(kelvin) * kelvin / 2.897_771_955e6 - 1.0).abs() < 1e-9);
            assert!((normalised(peak(kelvin), kelvin) - 1.0).abs() < 1e-12);
            assert!(normalised(peak(kelvin) * 1.01, kelvin) < 1.0 && normalised(peak(kelvin) * 0.99, kelvin) < 1.0);
            let far = peak(kelvin) * 3.0;
            assert!(
                (radiance(far, kelvin) / radiance(peak(kelvin), kelvin) / normalised(far, kelvin) - 1.0).abs() < 1e-12
            );
        }
        assert_eq!(normalised(1.0, 10.0), 0.0);
    }

    #[test]
    fn black_bodies_have_the_chromaticities_of_the_planckian_locus() {
        // Computed with colour-science 0.4.7 from 360 to 830 nm.
        for (kelvin, x, y) in
            [(2000.0, 0.526_681, 0.413_296), (5000.0, 0.345_103, 0.351_610), (10_000.0, 0.280_634, 0.288_289)]
        {
            let found = chromaticity(tristimulus(&spectrum(kelvin).expect("a spectrum"))).expect("light");
            assert!((found.x - x).abs() < 1e-5 && (found.y - y).abs() < 1e-5, "{kelvin}: {found}");
        }
        for kelvin in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(spectrum(kelvin).is_err());
        }
    }
}
