//! The order of the house: layers, first lines, top-level entries, sizes of files.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

/// Most lines of a source file.
const MAX_LINES: usize = 600;

/// Top-level entries beside dot files and licences.
const TOP_LEVEL: &[&str] = &[
    "Cargo.toml",
    "Cargo.lock",
    "README.md",
    "host",
    "ps340",
    "protocol",
    "tests",
    "target",
    "peris-demo",
    "peris-run",
];

/// A crate of the workspace.
struct Crate {
    name: &'static str,
    /// Where it is, seen from the root.
    folder: &'static str,
    /// The crates of the workspace that it may name.
    below: &'static [&'static str],
}

const CRATES: &[Crate] = &[
    Crate { name: "files", folder: "protocol/files", below: &[] },
    Crate { name: "processes", folder: "protocol/processes", below: &[] },
    Crate { name: "protocol", folder: "protocol", below: &[] },
    Crate { name: "ps340", folder: "ps340", below: &["protocol", "files", "processes"] },
    Crate { name: "host", folder: "host", below: &["protocol", "files", "processes"] },
    Crate { name: "tests", folder: "tests", below: &["protocol", "files", "processes", "ps340", "host"] },
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace is the parent folder").to_owned()
}

/// All Rust files of a folder, sorted, without those of crates inside it.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let Ok(entries) = fs::read_dir(folder) else {
        return files;
    };
    for entry in entries {
        let path = entry.expect("a folder that was opened can be read").path();
        if path.is_dir() && !path.ends_with("target") && !path.join("Cargo.toml").exists() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The code without comments, and with the contents of texts and characters left out.
fn code(source: &str) -> String {
    let mut code = String::with_capacity(source.len());
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let skipped = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |at| at + 2)
        } else if let Some(hashes) = raw_text(rest) {
            let end = format!("\"{}", "#".repeat(hashes));
            rest[hashes + 2..].find(&end).map_or(rest.len(), |at| hashes + 2 + at + end.len())
        } else if first == '"' {
            quoted(rest, '"')
        } else if rest.starts_with("'\\") || rest.starts_with("'\"'") {
            quoted(rest, '\'')
        } else {
            code.push(first);
            rest = &rest[first.len_utf8()..];
            continue;
        };
        code.push(' ');
        rest = &rest[skipped..];
    }
    code
}

/// The number of `#` of a raw text that begins here.
fn raw_text(rest: &str) -> Option<usize> {
    let after = rest.strip_prefix('r')?;
    let hashes = after.len() - after.trim_start_matches('#').len();
    after[hashes..].starts_with('"').then_some(hashes)
}

/// The length of a text or character in quotes.
fn quoted(rest: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            c if c == quote => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// The names of the paths that begin with `prefix::`, also those in braces: `crate::{a::B, c}` gives a and c.
fn named(code: &str, prefix: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for (at, found) in code.match_indices(prefix) {
        let before = code[..at].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':') {
            continue;
        }
        let Some(rest) = code[at + found.len()..].trim_start().strip_prefix("::") else {
            continue;
        };
        let rest = rest.trim_start();
        match rest.strip_prefix('{') {
            Some(group) => names.extend(members(group)),
            None => names.extend(identifier(rest)),
        }
    }
    names
}

/// The first identifiers of the members of a group in braces, from behind its `{`.
fn members(group: &str) -> Vec<String> {
    let mut names = Vec::new();
    let (mut depth, mut begin) = (0_usize, 0);
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                names.extend(identifier(group[begin..at].trim_start()));
                begin = at + 1;
                if c == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    names
}

fn identifier(text: &str) -> Option<String> {
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
    (end > 0).then(|| text[..end].to_owned())
}

/// The layers of a crate, lowest first, and the layer of each name that `lib.rs` re-exports.
fn layers(library: &str) -> (Vec<String>, BTreeMap<String, String>) {
    let mut layers = Vec::new();
    let mut exports = BTreeMap::new();
    let library = code(library);
    for statement in library.split(';') {
        let statement = statement.trim().trim_start_matches("pub ").trim();
        let statement = statement.rsplit(']').next().unwrap_or(statement).trim().trim_start_matches("pub ").trim();
        if let Some(module) = statement.strip_prefix("mod ") {
            layers.push(module.trim().to_owned());
        } else if let Some(path) = statement.strip_prefix("use ")
            && let Some((module, names)) = path.split_once("::")
        {
            let module = module.trim().to_owned();
            for name in names.trim_matches(|c| c == '{' || c == '}').split(',') {
                let name = name.rsplit(" as ").next().unwrap_or(name).trim();
                exports.insert(name.to_owned(), module.clone());
            }
        }
    }
    (layers, exports)
}

