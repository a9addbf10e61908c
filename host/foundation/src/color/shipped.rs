//! Spectra that ship with the program: of lamps, daylight, the observer, metals, glasses, and reflectances of surfaces.
//!
//! The files lie in `data/color`; each states its source and its terms in its head.

use super::{ColorError, Extrapolation, Glass, Origin, Spectrum, columns};
use crate::spelling;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// Light of lamps and standard illuminants, relative to any unit.
const LIGHTS: &[&str] =
    &[include_str!("../../../data/color/illuminants.txt"), include_str!("../../../data/color/fluorescent.txt")];
/// Refractive indices of metals and alloys: of each two columns, its name with `.n` and with `.k`.
const METALS: &[&str] = &[
    include_str!("../../../data/color/noble_metals.txt"),
    include_str!("../../../data/color/transition_metals.txt"),
    include_str!("../../../data/color/aluminium.txt"),
    include_str!("../../../data/color/brasses.txt"),
    include_str!("../../../data/color/steels.txt"),
    include_str!("../../../data/color/platinum.txt"),
    include_str!("../../../data/color/rhodium.txt"),
    include_str!("../../../data/color/tungsten.txt"),
    include_str!("../../../data/color/molybdenum.txt"),
    include_str!("../../../data/color/mercury.txt"),
    include_str!("../../../data/color/lead.txt"),
    include_str!("../../../data/color/magnesium.txt"),
    include_str!("../../../data/color/electrum.txt"),
    include_str!("../../../data/color/permalloy.txt"),
    include_str!("../../../data/color/titanium_nitride.txt"),
];
/// Transparent solids.
const GLASSES: &str = include_str!("../../../data/color/glasses.txt");
/// Liquids.
const LIQUIDS: &str = include_str!("../../../data/color/liquids.txt");
/// Reflectances of surfaces; the patches of the colour checker first.
const REFLECTANCES: &[&str] = &[
    CHECKER,
    include_str!("../../../data/color/paints.txt"),
    include_str!("../../../data/color/stones.txt"),
    include_str!("../../../data/color/woods.txt"),
    include_str!("../../../data/color/fabrics.txt"),
    include_str!("../../../data/color/oak.txt"),
    include_str!("../../../data/color/test_colors.txt"),
];
const CHECKER: &str = include_str!("../../../data/color/checker.txt");
/// Functions that belong together: the observer, and daylight.
const FUNCTIONS: &[(&str, &str)] = &[
    ("observer", include_str!("../../../data/color/observer.txt")),
    ("daylight", include_str!("../../../data/color/daylight.txt")),
];

/// A metal: its complex index of refraction n + ik over the wavelength.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComplexIndex {
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
        if let Some((_, spectrum)) =
            columns::spectra(text, Extrapolation::Zero)?.into_iter().find(|(known, _)| *known == name)
        {
            return Ok(spectrum);
        }
    }
    Err(unknown("light", name, &lights()))
}

/// The names of all metals and alloys.
pub fn metals() -> Vec<&'static str> {
    METALS.iter().flat_map(|text| metals_of(text)).collect()
}

/// The names of the metals of a table.
fn metals_of(text: &'static str) -> impl Iterator<Item = &'static str> {
    columns::names(text).into_iter().filter_map(|column| column.strip_suffix(".n"))
}

/// A metal or an alloy, as [`metals`] names it.
///
/// # Errors
/// [`ColorError::Unknown`].
pub fn metal(name: &str) -> Result<ComplexIndex, ColorError> {
    let missing = || unknown("metal", name, &metals());
    let text = METALS.iter().find(|text| metals_of(text).any(|known| known == name)).ok_or_else(missing)?;
    let spectra = columns::spectra(text, Extrapolation::Held)?;
    let column = |letter| {
        let of = |column: &&(&str, Spectrum)| column.0.strip_suffix(letter) == Some(name);
        spectra.iter().find(of).map(|(_, spectrum)| spectrum.clone()).ok_or_else(missing)
    };
    Ok(ComplexIndex { n: column(".n")?, k: column(".k")? })
}

/// The names of all glasses and other transparent solids.
pub fn glasses() -> Vec<&'static str> {
    first_words(GLASSES)
}

