//! `peris render`: a scene to a picture file.

use super::source::stem;
use super::{Definitions, Exit, Failure, Progress, Row, SCRIPT_HELP, load, watch_interrupts};
use crate::picture::Picture;
use crate::plan::Plan;
use crate::render::radiosity::{Radiosity, Report};
use crate::render::ray_tracing::{Explanation, RayTracer, Shelf};
use crate::render::scan_line::ScanLine;
use crate::render::{Film, Fingerprint, Order, RenderError, Renderer, Rendering, Watch};
use crate::scene::{Camera, Prepared, Scene, View};
use clap::{Args, FromArgMatches, ValueEnum};
use glam::DVec3;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Most samples of a pixel that are explained.
const EXPLAINED: usize = 4;
/// Most views at once.
const MOST_VIEWS: i64 = 10_000;

pub(super) const ROW: Row = Row {
    name: "render",
    summary: "Renders a scene by ray tracing, scan line or radiosity into a PNG or EXR file.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

/// Who makes the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// All light: mirrors, glass, rough surfaces, soft shadows
    RayTracing,
    /// The same, with light that is followed from lamps through mirrors and glass first: caustics
    TwoWay,
    /// Light that comes straight from lights, with sharp shadows and straight transparency; many times faster. Mirrors show
    /// lights and ambient light only, and glass bends nothing
    ScanLine,
    /// Light that goes from diffuse surface to diffuse surface, found once for all views; mirrors, glass and highlights are
    /// not seen
    Radiosity,
}

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
    #[arg(long, value_name = "RENDERER", value_enum, default_value_t = Kind::RayTracing)]
    renderer: Kind,
    /// Columns, instead of those of the scene; alone, the rows follow
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    width: Option<u32>,
    /// Rows, instead of those of the scene; alone, the columns follow
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    height: Option<u32>,
    /// Samples in each pixel, instead of those of the scene
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=i64::from(crate::scene::MAX_SAMPLES)))]
    samples: Option<u32>,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "COUNT", value_parser = super::threads)]
    threads: Option<NonZeroUsize>,
    /// Seed of the sample positions, instead of that of the scene
    #[arg(long, value_name = "NUMBER")]
    seed: Option<u64>,
    /// Tessellation tolerance in scene units, instead of that of the scene
    #[arg(long, value_name = "LENGTH")]
    tolerance: Option<f64>,
    /// Relative error of the luminance at which a pixel has samples enough; --samples is then the most of them
    #[arg(long, value_name = "PART", value_parser = super::length)]
    error: Option<f64>,
    /// Begins no sample after so many seconds; --samples is then the most of them
    #[arg(long, value_name = "SECONDS", value_parser = super::length)]
    seconds: Option<f64>,
    /// Goes on with what is in this file, and writes there what is known in the end, also when interrupted; more samples can
    /// be added at any time
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    /// Renders so many views: the camera goes round what it looks at, and the files are numbered; what does not depend on
    /// the view is done once
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=MOST_VIEWS), conflicts_with_all = ["resume", "pixel"])]
    views: Option<u32>,
    /// How far the camera goes from one view to the next [default: a full turn in all]
    #[arg(long, value_name = "DEGREES", requires = "views", allow_negative_numbers = true)]
    turn: Option<f64>,
    /// Keeps the light that two-way ray tracing catches in this database (.redb), which is made if need be, and takes from
    /// there what was caught before, for as long as geometry, materials and lamps are the same
    #[arg(long, value_name = "DATABASE")]
    light: Option<PathBuf>,
    /// Writes depth, normals, numbers of objects and materials, samples and variance into EXR files, too; by ray tracing
    /// without --resume also emitted, direct, caustic and indirect light, which together are the picture
    #[arg(long)]
    layers: bool,
    /// Leaves the background out where nothing stands before it, so that `peris compose` can put another one there; it
    /// stays behind glass and in mirrors
    #[arg(long)]
    matte: bool,
    /// Renders one pixel only, counted from the upper left corner, and prints its radiance; writes no file
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pixel: Option<[u32; 2]>,
    /// Prints the ways of the first samples of the pixel, and every term that they add
    #[arg(long, requires = "pixel")]
    explain: bool,
    /// Leaves nothing out; the picture is the same
    #[arg(long)]
    everything: bool,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    watch_interrupts();
    arguments.check()?;
    let mut outputs = arguments.output.clone();
    if outputs.is_empty() {
        outputs.push(PathBuf::from(format!("{}.png", stem(&arguments.script))));
    }
    outputs.iter().try_for_each(|path| Picture::check_name(path)).map_err(|e| Failure::new(Exit::Usage, e))?;
    let mut scene = load(&arguments.script, &arguments.definitions)?.scene;
    super::warn_of_darkness(&scene);
    let settings = &mut scene.settings;
    (settings.width, settings.height) = size(settings.width, settings.height, arguments.width, arguments.height);
    settings.samples = arguments.samples.unwrap_or(settings.samples);
    settings.seed = arguments.seed.unwrap_or(settings.seed);
    settings.tolerance = arguments.tolerance.or(settings.tolerance);
    settings.two_way |= arguments.renderer == Kind::TwoWay;
    // Surfaces out of view send light, too.
    settings.interreflection |= arguments.renderer == Kind::Radiosity;
    let start = Instant::now();
    let prepared = Prepared::new(&scene)?;
    let views = arguments.views_of(&prepared)?;
    let plan = Plan::of_views(&prepared, &views, arguments.everything);
    let shelf = arguments.light.as_ref().map(|path| Shelf::new(path, &scene, &prepared)).transpose()?;
    let order = Order {
        threads: arguments.threads,
        target: arguments.error,
        seconds: arguments.seconds,
        matte: arguments.matte,
        ..Order::of(&prepared.settings)
    };
    let progress = Progress::new("rendering", arguments.json);
    let watch = Watch { cancelled: watch_interrupts(), progress: &|done, all| progress.update(done, all) };
    let mut job = Job { arguments, outputs: &outputs, views: &views, prepared: &prepared, start, books: None };
    match arguments.renderer {
        Kind::Radiosity => {
            let settings = prepared.settings.into();
            let solution = in_pool(arguments, || Radiosity::new(&prepared, &plan, &settings, None, &watch))?;
            job.books = Some(solution.report);
            let scan_line = ScanLine::showing(&solution, &prepared, &plan)?;
            scan_line.left_out(&views[0]).iter().for_each(|what| eprintln!("warning: by radiosity, {what}"));
            job.perform(&progress, |view| Ok(scan_line.render(view, &order, &watch)?))
        }
        Kind::ScanLine => {
            let scan_line = ScanLine::new(&prepared, &plan)?;
            scan_line.left_out(&views[0]).iter().for_each(|what| eprintln!("warning: by scan line, {what}"));
            job.perform(&progress, |view| Ok(scan_line.render(view, &order, &watch)?))
        }
        Kind::RayTracing | Kind::TwoWay => {
            let tracer = in_pool(arguments, || RayTracer::watched(&prepared, &plan, shelf.as_ref(), &watch))?;
            job.books = tracer.radiosity().map(|solution| solution.report);
            if let Some(pixel) = arguments.pixel {
                progress.finish();
                return explain(arguments, &tracer, &views[0], &order, pixel);
            }
            job.perform(&progress, |view| trace(arguments, &scene, &tracer, (view, &order), &watch))
        }
    }
}

