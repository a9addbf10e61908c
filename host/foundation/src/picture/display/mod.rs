//! From scene-referred radiance to what a display shows: exposure, white balance, bloom and a tone curve.
//!
//! # Source
//! Reinhard, Heidrich, Debevec, Pattanaik, Ward and Myszkowski, *High Dynamic Range Imaging*, second edition 2010.

mod bloom;
mod filmic;
mod gamut;
mod tone;
mod white_balance;

pub use tone::Tone;
pub use white_balance::neutral;

use super::{Picture, PictureError};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// Radiance to which the exposure meter leads the mean of an ordinary scene: that of a surface which reflects 18 % of the
/// light, middle grey.
pub const MIDDLE_GREY: f64 = 0.18;

/// Stops beyond which an exposure that is asked for is taken for a mistake.
const MAX_STOPS: f64 = 100.0;

/// How a picture of radiance is shown.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct DisplayTransform {
    /// How much brighter or darker it is shown.
    pub exposure: Exposure,
    /// Chromaticity x, y of the light that is shown as white; without one, that of D65.
    pub white: Option<DVec2>,
    /// How much light the point spread of an eye scatters about bright points: 0 none, 1 as a healthy eye does.
    pub bloom: f64,
    /// From exposed radiance to the light of the display.
    pub tone: Tone,
}

impl Default for DisplayTransform {
    /// Exposed by the meter, with the filmic curve, as people look at pictures.
    fn default() -> DisplayTransform {
        DisplayTransform { exposure: Exposure::Auto { compensation: 0.0 }, white: None, bloom: 0.0, tone: Tone::Filmic }
    }
}

/// How much brighter or darker than it is a picture is shown.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Exposure {
    /// As the exposure meter finds, and so many stops more.
    Auto {
        /// Stops, -100..=100.
        compensation: f64,
    },
    /// By so many stops, -100..=100: radiance is multiplied by 2 to this power.
    Stops(f64),
}

impl FromStr for Exposure {
    type Err = String;

    /// Reads `1.5`, `auto` or `auto+0.5`.
    fn from_str(text: &str) -> Result<Exposure, String> {
        let wrong = || format!("'{text}' is no exposure: give stops, such as -1.5, or auto, or auto+0.5");
        let number = |text: &str| {
            let number = text.parse::<f64>().ok().filter(|stops| stops.abs() <= MAX_STOPS);
            number.ok_or_else(wrong)
        };
        match text.strip_prefix("auto") {
            None => Ok(Exposure::Stops(number(text)?)),
            Some("") => Ok(Exposure::Auto { compensation: 0.0 }),
            Some(more) if more.starts_with(['+', '-']) => Ok(Exposure::Auto { compensation: number(more)? }),
            Some(_) => Err(wrong()),
        }
    }
}

impl DisplayTransform {
    /// Shows radiance as it is: 1 is white, and what is brighter is clipped.
    pub const LINEAR: DisplayTransform =
        DisplayTransform { exposure: Exposure::Stops(0.0), white: None, bloom: 0.0, tone: Tone::Linear };

