//! `peris run` and `peris demo`: the main job from a scene to the image on the raster screen.

use super::source::{load_lit, stem, warn_of_emptiness, warn_of_short_scatters};
use super::timeouts::TimeoutArguments;
use super::{CommandFailure, SCRIPT_HELP, ScriptArguments, SubcommandRow, interrupts, load, progress};
use crate::{
    picture::Picture,
    production::{Production, Sent, difference, view_of_dials},
    render::{RenderOrder, Technique},
    scene::Scene,
    study::{Options, renderers},
    workstation::{Drawing, Emulator, Session},
};
use clap::{Args, FromArgMatches};
use files::{Folder, WriteError};
use protocol::address::Address;
use serde_json::{Map, Value, json};
use std::{fmt::Write as _, io::Write as _, num::NonZeroUsize, path::PathBuf, str::FromStr, time::Instant};

pub(super) const RUN: SubcommandRow = SubcommandRow {
    name: "run",
    summary: "Shows a scene on a PS 340, turns dials there, renders the view, and shows the image on the raster screen.",
    arguments: RunArguments::augment_args,
    run: |matches| run(&RunArguments::from_arg_matches(matches)?),
};

pub(super) const DEMO: SubcommandRow = SubcommandRow {
    name: "demo",
    summary: "Does the main job on the teapot, with a PS 340 process of its own, and studies error against run time.",
    arguments: DemoArguments::augment_args,
    run: |matches| demo(&DemoArguments::from_arg_matches(matches)?),
};

/// What the demo turns: about the upright axis, then a little towards the viewer.
const DEMO_DIALS: [Turn; 2] = [Turn { dial: 2, turns: 0.1 }, Turn { dial: 1, turns: -0.06 }];

/// A dial and how far it is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turn {
    dial: usize,
    turns: f64,
}

impl FromStr for Turn {
    type Err = String;

    fn from_str(text: &str) -> Result<Turn, String> {
        let failed = || format!("'{text}' is not DIAL=TURNS with a dial of 1 to 7, such as 2=0.25");
        let (dial, turns) = text.split_once('=').ok_or_else(failed)?;
        let dial = dial.trim().parse().ok().filter(|d| (1..=7).contains(d)).ok_or_else(failed)?;
        let turns = turns.trim().parse().ok().filter(|t: &f64| t.abs() <= 1e6).ok_or_else(failed)?;
        Ok(Turn { dial, turns })
    }
}

#[derive(Args, Debug)]
struct Common {
    /// Folder for what is made; it is made if need be [default: peris-demo for the demo, peris-run for a run]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Samples in each pixel, instead of those of the scene
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=i64::from(crate::scene::MAX_SAMPLES)))]
    samples: Option<u32>,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "COUNT", value_parser = super::values::threads)]
    threads: Option<NonZeroUsize>,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    waits: TimeoutArguments,
}

#[derive(Args, Debug)]
struct RunArguments {
    #[arg(help = SCRIPT_HELP, value_name = "SCRIPT")]
    script: String,
    #[command(flatten)]
    definitions: ScriptArguments,
    #[command(flatten)]
    common: Common,
    /// The host line of a PS 340 that runs already (tcp:HOST:PORT or unix:PATH); without it, one is started
    #[arg(long, value_name = "LINE")]
    to: Option<Address>,
    /// Turns a dial of the PS 340 that is started, e.g. 2=0.25; may be given more than once
    #[arg(long = "dial", value_name = "DIAL=TURNS", conflicts_with = "to")]
    dials: Vec<Turn>,
}

#[derive(Args, Debug)]
struct DemoArguments {
    #[command(flatten)]
    common: Common,
    /// Leaves the study of error against run time out
    #[arg(long)]
    quick: bool,
}

/// What is to be done.
struct Job<'a> {
    title: &'a str,
    /// The scene's name in picture files.
    source: &'a str,
    scene: Scene,
    common: &'a Common,
    to: Option<&'a Address>,
    dials: &'a [Turn],
    study: bool,
    folder: &'a str,
    /// What was found out, for `--json`.
    report: Map<String, Value>,
}

fn run(arguments: &RunArguments) -> Result<(), CommandFailure> {
    let evaluated = load_lit(&arguments.script, &arguments.definitions)?;
    let (common, to, dials) = (&arguments.common, arguments.to.as_ref(), arguments.dials.as_slice());
    Job {
        title: &evaluated.name,
        source: stem(&arguments.script),
        scene: evaluated.scene,
        common,
        to,
        dials,
        study: false,
        folder: "peris-run",
        report: Map::new(),
    }
    .perform()
}

