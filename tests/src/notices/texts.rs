//! The texts of licences and notices that lie in the folder of a crate.

use super::{NoticesError, read};
use std::path::{Path, PathBuf};

/// How the names of files that hold terms begin, in lower case.
const BEGINNINGS: [&str; 6] = ["licen", "copying", "copyright", "notice", "unlicense", "authors"];
/// A folder whose texts are the terms of the fonts in it.
const FONTS: &str = "fonts";

/// The texts in the folder of a crate, sorted by their names: of all its licences but the Apache License, whose text is
/// the same for all, or where that is the only one, its notices.
///
/// - `is_apache`: whether the Apache License is all that is chosen.
///
/// # Errors
/// [`NoticesError::File`].
pub fn texts(folder: &Path, is_apache: bool) -> Result<Vec<String>, NoticesError> {
    let mut paths = terms(folder, |name| {
        if is_apache { name.starts_with("notice") } else { BEGINNINGS.iter().any(|begin| name.starts_with(begin)) }
    })?;
    if folder.join(FONTS).is_dir() {
        paths.extend(terms(&folder.join(FONTS), |name| name.ends_with(".txt"))?);
    }
    let texts = paths.iter().map(|path| read(path)).collect::<Result<Vec<_>, _>>()?;
    Ok(texts.into_iter().filter(|text| is_apache || !is_apache_licence(text)).map(|text| tidy(&text)).collect())
}

/// The files of a folder with such names, in lower case.
fn terms(folder: &Path, is_such: impl Fn(&str) -> bool) -> Result<Vec<PathBuf>, NoticesError> {
    let failed = |source| NoticesError::File { path: folder.into(), source };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        if path.is_file() && is_such(&name) && !name.ends_with(".rs") {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}

fn is_apache_licence(text: &str) -> bool {
    text.contains("Apache License") && text.contains("TERMS AND CONDITIONS FOR USE, REPRODUCTION, AND DISTRIBUTION")
}

/// A text without blanks at the ends of lines, and without empty lines around it.
fn tidy(text: &str) -> String {
    text.replace('\t', "    ").lines().map(str::trim_end).collect::<Vec<_>>().join("\n").trim_matches('\n').to_owned()
}
