//! The arguments of `peris render`, and what they say of settings, files and views.

use crate::cli::display::DisplayArguments;
use crate::cli::source::stem;
use crate::cli::{CommandFailure, Exit, SCRIPT_HELP, ScriptArguments};
use crate::picture::{Filter, Picture};
use crate::render::{RENDERERS, RenderOrder, Technique};
use crate::scene::{Camera, MAX_SAMPLES, Prepared, Settings, View};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use files::Destination;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// Most views at once.
const MOST_VIEWS: i64 = 10_000;

#[derive(Args, Debug)]
pub(super) struct RenderArguments {
    #[arg(help = SCRIPT_HELP, default_value = "teapot", value_name = "SCRIPT")]
    pub(super) script: String,
    #[command(flatten)]
    pub(super) definitions: ScriptArguments,
    /// Picture file, .png (sRGB) or .exr (linear, coverage as alpha); may be given more than once [default: NAME.png]
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Vec<PathBuf>,
    /// Who makes the picture
    #[arg(long, value_name = "RENDERER", value_parser = renderers(), default_value = RENDERERS[0].option)]
    pub(super) renderer: Technique,
    /// Columns, instead of those of the scene; alone, the rows follow
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) width: Option<u32>,
    /// Rows, instead of those of the scene; alone, the columns follow
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) height: Option<u32>,
    /// Samples in each pixel, instead of those of the scene
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=i64::from(crate::scene::MAX_SAMPLES)))]
    pub(super) samples: Option<u32>,
    /// How samples around a pixel become one value, instead of that of the scene: box is the mean over the pixel,
    /// gaussian and blackman-harris smooth, mitchell sharpens
    #[arg(long, value_name = "FILTER", value_parser = PossibleValuesParser::new(Filter::WORDS).map(|word| Filter::of_word(&word).unwrap_or_default()))]
    pub(super) filter: Option<Filter>,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "COUNT", value_parser = crate::cli::values::threads)]
    pub(super) threads: Option<NonZeroUsize>,
    /// Seed of the sample positions, instead of that of the scene
    #[arg(long, value_name = "NUMBER")]
    pub(super) seed: Option<u64>,
    /// Tessellation tolerance in scene units, instead of that of the scene
    #[arg(long, value_name = "LENGTH")]
    pub(super) tolerance: Option<f64>,
    /// Relative error of the luminance at which a pixel has samples enough; --samples, if given, is then the most of
    /// them. If pixels miss it, the picture is written all the same, and the exit code tells
    #[arg(long, value_name = "PART", value_parser = crate::cli::values::length)]
    pub(super) error: Option<f64>,
    /// Begins no sample after so many seconds; --samples, if given, is then the most of them
    #[arg(long, value_name = "SECONDS", value_parser = crate::cli::values::length)]
    pub(super) seconds: Option<f64>,
    /// Goes on with what is in this file, and writes there what is known: every minute, when interrupted, and in the
    /// end; more samples can be added at any time. Of several views, those that are finished are not made again
    #[arg(long, value_name = "FILE")]
    pub(super) resume: Option<PathBuf>,
    /// How often the file of --resume is written; what was done since then is lost if the process is killed
    #[arg(long, value_name = "SECONDS", value_parser = crate::cli::values::length, default_value_t = 60.0, requires = "resume")]
    pub(super) checkpoint: f64,
    /// Renders so many views: the camera goes round what it looks at, and the files are numbered; what does not depend
    /// on the view is done once
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=MOST_VIEWS), conflicts_with = "pixel")]
    pub(super) views: Option<u32>,
    /// How far the camera goes from one view to the next [default: a full turn in all]
    #[arg(long, value_name = "DEGREES", requires = "views", allow_negative_numbers = true)]
    pub(super) turn: Option<f64>,
    /// Keeps the photons that two-way ray tracing stores in this database (.redb), which is made if need be, and takes
    /// from there those that were stored before, for as long as geometry, materials and lamps are the same
    #[arg(long, value_name = "DATABASE")]
    pub(super) light: Option<PathBuf>,
    /// Writes depth, normals, numbers of objects and materials, samples and variance into EXR files, too; by ray
    /// tracing without --resume also emitted, direct, caustic and indirect light, which together are the picture before
    /// it is denoised; and the albedo, with --denoise
    #[arg(long)]
    pub(super) layers: bool,
    /// Leaves the background out where nothing stands before it, so that `peris compose` can put another one there; it
    /// stays behind glass and in mirrors. PNG files are then linear, whatever the scene says, unless --exposure or
    /// --tone do
    #[arg(long)]
    pub(super) matte: bool,
    /// Takes most of the noise out of the picture, for few samples and previews, in one to two seconds for a million
    /// pixels on two cores. Edges, patterns and what mirrors show stay; faint and fine light, as that of caustics, may
    /// be lost
    #[arg(long, conflicts_with = "pixel")]
    pub(super) denoise: bool,
    #[command(flatten)]
    pub(super) display: DisplayArguments,
    /// Renders one pixel only, counted from the upper left corner, and prints its radiance; writes no file
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    pub(super) pixel: Option<[u32; 2]>,
    /// Prints the paths of the first samples of the pixel, and every term that they add
    #[arg(long, requires = "pixel")]
    pub(super) explain: bool,
    /// Leaves nothing out; the picture is the same
    #[arg(long)]
    pub(super) everything: bool,
    /// Tells how long each stage took and how much work it was, too: triangles, rays or spans, radiosity, photons. --json
    /// has all of it
    #[arg(long)]
    pub(super) stats: bool,
    /// Reports as JSON on standard output
    #[arg(long)]
    pub(super) json: bool,
}

