//! The order of the source tree: layers, first lines, top-level entries, sizes of files.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use tests::source_tree::{CRATES, Crate, Uses, code, members, read, root, sources};

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
            Some(group) => names.extend(members(group).into_iter().filter_map(identifier)),
            None => names.extend(identifier(rest)),
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
    for Crate { name, folder, below, .. } in CRATES {
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
fn no_files_use_each_other_in_circles() {
    let mut faults = Vec::new();
    for Crate { name, folder, .. } in CRATES {
        let uses = Uses::of(&root().join(folder).join("src"));
        assert!(uses.edges.len() < 9 || uses.edges.values().any(|used| !used.is_empty()), "{name}: the test is blind");
        for circle in uses.circles() {
            let names: Vec<String> = circle.iter().map(|module| module.join("/")).collect();
            let why = "let one of them say what it needs in its own words, or move what both need below them";
            faults.push(format!("{name}: {} use each other in a circle; {why}", names.join(", ")));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn one_file_of_the_host_names_the_crate_of_binary_forms() {
    let floors = CRATES.iter().filter(|one| one.house == "host");
    let names = |path: &PathBuf| code(&read(path)).contains("bincode");
    let files: Vec<PathBuf> =
        floors.flat_map(|one| sources(&root().join(one.folder).join("src"))).filter(names).collect();
    assert_eq!(files, [root().join("host/foundation/src/encoding.rs")]);
}

/// Families of kinds that grow: the crate, the enumeration, and the module that may distinguish its kinds, if any may.
const FAMILIES: &[(&str, &str, Option<&str>)] = &[
    ("host", "Technique", Some("render/renderers")),
    ("host", "AnyLobe", Some("illumination/optics")),
    ("host", "Light", Some("illumination/light")),
    ("host", "AnyEmitter", Some("illumination/light")),
    ("protocol", "Operate", Some("command/operate")),
    ("protocol", "OperateKind", Some("command/operate")),
    ("ps340", "Operate", Some("structure/operation")),
    ("ps340", "OperateKind", None),
    ("ps340", "Operation", Some("structure/operation")),
    ("host", "Operate", None),
    ("host", "OperateKind", None),
];

/// Whether a pattern names a kind of a family, which begins with a capital: `Light::Sky`, but not `Light::new`.
fn names_a_kind(pattern: &str, family: &str) -> bool {
    pattern.match_indices(family).any(|(at, _)| {
        let is_whole = !pattern[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let kind = pattern[at + family.len()..].strip_prefix("::");
        is_whole && kind.is_some_and(|kind| kind.starts_with(|c: char| c.is_ascii_uppercase()))
    })
}

/// Lines of a `match` that distinguish kinds of a family.
fn arms<'a>(code: &'a str, family: &str) -> Vec<&'a str> {
    let is_arm = |line: &&str| {
        let pattern = line.split_once("=>").map_or(line.trim(), |(pattern, _)| pattern);
        (line.contains("=>") || pattern.starts_with('|')) && names_a_kind(pattern, family)
    };
    code.lines().map(str::trim).filter(is_arm).collect()
}

#[test]
fn kinds_of_a_family_are_told_apart_in_their_room_only() {
    let text =
        "match light {\n    Light::Point { at, .. }\n    | Light::Sky { .. } => at,\n    other => Light::new(other),";
    assert_eq!(arms(text, "Light"), ["| Light::Sky { .. } => at,"]);
    assert_eq!(arms("Some(Node::Operate { operation: Operation::WriteBack, .. }) => true,", "Operation").len(), 1);
    assert!(arms("BlendOperation::Add => 1,\nNode::Operate { .. } => 2,", "Operation").is_empty());
    let mut faults = Vec::new();
    for (name, family, room) in FAMILIES {
        let floors = CRATES.iter().filter(|row| row.house == *name);
        let floors: Vec<PathBuf> = floors.map(|row| root().join(row.folder).join("src")).collect();
        let rooms: Vec<PathBuf> = floors.iter().flat_map(|src| room.map(|room| src.join(room))).collect();
        let is_room = |room: &PathBuf| room.exists() || room.with_extension("rs").exists();
        assert!(room.is_none() || rooms.iter().any(is_room), "{name}: no {room:?}");
        let is_inside =
            |path: &PathBuf| rooms.iter().any(|room| path.starts_with(room) || *path == room.with_extension("rs"));
        let files = floors.iter().flat_map(|src| sources(src));
        for path in files.filter(|path| !is_inside(path) && !is_test(path)) {
            let text = code(&read(&path));
            let text = &text[..text.find("mod tests {").unwrap_or(text.len())];
            let place = path.display();
            faults.extend(arms(text, family).into_iter().map(|arm| format!("{place}: {arm}")));
        }
    }
    assert!(faults.is_empty(), "ask a row or a method of the kind instead:\n{}", faults.join("\n"));
}

/// Whether a file holds tests only.
fn is_test(path: &Path) -> bool {
    path.file_stem().is_some_and(|stem| stem.to_string_lossy().ends_with("tests"))
}

#[test]
fn circles_are_seen_through_what_a_folder_hands_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("in the folder")).expect("a folder");
        fs::write(path, text).expect("a file");
    };
    write("lib.rs", "mod a;");
    write("a/mod.rs", "mod low;\nmod high;\npub use low::Low;\nuse high::High;\nfn f(_: High) {}");
    write(
        "a/low.rs",
        "pub struct Low;\n// use super::high::High;\n#[cfg(test)]\nmod tests {\n use super::super::high; }",
    );
    write("a/high.rs", "use super::Low;\npub struct High(Low);");
    assert!(Uses::of(folder.path()).circles().is_empty());
    write("a/low.rs", "pub struct Low(Box<super::high::High>);");
    let circles = Uses::of(folder.path()).circles();
    assert_eq!(circles, [[["a", "high"], ["a", "low"]]]);
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
fn doc_comments_stand_alone() {
    let mut faults = Vec::new();
    for path in CRATES.iter().flat_map(|one| sources(&root().join(one.folder))) {
        for (number, line) in read(&path).lines().enumerate() {
            let line = line.trim();
            let Some(text) = line.strip_prefix("/// ").or_else(|| line.strip_prefix("//! ")) else { continue };
            if text.starts_with("The same") || matches!(text, "Which." | "Why." | "It." | "How.") {
                faults.push(format!("{}:{}: '{text}' says nothing by itself", path.display(), number + 1));
            }
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