/// A glass or another transparent solid, as [`glasses`] names it.
///
/// # Errors
/// [`ColorError::Unknown`].
pub fn glass(name: &str) -> Result<Glass, ColorError> {
    formula(GLASSES, name)?.ok_or_else(|| unknown("glass", name, &glasses()))
}

/// The names of all liquids.
pub fn liquids() -> Vec<&'static str> {
    first_words(LIQUIDS)
}

/// A liquid, as [`liquids`] names it.
///
/// # Errors
/// [`ColorError::Unknown`].
pub fn liquid(name: &str) -> Result<Glass, ColorError> {
    formula(LIQUIDS, name)?.ok_or_else(|| unknown("liquid", name, &liquids()))
}

/// The first words of the lines of a table.
fn first_words(text: &'static str) -> Vec<&'static str> {
    columns::named_rows(text).unwrap_or_default().iter().map(|row| row.first).collect()
}

/// Sellmeier's formula of a line of a table.
fn formula(text: &str, name: &str) -> Result<Option<Glass>, ColorError> {
    let rows = columns::named_rows(text)?;
    let numbers = rows.iter().find(|row| row.first == name).map(|row| row.numbers.as_slice());
    Ok(numbers.and_then(|numbers| match *numbers {
        [from, to, ref terms @ ..] => {
            let terms = terms.chunks_exact(2).map(|term| [term[0], term[1]]).filter(|term| term[0] != 0.0);
            Some(Glass { name: name.into(), from, to, terms: terms.collect() })
        }
        _ => None,
    }))
}

/// The names of the 24 patches of the colour checker, row by row.
pub fn patches() -> Vec<&'static str> {
    columns::names(CHECKER)
}

/// The names of all reflectances; the patches of the colour checker first.
pub fn reflectances() -> Vec<&'static str> {
    REFLECTANCES.iter().flat_map(|text| columns::names(text)).collect()
}

/// The reflectance of a surface, 0..=1, as [`reflectances`] names it.
///
/// # Errors
/// [`ColorError::Unknown`].
pub fn reflectance(name: &str) -> Result<Spectrum, ColorError> {
    for text in REFLECTANCES.iter().filter(|text| columns::names(text).contains(&name)) {
        let mut all = columns::spectra(text, Extrapolation::Held)?.into_iter();
        if let Some((_, spectrum)) = all.find(|(known, _)| *known == name) {
            return Ok(spectrum);
        }
    }
    Err(unknown("reflectance", name, &reflectances()))
}

/// The names of functions that belong together.
pub fn functions() -> Vec<&'static str> {
    FUNCTIONS.iter().map(|row| row.0).collect()
}

/// Functions over the wavelength that belong together, each with its name: those of the observer, or of daylight.
///
/// # Errors
/// [`ColorError::Unknown`].
pub fn function(name: &str) -> Result<Vec<(&'static str, Spectrum)>, ColorError> {
    match FUNCTIONS.iter().find(|row| row.0 == name) {
        Some((_, text)) => columns::spectra(text, Extrapolation::Zero),
        None => Err(unknown("function", name, &functions())),
    }
}

/// The origin of the figures of a name, whatever it names.
pub fn origin(name: &str) -> Option<Origin> {
    let function = || FUNCTIONS.iter().find(|row| row.0 == name).map(|row| row.1);
    let metal = || METALS.iter().find(|text| metals_of(text).any(|known| known == name)).copied();
    let clear = || [GLASSES, LIQUIDS].into_iter().find(|text| first_words(text).contains(&name));
    let column = || LIGHTS.iter().chain(REFLECTANCES).find(|text| columns::names(text).contains(&name)).copied();
    function().or_else(metal).or_else(clear).or_else(column).map(columns::origin)
}

