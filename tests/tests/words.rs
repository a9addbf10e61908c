//! One meaning a word: the page of words and the code agree, type names mean one thing, retired words stay away.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use tests::source_tree::{CRATES, code, comments, read, root, sources};

/// The page of words.
fn page() -> String {
    read(&root().join("host/docs/words.md"))
}

/// What stands in back quotes.
fn names(line: &str) -> impl Iterator<Item = &str> {
    line.split('`').skip(1).step_by(2)
}

/// The identifiers of a text.
fn identifiers(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|word| !word.is_empty())
}

/// The words of an identifier, in small letters: `PathSegment` and `path_segment` are path and segment.
fn words_of(identifier: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = '_';
    for c in identifier.chars() {
        if c == '_' || (c.is_uppercase() && before.is_lowercase()) {
            words.push(String::new());
        }
        if c != '_' {
            words.last_mut().expect("one at least").extend(c.to_lowercase());
        }
        before = c;
    }
    words.retain(|word| !word.is_empty());
    words
}

/// All source files of the workspace.
fn files() -> Vec<PathBuf> {
    CRATES.iter().flat_map(|one| sources(&root().join(one.folder))).collect()
}

#[test]
fn every_name_on_the_page_of_words_stands_in_the_code() {
    let known: BTreeSet<String> = files()
        .iter()
        .flat_map(|path| identifiers(&code(&read(path))).map(str::to_owned).collect::<Vec<_>>())
        .collect();
    let modules: BTreeSet<String> =
        files().iter().filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned())).collect();
    let page = page();
    let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("- **")).collect();
    assert!(rows.len() >= 120, "{} words", rows.len());
    let is_known = |name: &str| known.contains(name) || modules.contains(name);
    let strange: Vec<String> = rows
        .iter()
        .flat_map(|row| names(row).flat_map(identifiers).map(move |name| (row, name)))
        .filter(|(_, name)| !is_known(name))
        .map(|(row, name)| format!("{name}: {row}"))
        .collect();
    assert!(strange.is_empty(), "not in the code:\n{}", strange.join("\n"));
    let mut words: Vec<&str> = rows.iter().filter_map(|row| row.split("**").nth(1)).collect();
    words.sort_unstable();
    assert_eq!(words.windows(2).find(|pair| pair[0] == pair[1]), None, "a word with two meanings");
}

/// The types of a file that may leave it.
fn public_types(code: &str) -> Vec<String> {
    let mut types = Vec::new();
    for line in code.lines().map(str::trim_start) {
        let Some(rest) = line.strip_prefix("pub") else { continue };
        let rest = match rest.strip_prefix('(') {
            Some(rest) => rest.split_once(')').map_or("", |(_, rest)| rest),
            None => rest,
        };
        let mut words = rest.split_whitespace().skip_while(|word| *word == "unsafe");
        if matches!(words.next(), Some("struct" | "enum" | "trait" | "type" | "union")) {
            types.extend(words.next().and_then(|word| identifiers(word).next()).map(str::to_owned));
        }
    }
    types
}

#[test]
fn a_type_name_that_leaves_its_file_means_one_thing_in_its_crate() {
    let source = "pub(super) struct A(u8);\nstruct B;\n    pub type C<T> = T;\npub unsafe trait D {}";
    assert_eq!(public_types(source), ["A", "C", "D"]);
    let mut faults = Vec::new();
    let mut meanings: BTreeMap<(&str, String), Vec<PathBuf>> = BTreeMap::new();
    for one in CRATES {
        for path in sources(&root().join(one.folder)) {
            for name in public_types(&code(&read(&path))) {
                meanings.entry((one.house, name)).or_default().push(path.clone());
            }
        }
    }
    let twice = meanings.into_iter().filter(|(_, paths)| paths.len() > 1);
    faults.extend(twice.map(|((_, name), paths)| format!("{name} in {paths:?}")));
    assert!(faults.is_empty(), "one name, several things:\n{}", faults.join("\n"));
}

/// A retired word and the folder where it does not come back.
struct Retired {
    word: String,
    instead: String,
    folder: PathBuf,
}

/// The rows `| word, word | instead | folder, folder |` of the last table of the page.
fn retired(page: &str) -> Vec<Retired> {
    let table = page.split_once("## Retired").expect("a table of retired words").1;
    let mut all = Vec::new();
    for row in table.lines().filter(|line| line.starts_with("| ")).skip(1) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let [_, words, instead, folders, _] = cells[..] else { panic!("no row of three cells: {row}") };
        for word in words.split(", ") {
            for folder in names(folders) {
                let folder = root().join(folder);
                assert!(folder.is_dir(), "there is no folder {}", folder.display());
                all.push(Retired { word: word.to_owned(), instead: instead.to_owned(), folder });
            }
        }
    }
    all
}

/// The lines on which each word stands, in comments and then in code, alone or as a part of a name.
fn lines_of_words(source: &str) -> BTreeMap<String, Vec<usize>> {
    let mut lines: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for text in [comments(source), code(source)] {
        for (line, number) in text.lines().zip(1..) {
            for word in identifiers(line).flat_map(words_of) {
                lines.entry(word).or_default().push(number);
            }
        }
    }
    lines
}

/// The lines of a word and of its plural.
fn uses_of<'a>(word: &str, lines: &'a BTreeMap<String, Vec<usize>>) -> Vec<&'a usize> {
    [word, &format!("{word}s")].into_iter().filter_map(|word| lines.get(word)).flatten().collect()
}

#[test]
fn retired_words_do_not_come_back() {
    let lines = lines_of_words("let a = 1; // of combs\nlet c = \"comb\"; // to combine\nlet of_comb = 2;");
    assert_eq!(uses_of("comb", &lines), [&3, &1]);
    let retired = retired(&page());
    assert!(retired.len() >= 20, "{} retired words", retired.len());
    let mut faults = Vec::new();
    for path in files() {
        let lines = lines_of_words(&read(&path));
        let here = |row: &&Retired| Path::starts_with(&path, &row.folder);
        for Retired { word, instead, .. } in retired.iter().filter(here) {
            let place = path.display();
            let uses = uses_of(word, &lines).into_iter();
            faults.extend(uses.map(|line| format!("{place}:{line}: {word}; say {instead}")));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
