//! Dry runs: patches that add a kind to each family, the places that each of them touches, and its tests.
//!
//! In the long lane, with `PERIS_LONG=1`, all patches are applied to a copy of the sources, which is compiled and tested.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

/// Most places of a kind: its file, the line that names this file, and its row.
const GOAL: usize = 3;
/// Folders that are no sources.
const NO_SOURCES: [&str; 4] = ["target", ".git", "peris-demo", "peris-run"];

/// Tests of one call of cargo.
struct Lane {
    crates: &'static [&'static str],
    /// The beginnings of the names of tests.
    tests: &'static [&'static str],
    /// Those of them that walk a table into which a patch puts a row.
    contracts: &'static [&'static str],
}

const LANES: [Lane; 2] = [
    Lane {
        crates: &["-p", "foundation", "-p", "modelling", "-p", "synthesis", "-p", "host"],
        tests: &[
            "cli::objects::",
            "cli::program::",
            "illumination::distribution::",
            "illumination::light::",
            "illumination::optics::contract_tests::",
            "illumination::optics::diffuse::",
            "illumination::texture::",
            "render::headlight::",
            "render::renderers::",
            "script::shaping::",
            "script::tests::",
            "solid::primitive::",
            "study::rendering::tests::every_knob",
            "study::rendering::tests::the_shutter",
        ],
        contracts: &[
            "every_command_documents_its_arguments_and_the_exit_codes",
            "every_density_is_finite_and_not_negative_at_every_roughness",
            "every_example_in_the_table_runs",
            "every_knob_changes_the_picture_or_says_why_not",
            "every_pattern_of_paints_is_tried",
            "every_solid_has_a_function_of_its_word",
            "light_goes_to_and_fro_alike",
            "rows_stand_in_the_order_of_the_techniques_and_their_names_lead_to_them",
            "sampled_irradiance_is_that_of_all_that_is_seen",
            "there_is_a_light_of_every_kind",
            "there_is_a_lobe_of_every_kind",
        ],
    },
    Lane {
        crates: &["-p", "protocol", "-p", "emulation", "--no-default-features"],
        tests: &["command::", "functions::", "network::contract::", "structure::"],
        contracts: &[
            "each_command_has_an_example_that_makes_an_operation",
            "each_command_is_encoded_and_decoded",
            "each_command_is_printed_parsed_back_and_named",
            "examples_give_their_results_and_faults",
            "every_function_has_two_examples_and_one_of_them_with_a_result_or_a_fault",
        ],
    },
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the crate lies in the workspace").to_owned()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A patch, and what the table says of it.
struct DryRun {
    path: PathBuf,
    text: String,
    /// The files and the edits of the table.
    told: (BTreeSet<String>, [usize; 2]),
    /// Whether the table says why it is beyond the goal.
    is_excused: bool,
}

impl DryRun {
    /// Reads the row `| [kind](kind.patch) | places | edits | before | files | why so many |` and its patch.
    fn of_row(folder: &Path, row: &str) -> DryRun {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [name, places, edits, _before, files, why] = cells[..] else { panic!("no row of six cells: {row}") };
        let file = name.split_once("](").and_then(|(_, rest)| rest.strip_suffix(')'));
        let path = folder.join(file.unwrap_or_else(|| panic!("no link to a patch: {row}")));
        let count = |cell: &str| cell.parse().unwrap_or_else(|_| panic!("no number: {cell} in {row}"));
        let files = files.split('`').skip(1).step_by(2).map(str::to_owned).collect();
        let told = (files, [count(places), count(edits)]);
        DryRun { text: read(&path), path, told, is_excused: !why.is_empty() }
    }

    /// The files that the patch changes or adds.
    fn files(&self) -> BTreeSet<String> {
        self.text.lines().filter_map(|line| line.strip_prefix("+++ b/")).map(str::to_owned).collect()
    }

    /// How many pieces of code it changes or adds.
    fn edits(&self) -> usize {
        self.text.lines().filter(|line| line.starts_with("@@ ")).count()
    }

    /// The names of the tests that it adds.
    fn tests(&self) -> Vec<&str> {
        let added: Vec<&str> = self.text.lines().filter_map(|line| line.strip_prefix('+')).map(str::trim).collect();
        let tests = added.windows(2).filter(|pair| pair[0] == "#[test]").map(|pair| pair[1]);
        tests.filter_map(|line| line.strip_prefix("fn ")?.split('(').next()).collect()
    }
}

fn dry_runs() -> Vec<DryRun> {
    let folder = root().join("tests/dry_runs");
    let table = read(&folder.join("README.md"));
    let runs: Vec<DryRun> =
        table.lines().filter(|line| line.starts_with("| [")).map(|row| DryRun::of_row(&folder, row)).collect();
    let told: BTreeSet<&Path> = runs.iter().map(|run| run.path.as_path()).collect();
    let entries = fs::read_dir(&folder).expect("the folder can be read").map(|entry| entry.expect("an entry").path());
    let patches: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "patch")).collect();
    assert_eq!(told, patches.iter().map(PathBuf::as_path).collect(), "the table and the patches beside it");
    runs
}

