//! The optical properties of air, haze and ozone, and the irradiance by the sun above them.

use std::f64::consts::PI;

/// Wavelengths at which the sky is known.
pub const NODES: usize = 11;

/// Radiance or irradiance at each node of the wavelength, per nanometre.
pub type Spectral = [f64; NODES];

/// The wavelength of a node, nm: 360 to 760.
pub fn node(index: usize) -> f64 {
    360.0 + 40.0 * index as f64
}

/// Irradiance by the sun above the air at each node, W/(m² nm): means over the 40 nm to both sides, less farther away.
///
/// # Source
/// ASTM G173-03, extraterrestrial spectrum.
const SUN: Spectral = [1.107, 1.481, 1.860, 1.963, 1.874, 1.837, 1.745, 1.600, 1.475, 1.345, 1.236];

/// Absorption by a molecule of ozone at each node, m²: means as those of the sun.
///
/// # Source
/// Serdyuchenko and others 2014, at 233 K.
const OZONE: Spectral =
    [6.60e-28, 2.29e-27, 1.84e-26, 8.01e-26, 2.20e-25, 4.00e-25, 4.45e-25, 2.75e-25, 1.26e-25, 5.54e-26, 2.95e-26];

/// Molecules of ozone over a square metre: 300 Dobson units.
const OZONE_COLUMN: f64 = 300.0 * 2.687e20;
/// Height in which half of the ozone is, and up to which it goes from there up and down, km.
const OZONE_LAYER: [f64; 2] = [25.0, 15.0];

/// Scattering by air at 1000 nm at sea level, 1/km; it grows with the fourth power of the wavelength's reciprocal.
const RAYLEIGH: f64 = 1.24062e-3;
/// Heights in which there are 1/e of the air and of the haze at sea level, km.
const HEIGHTS: [f64; 2] = [8.0, 1.2];
/// The part of the light that haze scatters of what it takes away.
const SCATTERED: f64 = 0.9;
/// How the optical depth of haze falls with the wavelength: Ångström's exponent.
const HAZE_EXPONENT: f64 = 1.3;
/// Asymmetry of the phase function of haze.
const ASYMMETRY: f64 = 0.8;
/// The part of what haze scatters that goes straight on, as the delta-Eddington approximation has it.
const STRAIGHT: f64 = ASYMMETRY * ASYMMETRY;

/// Amounts of air, haze and ozone along a line or at a height, as if it were so many kilometres at sea level or in the
/// middle of the layer.
pub(super) type Amounts = [f64; 3];

/// Amounts in a kilometre at a height over the ground, km.
pub(super) fn density(height: f64) -> Amounts {
    let [air, haze] = HEIGHTS.map(|scale| (-height.max(0.0) / scale).exp());
    [air, haze, (1.0 - (height - OZONE_LAYER[0]).abs() / OZONE_LAYER[1]).max(0.0)]
}

/// Coefficients at each node, 1/km.
pub(super) struct Air {
    /// Scattering by air and by haze.
    pub(super) scattering: [Spectral; 2],
    /// Extinction by air, haze and ozone.
    pub(super) extinction: [Spectral; 3],
    /// Extinction without what haze scatters straight on.
    pub(super) scaled: [Spectral; 3],
    pub(super) sun: Spectral,
}

impl Air {
    pub(super) fn new(turbidity: f64) -> Air {
        let micrometres = |index: usize| node(index) / 1000.0;
        let air: Spectral = std::array::from_fn(|index| RAYLEIGH * micrometres(index).powi(-4));
        // Preetham, Shirley and Smits 1999, appendix 1: Ångström's coefficient of a turbidity.
        let depth = (0.046_08 * turbidity - 0.045_86).max(0.0);
        let haze: Spectral = std::array::from_fn(|index| depth * micrometres(index).powf(-HAZE_EXPONENT) / HEIGHTS[1]);
        let ozone = OZONE.map(|molecule| OZONE_COLUMN / OZONE_LAYER[1] * molecule);
        let scaled = [air, haze.map(|taken| taken * (1.0 - STRAIGHT * SCATTERED)), ozone];
        Air { scattering: [air, haze.map(|taken| SCATTERED * taken)], extinction: [air, haze, ozone], scaled, sun: SUN }
    }

    /// The part of what haze scatters that does not go straight on.
    pub(super) const TURNED: f64 = 1.0 - STRAIGHT;
}

/// Extinction by so much air: in a kilometre, 1/km, or along a line, its optical depth.
///
/// - `coefficients`: by air, haze and ozone, 1/km.
pub(super) fn extinction(coefficients: &[Spectral; 3], amounts: &Amounts, node: usize) -> f64 {
    coefficients.iter().zip(amounts).map(|(coefficient, amount)| coefficient[node] * amount).sum()
}

/// Phase functions of air and of haze, 1/sr.
///
/// - `cosine`: of the angle by which light is scattered.
///
/// # Source
/// Rayleigh; Cornette and Shanks 1992.
pub(super) fn phases(cosine: f64) -> [f64; 2] {
    let both = 1.0 + cosine * cosine;
    let g = ASYMMETRY;
    let haze = 3.0 / (8.0 * PI) * (1.0 - g * g) * both / ((2.0 + g * g) * (1.0 + g * g - 2.0 * g * cosine).powf(1.5));
    [3.0 / (16.0 * PI) * both, haze]
}
