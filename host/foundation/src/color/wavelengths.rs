//! Wavelength sets: the wavelengths that rays carry, and quantities at them.
//!
//! Where a scene needs no spectra, a ray carries the three bands of a screen. Where it does, it carries eight
//! wavelengths, evenly spaced over all that is seen, as a wavelength set that is sampled anew for each sample of a
//! pixel. There are 64 sets: all together they are 512 bins less than a nanometre wide, and a quantity is tabulated
//! once as its means over them.
//!
//! # Source
//! Hero wavelength sampling, Wilkie and others 2014; here of 64 sets of bins in the place of any wavelengths.

use super::{Bins, Channels, Color, LANES, Spectrum, color::WHITE, srgb};
use glam::DVec3;

/// Number of wavelength sets.
const SETS: usize = 64;
/// Wavelengths, nm, at which indices of refraction are taken for the three bands: about where each band has its middle.
const OF_BANDS: [f64; 3] = [611.0, 549.0, 464.0];

/// The wavelengths or bands that rays carry, as wavelength sets.
#[derive(Clone, Debug)]
pub struct WavelengthSets {
    /// For each wavelength set the wavelength of each lane, nm; 0 for unused lanes.
    at: Vec<[f64; LANES]>,
    /// For each wavelength set and lane what light of 1 there adds to linear sRGB.
    srgb_weights: Vec<[DVec3; LANES]>,
    spectral: bool,
}

/// A spectral table: a quantity at the wavelengths of each wavelength set.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralTable(Vec<Channels>);

impl SpectralTable {
    /// A table of a quantity for each of some wavelength sets.
    pub fn each(sets: usize, of: impl FnMut(usize) -> Channels) -> SpectralTable {
        SpectralTable((0..sets.max(1)).map(of).collect())
    }

    /// The quantity at the wavelengths of a wavelength set.
    #[inline]
    pub fn of(&self, wavelength_set: usize) -> Channels {
        self.0[wavelength_set.min(self.0.len() - 1)]
    }

    /// The greatest value.
    pub fn max(&self) -> f64 {
        self.0.iter().fold(0.0, |most, channels| channels.max().max(most))
    }
}

impl WavelengthSets {
    /// Red, green and blue.
    pub fn bands() -> WavelengthSets {
        let lane = |lane: usize| OF_BANDS.get(lane).copied().unwrap_or(0.0);
        let unit = |lane: usize| if lane < 3 { DVec3::AXES[lane] } else { DVec3::ZERO };
        WavelengthSets {
            at: vec![std::array::from_fn(lane)],
            srgb_weights: vec![std::array::from_fn(unit)],
            spectral: false,
        }
    }

    /// Eight wavelengths from 360 to 830 nm.
    pub fn spectral() -> WavelengthSets {
        let bins = bins();
        let weights = bins.weights();
        let middles: Vec<f64> = bins.ranges().map(|(from, to)| 0.5 * (from + to)).collect();
        let of = |wavelength_set: usize| std::array::from_fn(|lane| lane * SETS + wavelength_set);
        let sets = || (0..SETS).map(of);
        WavelengthSets {
            at: sets().map(|bins: [usize; LANES]| bins.map(|bin| middles[bin])).collect(),
            srgb_weights: sets().map(|bins| bins.map(|bin| srgb::from_xyz(weights[bin]) * SETS as f64)).collect(),
            spectral: true,
        }
    }

    /// Whether rays carry wavelengths, not bands.
    pub fn is_spectral(&self) -> bool {
        self.spectral
    }

    /// How many lanes carry light.
    pub fn lanes(&self) -> usize {
        if self.spectral { LANES } else { 3 }
    }

    /// The wavelength set for a number that is uniform in 0..1.
    pub fn set_at(&self, uniform: f64) -> usize {
        ((uniform * self.at.len() as f64) as usize).min(self.at.len() - 1)
    }

    /// How many wavelength sets there are.
    pub fn count(&self) -> usize {
        self.at.len()
    }

    /// The wavelengths of a wavelength set, nm; 0 for unused lanes.
    pub fn at(&self, wavelength_set: usize) -> [f64; LANES] {
        self.at[wavelength_set.min(self.at.len() - 1)]
    }

    /// Linear sRGB of light. Its mean over all wavelength sets is exact.
    #[inline]
    pub fn to_srgb(&self, wavelength_set: usize, light: Channels) -> DVec3 {
        if !self.spectral {
            return DVec3::new(light.0[0], light.0[1], light.0[2]);
        }
        let weights = &self.srgb_weights[wavelength_set.min(self.srgb_weights.len() - 1)];
        (0..LANES).map(|lane| weights[lane] * light.0[lane]).sum()
    }