fn unknown(kind: &'static str, name: &str, known: &[&str]) -> ColorError {
    ColorError::Unknown { kind, name: name.into(), advice: spelling::advice(name, known) }
}

/// The three columns of a file that ships with the program and is read again and again.
fn three(text: &str, beyond: Extrapolation) -> [Spectrum; 3] {
    let spectra = columns::spectra(text, beyond).expect("the embedded table is read by the tests");
    let spectra: Vec<Spectrum> = spectra.into_iter().map(|(_, spectrum)| spectrum).collect();
    spectra.try_into().expect("the embedded table has three columns")
}

/// The functions x, y and z of the CIE 1931 observer, 360 to 830 nm.
pub(super) static OBSERVER: LazyLock<[Spectrum; 3]> = LazyLock::new(|| three(FUNCTIONS[0].1, Extrapolation::Zero));

/// Mean daylight and its two characteristic vectors, 300 to 830 nm.
pub(super) static DAYLIGHT: LazyLock<[Spectrum; 3]> = LazyLock::new(|| three(FUNCTIONS[1].1, Extrapolation::Zero));

/// The standard illuminant D65.
pub static D65: LazyLock<Spectrum> = LazyLock::new(|| light("D65").expect("the embedded table has D65"));

#[cfg(test)]
mod tests {
    use super::super::observer;
    use super::*;
    use glam::DVec3;

    #[test]
    fn everything_that_is_named_can_be_had() {
        assert_eq!(lights(), ["A", "D65", "F2", "F7", "F11"]);
        assert!(lights().iter().all(|name| light(name).is_ok_and(|s| s.samples().all(|(_, v)| v >= 0.0))));
        assert_eq!(metals().iter().filter(|name| metal(name).is_ok()).count(), 26);
        assert_eq!(glasses().iter().filter(|name| glass(name).is_ok()).count(), 15);
        assert_eq!(liquids().iter().filter(|name| liquid(name).is_ok()).count(), 5);
        assert_eq!((patches().len(), reflectances().len()), (24, 70));
        for name in reflectances() {
            assert!(reflectance(name).is_ok_and(|s| s.samples().all(|(_, v)| (0.0..=1.0).contains(&v))), "{name}");
        }
        assert!(functions().iter().all(|name| function(name).is_ok_and(|all| all.len() == 3)));
    }

    #[test]
    fn every_name_is_given_once_and_has_source_and_terms() {
        let mut names = [lights(), metals(), glasses(), liquids(), reflectances(), functions()].concat();
        for name in &names {
            let Origin { what, source, terms } = origin(name).expect("an origin");
            assert!(what.ends_with('.') && source.ends_with('.') && terms.ends_with('.'), "{name}: {source} {terms}");
        }
        names.sort_unstable();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
        assert_eq!(origin("unobtainium"), None);
    }

    /// Chroma and hue, degrees, of CIE L*a*b* under D65.
    fn chroma_and_hue(name: &str) -> (f64, f64) {
        let white = observer::tristimulus(&D65);
        let seen =
            observer::surface_tristimulus(&reflectance(name).expect("a reflectance"), &D65).expect("D65 is seen");
        // X, Y and Z over those of white, as their cube roots; all here are above the linear part of L*a*b* but black.
        let root = |seen: f64, white: f64| (seen / (white / white_y(&D65))).cbrt();
        let (x, y, z) = (root(seen.x, white.x), root(seen.y, white.y), root(seen.z, white.z));
        let (a, b) = (500.0 * (x - y), 200.0 * (y - z));
        (a.hypot(b), b.atan2(a).to_degrees().rem_euclid(360.0))
    }

    fn white_y(light: &Spectrum) -> f64 {
        observer::tristimulus(light).y
    }