/// Pictures that are made.
struct Job<'a> {
    arguments: &'a Arguments,
    outputs: &'a [PathBuf],
    views: &'a [View],
    prepared: &'a Prepared,
    start: Instant,
    /// What radiosity took.
    books: Option<Report>,
}

impl Job<'_> {
    /// Renders each view, writes it and reports on it.
    fn perform(
        &self,
        progress: &Progress,
        mut render: impl FnMut(&View) -> Result<Rendering, Failure>,
    ) -> Result<(), Failure> {
        let build_seconds = self.start.elapsed().as_secs_f64();
        let mut reports = Vec::new();
        for (number, view) in self.views.iter().enumerate() {
            let rendering = render(view);
            progress.finish();
            let rendering = rendering?;
            let outputs: Vec<PathBuf> = self.outputs.iter().map(|path| self.numbered(path, number)).collect();
            outputs.iter().try_for_each(|path| match self.arguments.layers && Picture::is_exr(path) {
                true => rendering.film.write_layers(path, self.prepared),
                false => rendering.picture.write(path),
            })?;
            match self.arguments.json {
                true => reports.push(self.json(&outputs, &rendering, build_seconds)),
                false => self.report(&outputs, &rendering, build_seconds),
            }
            if !rendering.complete {
                let [least, most] = rendering.film.samples();
                let message = format!("interrupted; pixels have {least} to {most} samples, which are kept");
                self.say_json(reports)?;
                return Err(Failure::new(Exit::Interrupted, anyhow::anyhow!(message)));
            }
        }
        self.say_json(reports)
    }

    /// The file of a view.
    fn numbered(&self, path: &Path, number: usize) -> PathBuf {
        let Some(count) = self.arguments.views else { return path.into() };
        let digits = count.ilog10() as usize + 1;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        path.with_file_name(format!("{stem}-{:0digits$}.{ending}", number + 1))
    }

    /// Prints what is known for programs: of each view, if several were asked for.
    fn say_json(&self, mut reports: Vec<serde_json::Value>) -> Result<(), Failure> {
        match self.arguments.views {
            _ if !self.arguments.json => {}
            Some(_) => say!("{}", serde_json::to_string_pretty(&reports)?),
            None => say!("{}", serde_json::to_string_pretty(&reports.pop())?),
        }
        Ok(())
    }

    fn json(&self, outputs: &[PathBuf], rendering: &Rendering, build_seconds: f64) -> serde_json::Value {
        let picture = &rendering.picture;
        serde_json::json!({
            "files": outputs,
            "width": picture.width(),
            "height": picture.height(),
            "samples": rendering.film.samples(),
            "standard_error": Some(rendering.film.standard_error()).filter(|error| error.is_finite()),
            "seed": self.prepared.settings.seed,
            "triangles": self.prepared.triangles.len(),
            "build_seconds": build_seconds,
            "render_seconds": rendering.seconds,
            "threads": rendering.threads,
            "rays": rendering.rays,
            "caught_light": rendering.balance,
            "spans": rendering.spans,
            "radiosity": self.books,
            "complete": rendering.complete,
        })
    }

    fn report(&self, outputs: &[PathBuf], rendering: &Rendering, build_seconds: f64) {
        let picture = &rendering.picture;
        let [least, most] = rendering.film.samples();
        let names: Vec<String> = outputs.iter().map(|p| p.display().to_string()).collect();
        say!(
            "{}: {} x {} pixels, {} to {} samples each; standard error of luminance {:.2e}",
            names.join(", "),
            picture.width(),
            picture.height(),
            least,
            most,
            rendering.film.standard_error()
        );
        say!("{} triangles, built in {build_seconds:.3} s", self.prepared.triangles.len());
        if let Some(balance) = &rendering.balance {
            say!("{balance}");
        }
        self.books.iter().flat_map(Report::lines).for_each(|line| say!("{line}"));
        let Rendering { rays, spans, seconds, threads, .. } = rendering;
        if matches!(self.arguments.renderer, Kind::ScanLine | Kind::Radiosity) {
            let (all, shadows) = (spans.surfaces, spans.shadows);
            say!("{all} spans of surfaces, {shadows} of shadow polygons in {seconds:.3} s on {threads} threads");
            return;
        }
        say!(
            "{} rays (primary {}, shadow {}, reflected {}; {} spared) in {seconds:.3} s on {threads} threads: {:.2} million a second",
            rays.total(),
            rays.primary,
            rays.shadow,
            rays.reflected,
            rays.spared,
            rendering.mega_rays_per_second()
        );
    }
}

