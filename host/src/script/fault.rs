//! Faults of a script, with the place and the line where they are.

use crate::scene::ScriptPosition;
use std::fmt;

/// Steps that a script may take.
pub const MAX_OPERATIONS: u64 = 20_000_000;

/// A fault at a position of a script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScriptFault {
    /// The script.
    pub file: String,
    /// Line, from 1; 0 if it is not known.
    pub line: usize,
    /// Column, from 1; 0 if it is not known.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// The text of the line.
    pub text: String,
}

impl fmt::Display for ScriptFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ScriptFault { file, line, column, message, text } = self;
        match line {
            0 => write!(f, "{file}: {message}"),
            _ => {
                let number = line.to_string();
                let gutter = " ".repeat(number.len());
                let lead: String =
                    text.chars().take(column.saturating_sub(1)).map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
                write!(f, "{file}:{line}:{column}: {message}\n{number} | {text}\n{gutter} | {lead}^")
            }
        }
    }
}

impl ScriptFault {
    /// A fault of a script.
    ///
    /// - `script`: its text.
    pub(super) fn new(file: &str, script: &str, at: Option<ScriptPosition>, message: String) -> ScriptFault {
        let ScriptPosition { line, column } = at.unwrap_or(ScriptPosition { line: 0, column: 0 });
        let text = line.checked_sub(1).and_then(|l| script.lines().nth(l)).unwrap_or_default().to_owned();
        ScriptFault { file: file.to_owned(), line, column, message, text }
    }

    /// Where it is, if that is known.
    pub(super) fn position(&self) -> Option<ScriptPosition> {
        (self.line > 0).then_some(ScriptPosition { line: self.line, column: self.column })
    }
}
