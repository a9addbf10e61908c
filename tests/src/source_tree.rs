//! The source tree of the workspace: crates, files, what each file uses, and circles among them.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A crate of the workspace.
pub struct Crate {
    /// Its name.
    pub name: &'static str,
    /// Where it is, seen from the root.
    pub folder: &'static str,
    /// The crate of which it is a floor; its own name for one that stands alone.
    pub house: &'static str,
    /// The crates of the workspace that it may name.
    pub below: &'static [&'static str],
}

/// All of them, lowest first.
pub const CRATES: &[Crate] = &[
    Crate { name: "files", folder: "protocol/files", house: "files", below: &[] },
    Crate { name: "processes", folder: "protocol/processes", house: "processes", below: &[] },
    Crate { name: "protocol", folder: "protocol", house: "protocol", below: &[] },
    Crate { name: "emulation", folder: "ps340/emulation", house: "ps340", below: &["protocol", "files", "processes"] },
    Crate { name: "ps340", folder: "ps340", house: "ps340", below: &["emulation", "protocol", "files", "processes"] },
    Crate { name: "foundation", folder: "host/foundation", house: "host", below: &["protocol", "files"] },
    Crate { name: "modelling", folder: "host/modelling", house: "host", below: &["foundation", "protocol", "files"] },
    Crate {
        name: "synthesis",
        folder: "host/synthesis",
        house: "host",
        below: &["modelling", "foundation", "protocol", "files", "processes"],
    },
    Crate {
        name: "host",
        folder: "host",
        house: "host",
        below: &["synthesis", "modelling", "foundation", "protocol", "files", "processes"],
    },
    Crate {
        name: "tests",
        folder: "tests",
        house: "tests",
        below: &["protocol", "files", "processes", "ps340", "host"],
    },
];

/// The folder of the workspace.
///
/// # Panics
/// If this crate has no parent folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace is the parent folder").to_owned()
}

