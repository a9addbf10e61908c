//! `peris db`: databases of geometry, textures, materials, lights and spectra.

mod record_address;
mod plot;
mod show;

use super::{CommandFailure, Exit, ScriptArguments, SubcommandRow};
use crate::database::{
    self, ColumnQuantity, DatabaseError, DatabaseReport, Record, RecordContent, RecordEntry, RecordKind, Store,
    check_name, shipped,
};
use crate::scene::{Object, Scene, Shape};
use clap::{ArgMatches, Args, Command, FromArgMatches, Subcommand};
use files::{Destination, Folder};
use record_address::{RecordAddress, SHIPPED, kind_of};
use std::path::{Path, PathBuf};

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "db",
    summary: "Lists, shows, plots, adds, removes, exports and checks records of databases: geometry, textures, \
              materials, lights, spectra, photons.",
    arguments: |command| {
        let command = command.subcommand_required(true).arg_required_else_help(true);
        let help = |sub: Command| sub.after_help(super::exit::table());
        Commands::augment_subcommands(command).mut_subcommands(help)
    },
    run: |matches| run(matches),
};

#[derive(Subcommand, Debug)]
enum Commands {
    /// Lists what there is, with source and terms: in a file, if one is given, and what ships with the program
    List {
        /// A database (.redb); without it only what ships is listed
        #[arg(value_name = "DATABASE")]
        database: Option<PathBuf>,
        /// Only records of this kind
        #[arg(long, value_enum, value_name = "KIND")]
        kind: Option<RecordKind>,
        /// Reports as JSON on standard output
        #[arg(long)]
        json: bool,
    },
    /// Prints a record: spectra as columns, materials and lights as JSON, counts and bounds of meshes and pictures
    Show {
        #[command(flatten)]
        place: RecordAddress,
        /// Reports as JSON on standard output
        #[arg(long)]
        json: bool,
    },
    /// Draws a record: spectra as curves (SVG and PNG), materials and geometry as a picture (PNG)
    Plot {
        #[command(flatten)]
        place: RecordAddress,
        /// Folder for the files; it is made if need be
        #[arg(short, long, value_name = "DIR", default_value = ".")]
        output: PathBuf,
    },
    /// Adds the record of a file, or the materials of a scene; makes the database if there is none
    Add(Addition),
    /// Removes a record
    Remove {
        /// The database (.redb)
        #[arg(value_name = "DATABASE")]
        database: PathBuf,
        /// Its name
        #[arg(value_name = "NAME")]
        name: String,
        /// Its kind, if there are several of that name
        #[arg(long, value_enum, value_name = "KIND")]
        kind: Option<RecordKind>,
    },
    /// Writes a record into a file, whose ending names the format, as it can be added again
    Export {
        #[command(flatten)]
        place: RecordAddress,
        /// The file: a mesh (.obj, .ply, .stl, .gltf, .glb, .cmesh), a picture (.exr, .png), a spectrum (.txt, .json),
        /// a material or a light (.json)
        #[arg(value_name = "FILE")]
        file: PathBuf,
    },
    /// Checks pages, checksums and numbers of a whole database; the exit code tells
    Check {
        /// The database (.redb)
        #[arg(value_name = "DATABASE")]
        database: PathBuf,
        /// Reports as JSON on standard output
        #[arg(long)]
        json: bool,
    },
}

#[derive(Args, Debug)]
struct Addition {
    /// The database (.redb)
    #[arg(value_name = "DATABASE")]
    database: PathBuf,
    /// A mesh (.obj, .stl, .ply, .gltf, .glb, .cmesh), a picture (.exr, .png), columns of spectra (.txt), a material,
    /// light or spectrum (.json), or a scene script (.rhai), all materials of which are added under the names of its
    /// objects
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    definitions: ScriptArguments,
    /// What the record is called [default: what the file says, or its name]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// What the columns of a text are [default: reflectance, or metal where they are called n and k]
    #[arg(long = "as", value_enum, value_name = "QUANTITY")]
    quantity: Option<ColumnQuantity>,
    /// Who made or measured it [default: what the file says]
    #[arg(long, value_name = "TEXT")]
    source: Option<String>,
    /// Under which terms it may be passed on [default: what the file says]
    #[arg(long, value_name = "TEXT")]
    terms: Option<String>,
    /// Lets records of the same kind and name give way
    #[arg(long)]
    replace: bool,
}

fn run(matches: &ArgMatches) -> Result<(), CommandFailure> {
    match Commands::from_arg_matches(matches)? {
        Commands::List { database, kind, json } => list(database.as_deref(), kind, json),
        Commands::Show { place, json } => show::show(&place.record()?, json),
        Commands::Plot { place, output } => {
            let folder = Folder::make(&output)?;
            plot::plot(&place.record()?, &place, &folder)
        }
        Commands::Add(addition) => add(&addition),
        Commands::Remove { database, name, kind } => {
            let kind = kind_of(&RecordAddress { database: database.clone(), name: name.clone(), kind })?;
            Store::open_existing(&database)?.remove(&[(kind, &name)])?;
            say!("{}: removed {kind} \"{name}\"", database.display());
            Ok(())
        }
        Commands::Export { place, file } => {
            let destination = Destination::of(&file)?;
            database::write(&place.record()?, &destination)?;
            say!("{}", file.display());
            Ok(())
        }
        Commands::Check { database, json } => check(&database, json),
    }
}