impl RenderArguments {
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

    /// How pictures are to be made. Where errors or the clock decide about samples, the scene does not.
    pub(super) fn render_options(&self, settings: &Settings) -> RenderOrder {
        let is_open = self.error.is_some() || self.seconds.is_some();
        RenderOrder {
            samples: self.samples.unwrap_or(if is_open { MAX_SAMPLES } else { settings.image.samples }),
            threads: self.threads,
            target: self.error,
            seconds: self.seconds,
            matte: self.matte,
            denoise: self.denoise,
            ..RenderOrder::of(settings)
        }
    }

    /// The files of each view, tested; none for a single pixel.
    pub(super) fn destinations(&self) -> Result<Vec<Vec<Destination>>, CommandFailure> {
        if self.pixel.is_some() {
            return Ok(Vec::new());
        }
        let mut names = self.output.clone();
        if names.is_empty() {
            names.push(PathBuf::from(format!("{}.png", stem(&self.script))));
        }
        let of_view = |number: u32| {
            let files = names.iter().map(|name| Picture::destination(&self.numbered(name, number)));
            Ok(files.collect::<Result<_, _>>()?)
        };
        (1..=self.views.unwrap_or(1)).map(of_view).collect()
    }

    /// The name of the file of a view.
    fn numbered(&self, name: &Path, number: u32) -> PathBuf {
        let Some(count) = self.views else { return name.into() };
        let digits = count.ilog10() as usize + 1;
        let stem = name.file_stem().unwrap_or_default().to_string_lossy();
        let ending = name.extension().unwrap_or_default().to_string_lossy();
        name.with_file_name(format!("{stem}-{number:0digits$}.{ending}"))
    }

    /// From where the scene is seen.
    pub(super) fn views_of(&self, prepared: &Prepared) -> Result<Vec<View>, CommandFailure> {
        let count = self.views.unwrap_or(1);
        let step = self.turn.unwrap_or(360.0 / f64::from(count)).to_radians();
        let camera = prepared.camera;
        let views = (0..count).map(|number| camera.turned(step * f64::from(number)));
        let sound = |camera: Camera| camera.check().map(|()| View::Camera(camera));
        Ok(views.map(sound).collect::<Result<_, _>>()?)
    }

    /// Refuses what a renderer does not know.
    pub(super) fn check(&self) -> Result<(), CommandFailure> {
        let row = self.renderer.row();
        let given = [
            ("--error", self.error.is_some()),
            ("--seconds", self.seconds.is_some()),
            ("--resume", self.resume.is_some() && !row.solves_radiosity),
            ("--pixel", self.pixel.is_some()),
            ("--denoise", self.denoise),
        ];
        let message = match given.iter().find(|(_, given)| *given) {
            _ if self.light.is_some() && !row.can_map_photons => "--light is of two-way ray tracing only".to_owned(),
            Some((name, _)) if !row.adds_samples => {
                format!("{} has no {name}: it takes all samples at once", row.word)
            }
            _ => return Ok(()),
        };
        Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)))
    }
}

/// Reads the name of a renderer.
fn renderers() -> impl TypedValueParser<Value = Technique> {
    let values = RENDERERS.iter().map(|row| PossibleValue::new(row.option).help(row.help));
    PossibleValuesParser::new(values).map(|option| Technique::of_option(&option).unwrap_or(RENDERERS[0].technique))
}

/// Reads the coordinates of a pixel.
fn parse_pixel(text: &str) -> Result<[u32; 2], String> {
    let (x, y) = text.split_once(',').ok_or("give X,Y")?;
    let number = |text: &str| text.trim().parse().map_err(|_| format!("'{text}' is no number of a pixel"));
    Ok([number(x)?, number(y)?])
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