    /// Checks its numbers.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn check(&self) -> Result<(), String> {
        let (Exposure::Auto { compensation: stops } | Exposure::Stops(stops)) = self.exposure;
        if !(-MAX_STOPS..=MAX_STOPS).contains(&stops) {
            return Err(format!("an exposure of {stops} stops is not within -{MAX_STOPS} to {MAX_STOPS}"));
        }
        if !(0.0..=100.0).contains(&self.bloom) {
            return Err(format!("bloom {} is not within 0 to 100", self.bloom));
        }
        match self.white {
            Some(white) if white_balance::matrix(white).is_none() => {
                Err(format!("no eye takes light of chromaticity {}, {} for white", white.x, white.y))
            }
            _ => Ok(()),
        }
    }

    /// The picture as a display shows it: its radiance is light of the display, 0 black and 1 white. Coverage stays.
    ///
    /// - `stops`: by how many the picture is exposed: those of the transform, or what an exposure meter found.
    /// - `pixel_angle`: what a pixel spans, degrees, for bloom.
    ///
    /// Memory for bloom: 32 bytes a pixel.
    ///
    /// # Errors
    /// [`PictureError`] if there is no memory for another picture.
    pub fn shown(&self, picture: &Picture, stops: f64, pixel_angle: f64) -> Result<Picture, PictureError> {
        let mut shown = Picture::new(picture.width, picture.height)?;
        let gain = stops.exp2();
        let balance = self.white.and_then(white_balance::matrix);
        let pixels = shown.pixels.par_iter_mut().with_min_len(1 << 12).zip(&picture.pixels);
        pixels.for_each(|(shown, pixel)| {
            let exposed = DVec3::from(pixel.radiance.map(f64::from)) * gain;
            let balanced = balance.map_or(exposed, |matrix| (matrix * exposed).max(DVec3::ZERO));
            shown.radiance = balanced.as_vec3().to_array();
            shown.coverage = pixel.coverage;
        });
        if self.bloom > 0.0 {
            bloom::scatter(&mut shown, self.bloom, pixel_angle)?;
        }
        let curve = self.tone.curve();
        shown.pixels.par_iter_mut().with_min_len(1 << 12).for_each(|pixel| {
            pixel.radiance = curve(DVec3::from(pixel.radiance.map(f64::from))).as_vec3().to_array();
        });
        Ok(shown)
    }
}

/// The part of the pixels of a picture for a display that are clipped: a band is brighter than white, 0..=1.
pub fn clipped(shown: &Picture) -> f64 {
    let is_clipped = |pixel: &&super::Pixel| pixel.radiance.iter().any(|band| *band > 1.0);
    shown.pixels.iter().filter(is_clipped).count() as f64 / shown.pixels.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Pixel;

    fn grey(radiance: f32) -> Picture {
        let mut picture = Picture::new(3, 2).expect("small");
        picture.pixels_mut().fill(Pixel { radiance: [radiance; 3], coverage: 0.5 });
        picture
    }

    #[test]
    fn exposures_are_read() {
        for (text, exposure) in [
            ("-1.5", Exposure::Stops(-1.5)),
            ("+2", Exposure::Stops(2.0)),
            ("auto", Exposure::Auto { compensation: 0.0 }),
            ("auto-0.5", Exposure::Auto { compensation: -0.5 }),
        ] {
            assert_eq!(text.parse(), Ok(exposure));
        }
        for text in ["", "automatic", "auto 1", "auto+", "1e9", "nan", "dark"] {
            assert!(text.parse::<Exposure>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_stop_doubles_the_light_and_coverage_stays() {
        let shown =
            |radiance: f32, stops: f64| DisplayTransform::LINEAR.shown(&grey(radiance), stops, 0.1).expect("small");
        assert!(shown(0.25, 1.0).pixels().iter().all(|p| *p == Pixel { radiance: [0.5; 3], coverage: 0.5 }));
        assert_eq!([clipped(&shown(0.6, 1.0)), clipped(&shown(0.25, 1.0))], [1.0, 0.0]);
        assert_eq!(shown(7.0, 0.0), grey(7.0));
    }

    #[test]
    fn impossible_numbers_are_refused() {
        let linear = DisplayTransform::LINEAR;
        assert!(linear.check().is_ok() && DisplayTransform::default().check().is_ok());
        for wrong in [
            DisplayTransform { exposure: Exposure::Stops(f64::NAN), ..linear },
            DisplayTransform { bloom: -1.0, ..linear },
            DisplayTransform { white: Some(DVec2::new(0.3, 0.0)), ..linear },
            DisplayTransform { white: Some(DVec2::new(f64::NAN, 0.3)), ..linear },
        ] {
            assert!(wrong.check().is_err(), "{wrong:?}");
        }
    }
}