fn demo(arguments: &DemoArguments) -> Result<(), CommandFailure> {
    let evaluated = load("teapot", &ScriptArguments::default())?;
    let (common, study) = (&arguments.common, !arguments.quick);
    Job {
        title: "the teapot",
        source: "teapot",
        scene: evaluated.scene,
        common,
        to: None,
        dials: &DEMO_DIALS,
        study,
        folder: "peris-demo",
        report: Map::new(),
    }
    .perform()
}

/// The files that were made, with what they are.
struct Contents<'a> {
    folder: &'a Folder,
    lines: String,
    names: Vec<String>,
}

impl Contents<'_> {
    /// The path of a file in the folder, which is noted with what it is.
    fn file(&mut self, name: &str, what: &str) -> PathBuf {
        let _ = writeln!(self.lines, "{name:<24} {what}");
        self.names.push(name.into());
        self.folder.path().join(name)
    }

    /// Writes a text into a file, which is noted with what it is.
    fn write(&mut self, name: &str, what: &str, text: &str) -> Result<(), WriteError> {
        self.file(name, what);
        self.folder.write_or_save_elsewhere(name, |file| file.write_all(text.as_bytes())).map(drop)
    }
}

impl Job<'_> {
    fn perform(mut self) -> Result<(), CommandFailure> {
        let folder = self.common.output.clone().unwrap_or_else(|| self.folder.into());
        let folder = Folder::make(std::path::absolute(&folder)?)?;
        interrupts::note_saved(format!("what was finished is in {}", folder.path().display()));
        let mut contents = Contents { folder: &folder, lines: String::new(), names: Vec::new() };
        self.scene.settings.image.samples = self.common.samples.unwrap_or(self.scene.settings.image.samples);
        warn_of_emptiness(&self.scene);
        let timeouts = self.common.waits.timeouts();
        let (mut emulator, line) = match self.to {
            Some(line) => (None, line.clone()),
            None => {
                let emulator = Emulator::start(timeouts, folder.path(), false)?;
                let (process, line) = (emulator.process(), emulator.line().clone());
                let known = json!({ "process": process, "line": line.to_string() });
                self.note("workstation", known, format_args!("workstation: process {process}, host line {line}"));
                (Some(emulator), line)
            }
        };
        let process = std::process::id();
        self.note("host", json!({ "process": process }), format_args!("host: process {process}"));
        let session = Session::attach(&line, timeouts)?;
        let mut production = Production::begin(&self.scene, session, &Drawing::default())?;
        let (prepared, Sent { lines, points, seconds, .. }) = (production.prepared(), production.sent());
        warn_of_short_scatters(prepared);
        let (title, objects, triangles) = (self.title, prepared.objects.len(), prepared.triangles.len());
        let known = json!({ "objects": objects, "triangles": triangles, "vectors": lines, "points": points, "seconds": seconds });
        let text = format!(
            "{title}: {objects} objects, {triangles} triangles; {lines} vectors ({points} points) shown after {seconds:.3} s"
        );
        self.note("shown", known, format_args!("{text}"));
        if let Some(emulator) = &mut emulator {
            self.turn(emulator, &mut contents)?;
        }
        let picture = self.image(&mut production, &mut contents)?;
        production.show_image(&picture)?;
        if let Some(emulator) = &mut emulator {
            let file = contents.file("raster.png", "the raster screen of the PS 340 with that image");
            emulator.operator_command(&format!("picture raster {}", file.display()))?;
        }
        if self.study {
            self.study(&mut contents)?;
        }
        let list = contents.lines.clone();
        folder.write_or_save_elsewhere("CONTENTS.txt", |file| file.write_all(list.as_bytes()))?;
        if self.common.json {
            self.report.insert("folder".into(), json!(folder.path()));
            self.report.insert("files".into(), json!(contents.names));
            say!("{}", serde_json::to_string_pretty(&self.report)?);
        } else {
            say!("\n{}", folder.path().display());
            say_on!("{}", contents.lines);
        }
        Ok(())
    }

    /// Tells what was found out: as text now, or for the report at the end.
    fn note(&mut self, key: &str, known: Value, text: std::fmt::Arguments<'_>) {
        if self.common.json {
            self.report.insert(key.into(), known);
        } else {
            say!("{text}");
        }
    }

    /// Takes a picture, turns the dials, and takes another.
    fn turn(&self, emulator: &mut Emulator, contents: &mut Contents<'_>) -> Result<(), CommandFailure> {
        emulator.operator_command("idle")?;
        let file = contents.file("vector-before.png", "the vector screen of the PS 340 before a dial was turned");
        emulator.operator_command(&format!("picture vector {}", file.display()))?;
        for turn in self.dials {
            emulator.operator_command(&format!("dial {} {}", turn.dial, turn.turns))?;
        }
        emulator.operator_command("idle")?;
        let file = contents.file("vector-after.png", "the vector screen after the dials were turned");
        emulator.operator_command(&format!("picture vector {}", file.display()))?;
        Ok(())
    }

    /// Renders the view that is set on the workstation.
    fn image(&mut self, production: &mut Production, contents: &mut Contents<'_>) -> Result<Picture, CommandFailure> {
        let matrix = production.view()?;
        if self.to.is_none() {
            let mut turns = [0.0; 7];
            self.dials.iter().for_each(|t| turns[t.dial - 1] += t.turns);
            if let Some(expected) = view_of_dials(production.initial(), &turns) {
                let off = difference(&matrix, &expected);
                let text =
                    format_args!("the matrix that the dials set was read back; off the closed form by {off:.1e}");
                self.note("matrix_error", json!(off), text);
            }
        }
        let order = RenderOrder { threads: self.common.threads, ..RenderOrder::of(&self.scene.settings) };
        let shot = production.render(&matrix, &order, &self.scene.display, &progress::watch())?;
        let rendering = &shot.rendering;
        if let Some(bytes) = shot.octree_bytes {
            let seconds = shot.build_seconds;
            let known = json!({ "bytes_per_triangle": bytes, "build_seconds": seconds });
            let text = format!("octree: {bytes:.1} bytes a triangle, built with all tables in {seconds:.3} s");
            self.note("octree", known, format_args!("{text}"));
        }
        let (rays, seconds, threads) = (rendering.rays.total(), rendering.seconds, rendering.threads);
        let rate = rendering.mega_rays_per_second();
        let known = json!({ "rays": rendering.rays, "seconds": seconds, "threads": threads });
        let text =
            format!("ray tracing: {rays} rays in {seconds:.3} s, {rate:.2} million a second on {threads} threads");
        self.note("ray_tracing", known, format_args!("{text}"));
        let exposure = format!("exposed by {:+.2} stops", shot.stops);
        self.note("exposure", json!(shot.stops), format_args!("{exposure}"));
        let what = "the ray-traced image of that view";
        let display = &self.scene.display;
        let provenance = rendering.provenance(self.source, "ray-tracing", order.seed, display, shot.stops);
        for (name, form, picture) in [
            ("raytraced.png", &exposure, &shot.shown),
            ("raytraced.exr", &"linear radiance, coverage as alpha".to_string(), &rendering.picture),
        ] {
            let path = contents.file(name, &format!("{what} ({form})"));
            picture.write_with(&Picture::destination(&path)?, &provenance)?;
        }
        Ok(shot.shown)
    }

    fn study(&mut self, contents: &mut Contents<'_>) -> Result<(), CommandFailure> {
        let options = Options { width: 160, samples: 256, settings: 6, threads: self.common.threads };
        let start = Instant::now();
        let study = renderers(&self.scene, &[Technique::RayTracing], &["samples"], &options, &progress::watch())?;
        let (seconds, table) = (start.elapsed().as_secs_f64(), study.table());
        let text = format!("\nerror against run time (studied in {seconds:.1} s)\n{}", table.trim_end());
        self.note("study", serde_json::to_value(&study)?, format_args!("{text}"));
        contents.write("study-render.txt", "error against run time, as a table", &table)?;
        contents.write("study-render.csv", "error against run time, for programs", &study.csv())?;
        contents.file("study-render.svg", "error against run time, as a plot");
        contents.file("study-render.png", "the plot in pixels");
        for (_, plot) in study.plots(self.title) {
            plot.write(contents.folder, "study-render")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_read() {
        assert_eq!("2=0.25".parse(), Ok(Turn { dial: 2, turns: 0.25 }));
        for text in ["", "2", "0=1", "8=1", "1=x", "1=NaN"] {
            assert!(text.parse::<Turn>().is_err(), "{text}");
        }
    }
}
