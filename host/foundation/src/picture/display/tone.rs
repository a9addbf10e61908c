//! Tone curves, one row each.

use super::filmic;
use super::gamut::fitted;
use crate::color::srgb::LUMINANCE;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Radiance that the curve of Reinhard and others shows as white: four stops above diffuse white.
const BURN_OUT: f64 = 16.0;

/// From exposed radiance to the light of a display.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tone {
    /// As it is; what is brighter than 1 is clipped.
    Linear,
    /// As film takes it: bright light and dark shadows go softly into white and black, and bright colours into white.
    #[default]
    Filmic,
    /// The curve of Reinhard and others of the luminance alone, so that colours keep their chromaticity.
    Reinhard,
}

/// A tone curve.
struct Row {
    tone: Tone,
    word: &'static str,
    /// The least grey that is shown as white.
    white: f64,
    curve: fn(DVec3) -> DVec3,
}

const ROWS: &[Row] = &[
    Row { tone: Tone::Linear, word: "linear", white: 1.0, curve: |rgb| rgb },
    Row { tone: Tone::Filmic, word: "filmic", white: filmic::WHITE, curve: filmic::curve },
    Row { tone: Tone::Reinhard, word: "reinhard", white: BURN_OUT, curve: reinhard },
];

impl Tone {
    /// The words for all of them.
    pub const WORDS: [&str; ROWS.len()] = words!(ROWS);

    /// All of them, each with its word.
    pub const NAMED: [(&'static str, Tone); ROWS.len()] = named!(ROWS, tone);

    /// The one that a word names.
    pub fn of_word(word: &str) -> Option<Tone> {
        ROWS.iter().find(|row| row.word == word).map(|row| row.tone)
    }

    /// The word for it.
    pub fn word(self) -> &'static str {
        self.row().word
    }

    /// The least grey radiance that it shows as white.
    pub fn white(self) -> f64 {
        self.row().white
    }

    /// From exposed radiance, linear sRGB, to the light of the display.
    pub(super) fn curve(self) -> fn(DVec3) -> DVec3 {
        self.row().curve
    }

    fn row(self) -> &'static Row {
        ROWS.iter().find(|row| row.tone == self).unwrap_or(&ROWS[0])
    }
}

/// The curve of the luminance, which keeps chromaticities.
///
/// # Source
/// Reinhard, Stark, Shirley and Ferwerda 2002, equation 4: L (1 + L / white²) / (1 + L).
fn reinhard(rgb: DVec3) -> DVec3 {
    let luminance = rgb.dot(LUMINANCE);
    if !(luminance > 0.0 && luminance.is_finite()) {
        return DVec3::ZERO;
    }
    fitted(rgb * ((1.0 + luminance / (BURN_OUT * BURN_OUT)) / (1.0 + luminance)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::{Color, shipped};

    /// Colours of the colour checker under D65, and saturated ones.
    fn colours() -> Vec<DVec3> {
        let patches = shipped::patches()
            .into_iter()
            .map(|name| Color::Spectrum(shipped::reflectance(name).expect("shipped")).bands_of_reflectance());
        patches.chain([DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 1.0)]).collect()
    }

    #[test]
    fn every_curve_has_its_word_and_its_white() {
        for row in ROWS {
            assert_eq!(
                (Tone::of_word(row.word), row.tone.word(), row.tone.row().word),
                (Some(row.tone), row.word, row.word)
            );
            let white = (row.curve)(DVec3::splat(row.white));
            assert!((white - DVec3::ONE).abs().max_element() < 1e-9, "{}: {white}", row.word);
            let grey = (row.curve)(DVec3::splat(0.9 * row.white));
            assert!(grey.max_element() < 1.0 && grey.max_element() - grey.min_element() < 1e-9, "{}: {grey}", row.word);
            assert_eq!((row.curve)(DVec3::ZERO), DVec3::ZERO, "{}", row.word);
        }
        assert_eq!(Tone::of_word("film"), None);
    }

    #[test]
    fn more_light_is_never_shown_darker() {
        for row in ROWS {
            for colour in colours() {
                let mut before = -1.0;
                for step in -280..=240 {
                    let shown = (row.curve)(colour * f64::exp2(f64::from(step) / 20.0));
                    let luminance = shown.dot(LUMINANCE);
                    assert!(shown.is_finite() && luminance >= before - 1e-9, "{} {colour} {step}", row.word);
                    before = luminance;
                }
            }
        }
    }

    #[test]
    fn light_without_end_or_number_is_white_or_black() {
        for row in ROWS.iter().filter(|row| row.tone != Tone::Linear) {
            for wrong in [DVec3::splat(f64::NAN), DVec3::splat(-1.0), DVec3::splat(1e300), DVec3::splat(f64::INFINITY)]
            {
                let shown = (row.curve)(wrong);
                assert!(shown.min_element() >= 0.0 && shown.max_element() <= 1.0, "{} {wrong}: {shown}", row.word);
            }
        }
    }
}
