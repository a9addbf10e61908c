//! `peris study render`: error against run time of every knob of every renderer.

use super::source::{load_lit, stem};
use super::study_memo::memo;
use super::{CommandFailure, SCRIPT_HELP, ScriptArguments, progress};
use crate::render::Watch;
use crate::render::{RENDERERS, Technique};
use crate::study::{Options, RENDER_KNOBS, RENDER_OPTIONS, RenderKnob, renderers, studied, usual};
use clap::builder::PossibleValuesParser;
use clap::{ArgMatches, Args, Command, FromArgMatches};
use files::Folder;
use std::io::Write;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Its name among the studies.
pub(super) const NAME: &str = "render";

#[derive(Args, Debug)]
struct Arguments {
    #[arg(help = SCRIPT_HELP, default_value = "corner", value_name = "SCRIPT")]
    script: String,
    #[command(flatten)]
    definitions: ScriptArguments,
    /// Knobs to sweep, listed below [default: all that change something in the scene]
    #[arg(short, long, value_name = "NAME,...", value_delimiter = ',', value_parser = PossibleValuesParser::new(RENDER_KNOBS.iter().map(|knob| knob.name)), hide_possible_values = true)]
    knob: Vec<String>,
    /// Who makes the pictures [default: scan-line, and two-way if the scene asks for it, otherwise ray-tracing]
    #[arg(long, value_name = "RENDERER", value_delimiter = ',', value_parser = PossibleValuesParser::new(studied().map(|technique| technique.row().option)))]
    renderer: Vec<String>,
    /// Folder for the table (.csv) and the plots (.svg and .png); it is made if need be
    #[arg(short, long, value_name = "DIR", default_value = ".")]
    output: PathBuf,
    /// Columns of the pictures; the rows follow
    #[arg(long, value_name = "PIXELS", default_value_t = RENDER_OPTIONS.width, value_parser = clap::value_parser!(u32).range(1..=16384))]
    width: u32,
    /// Samples in each pixel of the reference, in two independent halves
    #[arg(long, value_name = "COUNT", default_value_t = RENDER_OPTIONS.samples, value_parser = clap::value_parser!(u32).range(4..=i64::from(crate::scene::MAX_SAMPLES)))]
    samples: u32,
    /// About how many settings of each knob are tried
    #[arg(long, value_name = "COUNT", default_value_t = RENDER_OPTIONS.settings, value_parser = clap::value_parser!(u32).range(2..=16))]
    settings: u32,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "COUNT", value_parser = super::values::threads)]
    threads: Option<NonZeroUsize>,
    /// Goes on with a study that was interrupted: what it has done is kept in the folder, in a file that ends in .state
    #[arg(long)]
    resume: bool,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

/// The sub-command.
pub(super) fn command() -> Command {
    let line = |knob: &RenderKnob| {
        let by: Vec<&str> = RENDERERS.iter().filter(|row| (knob.renderers)(row)).map(|row| row.word).collect();
        format!("\n  {:<16} {} ({})", knob.name, knob.sets, by.join(", "))
    };
    let knobs: String = RENDER_KNOBS.iter().map(line).collect();
    Arguments::augment_args(Command::new(NAME))
        .about("Sweeps the knobs of the renderers, each while the others stay as the scene has them.")
        .after_help(format!("Knobs:{knobs}\n\n{}", super::exit::table()))
}

/// Runs it.
pub(super) fn run(matches: &ArgMatches) -> Result<(), CommandFailure> {
    let arguments = Arguments::from_arg_matches(matches)?;
    let folder = Folder::make(&arguments.output)?;
    let scene = load_lit(&arguments.script, &arguments.definitions)?.scene;
    let Arguments { width, samples, settings, threads, .. } = arguments;
    let options = Options { width, samples, settings, threads };
    let usual = usual(&scene.settings);
    let techniques = studied().filter(|technique| match arguments.renderer.is_empty() {
        true => usual.contains(technique),
        false => arguments.renderer.iter().any(|name| name == technique.row().option),
    });
    let names = RENDER_KNOBS
        .iter()
        .map(|knob| knob.name)
        .filter(|name| arguments.knob.is_empty() || arguments.knob.iter().any(|knob| knob == name));
    let (techniques, names): (Vec<Technique>, Vec<&str>) = (techniques.collect(), names.collect());
    let script = stem(&arguments.script);
    let words = format!("{techniques:?} {names:?} {options:?} {}", serde_json::to_string(&scene)?);
    let memo = memo(&folder, &format!("{script}-{NAME}"), &words, arguments.resume)?;
    let watch = Watch { memo: Some(&memo), ..progress::watch() };
    let study = renderers(&scene, &techniques, &names, &options, &watch)?;
    let table = study.csv();
    let csv =
        folder.write_or_save_elsewhere(&format!("{script}-{NAME}.csv"), |file| file.write_all(table.as_bytes()))?;
    let mut written = vec![csv];
    for (name, plot) in study.plots(script) {
        written.extend(plot.write(&folder, &format!("{script}-{NAME}{name}"))?);
    }
    if arguments.json {
        say!("{}", serde_json::to_string_pretty(&study)?);
    } else {
        say!("{}", study.table());
        let names: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
        say!("{}", names.join(", "));
    }
    memo.remove();
    Ok(())
}
