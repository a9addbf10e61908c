//! `peris study`: error against run time.

use super::source::{load_lit, stem};
use super::study_memo::memo;
use super::{CommandFailure, SCRIPT_HELP, ScriptArguments, SubcommandRow, progress, study_render};
use crate::render::Watch;
use crate::study::{KNOBS, KnobRow, illumination};
use clap::{ArgMatches, Args, Command, FromArgMatches};
use files::Folder;
use std::io::Write;
use std::num::NonZeroUsize;
use std::path::PathBuf;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "study",
    summary: "Sweeps a quality setting: error against run time, as table, CSV and plot.",
    arguments,
    run,
};

#[derive(Args, Debug)]
struct Arguments {
    #[arg(help = SCRIPT_HELP, default_value = "teapot", value_name = "SCRIPT")]
    script: String,
    #[command(flatten)]
    definitions: ScriptArguments,
    /// Folder for the table (.csv) and the plot (.svg and .png); it is made if need be
    #[arg(short, long, value_name = "DIR", default_value = ".")]
    output: PathBuf,
    /// Columns of the pictures; the rows follow [default: 160]
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=16384))]
    width: Option<u32>,
    /// Samples in each pixel: of the reference, or of all pictures where something else is studied
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=i64::from(crate::scene::MAX_SAMPLES)))]
    samples: Option<u32>,
    /// How many settings are tried [default: 7]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=16))]
    settings: Option<u32>,
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

/// The study that needs no scene.
const ILLUMINATION: &str = "illumination";

#[derive(Args, Debug)]
struct IlluminationArguments {
    /// Roughness of the facets: root mean square slope times root 2, 1e-8 to 1000
    #[arg(long, value_name = "M,...", value_delimiter = ',', default_values_t = [0.1, 0.3, 1.0])]
    roughness: Vec<f64>,
    /// Folder for the table (.csv) and the plots (.svg and .png); it is made if need be
    #[arg(short, long, value_name = "DIR", default_value = ".")]
    output: PathBuf,
    /// Goes on with a study that was interrupted: what it has done is kept in the folder, in a file that ends in .state
    #[arg(long)]
    resume: bool,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn arguments(command: Command) -> Command {
    let command = command.subcommand_required(true).arg_required_else_help(true).subcommand(
        IlluminationArguments::augment_args(Command::new(ILLUMINATION))
            .about("Measures how light is distributed: every D over incidence and roughness, and what it costs.")
            .after_help(super::exit::table()),
    );
    let command = command.subcommand(study_render::command());
    KNOBS.iter().fold(command, |command, knob| {
        command.subcommand(
            Arguments::augment_args(Command::new(knob.name))
                .about(format!("Sweeps {}.", knob.summary))
                .after_help(super::exit::table()),
        )
    })
}

fn run(matches: &ArgMatches) -> Result<(), CommandFailure> {
    let (name, matches) = matches.subcommand().ok_or_else(|| anyhow::anyhow!("no study is named"))?;
    if name == ILLUMINATION {
        return measure(&IlluminationArguments::from_arg_matches(matches)?);
    }
    if name == study_render::NAME {
        return study_render::run(matches);
    }
    let knob = KNOBS.iter().find(|k| k.name == name).ok_or_else(|| anyhow::anyhow!("no study {name}"))?;
    sweep(knob, &Arguments::from_arg_matches(matches)?)
}

fn measure(arguments: &IlluminationArguments) -> Result<(), CommandFailure> {
    let folder = Folder::make(&arguments.output)?;
    let memo = memo(&folder, ILLUMINATION, &format!("{:?}", arguments.roughness), arguments.resume)?;
    let watch = Watch { memo: Some(&memo), ..progress::watch() };
    let study = illumination(&arguments.roughness, &watch)?;
    let table = study.csv();
    let csv =
        folder.write_or_save_elsewhere(&format!("{ILLUMINATION}.csv"), |file| file.write_all(table.as_bytes()))?;
    let mut written = vec![csv];
    for (roughness, plot) in study.plots() {
        written.extend(plot.write(&folder, &format!("{ILLUMINATION}-{roughness}"))?);
    }
    memo.remove();
    if arguments.json {
        say!("{}", serde_json::to_string_pretty(&study)?);
    } else {
        say_on!("{}", study.table());
        let names: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
        say!("{}", names.join(", "));
    }
    Ok(())
}

fn sweep(knob: &KnobRow, arguments: &Arguments) -> Result<(), CommandFailure> {
    let folder = Folder::make(&arguments.output)?;
    let scene = load_lit(&arguments.script, &arguments.definitions)?.scene;
    let mut options = knob.options;
    options.width = arguments.width.unwrap_or(options.width);
    options.samples = arguments.samples.unwrap_or(options.samples);
    options.settings = arguments.settings.unwrap_or(options.settings);
    options.threads = arguments.threads;
    let script = stem(&arguments.script);
    let name = format!("{script}-{}", knob.name);
    let words = format!("{name} {options:?} {}", serde_json::to_string(&scene)?);
    let memo = memo(&folder, &name, &words, arguments.resume)?;
    let watch = Watch { memo: Some(&memo), ..progress::watch() };
    let study = (knob.run)(&scene, &options, &watch)?;
    let table = study.csv();
    let csv = folder.write_or_save_elsewhere(&format!("{name}.csv"), |file| file.write_all(table.as_bytes()))?;
    let [svg, png] = study.plot(&format!("{script}: {}", knob.summary)).write(&folder, &name)?;
    memo.remove();
    if arguments.json {
        say!("{}", serde_json::to_string_pretty(&study)?);
    } else {
        say_on!("{}", study.table());
        say!("{}, {}, {}", csv.display(), svg.display(), png.display());
    }
    Ok(())
}