/// Lets git apply a patch in a folder, or check that it can; false where there is no git.
fn apply(patch: &Path, folder: &Path, options: &[&str]) -> bool {
    // A copy of the sources below the folder of a repository is none of its own.
    let above = folder.parent().expect("no root");
    let mut git = Command::new("git");
    git.current_dir(folder).env("GIT_CEILING_DIRECTORIES", above).arg("apply").args(options).arg(patch);
    match git.output() {
        Err(error) if error.kind() == io::ErrorKind::NotFound => false,
        Err(error) => panic!("git: {error}"),
        Ok(ended) => {
            let why = String::from_utf8_lossy(&ended.stderr);
            assert!(ended.status.success(), "{} does not apply any more:\n{why}", patch.display());
            true
        }
    }
}

#[test]
fn a_new_kind_touches_the_places_that_the_table_tells() {
    let runs = dry_runs();
    assert_eq!(runs.len(), 11);
    let mut touched = BTreeSet::new();
    for run in &runs {
        let (name, files) = (run.path.display(), run.files());
        assert_eq!(run.told, (files.clone(), [files.len(), run.edits()]), "{name}: the table, and the patch");
        assert!(
            files.len() <= GOAL || run.is_excused,
            "{name}: {} places, and the table does not say why",
            files.len()
        );
        let twice: Vec<String> = files.into_iter().filter(|file| !touched.insert(file.clone())).collect();
        assert!(twice.is_empty(), "{name}: another patch changes {twice:?}, so that they may not apply together");
    }
}

#[test]
fn every_patch_applies_to_the_sources_as_they_are() {
    for run in dry_runs() {
        if !apply(&run.path, &root(), &["--check"]) {
            println!("git is not installed: whether patches apply was not looked at");
            return;
        }
    }
}

/// Copies the sources below a folder.
fn copy(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let (path, name) = entry.map(|entry| (entry.path(), entry.file_name()))?;
        match path.is_dir() {
            true if NO_SOURCES.iter().any(|other| name == *other) => {}
            true => copy(&path, &to.join(name))?,
            false => drop(fs::copy(&path, to.join(name))?),
        }
    }
    Ok(())
}

/// Runs the tests of a lane in a copy of the sources; what cargo said.
fn run(lane: &Lane, tree: &Path, build: &Path) -> String {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(tree).env("CARGO_TARGET_DIR", build).args(["test", "--locked", "--lib", "--no-fail-fast"]);
    // Optimised as far as it pays for so few tests.
    for setting in ["debug=0", "package.host.opt-level=1", "package.emulation.opt-level=1"] {
        cargo.args(["--config", &format!("profile.dev.{setting}")]);
    }
    let ended = cargo.args(lane.crates).arg("--").args(lane.tests).output().expect("cargo runs");
    let [out, errors] = [ended.stdout, ended.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert!(ended.status.success(), "{:?} with all patches: {errors}{out}", lane.crates);
    assert!(!errors.contains("warning:"), "{:?} with all patches: {errors}", lane.crates);
    out
}

#[test]
fn a_tree_with_all_new_kinds_compiles_and_keeps_the_contracts() {
    if env::var_os("PERIS_LONG").is_none() {
        return;
    }
    let folder = root().join("target/dry-runs");
    let (tree, build) = (folder.join("tree"), folder.join("build"));
    if tree.exists() {
        fs::remove_dir_all(&tree).expect("an earlier copy can be removed");
    }
    copy(&root(), &tree).expect("the sources can be copied");
    let runs = dry_runs();
    for patch in &runs {
        if !apply(&patch.path, &tree, &[]) {
            println!("git is not installed: nothing was tried");
            return;
        }
    }
    let mut passed = String::new();
    for lane in &LANES {
        passed += &run(lane, &tree, &build);
        let missing: Vec<_> =
            lane.contracts.iter().filter(|name| !passed.contains(&format!("{name} ... ok"))).collect();
        assert!(missing.is_empty(), "not run: {missing:?}");
    }
    for patch in &runs {
        for test in patch.tests() {
            assert!(passed.contains(&format!("::{test} ... ok")), "{}: {test} was not run", patch.path.display());
        }
    }
}
