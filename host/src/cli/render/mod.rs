//! `peris render`: a scene to a picture file.

mod pixel;
mod saved;
mod views;

use super::display::DisplayArguments;
use super::source::stem;
use super::{Definitions, Exit, Failure, Row, SCRIPT_HELP, load_lit, progress, warn};
use crate::picture::display::DisplayTransform;
use crate::picture::{Filter, Picture};
use crate::plan::Plan;
use crate::render::metering::Meter;
use crate::render::two_way::Shelf;
use crate::render::{Film, Fingerprint, Made, Order, RENDERERS, Ready, RenderError, Task, Technique, Watch};
use crate::scene::{Camera, MAX_SAMPLES, Prepared, Settings, View};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, FromArgMatches};
use files::Destination;
use saved::{Intermediate, Saved};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use views::Views;

/// Most views at once.
const MOST_VIEWS: i64 = 10_000;

pub(super) const ROW: Row = Row {
    name: "render",
    summary: "Renders a scene by ray tracing, scan line or radiosity into a PNG or EXR file.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    #[arg(help = SCRIPT_HELP, default_value = "teapot", value_name = "SCRIPT")]
    script: String,
    #[command(flatten)]
    definitions: Definitions,
    /// Picture file, .png (sRGB) or .exr (linear, coverage as alpha); may be given more than once [default: NAME.png]
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// Who makes the picture
    #[arg(long, value_name = "RENDERER", value_parser = renderers(), default_value = RENDERERS[0].option)]
    renderer: Technique,
    /// Columns, instead of those of the scene; alone, the rows follow
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    width: Option<u32>,
    /// Rows, instead of those of the scene; alone, the columns follow
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    height: Option<u32>,
    /// Samples in each pixel, instead of those of the scene
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=i64::from(crate::scene::MAX_SAMPLES)))]
    samples: Option<u32>,
    /// How samples around a pixel become one value, instead of that of the scene: box is the mean over the pixel, gaussian
    /// and blackman-harris smooth, mitchell sharpens
    #[arg(long, value_name = "FILTER", value_parser = PossibleValuesParser::new(Filter::WORDS).map(|word| Filter::of_word(&word).unwrap_or_default()))]
    filter: Option<Filter>,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "COUNT", value_parser = super::threads)]
    threads: Option<NonZeroUsize>,
    /// Seed of the sample positions, instead of that of the scene
    #[arg(long, value_name = "NUMBER")]
    seed: Option<u64>,
    /// Tessellation tolerance in scene units, instead of that of the scene
    #[arg(long, value_name = "LENGTH")]
    tolerance: Option<f64>,
    /// Relative error of the luminance at which a pixel has samples enough; --samples, if given, is then the most of them. If
    /// pixels miss it, the picture is written all the same, and the exit code tells
    #[arg(long, value_name = "PART", value_parser = super::length)]
    error: Option<f64>,
    /// Begins no sample after so many seconds; --samples, if given, is then the most of them
    #[arg(long, value_name = "SECONDS", value_parser = super::length)]
    seconds: Option<f64>,
    /// Goes on with what is in this file, and writes there what is known: every minute, when interrupted, and in the end;
    /// more samples can be added at any time. Of several views, those that are finished are not made again
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    /// How often the file of --resume is written; what was done since then is lost if the process is killed
    #[arg(long, value_name = "SECONDS", value_parser = super::length, default_value_t = 60.0, requires = "resume")]
    checkpoint: f64,
    /// Renders so many views: the camera goes round what it looks at, and the files are numbered; what does not depend on
    /// the view is done once
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=MOST_VIEWS), conflicts_with = "pixel")]
    views: Option<u32>,
    /// How far the camera goes from one view to the next [default: a full turn in all]
    #[arg(long, value_name = "DEGREES", requires = "views", allow_negative_numbers = true)]
    turn: Option<f64>,
    /// Keeps the light that two-way ray tracing catches in this database (.redb), which is made if need be, and takes from
    /// there what was caught before, for as long as geometry, materials and lamps are the same
    #[arg(long, value_name = "DATABASE")]
    light: Option<PathBuf>,
    /// Writes depth, normals, numbers of objects and materials, samples and variance into EXR files, too; by ray tracing
    /// without --resume also emitted, direct, caustic and indirect light, which together are the picture before it is
    /// denoised; and the albedo, with --denoise
    #[arg(long)]
    layers: bool,
    /// Leaves the background out where nothing stands before it, so that `peris compose` can put another one there; it
    /// stays behind glass and in mirrors. PNG files are then linear, whatever the scene says, unless --exposure or --tone do
    #[arg(long)]
    matte: bool,
    /// Takes most of the noise out of the picture, for few samples and previews, in one to two seconds for a million pixels
    /// on two cores. Edges, patterns and what mirrors show stay; faint and fine light, as that of caustics, may be lost
    #[arg(long, conflicts_with = "pixel")]
    denoise: bool,
    #[command(flatten)]
    display: DisplayArguments,
    /// Renders one pixel only, counted from the upper left corner, and prints its radiance; writes no file
    #[arg(long, value_name = "X,Y", value_parser = pixel::place)]
    pixel: Option<[u32; 2]>,
    /// Prints the ways of the first samples of the pixel, and every term that they add
    #[arg(long, requires = "pixel")]
    explain: bool,
    /// Leaves nothing out; the picture is the same
    #[arg(long)]
    everything: bool,
    /// Tells how much work it was, too: triangles, rays or spans, radiosity, caught light. --json has all of it
    #[arg(long)]
    stats: bool,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.check()?;
    let outputs = arguments.destinations()?;
    let state = arguments.resume.as_ref().map(Destination::of).transpose()?;
    arguments.light.as_ref().map(Destination::of).transpose()?;
    let mut scene = load_lit(&arguments.script, &arguments.definitions)?.scene;
    super::warn_of_emptiness(&scene);
    // Layers of a composition are put together as light, and exposed as a whole.
    let display = arguments.display.over(if arguments.matte { DisplayTransform::LINEAR } else { scene.display })?;
    // Several views are exposed as the first, which is that of the scene.
    let meter = Meter::new(&scene.settings, &display, arguments.threads);
    arguments.set(&mut scene.settings);
    let start = Instant::now();
    progress::stage("while building the geometry");
    let prepared = Prepared::new(&scene)?;
    let views = arguments.views_of(&prepared)?;
    let plan = Plan::of_views(&prepared, &views, arguments.everything);
    let order = arguments.order(&prepared.settings);
    if order.denoise && order.samples < 2 {
        let message = "--denoise needs 2 samples in each pixel: what differs between them is noise";
        return Err(Failure::new(Exit::Usage, anyhow::anyhow!(message)));
    }
    let every = Duration::from_secs_f64(arguments.checkpoint.min(1e9));
    let intermediate = Intermediate::of(arguments, &plan);
    let keeps = |(path, lasts): (&Path, bool)| Shelf::new(path, &scene, &prepared, every, lasts);
    let shelf = intermediate.light(arguments).map(keeps).transpose()?;
    // Only what is kept has to be known again.
    let fingerprint = state.as_ref().map(|_| Fingerprint::of(&scene, &prepared, &order));
    let memo = intermediate.memo(arguments, fingerprint.as_ref())?;
    let watch = Watch { memo: memo.as_ref(), ..progress::watch() };
    if order.seconds.is_none() && order.target.is_none() {
        progress::follow(&format!("{} samples", order.samples));
    }
    let mut all = Views {
        arguments,
        views: &views,
        outputs: &outputs,
        prepared: &prepared,
        display: &display,
        stops: 0.0,
        start,
        radiosity: None,
        saved: None,
        comes_bit_by_bit: false,
    };
    let row = arguments.renderer.row();
    if let (true, Some(state), Some(fingerprint)) = (row.adds_samples, &state, fingerprint) {
        all.saved = Some(Saved::read(arguments, every, state, fingerprint, &order)?);
    }
    let task = Task { prepared: &prepared, plan: &plan, shelf: shelf.as_ref(), watch };
    let Ready { renderer, radiosity } = in_pool(arguments, || arguments.renderer.prepare(&task))?;
    all.radiosity = radiosity;
    if let (Some(pixel), Made::BySamples(tracer)) = (arguments.pixel, &renderer) {
        progress::stage("while sampling the pixel");
        return pixel::explain(arguments, tracer, &views[0], &order, pixel);
    }
    renderer.any().left_out(&views[0]).iter().for_each(|what| warn(&format!("by {}, {what}", row.word)));
    all.stops = meter.stops(renderer.any(), &prepared, &views[..1], &watch)?;
    let ended = match &renderer {
        Made::Whole(renderer) => all.render(&mut |view, _, _| Ok(renderer.render(view, &order, &watch)?)),
        Made::BySamples(tracer) => {
            all.comes_bit_by_bit = true;
            all.render(&mut |view, film, checkpoints| {
                let film = film.map_or_else(|| Film::new(order.width, order.height), Ok)?;
                let film = if arguments.layers && state.is_none() { film.with_classes() } else { film };
                Ok(tracer.go_on(film, view, &order, &watch, checkpoints)?)
            })
        }
    };
    if ended.as_ref().map_or_else(|failure| failure.exit == Exit::Missed, |()| true) {
        intermediate.remove();
    }
    ended
}

