//! Arguments of commands that render pictures into files, and what they say of settings and orders.

use super::display::DisplayArguments;
use super::{CommandFailure, Exit};
use crate::picture::Filter;
use crate::picture::display::DisplayTransform;
use crate::render::{RENDERERS, RenderOrder, Technique};
use crate::scene::{MAX_SAMPLES, Scene, Settings};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::num::NonZeroUsize;

/// How pictures are rendered, as far as the command line says.
#[derive(Args, Debug)]
pub(super) struct RenderingArguments {
    /// Who makes the picture
    #[arg(long, value_name = "RENDERER", value_parser = renderers(), default_value = RENDERERS[0].option)]
    pub(super) renderer: Technique,
    /// Columns, instead of those of the scene; alone, the rows follow
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    width: Option<u32>,
    /// Rows, instead of those of the scene; alone, the columns follow
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    height: Option<u32>,
    /// Samples in each pixel, instead of those of the scene
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=i64::from(crate::scene::MAX_SAMPLES)))]
    samples: Option<u32>,
    /// How samples around a pixel become one value, instead of that of the scene: box is the mean over the pixel,
    /// gaussian and blackman-harris smooth, mitchell sharpens
    #[arg(long, value_name = "FILTER", value_parser = PossibleValuesParser::new(Filter::WORDS).map(|word| Filter::of_word(&word).unwrap_or_default()))]
    filter: Option<Filter>,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "COUNT", value_parser = super::values::threads)]
    pub(super) threads: Option<NonZeroUsize>,
    /// Most memory for what procedural models make, such as 64M; half of what the command may take if not given. What does
    /// not fit is made again; the picture is the same
    #[arg(long, value_name = "SIZE", value_parser = super::values::any_bytes)]
    pub(super) detail_memory: Option<u64>,
    /// Seed of the sample positions, instead of that of the scene
    #[arg(long, value_name = "NUMBER")]
    seed: Option<u64>,
    /// Tessellation tolerance in scene units, instead of that of the scene
    #[arg(long, value_name = "LENGTH")]
    tolerance: Option<f64>,
    /// Relative error of the luminance at which a pixel has samples enough; --samples, if given, is then the most of
    /// them. If pixels miss it, the picture is written all the same, and the exit code tells
    #[arg(long, value_name = "PART", value_parser = super::values::length)]
    pub(super) error: Option<f64>,
    /// Writes depth, normals, numbers of objects and materials, samples and variance into EXR files, too; by ray
    /// tracing that goes on from no file also emitted, direct, caustic and indirect light, which together are the
    /// picture before it is denoised; and the albedo, with --denoise
    #[arg(long)]
    pub(super) layers: bool,
    /// Leaves the background out where nothing stands before it, so that `peris compose` can put another one there; it
    /// stays behind glass and in mirrors. PNG files are then linear, whatever the scene says, unless --exposure or
    /// --tone do
    #[arg(long)]
    matte: bool,
    /// Takes most of the noise out of the picture, for few samples and previews, in one to two seconds for a million
    /// pixels on two cores. Edges, patterns and what mirrors show stay; faint and fine light, as that of caustics, may
    /// be lost
    #[arg(long)]
    pub(super) denoise: bool,
    #[command(flatten)]
    display: DisplayArguments,
    /// Leaves nothing out; the picture is the same
    #[arg(long)]
    pub(super) everything: bool,
}

impl RenderingArguments {
    /// Sets what the command line says of the scene's settings.
    pub(super) fn set(&self, settings: &mut Settings) {
        (settings.image.width, settings.image.height) =
            size(settings.image.width, settings.image.height, self.width, self.height);
        settings.image.samples = self.samples.unwrap_or(settings.image.samples);
        settings.image.filter = self.filter.unwrap_or(settings.image.filter);
        settings.image.seed = self.seed.unwrap_or(settings.image.seed);
        settings.geometry.tolerance = self.tolerance.or(settings.geometry.tolerance);
        (self.renderer.row().require)(settings);
    }

    /// How pictures are shown.
    ///
    /// # Errors
    /// [`Exit::Usage`] as a [`CommandFailure`] for impossible numbers.
    pub(super) fn display_of(&self, scene: &Scene) -> Result<DisplayTransform, CommandFailure> {
        // Layers of a composition are put together as light, and exposed as a whole.
        self.display.over(if self.matte { DisplayTransform::LINEAR } else { scene.display })
    }

    /// How pictures are to be made. Where errors or the clock decide about samples, the scene does not.
    ///
    /// - `seconds`: after which no sample is begun.
    ///
    /// # Errors
    /// [`Exit::Usage`] as a [`CommandFailure`] for a picture that is to be denoised and has no samples for it.
    pub(super) fn order(&self, settings: &Settings, seconds: Option<f64>) -> Result<RenderOrder, CommandFailure> {
        let is_open = self.error.is_some() || seconds.is_some();
        let order = RenderOrder {
            samples: self.samples.unwrap_or(if is_open { MAX_SAMPLES } else { settings.image.samples }),
            threads: self.threads,
            target: self.error,
            seconds,
            matte: self.matte,
            denoise: self.denoise,
            ..RenderOrder::of(settings)
        };
        if order.denoise && order.samples < 2 {
            let message = "--denoise needs 2 samples in each pixel: what differs between them is noise";
            return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)));
        }
        Ok(order)
    }

    /// Refuses what a renderer does not know.
    ///
    /// - `more`: options of a command of its own that only renderers know which add samples, and whether they are given.
    ///
    /// # Errors
    /// [`Exit::Usage`] as a [`CommandFailure`].
    pub(super) fn check(&self, more: &[(&str, bool)]) -> Result<(), CommandFailure> {
        let row = self.renderer.row();
        let own = [("--error", self.error.is_some()), ("--denoise", self.denoise)];
        match own.iter().chain(more).find(|(_, given)| *given) {
            Some((name, _)) if !row.adds_samples => {
                let message = format!("{} has no {name}: it takes all samples at once", row.word);
                Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)))
            }
            _ => Ok(()),
        }
    }
}

/// Reads the name of a renderer.
fn renderers() -> impl TypedValueParser<Value = Technique> {
    let values = RENDERERS.iter().map(|row| PossibleValue::new(row.option).help(row.help));
    PossibleValuesParser::new(values).map(|option| Technique::of_option(&option).unwrap_or(RENDERERS[0].technique))
}

/// The size of the picture, when the command line gives one side or both.
fn size(width: u32, height: u32, new_width: Option<u32>, new_height: Option<u32>) -> (u32, u32) {
    let scaled = |side: u32, new: u32, old: u32| {
        (f64::from(side) * f64::from(new) / f64::from(old)).round().clamp(1.0, f64::from(u32::MAX)) as u32
    };
    match (new_width, new_height) {
        (None, None) => (width, height),
        (Some(w), None) => (w, scaled(height, w, width)),
        (None, Some(h)) => (scaled(width, h, height), h),
        (Some(w), Some(h)) => (w, h),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_side_of_the_picture_takes_the_other_with_it() {
        assert_eq!(size(640, 480, None, None), (640, 480));
        assert_eq!(size(640, 480, Some(320), None), (320, 240));
        assert_eq!(size(640, 480, None, Some(1)), (1, 1));
        assert_eq!(size(640, 480, Some(10), Some(20)), (10, 20));
    }
}