fn list(database: Option<&Path>, kind: Option<RecordKind>, json: bool) -> Result<(), CommandFailure> {
    let mut groups: Vec<(String, Vec<RecordEntry>)> = Vec::new();
    if let Some(path) = database.filter(|path| *path != Path::new(SHIPPED)) {
        groups.push((path.display().to_string(), Store::open(path)?.entries(kind)?));
    }
    groups.push((SHIPPED.into(), shipped::entries(kind)));
    if json {
        let group = |(database, records): &(String, Vec<RecordEntry>)| serde_json::json!({ "database": database, "records": records });
        say!("{:#}", serde_json::Value::Array(groups.iter().map(group).collect()));
        return Ok(());
    }
    for (database, entries) in groups {
        say!("{database}: {} records", entries.len());
        let width = entries.iter().map(|entry| entry.name.chars().count()).max().unwrap_or(0).min(40);
        for RecordEntry { kind, name, summary, .. } in &entries {
            say!("  {:<8}  {name:<width$}  {summary}", kind.word());
        }
        say_on!("{}", sources(&entries));
    }
    Ok(())
}

/// Each source once, with its terms and the names of its records.
fn sources(entries: &[RecordEntry]) -> String {
    let mut groups: Vec<(&str, &str, Vec<&str>)> = Vec::new();
    for RecordEntry { name, source, terms, .. } in entries.iter().filter(|entry| !entry.source.is_empty()) {
        match groups.iter_mut().find(|group| (group.0, group.1) == (source, terms)) {
            Some((_, _, names)) if names.last() != Some(&name.as_str()) => names.push(name),
            Some(_) => {}
            None => groups.push((source, terms, vec![name])),
        }
    }
    let mut text = String::new();
    for (source, terms, names) in groups {
        text.push_str(&format!("\n  {}\n    source: {source}\n", names.join(", ")));
        if !terms.is_empty() {
            text.push_str(&format!("    terms: {terms}\n"));
        }
    }
    text
}

fn add(addition: &Addition) -> Result<(), CommandFailure> {
    Destination::of(&addition.database)?;
    let file = &addition.file;
    let is_script = file.extension().is_some_and(|ending| ending == "rhai");
    let mut records = if is_script {
        let scene = super::load(&file.display().to_string(), &addition.definitions)?.scene;
        materials(&scene, &format!("Scene script {}.", file.display()))?
    } else if addition.definitions.is_empty() {
        database::read(file, addition.name.as_deref(), addition.quantity)?
    } else {
        let message = format!("-D sets parameters of a script, and {} is none", file.display());
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)));
    };
    if let [record] = &mut records[..] {
        record.name = addition.name.clone().unwrap_or_else(|| record.name.clone());
    } else if addition.name.is_some() {
        let message = format!("{} gives {} records, which --name cannot name", file.display(), records.len());
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)));
    }
    for record in &mut records {
        check_name(&record.name)?;
        record.origin.source = addition.source.clone().unwrap_or_else(|| record.origin.source.clone());
        record.origin.terms = addition.terms.clone().unwrap_or_else(|| record.origin.terms.clone());
    }
    Store::open_to_write(&addition.database)?.add(&records, addition.replace).map_err(|error| match error {
        DatabaseError::Exists { .. } => {
            CommandFailure::new(Exit::Usage, anyhow::anyhow!("{error}; --replace lets it give way"))
        }
        other => other.into(),
    })?;
    for record in &records {
        let place = addition.database.display();
        say!("{place}: added {} \"{}\", {}", record.kind(), record.name, record.content.summary());
    }
    Ok(())
}

/// The materials of a scene under the names of its objects; equal ones of a name once.
fn materials(scene: &Scene, source: &str) -> Result<Vec<Record>, CommandFailure> {
    fn walk(object: &Object, source: &str, records: &mut Vec<Record>) -> Result<(), CommandFailure> {
        if let Some(material) = &object.material {
            let content = RecordContent::Material(Box::new(material.clone()));
            let origin = crate::color::Origin { source: source.into(), ..Default::default() };
            match records.iter().find(|record| record.name == object.name) {
                Some(record) if record.content == content => {}
                Some(_) => {
                    let message = format!("two objects called \"{}\" are of different materials", object.name);
                    return Err(CommandFailure::new(Exit::Scene, anyhow::anyhow!(message)));
                }
                None => records.push(Record { name: object.name.clone(), origin, content }),
            }
        }
        match &object.shape {
            Shape::Composite(composite) => composite.operands.iter().try_for_each(|o| walk(o, source, records)),
            Shape::Rounded(rounded) => walk(&rounded.object, source, records),
            Shape::Instances(instances) => {
                instances.prototypes.iter().flatten().try_for_each(|object| walk(object, source, records))
            }
            _ => Ok(()),
        }
    }
    let mut records = Vec::new();
    scene.objects.iter().try_for_each(|object| walk(object, source, &mut records))?;
    if records.is_empty() {
        return Err(CommandFailure::new(Exit::Scene, anyhow::anyhow!("no object of the scene has a material")));
    }
    Ok(records)
}

fn check(database: &Path, json: bool) -> Result<(), CommandFailure> {
    let report = DatabaseReport::of(database)?;
    if json {
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        for problem in &report.problems {
            say!("{}", problem.problem);
        }
        if let Some(problem) = &report.file {
            say!("{problem}");
        }
        say!("{}: {} records are whole, {} are not", database.display(), report.whole, report.problems.len());
    }
    if report.is_whole() {
        return Ok(());
    }
    Err(CommandFailure::new(Exit::Failed, anyhow::anyhow!("{} is damaged", database.display())))
}
