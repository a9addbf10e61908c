//! A quantity over the wavelength as a scene states it: three numbers for a screen, or a spectrum.

use super::{SmoothReflectance, Spectrum, observer, shipped, srgb};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// A reflectance, or the strength of a light, over the wavelength.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Color {
    /// Linear sRGB. Of a light, (1, 1, 1) is D65 whose integral with the observer's ȳ is 1 watt; of a reflectance it is
    /// a perfect reflector.
    Bands(DVec3),
    /// Per nanometre, if it is light; fractions, if it is a reflectance.
    Spectrum(Spectrum),
}

/// D65, with Y = 1.
pub static WHITE: LazyLock<Spectrum> =
    LazyLock::new(|| shipped::D65.scaled(observer::tristimulus(&shipped::D65).y.recip()));

impl From<DVec3> for Color {
    fn from(bands: DVec3) -> Color {
        Color::Bands(bands)
    }
}

impl Color {
    /// No light.
    pub const BLACK: Color = Color::Bands(DVec3::ZERO);

    /// One value in all bands.
    pub fn grey(value: f64) -> Color {
        Color::Bands(DVec3::splat(value))
    }

    /// A light of a spectrum, with a strength as if it were white: Y is that number, whatever the unit of the spectrum.
    ///
    /// - Returns none for a spectrum that cannot be seen.
    pub fn light_of(spectrum: &Spectrum, strength: f64) -> Option<Color> {
        let seen = observer::tristimulus(spectrum).y;
        (seen > 0.0).then(|| Color::Spectrum(spectrum.scaled(strength / seen)))
    }

    /// Whether it is given over the wavelength.
    pub fn is_spectral(&self) -> bool {
        matches!(self, Color::Spectrum(_))
    }

    /// Whether it is 0 at all wavelengths.
    pub fn is_black(&self) -> bool {
        match self {
            Color::Bands(bands) => *bands == DVec3::ZERO,
            Color::Spectrum(spectrum) => spectrum.samples().all(|(_, value)| value == 0.0),
        }
    }

    /// Its least and its greatest value.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Color::Bands(bands) => [bands.min_element(), bands.max_element()],
            Color::Spectrum(spectrum) => {
                spectrum.samples().fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], (_, value)| {
                    [least.min(value), most.max(value)]
                })
            }
        }
    }

    /// Linear sRGB of a reflectance, as seen under D65; negative where a screen cannot show it.
    pub fn bands_of_reflectance(&self) -> DVec3 {
        match self {
            Color::Bands(bands) => *bands,
            Color::Spectrum(spectrum) => {
                observer::surface_tristimulus(spectrum, &shipped::D65).map_or(DVec3::ZERO, srgb::from_xyz)
            }
        }
    }

    /// Linear sRGB of a light.
    pub fn bands_of_light(&self) -> DVec3 {
        match self {
            Color::Bands(bands) => *bands,
            Color::Spectrum(spectrum) => srgb::from_xyz(observer::tristimulus(spectrum)),
        }
    }

    /// A reflectance at wavelengths, nm; of bands the smooth one that looks like them under D65.
    pub(super) fn reflectance_at(&self) -> Box<dyn Fn(f64) -> f64 + '_> {
        match self {
            Color::Bands(bands) if bands.min_element() == bands.max_element() => Box::new(|_| bands.x),
            Color::Bands(bands) => match SmoothReflectance::from_linear_srgb(*bands) {
                Ok(fit) => Box::new(move |wavelength| fit.reflectance.at(wavelength)),
                Err(_) => Box::new(|_| 0.0),
            },
            Color::Spectrum(spectrum) => Box::new(|wavelength| spectrum.at(wavelength)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_light_and_the_spectrum_of_d65_are_the_same_color() {
        let light = Color::light_of(&shipped::D65, 3.0).expect("visible");
        assert!((light.bands_of_light() - DVec3::splat(3.0)).length() < 1e-9);
        assert!(light.is_spectral() && !light.is_black() && Color::BLACK.is_black());
    }

    #[test]
    fn a_perfect_reflector_is_white_and_a_color_keeps_its_bands() {
        let grey =
            Spectrum::regular(300.0, 600.0, vec![0.25; 2], super::super::Extrapolation::Held).expect("a spectrum");
        let grey = Color::Spectrum(grey);
        assert!((grey.bands_of_reflectance() - DVec3::splat(0.25)).length() < 1e-9);
        assert_eq!(grey.range(), [0.25, 0.25]);
        let copper = DVec3::new(0.9, 0.5, 0.3);
        let spectrum = SmoothReflectance::from_linear_srgb(copper).expect("a color").reflectance.spectrum();
        assert!((Color::Spectrum(spectrum).bands_of_reflectance() - copper).length() < 1e-4);
    }
}
