//! What is passed on with the programs is accounted for: crates of others, and every file that is no code.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use tests::notices::{self, Locked, carried};

/// Files whose names end so are code, documents or settings of the project.
const OWN: [&str; 9] = ["rs", "toml", "lock", "md", "py", "c", "cpp", "gitignore", "wgsl"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The cells of the rows of the tables in a text.
fn rows(text: &str) -> impl Iterator<Item = Vec<&str>> {
    let cells = |line: &'_ str| line.len() > 2 && line.starts_with("| ");
    text.lines().filter(move |line| cells(line)).map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
}

#[test]
fn the_notices_are_of_the_crates_in_cargo_lock() {
    let text = read(notices::PATH);
    let table = text.split("\n## Texts").next().unwrap_or_default();
    let listed = rows(table).skip(1).map(|row| Locked { name: row[0].into(), version: row[1].into() });
    let listed: BTreeSet<Locked> = listed.collect();
    let carried = carried(&root()).expect("Cargo.lock is read");
    assert!(carried.len() > 100, "only {} crates were found: the test is blind", carried.len());
    let (more, less) =
        (carried.difference(&listed).collect::<Vec<_>>(), listed.difference(&carried).collect::<Vec<_>>());
    assert!(
        more.is_empty() && less.is_empty(),
        "make the notices anew with `cargo run -p tests --bin notices`: missing {more:?}, left over {less:?}"
    );
    for required in
        ["Ubuntu Font Licence", "SIL OPEN FONT LICENSE", "Mozilla Public License", "END OF TERMS AND CONDITIONS"]
    {
        assert!(text.to_lowercase().contains(&required.to_lowercase()), "the text of the {required} is missing");
    }
}

/// Every file of a folder that is no code, as a path from the root; without those that building made, and the findings
/// of fuzzing.
fn data(folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(root().join(folder)).expect("a folder of the workspace") {
        let entry = entry.expect("a folder that was opened can be read");
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = format!("{folder}/{name}");
        let is_made = ["target", "found", "__pycache__", ".cargo"].contains(&&*name);
        match entry.file_type().expect("its kind is known").is_dir() {
            true if !is_made => found.extend(data(&path)),
            true => {}
            false if name.rsplit('.').next().is_some_and(|ending| OWN.contains(&ending)) => {}
            false => found.push(path),
        }
    }
    found
}

/// Whether a name of a table, which may hold a `*` for any text, is that of a file.
fn is_of(pattern: &str, path: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == path,
        Some((begin, end)) => path.strip_prefix(begin).is_some_and(|rest| rest.ends_with(end)),
    }
}

#[test]
fn every_file_of_data_has_its_terms_and_every_row_its_file() {
    let text = read(".cargo/licences/DATA.md");
    let patterns: Vec<&str> = rows(&text)
        .filter(|row| row[0].starts_with('`'))
        .flat_map(|row| row[0].split(", ").map(|name| name.trim_matches('`')))
        .collect();
    let files: Vec<String> = ["host", "ps340", "protocol", "tests"].into_iter().flat_map(data).collect();
    assert!(files.len() > 60, "only {} files were found: the test is blind", files.len());
    let without: Vec<&String> = files.iter().filter(|file| !patterns.iter().any(|row| is_of(row, file))).collect();
    assert!(without.is_empty(), "no row in .cargo/licences/DATA.md: {without:?}");
    let empty: Vec<&&str> = patterns.iter().filter(|row| !files.iter().any(|file| is_of(row, file))).collect();
    assert!(empty.is_empty(), "rows of .cargo/licences/DATA.md without a file: {empty:?}");
}