    #[test]
    fn test_colors_have_the_lightness_of_their_munsell_notation() {
        // Munsell values 8 and 4 are Y = 0.576 and 0.117 under C, of a perfect reflector (Newhall and others 1943: of
        // magnesium oxide 0.591 and 0.120).
        for (name, published) in [("skin", 0.576), ("green_leaf", 0.117)] {
            let y = observer::surface_tristimulus(&reflectance(name).expect("a reflectance"), &D65).expect("seen").y;
            assert!((y / published - 1.0).abs() < 0.04, "{name} {y}");
        }
    }

    #[test]
    fn colors_have_the_hues_of_their_names() {
        for (from, to, names) in [
            (15.0, 55.0, "cadmium_red vermilion alizarin_crimson red_brick dark_red_brick red_nylon"),
            (50.0, 75.0, "cadmium_orange skin cedar pine cardboard raw_umber"),
            (70.0, 100.0, "cadmium_yellow hansa_yellow yellow_ochre yellow_plastic"),
            (100.0, 190.0, "chromium_green viridian cobalt_green green_nylon green_leaf oak_leaf olive_webbing"),
            (220.0, 310.0, "cobalt_blue cerulean_blue phthalo_blue blue_nylon"),
            (300.0, 360.0, "cobalt_violet"),
        ] {
            for name in names.split(' ') {
                let (chroma, hue) = chroma_and_hue(name);
                assert!((from..to).contains(&hue) && chroma > 5.0, "{name}: chroma {chroma}, hue {hue}");
            }
        }
        for name in
            ["grey_brick", "concrete", "cinder_block", "asphalt", "roof_tar", "calcite", "zinc_white", "grey_paint"]
        {
            assert!(chroma_and_hue(name).0 < 12.0, "{name}: chroma {}", chroma_and_hue(name).0);
        }
    }

    #[test]
    fn white_things_are_brighter_than_grey_ones_and_those_than_black_ones() {
        let y = |name| {
            observer::surface_tristimulus(&reflectance(name).expect("a reflectance"), &D65).map_or(DVec3::ZERO, |s| s).y
        };
        let known = [
            "calcite",
            "zinc_white",
            "white_cotton",
            "pale_concrete",
            "cinder_block",
            "concrete",
            "asphalt",
            "roof_tar",
        ];
        assert!(known.windows(2).all(|pair| y(pair[0]) > y(pair[1])), "{:?}", known.map(y));
    }

    /// The part of light that a metal reflects at right angles, at 450, 550 and 650 nm.
    fn reflected(name: &str) -> [f64; 3] {
        let ComplexIndex { n, k } = metal(name).expect("a metal");
        [450.0, 550.0, 650.0].map(|w| {
            let (n, k) = (n.at(w), k.at(w));
            ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k)
        })
    }

    #[test]
    fn metals_have_the_colors_of_their_names() {
        // Yellow and red ones reflect more of long waves, in this order of how much; the others are about grey.
        for name in ["bronze", "red_brass", "brass", "copper", "gold", "electrum", "titanium_nitride"] {
            let [blue, green, red] = reflected(name);
            assert!(blue < 0.66 && blue + 0.15 < red && green + 0.015 < red, "{name} {blue} {green} {red}");
        }
        for name in metals() {
            let [blue, green, red] = reflected(name);
            assert!(green > 0.4 && green < 0.99 && red > 0.4, "{name} {blue} {green} {red}");
        }
        // Handbooks: silver 0.98, aluminium 0.91, rhodium 0.77, mercury 0.78, chromium 0.55 to 0.7, tungsten 0.5.
        for (name, published) in [("rhodium", 0.77), ("mercury", 0.78), ("aluminium", 0.915), ("tungsten", 0.5)] {
            assert!((reflected(name)[1] - published).abs() < 0.02, "{name} {:?}", reflected(name));
        }
    }

    #[test]
    fn a_name_that_is_not_known_is_answered_by_those_that_are() {
        let message = metal("unobtainium").expect_err("unknown").to_string();
        assert!(message.starts_with("no metal is called \"unobtainium\"; there are copper, gold, silver, iron, "));
        assert!(light("").is_err() && glass("gl\u{e4}ss").is_err() && reflectance("DARK").is_err());
    }
}
