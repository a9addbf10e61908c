//! Arguments of commands that show pictures: exposure, tone curve, white balance and bloom.

use super::{CommandFailure, Exit};
use crate::color::{light_of_temperature, shipped};
use crate::picture::display::{DisplayTransform, Exposure, Tone, neutral};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use glam::DVec2;

/// How pictures are shown, as far as the command line says. EXR files keep the radiance.
#[derive(Args, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DisplayArguments {
    /// How much brighter PNG files are, in stops, each of which doubles the light: 0 shows radiance as it is, auto is what
    /// suits the scene, auto+0.5 half a stop more
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true)]
    exposure: Option<Exposure>,
    /// The curve from exposed radiance to the light of PNG files: filmic goes softly into white and black, reinhard keeps
    /// chromaticities, linear clips what is brighter than 1
    #[arg(long, value_name = "CURVE", value_parser = PossibleValuesParser::new(Tone::WORDS).map(|word| Tone::of_word(&word).unwrap_or_default()))]
    tone: Option<Tone>,
    /// The light whose white PNG files show as white: A, D50 and others, "blackbody 3000", "daylight 5000"
    #[arg(long, value_name = "LIGHT", value_parser = white)]
    white: Option<DVec2>,
    /// Spreads light about bright points in PNG files: so many times what a healthy eye spreads
    #[arg(long, value_name = "AMOUNT")]
    bloom: Option<f64>,
}

impl DisplayArguments {
    /// Whether none is given.
    pub(super) fn is_empty(&self) -> bool {
        *self == DisplayArguments::default()
    }

    /// What the command line says, and for the rest another transform.
    ///
    /// # Errors
    /// [`Exit::Usage`] as a [`CommandFailure`] for impossible numbers.
    pub(super) fn over(&self, other: DisplayTransform) -> Result<DisplayTransform, CommandFailure> {
        let display = DisplayTransform {
            exposure: self.exposure.unwrap_or(other.exposure),
            white: self.white.or(other.white),
            bloom: self.bloom.unwrap_or(other.bloom),
            tone: self.tone.unwrap_or(other.tone),
        };
        display.check().map_err(|problem| CommandFailure::new(Exit::Usage, anyhow::anyhow!(problem)))?;
        Ok(display)
    }
}

/// Reads the name of a light as the chromaticity of its white.
fn white(name: &str) -> Result<DVec2, String> {
    let spectrum = light_of_temperature(name).unwrap_or_else(|| shipped::light(name));
    let spectrum = spectrum.map_err(|error| error.to_string())?;
    neutral(&spectrum).ok_or_else(|| format!("the light {name} cannot be seen"))
}