    /// About how much there is of long, middle and short wavelengths: no color, but nearly the same for all wavelength
    /// sets.
    pub fn broad_bands(&self, light: Channels) -> DVec3 {
        let light = light.0;
        match self.spectral {
            // The lanes from 419 to 477, 477 to 595 and 595 to 712 nm.
            true => DVec3::new(0.5 * (light[4] + light[5]), 0.5 * (light[2] + light[3]), light[1]),
            false => DVec3::new(light[0], light[1], light[2]),
        }
    }

    /// How much is seen of light of 1 in each lane: the greater of what it adds to or takes from red, green and blue.
    pub fn visibility(&self, wavelength_set: usize) -> [f64; LANES] {
        self.srgb_weights[wavelength_set.min(self.srgb_weights.len() - 1)].map(|seen| seen.abs().max_element())
    }

    /// A curve of one value everywhere, also in unused lanes.
    pub fn constant(&self, value: f64) -> SpectralTable {
        SpectralTable(vec![Channels::splat(value); self.at.len()])
    }

    /// A reflectance, or another fraction.
    pub fn reflectance(&self, color: &Color) -> SpectralTable {
        match color {
            Color::Bands(bands) if bands.min_element() == bands.max_element() => self.constant(bands.x),
            _ if !self.spectral => SpectralTable(vec![in_bands(color.bands_of_reflectance().max(DVec3::ZERO))]),
            Color::Spectrum(spectrum) => self.means(spectrum),
            _ => self.quantity(color.reflectance_at()),
        }
    }

    /// The reflectances that red, green and blue of an image stand for; they add up to 1 at all wavelengths, so that
    /// every mixture of them is a reflectance and that of equal parts is grey.
    pub fn primaries(&self) -> [SpectralTable; 3] {
        if !self.spectral {
            return DVec3::AXES.map(|axis| SpectralTable(vec![in_bands(axis)]));
        }
        let [red, blue] = [DVec3::X, DVec3::Z].map(|axis| self.reflectance(&Color::Bands(axis)));
        // Where the other two overlap they share.
        let shared = |wavelength_set: usize| {
            red.of(wavelength_set).0.iter().zip(blue.of(wavelength_set).0).map(|(r, b)| (r + b).max(1.0)).collect()
        };
        let shares: Vec<Vec<f64>> = (0..self.count()).map(shared).collect();
        let part = |curve: &SpectralTable| {
            SpectralTable::each(self.count(), |wavelength_set| {
                let own = curve.of(wavelength_set);
                Channels(std::array::from_fn(|lane| own.0[lane] / shares[wavelength_set][lane]))
            })
        };
        let [red, blue] = [part(&red), part(&blue)];
        let green = SpectralTable::each(self.count(), |wavelength_set| {
            (Channels::ONE - red.of(wavelength_set) - blue.of(wavelength_set)).map(|g| g.max(0.0))
        });
        [red, green, blue]
    }

    /// A factor of light, 0 and more.
    pub fn filter(&self, color: &Color) -> SpectralTable {
        match color {
            Color::Bands(bands) if bands.max_element() > 1.0 => {
                let greatest = bands.max_element();
                let shape = self.reflectance(&Color::Bands(*bands / greatest));
                SpectralTable(shape.0.iter().map(|channels| *channels * greatest).collect())
            }
            _ => self.reflectance(color),
        }
    }

    /// The strength of a light, per nanometre or in bands.
    pub fn light(&self, color: &Color) -> SpectralTable {
        match color {
            _ if !self.spectral => SpectralTable(vec![in_bands(color.bands_of_light().max(DVec3::ZERO))]),
            Color::Spectrum(spectrum) => self.means(spectrum),
            Color::Bands(bands) => {
                let greatest = bands.max_element();
                if greatest <= 0.0 {
                    return self.constant(0.0);
                }
                // Scaled first: the shape of a faint light is found as well as that of a bright one.
                let shape = self.reflectance(&Color::Bands(*bands / greatest));
                let white = self.means(&WHITE);
                SpectralTable(shape.0.iter().zip(&white.0).map(|(a, b)| *a * *b * greatest).collect())
            }
        }
    }

    /// A quantity that is given at every wavelength, nm, such as an index of refraction; for bands at a wavelength of
    /// each.
    ///
    /// Unused lanes have the value of the first.
    pub fn quantity(&self, function: impl Fn(f64) -> f64) -> SpectralTable {
        let value = |wavelengths: &[f64; LANES]| {
            Channels(wavelengths.map(|w| function(if w > 0.0 { w } else { wavelengths[0] })))
        };
        SpectralTable(self.at.iter().map(value).collect())
    }

    /// Means over the bins.
    fn means(&self, spectrum: &Spectrum) -> SpectralTable {
        let means = bins().means(spectrum);
        SpectralTable(
            (0..SETS)
                .map(|wavelength_set| Channels(std::array::from_fn(|lane| means[lane * SETS + wavelength_set])))
                .collect(),
        )
    }
}