/// All Rust files of a folder, sorted, without those of crates inside it; none if there is no such folder.
///
/// # Panics
/// If a folder that was opened cannot be read.
pub fn sources(folder: &Path) -> Vec<PathBuf> {
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

/// The text of a file.
///
/// # Panics
/// If it cannot be read.
pub fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The code without comments, and with the contents of texts and characters left out; its lines are those of the source.
pub fn code(source: &str) -> String {
    let mut code = String::with_capacity(source.len());
    walk(source, |part| match part {
        Part::Code(text) => code.push_str(text),
        Part::Comment(text) | Part::Literal(text) => {
            code.push(' ');
            code.extend(text.matches('\n'));
        }
    });
    code
}

/// The comments without the code; their lines are those of the source.
pub fn comments(source: &str) -> String {
    let mut comments = String::new();
    walk(source, |part| match part {
        Part::Comment(text) => comments.push_str(text),
        Part::Code(text) | Part::Literal(text) => comments.extend(text.matches('\n')),
    });
    comments
}

/// A part of a source file.
enum Part<'a> {
    Code(&'a str),
    Comment(&'a str),
    /// A text or a character in quotes.
    Literal(&'a str),
}

/// Hands over the parts of a source file in their order.
fn walk<'a>(source: &'a str, mut take: impl FnMut(Part<'a>)) {
    let (mut begin, mut at) = (0, 0);
    while let Some(first) = source[at..].chars().next() {
        let rest = &source[at..];
        let is_comment = rest.starts_with("//") || rest.starts_with("/*");
        let length = if rest.starts_with("//") {
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
            at += first.len_utf8();
            continue;
        };
        take(Part::Code(&source[begin..at]));
        let part = &rest[..length];
        take(if is_comment { Part::Comment(part) } else { Part::Literal(part) });
        at += length;
        begin = at;
    }
    take(Part::Code(&source[begin..]));
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

/// The members of a group in braces, from after its `{`, as they are written.
pub fn members(group: &str) -> Vec<&str> {
    let mut members = Vec::new();
    let (mut depth, mut begin) = (0_usize, 0);
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                members.push(group[begin..at].trim());
                begin = at + 1;
                if c == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    members.retain(|member| !member.is_empty());
    members
}

/// The paths of a `use`, one for each name, without what they are renamed to: `a::{b, c as d}` gives `a::b` and `a::c`.
fn paths(tree: &str) -> Vec<Vec<String>> {
    let tree = tree.trim();
    match tree.split_once('{') {
        Some((before, group)) => {
            let before: Vec<String> = segments(before);
            let with_before = |path: Vec<String>| before.iter().cloned().chain(path).collect();
            members(group).into_iter().flat_map(paths).map(with_before).collect()
        }
        None => vec![segments(tree.split(" as ").next().unwrap_or(tree))],
    }
}

fn segments(path: &str) -> Vec<String> {
    path.split("::").map(|segment| segment.trim().to_owned()).filter(|segment| !segment.is_empty()).collect()
}

/// What a module is called from the root of its crate: `render`, `film`.
pub type Module = Vec<String>;

/// The files of a crate with what each of them uses of the others. Files of tests are left out, and so are modules of
/// tests at the end of a file.
pub struct Uses {
    /// For each module those whose items it names, itself excepted. What a `mod.rs` hands on belongs to the file behind
    /// it.
    pub edges: BTreeMap<Module, BTreeSet<Module>>,
}

impl Uses {
    /// Those of the files below a folder `src`.
    pub fn of(folder: &Path) -> Uses {
        let mut texts = BTreeMap::new();
        for path in sources(folder) {
            let inside = path.strip_prefix(folder).expect("the file was found in the folder").with_extension("");
            let mut module: Module = inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            if module.last().is_some_and(|name| name == "mod") {
                module.pop();
            }
            let is_left_out = |name: &str| name.ends_with("tests") || matches!(name, "lib" | "main" | "bin");
            if !module.iter().any(|name| is_left_out(name)) {
                let text = code(&read(&path));
                let end = text.find("mod tests {").unwrap_or(text.len());
                texts.insert(module, text[..end].to_owned());
            }
        }
        let handed_on: BTreeMap<(Module, String), Vec<String>> = texts
            .iter()
            .flat_map(|(module, text)| {
                let paths = statements(text).filter(|(is_public, _)| *is_public).flat_map(|(_, tree)| paths(tree));
                paths.filter_map(|path| Some(((module.clone(), path.last()?.clone()), path))).collect::<Vec<_>>()
            })
            .collect();
        let house = ModuleGraph { texts: &texts, handed_on };
        Uses { edges: texts.keys().map(|module| (module.clone(), house.used_by(module))).collect() }
    }

    /// Modules that use each other in a circle, each group of them once.
    pub fn circles(&self) -> Vec<Vec<Module>> {
        let reach: BTreeMap<&Module, BTreeSet<&Module>> =
            self.edges.keys().map(|module| (module, self.reached(module))).collect();
        let mut circles: Vec<Vec<Module>> = Vec::new();
        for module in self.edges.keys() {
            let tied = |other: &&Module| reach[module].contains(*other) && reach[*other].contains(module);
            let circle: Vec<Module> = self.edges.keys().filter(tied).cloned().collect();
            if circle.len() > 1 && !circles.contains(&circle) {
                circles.push(circle);
            }
        }
        circles
    }

    /// All modules that one uses, straight or by others.
    fn reached(&self, module: &Module) -> BTreeSet<&Module> {
        let mut reached = BTreeSet::new();
        let mut waiting: Vec<&Module> = self.edges[module].iter().collect();
        while let Some(next) = waiting.pop() {
            if reached.insert(next) {
                waiting.extend(&self.edges[next]);
            }
        }
        reached
    }
}

/// The modules of a crate.
struct ModuleGraph<'a> {
    texts: &'a BTreeMap<Module, String>,
    /// For a module and a name that it makes public by `use`, the path.
    handed_on: BTreeMap<(Module, String), Vec<String>>,
}

impl ModuleGraph<'_> {
    /// The modules whose items a module names.
    fn used_by(&self, module: &Module) -> BTreeSet<Module> {
        let text = &self.texts[module];
        let mut named: Vec<Vec<String>> =
            statements(text).filter(|(is_public, _)| !is_public).flat_map(|(_, tree)| paths(tree)).collect();
        named.extend(paths_in_code(&without_uses(text)));
        let is_near = |path: &Vec<String>| {
            let first = path.first().map_or("", String::as_str);
            matches!(first, "crate" | "super" | "self") || self.has_child(module, first)
        };
        let owners = named.iter().filter(|path| is_near(path)).filter_map(|path| self.owner(module, path, 0));
        owners.filter(|owner| owner != module).collect()
    }

    fn has_child(&self, module: &Module, name: &str) -> bool {
        self.texts.contains_key(&joined(module, name))
    }

    /// The module that owns what a path leads to, seen from a module.
    fn owner(&self, from: &Module, path: &[String], depth: usize) -> Option<Module> {
        let mut at = from.clone();
        let mut rest = path;
        match rest.first()?.as_str() {
            "crate" => (at, rest) = (Module::new(), &rest[1..]),
            "self" => rest = &rest[1..],
            _ => {}
        }
        while rest.first().is_some_and(|name| name == "super") {
            at.pop();
            rest = &rest[1..];
        }
        while let Some(name) = rest.first().filter(|name| self.has_child(&at, name)) {
            at = joined(&at, name);
            rest = &rest[1..];
        }
        let handed_on = rest.first().and_then(|name| self.handed_on.get(&(at.clone(), name.clone())));
        match handed_on {
            Some(path) if depth < 4 => self.owner(&at, path, depth + 1).or(Some(at)),
            _ => self.texts.contains_key(&at).then_some(at),
        }
    }
}

fn joined(module: &Module, name: &str) -> Module {
    module.iter().cloned().chain([name.to_owned()]).collect()
}

/// The trees of all `use`, and whether each makes its names public.
fn statements(text: &str) -> impl Iterator<Item = (bool, &str)> {
    text.match_indices("use ").filter_map(|(at, found)| {
        // It begins a line, or follows `pub` there.
        let before = text[..at].rsplit('\n').next().unwrap_or_default().trim();
        let tree = &text[at + found.len()..];
        let is_statement = before.is_empty() || before.starts_with("pub");
        is_statement.then(|| (!before.is_empty(), &tree[..tree.find(';').unwrap_or(tree.len())]))
    })
}

/// The code without its `use`.
fn without_uses(text: &str) -> String {
    let trees = statements(text).map(|(_, tree)| tree.as_ptr() as usize - text.as_ptr() as usize);
    let mut code = String::with_capacity(text.len());
    let mut from = 0;
    for begin in trees {
        code.push_str(&text[from..begin.max(from)]);
        from = begin + text[begin..].find(';').unwrap_or(0);
    }
    code + &text[from..]
}

/// Paths outside of `use`: what begins with a small letter and has two segments and more, such as `crate::a::f` and
/// `child::f`.
fn paths_in_code(text: &str) -> Vec<Vec<String>> {
    let is_of_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let words = text.split(|c| !is_of_path(c)).filter(|word| word.contains("::"));
    words.map(segments).filter(|path| path.len() > 1 && path[0].starts_with(|c: char| c.is_lowercase())).collect()
}