impl Arguments {
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
        let given = [
            ("--error", self.error.is_some()),
            ("--seconds", self.seconds.is_some()),
            ("--resume", self.resume.is_some()),
            ("--pixel", self.pixel.is_some()),
        ];
        if self.light.is_some() && matches!(self.renderer, Kind::ScanLine | Kind::Radiosity) {
            let message = "--light is of two-way ray tracing only";
            return Err(Failure::new(Exit::Usage, anyhow::anyhow!(message)));
        }
        let word = match self.renderer {
            Kind::RayTracing | Kind::TwoWay => return Ok(()),
            Kind::ScanLine => "scan line",
            Kind::Radiosity => "radiosity",
        };
        match given.iter().find(|(_, given)| *given) {
            Some((name, _)) => {
                let message = format!("{word} has no {name}: it takes all samples at once");
                Err(Failure::new(Exit::Usage, anyhow::anyhow!(message)))
            }
            None => Ok(()),
        }
    }
}

/// Makes something on as many threads as are asked for.
fn in_pool<T: Send>(arguments: &Arguments, make: impl FnOnce() -> Result<T, RenderError> + Send) -> Result<T, Failure> {
    let threads = arguments.threads.map_or(0, |n| n.get());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(anyhow::Error::from)?;
    Ok(pool.install(make)?)
}