/// The bins of all wavelength sets.
fn bins() -> Bins {
    Bins::visible(SETS * LANES).expect("there are bins")
}

fn in_bands(bands: DVec3) -> Channels {
    Channels(std::array::from_fn(|lane| if lane < 3 { bands[lane] } else { 0.0 }))
}

#[cfg(test)]
mod tests {
    use super::super::shipped;
    use super::*;

    fn srgb_of(wavelengths: &WavelengthSets, light: &SpectralTable, reflectance: &SpectralTable) -> DVec3 {
        let sets = wavelengths.at.len();
        let sum: DVec3 = (0..sets).map(|c| wavelengths.to_srgb(c, light.of(c) * reflectance.of(c))).sum();
        sum / sets as f64
    }

    #[test]
    fn a_perfect_reflector_under_d65_is_white_for_bands_and_for_wavelengths() {
        for wavelengths in [WavelengthSets::bands(), WavelengthSets::spectral()] {
            let white = wavelengths.light(&Color::grey(2.0));
            let perfect = wavelengths.reflectance(&Color::grey(1.0));
            let found = srgb_of(&wavelengths, &white, &perfect);
            assert!((found - DVec3::splat(2.0)).length() < 2e-5, "{found}");
        }
    }

    #[test]
    fn colors_keep_their_bands_when_they_become_spectra() {
        let wavelengths = WavelengthSets::spectral();
        let white = wavelengths.light(&Color::grey(1.0));
        for bands in [DVec3::new(0.8, 0.3, 0.1), DVec3::new(0.05, 0.4, 0.9), DVec3::new(1.0, 0.0, 0.0)] {
            let reflectance = wavelengths.reflectance(&Color::Bands(bands));
            let found = srgb_of(&wavelengths, &white, &reflectance);
            assert!((found - bands).length() < 1e-3, "{bands} {found}");
            let light = wavelengths.light(&Color::Bands(bands * 7.0));
            let perfect = wavelengths.constant(1.0);
            assert!((srgb_of(&wavelengths, &light, &perfect) - bands * 7.0).length() < 7e-3, "{bands}");
        }
    }

    #[test]
    fn mixtures_of_primaries_are_the_colors_that_they_stand_for() {
        for wavelengths in [WavelengthSets::bands(), WavelengthSets::spectral()] {
            let primaries = wavelengths.primaries();
            let white = wavelengths.light(&Color::grey(1.0));
            for bands in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.2, 0.9, 0.4), DVec3::ONE] {
                let mixture = SpectralTable::each(wavelengths.count(), |wavelength_set| {
                    let part = |band: usize| primaries[band].of(wavelength_set) * bands[band];
                    part(0) + part(1) + part(2)
                });
                let found = srgb_of(&wavelengths, &white, &mixture);
                assert!((found - bands).length() < 1.2e-2, "{bands} {found}");
                let lanes = (0..wavelengths.count()).flat_map(|wavelength_set| mixture.of(wavelength_set).0);
                assert!(lanes.into_iter().all(|part| (0.0..=1.0 + 1e-12).contains(&part)));
            }
        }
    }

    #[test]
    fn a_spectrum_is_seen_as_its_integrals_tell() {
        let wavelengths = WavelengthSets::spectral();
        let red = Color::Spectrum(shipped::reflectance("red").expect("a patch"));
        let light = wavelengths.light(&Color::grey(1.0));
        let found = srgb_of(&wavelengths, &light, &wavelengths.reflectance(&red));
        assert!((found - red.bands_of_reflectance()).length() < 1e-5);
        let lamp = Color::light_of(&shipped::light("F11").expect("a light"), 1.0).expect("visible");
        let found = srgb_of(&wavelengths, &wavelengths.light(&lamp), &wavelengths.constant(1.0));
        assert!((found - lamp.bands_of_light()).length() < 1e-3, "{found} {}", lamp.bands_of_light());
    }

    #[test]
    fn a_lane_that_is_sampled_stands_for_all() {
        let light = Channels([1.0, 2.0, 3.0, 0.0, 5.0, 6.0, 7.0, 8.0]);
        let weights = [1.0, 4.0, 0.5, 1.0, 0.0, 2.0, 0.01, 3.0];
        let mut sum = Channels::ZERO;
        for i in 0..100_000 {
            let (lane, alone) = light.sample_lane(weights, (f64::from(i) + 0.5) / 1e5).expect("something is seen");
            assert!((0..LANES).all(|other| other == lane || alone.0[other] == 0.0));
            sum += alone * 1e-5;
        }
        // A lane that is never seen is never sampled.
        for (lane, mean) in sum.0.into_iter().enumerate() {
            let expected = if weights[lane] > 0.0 { light.0[lane] } else { 0.0 };
            assert!((mean - expected).abs() < 0.05, "{lane}: {mean}, not {expected}");
        }
        assert_eq!(Channels::ZERO.sample_lane(weights, 0.5), None);
    }
}
