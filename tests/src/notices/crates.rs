//! The crates of others that a program is made of, by `Cargo.lock` alone, so that no network is needed.

use super::{NoticesError, read_toml};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use toml_edit::{Item, TableLike};

/// The programs, and the crates of the workspace below them, with the folders of their manifests.
const OWN: [(&str, &str); 8] = [
    ("host", "host"),
    ("synthesis", "host/synthesis"),
    ("modelling", "host/modelling"),
    ("foundation", "host/foundation"),
    ("ps340", "ps340"),
    ("emulation", "ps340/emulation"),
    ("protocol", "protocol"),
    ("files", "protocol/files"),
];

/// A crate in one version.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Locked {
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
}

/// A package of `Cargo.lock`.
struct Package {
    locked: Locked,
    /// Whether it is of this workspace.
    is_own: bool,
    /// What it depends on: a name, or where there are several versions a name and a version.
    needs: Vec<String>,
}

/// The crates of others that `peris` and `ps340` are built from on any system: those in them, and the macros and build
/// scripts that helped, which cannot be distinguished here.
///
/// - `root`: the folder of the workspace.
///
/// # Errors
/// [`NoticesError`] if `Cargo.lock` or a manifest cannot be read.
pub fn carried(root: &Path) -> Result<BTreeSet<Locked>, NoticesError> {
    let packages = packages(root)?;
    let mut by_name: BTreeMap<&str, Vec<&Package>> = BTreeMap::new();
    packages.iter().for_each(|package| by_name.entry(&package.locked.name).or_default().push(package));
    let find = |need: &str| {
        let mut words = need.split(' ');
        let (name, version) = (words.next().unwrap_or_default(), words.next());
        let named = by_name.get(name).into_iter().flatten();
        named.copied().find(|package| version.is_none_or(|version| package.locked.version == version))
    };
    let mut waiting: Vec<&Package> = Vec::new();
    for (name, folder) in OWN {
        let asked = dependencies(&root.join(folder).join("Cargo.toml"))?;
        let own = by_name.get(name).into_iter().flatten().flat_map(|package| &package.needs);
        let is_asked = |need: &&String| asked.contains(need.split(' ').next().unwrap_or_default());
        waiting.extend(own.filter(is_asked).filter_map(|need| find(need)));
    }
    let mut found = BTreeSet::new();
    while let Some(package) = waiting.pop() {
        if !package.is_own && found.insert(package.locked.clone()) {
            waiting.extend(package.needs.iter().filter_map(|need| find(need)));
        }
    }
    Ok(found)
}

fn packages(root: &Path) -> Result<Vec<Package>, NoticesError> {
    let path = root.join("Cargo.lock");
    let lock = read_toml(&path)?;
    let form = |problem: &str| NoticesError::Form { what: path.display().to_string(), problem: problem.into() };
    let all = lock.get("package").and_then(Item::as_array_of_tables).ok_or_else(|| form("there are no packages"))?;
    let package = |table: &toml_edit::Table| {
        let text = |key: &str| table.get(key).and_then(Item::as_str).map(str::to_owned);
        let needs = table.get("dependencies").and_then(Item::as_array).into_iter().flatten();
        Some(Package {
            locked: Locked { name: text("name")?, version: text("version")? },
            is_own: text("source").is_none(),
            needs: needs.filter_map(|need| need.as_str().map(str::to_owned)).collect(),
        })
    };
    all.iter().map(|table| package(table).ok_or_else(|| form("a package has no name or version"))).collect()
}

/// What a manifest names as needed for the program, for all systems; what only its tests need is not among it.
fn dependencies(path: &Path) -> Result<BTreeSet<String>, NoticesError> {
    let manifest = read_toml(path)?;
    let of_systems = manifest.get("target").and_then(Item::as_table_like);
    let of_systems = of_systems.into_iter().flat_map(TableLike::iter).filter_map(|(_, item)| item.as_table_like());
    let tables = of_systems.chain([manifest.as_table() as &dyn TableLike]).flat_map(|table| {
        ["dependencies", "build-dependencies"].into_iter().filter_map(|name| table.get(name)?.as_table_like())
    });
    Ok(tables.flat_map(TableLike::iter).map(|(name, _)| name.to_owned()).collect())
}
