//! The notices as Markdown: a table of crates, then each text once, with the crates that it is of.

use super::crates::{Locked, carried};
use super::terms::Allowed;
use super::texts::texts;
use super::{NoticesError, read};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

const APACHE: &str = "Apache-2.0";

const HEAD: &str = "# Crates of others

What `peris` and `ps340` are built from, on any system, and the terms that are to be passed on with them. Made by
`cargo run -p tests --bin notices` from `Cargo.lock` and the crates; a test fails while it is not of this `Cargo.lock`.
Macros and build scripts are listed, too, though nothing of them is in the programs. Where a crate leaves the choice, it is
passed on under the first of its licences that `.cargo/deny.toml` allows. Data, fonts and pictures are in [DATA.md](DATA.md).
";

/// What is known of a crate.
struct Described {
    locked: Locked,
    offered: String,
    taken: Vec<String>,
    repository: String,
    authors: String,
    texts: Vec<String>,
}

/// Makes the notices; what the crates say of themselves comes from `cargo metadata`, which fetches those that are
/// missing.
///
/// - `root`: the folder of the workspace.
///
/// # Errors
/// [`NoticesError`] if a crate is missing, or its licence is not allowed.
pub fn print(root: &Path) -> Result<String, NoticesError> {
    let described = described(root)?;
    let mut out = HEAD.to_owned();
    out.push_str("\n| crate | version | offered under | passed on under | from |\n|---|---|---|---|---|\n");
    for Described { locked: Locked { name, version }, offered, taken, repository, .. } in &described {
        let _ = writeln!(out, "| {name} | {version} | {offered} | {} | {repository} |", taken.join(", "));
    }
    let mut groups: BTreeMap<&str, Vec<&Described>> = BTreeMap::new();
    for one in &described {
        one.texts.iter().for_each(|text| groups.entry(text).or_default().push(one));
    }
    let mut groups: Vec<(Vec<&Described>, &str)> = groups.into_iter().map(|(text, all)| (all, text)).collect();
    groups.sort_by_key(|(all, text)| (all[0].locked.clone(), *text));
    out.push_str("\n## Texts\n");
    for (all, text) in groups {
        section(&mut out, &all, text);
    }
    let bare: Vec<&Described> =
        described.iter().filter(|one| one.texts.is_empty() && one.taken.iter().any(|taken| taken == "MIT")).collect();
    if !bare.is_empty() {
        let authors = |one: &&Described| format!("{} {}", one.locked.name, one.authors);
        let holders = bare.iter().map(authors).collect::<Vec<_>>().join("; ");
        let own = read(&root.join("LICENSE-MIT"))?;
        let permission = own.find("Permission").map_or("", |begin| own[begin..].trim_end());
        section(&mut out, &bare, &format!("MIT License, of crates without its text. By {holders}.\n\n{permission}"));
    }
    let apache: Vec<&Described> =
        described.iter().filter(|one| one.taken.iter().any(|taken| taken == APACHE)).collect();
    section(&mut out, &apache, read(&root.join("LICENSE-APACHE"))?.trim_end());
    Ok(out)
}

fn section(out: &mut String, all: &[&Described], text: &str) {
    let names = all.iter().map(|one| format!("{} {}", one.locked.name, one.locked.version)).collect::<Vec<_>>();
    let _ = write!(out, "\n### {}\n\n````text\n{text}\n````\n", names.join(", "));
}

fn described(root: &Path) -> Result<Vec<Described>, NoticesError> {
    let allowed = Allowed::read(root)?;
    let known = metadata(root)?;
    let one = |locked: Locked| {
        let form = |problem: &str| NoticesError::Form { what: locked.name.clone(), problem: problem.into() };
        let package = known.get(&locked).ok_or_else(|| form("cargo metadata does not know it"))?;
        let text = |key: &str| package[key].as_str().unwrap_or_default().to_owned();
        let manifest = text("manifest_path");
        let folder = Path::new(&manifest).parent().ok_or_else(|| form("it has no folder"))?;
        let offered = text("license");
        let taken = allowed.chosen(&locked.name, &offered)?;
        let texts = texts(folder, taken == [APACHE])?;
        let authors = package["authors"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let authors =
            authors.map(|author| author.split(" <").next().unwrap_or_default()).collect::<Vec<_>>().join(", ");
        Ok(Described { repository: text("repository"), offered, taken, authors, texts, locked })
    };
    carried(root)?.into_iter().map(one).collect()
}

/// What cargo says of every package.
fn metadata(root: &Path) -> Result<BTreeMap<Locked, Value>, NoticesError> {
    let form = |problem: String| NoticesError::Form { what: "cargo metadata".into(), problem };
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo).args(["metadata", "--format-version", "1", "--locked"]).current_dir(root).output();
    let output = output.map_err(|error| form(error.to_string()))?;
    if !output.status.success() {
        return Err(form(String::from_utf8_lossy(&output.stderr).into_owned()));
    }
    let mut answer: Value = serde_json::from_slice(&output.stdout).map_err(|error| form(error.to_string()))?;
    let Value::Array(packages) = answer["packages"].take() else { return Err(form("it lists no packages".into())) };
    let named = |package: Value| {
        let text = |key: &str| package[key].as_str().unwrap_or_default().to_owned();
        (Locked { name: text("name"), version: text("version") }, package)
    };
    Ok(packages.into_iter().map(named).collect())
}
