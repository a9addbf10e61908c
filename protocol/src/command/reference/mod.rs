//! The command table: one row for each command, from which help and checks are derived.
//!
//! Tests hold the table to the parser: each example is read and gives the command of its row, each command and each
//! keyword has a row, and each keyword in a row is one of the parser.

mod curve;
mod data;
mod entry;
mod name_of;
mod network;
mod rendering;
pub(super) mod row;
mod structure;
mod system;
mod text;

pub use name_of::{name_of, name_of_object, name_of_operate};
pub use row::{CommandRow, Confidence, InputRow, OptionRow};

use super::{operate, spelling::nearest, words::Word};
use std::fmt::Write;

/// The rows of each group in parts, with its title.
const GROUPS: &[(&str, &[&[CommandRow]])] = &[
    ("Structures", &[structure::ROWS]),
    ("Data", &[data::ROWS]),
    ("Curves", &[curve::ROWS]),
    ("Text", &[text::ROWS, operate::TEXT]),
    ("Transformations", &[operate::TRANSFORMATIONS]),
    ("Viewing", &[operate::VIEWING]),
    ("Attributes", &[operate::ATTRIBUTES]),
    ("Conditions", &[operate::CONDITIONS]),
    ("Rendering and reading back", &[operate::RENDERING, rendering::ROWS, operate::READING_BACK]),
    ("Function networks", &[network::ROWS]),
    ("System", &[system::ROWS]),
];

/// All rows, group by group.
pub fn rows() -> impl Iterator<Item = &'static CommandRow> {
    GROUPS.iter().flat_map(|group| group.1.iter().copied().flatten())
}

/// A name that no row has, with the nearest name if one is near.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no command {requested}{}", .nearest.map(|name| format!("; did you mean {name}?")).unwrap_or_default())]
pub struct UnknownCommand {
    /// The name that was requested.
    pub requested: String,
    /// The nearest name of a row.
    pub nearest: Option<&'static str>,
}

/// The rows that `name` may mean: the row of that name; else those whose words begin with the words of `name`, which
/// may be abbreviated; else those that contain a keyword of that name. A blank may stand for an underscore.
///
/// # Errors
/// [`UnknownCommand`] if there are none.
pub fn find(name: &str) -> Result<Vec<&'static CommandRow>, UnknownCommand> {
    let asked: Vec<String> = words(name).map(str::to_ascii_uppercase).collect();
    let whole = asked.join(" ");
    let keyword = asked.join("_");
    let same: Vec<_> = rows().filter(|row| words(row.name).eq(asked.iter().map(String::as_str))).collect();
    let begins = |row: &&CommandRow| {
        let words: Vec<&str> = words(row.name).collect();
        !asked.is_empty()
            && words.len() >= asked.len()
            && words.iter().zip(&asked).all(|(word, asked)| word.starts_with(asked.as_str()))
    };
    let beginning: Vec<_> = rows().filter(begins).collect();
    let mentioning: Vec<_> = rows().filter(|row| row.words().any(|word| word.accepts(keyword.as_bytes()))).collect();
    for found in [same, beginning, mentioning] {
        if !found.is_empty() {
            return Ok(found);
        }
    }
    let word = nearest(&whole, rows().map(|row| row.name)).or_else(|| {
        let upper: Vec<(String, Word)> = Word::ALL.iter().map(|word| (word.upper(), *word)).collect();
        let near = nearest(&keyword, upper.iter().map(|pair| pair.0.as_str()))?;
        let word = upper.iter().find(|pair| pair.0 == near)?.1;
        rows().find(|row| row.words().any(|w| w == word)).map(|row| row.name)
    });
    Err(UnknownCommand { requested: name.to_owned(), nearest: word })
}

/// The parts of a name between blanks and underscores.
fn words(name: &str) -> impl Iterator<Item = &str> {
    name.split(|c: char| c == '_' || c.is_whitespace()).filter(|word| !word.is_empty())
}

/// The list of all commands: name and summary, group by group.
pub fn list() -> String {
    let width = rows().map(|row| row.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for (index, (title, rows)) in GROUPS.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}{title}", if index > 0 { "\n" } else { "" });
        for row in rows.iter().copied().flatten() {
            let _ = writeln!(text, "  {:width$}  {}", row.name, row.summary);
        }
    }
    text
}

#[cfg(test)]
mod tests;