/// How many folders a path such as `super::super::x` climbs at most.
fn climbed(code: &str) -> usize {
    let mut highest = 0;
    for (at, _) in code.match_indices("super::") {
        if code[..at].ends_with("super::") {
            continue;
        }
        let mut count = 0;
        let mut rest = &code[at..];
        while let Some(next) = rest.strip_prefix("super::") {
            count += 1;
            rest = next;
        }
        highest = highest.max(count);
    }
    highest
}

#[test]
fn a_folder_uses_only_the_layers_below_it() {
    let mut faults = Vec::new();
    let mut seen = 0;
    for Crate { folder, .. } in CRATES {
        let folder = root().join(folder).join("src");
        let (layers, exports) = layers(&read(&folder.join("lib.rs")));
        for path in sources(&folder) {
            let inside = path.strip_prefix(&folder).expect("the file was found in the folder");
            let parts: Vec<&str> = inside.iter().filter_map(|part| part.to_str()).collect();
            let own = parts[0].trim_end_matches(".rs");
            if parts.len() == 1 && matches!(own, "lib" | "main") || own == "bin" {
                continue;
            }
            let text = code(&read(&path));
            let Some(height) = layers.iter().position(|layer| layer == own) else {
                faults.push(format!("{}: `{own}` is no module of lib.rs", path.display()));
                continue;
            };
            for used in named(&text, "crate") {
                let used = exports.get(&used).cloned().unwrap_or(used);
                seen += 1;
                match layers.iter().position(|layer| *layer == used) {
                    Some(other) if other > height => {
                        faults.push(format!("{}: `{own}` uses `{used}`, which lies above it", path.display()));
                    }
                    _ => {}
                }
            }
            // A chain of `super` must not reach the root, where the layers cannot be seen. One more is needed inside
            // the module of the tests.
            let depth = parts.len() - usize::from(parts.last() == Some(&"mod.rs"));
            let tests = text.find("mod tests {").unwrap_or(text.len());
            if climbed(&text[..tests]) >= depth || climbed(&text[tests..]) > depth {
                faults.push(format!("{}: `super` reaches the root; write `crate`", path.display()));
            }
        }
    }
    assert!(seen > 20, "only {seen} uses were found: the test is blind");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn crates_name_only_the_crates_below_them() {
    let mut faults = Vec::new();
    for Crate { name, folder, below } in CRATES {
        let forbidden = CRATES.iter().map(|row| row.name).filter(|other| other != name && !below.contains(other));
        let manifest = read(&root().join(folder).join("Cargo.toml"));
        for other in forbidden {
            if manifest.lines().any(|line| line.split(['.', ' ', '=']).next() == Some(other)) {
                faults.push(format!("{folder}/Cargo.toml names `{other}`"));
            }
            for path in sources(&root().join(folder)) {
                let text = code(&read(&path));
                // A module of the crate itself may bear the name, as in `crate::ps340::`.
                let imported = text.contains(&format!("use {other};")) || text.contains(&format!("crate {other};"));
                if imported || !named(&text, other).is_empty() {
                    faults.push(format!("{}: names `{other}`", path.display()));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_file_says_first_what_it_is_for_and_is_short() {
    let mut faults = Vec::new();
    for path in CRATES.iter().flat_map(|one| sources(&root().join(one.folder))) {
        let text = read(&path);
        let first = text.lines().next().unwrap_or_default();
        if first.strip_prefix("//! ").is_none_or(|purpose| purpose.len() < 8) {
            faults.push(format!("{}: the first line is not `//!` and the purpose", path.display()));
        }
        let lines = text.lines().count();
        if lines > MAX_LINES {
            faults.push(format!("{}: {lines} lines, more than {MAX_LINES}", path.display()));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_top_level_holds_nothing_else() {
    let mut strange = Vec::new();
    for entry in fs::read_dir(root()).expect("the workspace can be read") {
        let name = entry.expect("the workspace can be read").file_name().to_string_lossy().into_owned();
        if !(name.starts_with('.') || name.starts_with("LICENSE") || TOP_LEVEL.contains(&name.as_str())) {
            strange.push(name);
        }
    }
    assert!(strange.is_empty(), "not in the plan of the house: {}", strange.join(", "));
}

#[test]
fn the_reader_of_code_is_not_deceived() {
    let source = r##"
        use crate::{a::{B, c}, d}; // crate::comment
        fn f() { crate::e::f("crate::text", '"', r#"crate::raw"#, '\''); my_crate::g(); }
        use super::super::x;
    "##;
    let text = code(source);
    assert_eq!(named(&text, "crate").into_iter().collect::<Vec<_>>(), ["a", "d", "e"]);
    assert_eq!(climbed(&text), 2);
    let (layers, exports) = layers("//! x\npub mod a;\n#[cfg(test)]\nmod b;\npub use a::{X, Y as Z};\npub use b::W;");
    assert_eq!(layers, ["a", "b"]);
    assert_eq!(exports.iter().map(|(n, m)| format!("{n}:{m}")).collect::<Vec<_>>(), ["W:b", "X:a", "Z:a"]);
}
