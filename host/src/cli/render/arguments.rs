//! The arguments of `peris render`, and what they say of settings, files and views.

use crate::cli::rendering_arguments::RenderingArguments;
use crate::cli::source::stem;
use crate::cli::{CommandFailure, Exit, SCRIPT_HELP, ScriptArguments};
use crate::picture::Picture;
use crate::scene::{Camera, Prepared, View};
use clap::Args;
use files::Destination;
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
    #[command(flatten)]
    pub(super) rendering: RenderingArguments,
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
    /// Renders one pixel only, counted from the upper left corner, and prints its radiance; writes no file
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel, conflicts_with = "denoise")]
    pub(super) pixel: Option<[u32; 2]>,
    /// Prints the paths of the first samples of the pixel, and every term that they add
    #[arg(long, requires = "pixel")]
    pub(super) explain: bool,
    /// Tells how long each stage took and how much work it was, too: triangles, rays or spans, radiosity, photons. --json
    /// has all of it
    #[arg(long)]
    pub(super) stats: bool,
    /// Reports as JSON on standard output
    #[arg(long)]
    pub(super) json: bool,
}

impl RenderArguments {
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
        let row = self.rendering.renderer.row();
        if self.light.is_some() && !row.can_map_photons {
            let message = "--light is of two-way ray tracing only";
            return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)));
        }
        self.rendering.check(&[
            ("--seconds", self.seconds.is_some()),
            ("--resume", self.resume.is_some() && !row.solves_radiosity),
            ("--pixel", self.pixel.is_some()),
        ])
    }
}

/// Reads the coordinates of a pixel.
fn parse_pixel(text: &str) -> Result<[u32; 2], String> {
    let (x, y) = text.split_once(',').ok_or("give X,Y")?;
    let number = |text: &str| text.trim().parse().map_err(|_| format!("'{text}' is no number of a pixel"));
    Ok([number(x)?, number(y)?])
}
