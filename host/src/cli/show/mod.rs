//! `peris show`: a scene on a workstation, with dials and keys, until someone ends it.

mod edits;
mod serving;
mod told;

use super::{Definitions, Exit, Failure, Row, SCRIPT_HELP, Waits, load, progress, source};
use crate::{
    production::{Model, Production, Sent, tiling},
    render::tiles::Tiling,
    scene::Scene,
    script::Evaluated,
    workstation::{Drawing, Emulator, InitialView, Lines, Patience, Session, network::KEYS},
};
use clap::{Args, FromArgMatches};
use edits::Watched;
use files::Destination;
use protocol::address::Address;
use serving::Server;
use std::{num::NonZeroUsize, path::PathBuf};
use told::Told;

pub(super) const ROW: Row = Row {
    name: "show",
    summary: "Shows a scene on a PS 340 with dials and keys: key 1 renders the view there, key 4 stops that, key 2 resets, key 3 tells the view as a line of a script, key 12 ends.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Clone, Debug)]
struct Arguments {
    #[arg(help = SCRIPT_HELP, default_value = "teapot", value_name = "SCRIPT")]
    script: String,
    #[command(flatten)]
    definitions: Definitions,
    /// The host line of a PS 340 that runs already (tcp:HOST:PORT or unix:PATH); without it, one is started, with a window if
    /// there is a display, and the lines of standard input are orders for its operator ('help' lists them)
    #[arg(long, value_name = "LINE")]
    to: Option<Address>,
    /// Sends the scene and ends, without waiting for keys
    #[arg(long, requires = "to")]
    once: bool,
    /// Shows the scene anew whenever its script, or a file that this reads, is saved. The view stays as dials have set it,
    /// unless the script asks for another camera than before
    #[arg(long, conflicts_with = "once")]
    watch: bool,
    /// Denoises what key 1 renders, when all samples are there
    #[arg(long, conflicts_with = "once")]
    denoise: bool,
    /// Samples of a pixel that key 1 takes, instead of those of the scene
    #[arg(long, value_name = "COUNT", conflicts_with = "once", value_parser = clap::value_parser!(u32).range(1..=i64::from(crate::scene::MAX_SAMPLES)))]
    samples: Option<u32>,
    /// Reports what was sent as JSON on standard output
    #[arg(long)]
    json: bool,
    /// Which edges are sent
    #[arg(long, value_enum, default_value = "grid")]
    lines: Lines,
    /// Edges that bend more than this are always sent, degrees
    #[arg(long, value_name = "DEGREES", default_value_t = Drawing::default().crease_degrees)]
    crease: f64,
    /// Sends polygons, materials and lights instead of vectors; the machine renders them itself when a host or operator
    /// sends FIX(1) to FIX(8) to <1>PERIS.SHADE, such as FIX(4), hidden lines, and FIX(8), Phong
    #[arg(long)]
    facets: bool,
    /// Solves for the light that goes from diffuse surface to diffuse surface, and sends it as colours at the corners of
    /// polygons beside the vectors; the machine shades them on its raster screen whenever the dials have stood still
    #[arg(long, conflicts_with = "facets")]
    radiosity: bool,
    /// Distance between curved surfaces and the lines sent, as a part of the object's diagonal
    #[arg(long, value_name = "PART", default_value_t = Drawing::default().tolerance, value_parser = super::part)]
    tolerance: f64,
    /// Opens no window, even if there is a display: orders from standard input do all
    #[arg(long, conflicts_with = "to")]
    headless: bool,
    /// Threads that render [default: one for each core]
    #[arg(long, value_name = "COUNT", value_parser = super::threads)]
    threads: Option<NonZeroUsize>,
    /// Writes the line of a script that asks for the view into this file, when key 3 is pressed and in the end
    #[arg(long, value_name = "FILE", conflicts_with = "once")]
    camera: Option<PathBuf>,
    /// The folder below which orders such as 'picture vector a.png' write files
    #[arg(long, value_name = "DIR", default_value = ".", conflicts_with = "to")]
    files: PathBuf,
    #[command(flatten)]
    waits: Waits,
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    if !(0.0..=180.0).contains(&arguments.crease) {
        return Err(Failure::new(Exit::Usage, anyhow::anyhow!("--crease is an angle of 0 to 180 degrees")));
    }
    if arguments.watch && source::file(&arguments.script).is_none() {
        let text = format!("--watch is for a file, and '{}' is a scene that ships", arguments.script);
        return Err(Failure::new(Exit::Usage, anyhow::anyhow!(text)));
    }
    let file = arguments.camera.as_ref().map(Destination::of).transpose()?;
    let watched = arguments.watch.then(|| Watched::of(&arguments.script));
    let evaluated = load(&arguments.script, &arguments.definitions)?;
    let camera = evaluated.scene.camera;
    let Evaluated { scene, files, .. } = source::lit(evaluated)?;
    let (model, light) = modelled(&scene, arguments, None)?;
    let edits = watched.map(|watched| edits::watch(arguments, watched, &files, camera, *model.initial()));
    let patience = arguments.waits.patience();
    let (mut emulator, line) = match &arguments.to {
        Some(line) => (None, line.clone()),
        None => {
            let emulator = start(arguments, patience)?;
            let line = emulator.line().clone();
            (Some(emulator), line)
        }
    };
    let session = Session::attach(&line, patience)?;
    let mut production = Production::show(model, session)?;
    report(arguments, &line, production.sent(), light.as_ref());
    drop(light);
    if arguments.once {
        return Ok(());
    }
    for (number, label, _) in KEYS.iter().filter(|_| !arguments.json) {
        say!("key {number}: {label}");
    }
    let mut told = Told::new(file, arguments.json);
    let served = Server::new(&mut production, &mut emulator, arguments, &mut told, &scene).serve(edits.as_ref());
    let is_cut = matches!(&served, Err(failure) if failure.exit == Exit::Line);
    if is_cut && emulator.as_mut().is_some_and(|emulator| emulator.has_window() && emulator.has_quit()) {
        // Its window was closed.
        return Ok(());
    }
    served?;
    match told.tell(&mut production) {
        // It ends as it was asked to, whether the machine still answers or not.
        Err(failure) if failure.exit == Exit::Line => {
            super::warn(&format!("the view is not known: {}", failure.error));
            Ok(())
        }
        told => told,
    }
}

impl Arguments {
    fn drawing(&self) -> Drawing {
        Drawing { lines: self.lines, crease_degrees: self.crease, tolerance: self.tolerance, facets: self.facets }
    }
}

/// The scene ready to be shown as the arguments say, with the light of its surfaces if that is to be shown.
///
/// - `initial`: from where it is seen, instead of by its own camera.
fn modelled(
    scene: &Scene,
    arguments: &Arguments,
    initial: Option<InitialView>,
) -> Result<(Model, Option<Tiling>), Failure> {
    let light = if arguments.radiosity {
        super::warn_of_emptiness(scene);
        let light = tiling(scene, arguments.threads, &progress::watch())?;
        progress::clear();
        Some(light)
    } else {
        None
    };
    let model = Model::new(scene, &arguments.drawing(), light.as_ref(), initial)?;
    Ok((model, light))
}

/// Starts a PS 340 of our own, with a window if there is a display to open it on.
fn start(arguments: &Arguments, patience: Patience) -> Result<Emulator, Failure> {
    let has_display =
        ["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|name| std::env::var_os(name).is_some_and(|d| !d.is_empty()));
    if has_display && !arguments.headless {
        match Emulator::start(patience, &arguments.files, true) {
            Ok(emulator) => return Ok(emulator),
            Err(error) => super::warn(&format!("{error}; it is started without a window")),
        }
    }
    Ok(Emulator::start(patience, &arguments.files, false)?)
}

/// Says what was sent.
fn report(arguments: &Arguments, line: &Address, sent: Sent, light: Option<&Tiling>) {
    let Sent { lines, points, seconds } = sent;
    let light = light.map(|light| (light.elements, light.tiles.len(), light.corners(), light.tolerance));
    if arguments.json {
        let light = light.map(|(elements, polygons, corners, tolerance)| {
            serde_json::json!({ "elements": elements, "polygons": polygons, "corners": corners, "tolerance": tolerance })
        });
        let line = line.to_string();
        let known =
            serde_json::json!({ "line": line, "vectors": lines, "points": points, "light": light, "seconds": seconds });
        return say!("{known}");
    }
    say!("{lines} vectors ({points} points) shown on {line} after {seconds:.3} s");
    if let Some((elements, polygons, corners, tolerance)) = light {
        let steps = tolerance * 255.0;
        say!(
            "the light of {elements} elements as {polygons} polygons ({corners} corners), {steps:.1} of 255 off at most"
        );
    }
}
