//! What ships with the program: lamps, daylight, the observer, metals, glasses, painted patches.
//!
//! The files lie in `data/color`; each states its source and its terms in its head.

use super::{Beyond, ColorError, Glass, Spectrum, columns};
use std::sync::LazyLock;

/// Light of lamps and standard illuminants, relative to any unit.
const LIGHTS: &[&str] =
    &[include_str!("../../data/color/illuminants.txt"), include_str!("../../data/color/fluorescent.txt")];
/// Metals, and the tables of their indices.
const METALS: &[(&str, &str)] = &[
    ("copper", include_str!("../../data/color/copper.txt")),
    ("gold", include_str!("../../data/color/gold.txt")),
    ("silver", include_str!("../../data/color/silver.txt")),
    ("aluminium", include_str!("../../data/color/aluminium.txt")),
    ("iron", include_str!("../../data/color/iron.txt")),
];
const GLASSES: &str = include_str!("../../data/color/glasses.txt");
const CHECKER: &str = include_str!("../../data/color/checker.txt");

/// A metal: its complex index of refraction n + ik over the wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct Metal {
    /// Refractive index n, 0 and more.
    pub n: Spectrum,
    /// Extinction coefficient k, 0 and more.
    pub k: Spectrum,
}

/// The names of all lights.
pub fn lights() -> Vec<&'static str> {
    LIGHTS.iter().flat_map(|text| columns::names(text)).collect()
}

/// The relative power of a light over the wavelength, as [`lights`] names it: D65, A, F2 and others.
///
/// # Errors
/// [`ColorError::Unknown`].
pub fn light(name: &str) -> Result<Spectrum, ColorError> {
    for text in LIGHTS {
        if let Some((_, spectrum)) = columns::spectra(text, Beyond::Zero)?.into_iter().find(|(known, _)| *known == name)
        {
            return Ok(spectrum);
        }
    }
    Err(unknown("light", name, &lights()))
}

/// The names of all metals.
pub fn metals() -> Vec<&'static str> {
    METALS.iter().map(|row| row.0).collect()
}

/// A metal, as [`metals`] names it.
///
/// # Errors
/// [`ColorError::Unknown`].
pub fn metal(name: &str) -> Result<Metal, ColorError> {
    let missing = || unknown("metal", name, &metals());
    let (_, text) = METALS.iter().find(|row| row.0 == name).ok_or_else(missing)?;
    let mut spectra = columns::spectra(text, Beyond::Held)?.into_iter().map(|(_, spectrum)| spectrum);
    spectra.next().zip(spectra.next()).map(|(n, k)| Metal { n, k }).ok_or_else(missing)
}

/// The names of all glasses.
pub fn glasses() -> Vec<&'static str> {
    columns::named_rows(GLASSES).unwrap_or_default().iter().map(|row| row.first).collect()
}

/// A glass or another transparent solid, as [`glasses`] names it.
///
/// # Errors
/// [`ColorError::Unknown`].
pub fn glass(name: &str) -> Result<Glass, ColorError> {
    let rows = columns::named_rows(GLASSES)?;
    match rows.iter().find(|row| row.first == name).map(|row| row.numbers.as_slice()) {
        Some(&[from, to, ref terms @ ..]) => {
            Ok(Glass { name: name.into(), from, to, terms: terms.chunks_exact(2).map(|t| [t[0], t[1]]).collect() })
        }
        _ => Err(unknown("glass", name, &glasses())),
    }
}

/// The names of the 24 patches of the colour checker, row by row.
pub fn patches() -> Vec<&'static str> {
    columns::names(CHECKER)
}

/// The reflectance of a patch of the colour checker, as [`patches`] names it.
///
/// # Errors
/// [`ColorError::Unknown`].
pub fn patch(name: &str) -> Result<Spectrum, ColorError> {
    let mut all = columns::spectra(CHECKER, Beyond::Held)?.into_iter();
    let found = all.find(|(known, _)| *known == name).map(|(_, spectrum)| spectrum);
    found.ok_or_else(|| unknown("patch", name, &patches()))
}

fn unknown(kind: &'static str, name: &str, known: &[&str]) -> ColorError {
    ColorError::Unknown { kind, name: name.into(), known: known.join(", ") }
}

/// The three columns of a file that ships with the program and is read again and again.
fn three(text: &str, beyond: Beyond) -> [Spectrum; 3] {
    let spectra = columns::spectra(text, beyond).expect("the embedded table is read by the tests");
    let spectra: Vec<Spectrum> = spectra.into_iter().map(|(_, spectrum)| spectrum).collect();
    spectra.try_into().expect("the embedded table has three columns")
}

/// The functions x, y and z of the CIE 1931 observer, 360 to 830 nm.
pub(super) static OBSERVER: LazyLock<[Spectrum; 3]> =
    LazyLock::new(|| three(include_str!("../../data/color/observer.txt"), Beyond::Zero));

/// Mean daylight and its two characteristic vectors, 300 to 830 nm.
pub(super) static DAYLIGHT: LazyLock<[Spectrum; 3]> =
    LazyLock::new(|| three(include_str!("../../data/color/daylight.txt"), Beyond::Zero));

/// The standard illuminant D65.
pub static D65: LazyLock<Spectrum> = LazyLock::new(|| light("D65").expect("the embedded table has D65"));

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_that_is_named_can_be_had() {
        assert_eq!(lights(), ["A", "D65", "F2", "F7", "F11"]);
        assert!(lights().iter().all(|name| light(name).is_ok_and(|s| s.samples().all(|(_, v)| v >= 0.0))));
        assert_eq!(metals().iter().filter(|name| metal(name).is_ok()).count(), 5);
        assert_eq!(glasses().iter().filter(|name| glass(name).is_ok()).count(), 4);
        assert_eq!(patches().len(), 24);
        for name in patches() {
            assert!(patch(name).is_ok_and(|s| s.samples().all(|(_, v)| (0.0..=1.0).contains(&v))), "{name}");
        }
    }

    #[test]
    fn a_name_that_is_not_known_is_answered_by_those_that_are() {
        let message = metal("unobtainium").expect_err("unknown").to_string();
        assert_eq!(message, "no metal is called \"unobtainium\"; there are copper, gold, silver, aluminium, iron");
        assert!(light("").is_err() && glass("gl\u{e4}ss").is_err() && patch("DARK").is_err());
    }
}