impl Arguments {
    /// Sets what the command line says of the scene's settings.
    fn set(&self, settings: &mut Settings) {
        (settings.image.width, settings.image.height) =
            size(settings.image.width, settings.image.height, self.width, self.height);
        settings.image.samples = self.samples.unwrap_or(settings.image.samples);
        settings.image.filter = self.filter.unwrap_or(settings.image.filter);
        settings.image.seed = self.seed.unwrap_or(settings.image.seed);
        settings.geometry.tolerance = self.tolerance.or(settings.geometry.tolerance);
        (self.renderer.row().require)(settings);
    }

    /// How pictures are to be made. Where errors or the clock decide about samples, the scene does not.
    fn order(&self, settings: &Settings) -> Order {
        let is_open = self.error.is_some() || self.seconds.is_some();
        Order {
            samples: self.samples.unwrap_or(if is_open { MAX_SAMPLES } else { settings.image.samples }),
            threads: self.threads,
            target: self.error,
            seconds: self.seconds,
            matte: self.matte,
            denoise: self.denoise,
            ..Order::of(settings)
        }
    }

    /// The files of each view, tested; none for a single pixel.
    fn destinations(&self) -> Result<Vec<Vec<Destination>>, Failure> {
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
    fn views_of(&self, prepared: &Prepared) -> Result<Vec<View>, Failure> {
        let count = self.views.unwrap_or(1);
        let step = self.turn.unwrap_or(360.0 / f64::from(count)).to_radians();
        let camera = prepared.camera;
        let views = (0..count).map(|number| camera.turned(step * f64::from(number)));
        let sound = |camera: Camera| camera.check().map(|()| View::Camera(camera));
        Ok(views.map(sound).collect::<Result<_, _>>()?)
    }

    /// Refuses what a renderer does not know.
    fn check(&self) -> Result<(), Failure> {
        let row = self.renderer.row();
        let given = [
            ("--error", self.error.is_some()),
            ("--seconds", self.seconds.is_some()),
            ("--resume", self.resume.is_some() && !row.solves),
            ("--pixel", self.pixel.is_some()),
            ("--denoise", self.denoise),
        ];
        let message = match given.iter().find(|(_, given)| *given) {
            _ if self.light.is_some() && !row.follows_light => "--light is of two-way ray tracing only".to_owned(),
            Some((name, _)) if !row.adds_samples => {
                format!("{} has no {name}: it takes all samples at once", row.word)
            }
            _ => return Ok(()),
        };
        Err(Failure::new(Exit::Usage, anyhow::anyhow!(message)))
    }
}

/// Reads the name of a renderer.
fn renderers() -> impl TypedValueParser<Value = Technique> {
    let values = RENDERERS.iter().map(|row| PossibleValue::new(row.option).help(row.help));
    PossibleValuesParser::new(values).map(|option| Technique::of_option(&option).unwrap_or(RENDERERS[0].technique))
}

/// Makes something on as many threads as are asked for.
fn in_pool<T: Send>(arguments: &Arguments, make: impl FnOnce() -> Result<T, RenderError> + Send) -> Result<T, Failure> {
    let threads = arguments.threads.map_or(0, |n| n.get());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(anyhow::Error::from)?;
    Ok(pool.install(make)?)
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