/// Traces rays, after those of a file if there is one to go on with.
fn trace(
    arguments: &Arguments,
    scene: &Scene,
    tracer: &RayTracer<'_>,
    (view, order): (&View, &Order),
    watch: &Watch<'_>,
) -> Result<Rendering, Failure> {
    let Some(path) = &arguments.resume else {
        let film = Film::new(order.width, order.height)?;
        let film = if arguments.layers { film.with_classes() } else { film };
        return Ok(tracer.go_on(film, view, order, watch)?);
    };
    let fingerprint = Fingerprint::of(scene, tracer.prepared(), order);
    let film = match path.exists() {
        true => Film::read_state(path, order, fingerprint)?,
        false => Film::new(order.width, order.height)?,
    };
    let rendering = tracer.go_on(film, view, order, watch)?;
    rendering.film.write_state(path, fingerprint)?;
    Ok(rendering)
}

/// Reads the place of a pixel.
fn pixel(text: &str) -> Result<[u32; 2], String> {
    let (x, y) = text.split_once(',').ok_or("give X,Y")?;
    let number = |text: &str| text.trim().parse().map_err(|_| format!("'{text}' is no number of a pixel"));
    Ok([number(x)?, number(y)?])
}

/// Prints what is known of one pixel.
fn explain(
    arguments: &Arguments,
    tracer: &RayTracer<'_>,
    view: &View,
    order: &Order,
    [x, y]: [u32; 2],
) -> Result<(), Failure> {
    if x >= order.width || y >= order.height {
        let message = format!("pixel {x},{y} is outside the picture of {} x {}", order.width, order.height);
        return Err(Failure::new(Exit::Usage, anyhow::anyhow!(message)));
    }
    let samples = tracer.explain(view, order, [x, y], order.samples)?;
    let mean = samples.iter().map(|sample| DVec3::from_array(sample.radiance)).sum::<DVec3>() / samples.len() as f64;
    let told = if arguments.explain { EXPLAINED.min(samples.len()) } else { 0 };
    if arguments.json {
        let json = serde_json::json!({ "pixel": [x, y], "radiance": mean.to_array(), "samples": &samples[..told] });
        say!("{}", serde_json::to_string_pretty(&json)?);
        return Ok(());
    }
    say!("pixel {x},{y}: radiance {:.6} {:.6} {:.6}, mean of {} samples", mean.x, mean.y, mean.z, samples.len());
    for Explanation { sample, wavelengths, notes, radiance: [r, g, b] } in &samples[..told] {
        say!("sample {}: {r:.6} {g:.6} {b:.6}", sample + 1);
        if let Some(wavelengths) = wavelengths {
            say!("  wavelengths {} nm", short(wavelengths, 1));
        }
        for note in notes {
            let indent = "  ".repeat(note.depth as usize + 1);
            let at = note.at.map_or(String::new(), |p| format!(" at {:.4} {:.4} {:.4}", p.x, p.y, p.z));
            let adds = note.adds.as_ref().map_or(String::new(), |adds| format!(": {}", short(adds, 6)));
            say!("{indent}{}{at}{adds}", note.what);
        }
    }
    Ok(())
}

fn short(values: &[f64], digits: usize) -> String {
    values.iter().map(|value| format!("{value:.digits$}")).collect::<Vec<_>>().join(" ")
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
