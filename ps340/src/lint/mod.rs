//! What is wrong in command files, found without a user at the machine: names, ports, kinds, functions that never fire.
//!
//! The files are read one after the other, as if one host sent them. Every command is also given to a machine of its
//! own, which reports faults as to any host; INITIALIZE ends a program and begins another. What a function sends
//! for which kinds of message is not listed in a table, it is tried out (`trial`).
//!
//! Found for certain: an error. Likely not meant, but the host could still make it right: a warning.

mod devices;
mod flow;
mod names;
mod ports;
mod program;
mod reading;
mod source_file;
mod trial;

pub use reading::lint;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// The machine refuses it, or something surely does not work.
    Error,
    /// It is probably not meant, or something is missing that a host could still send.
    Warning,
}

/// Something that is wrong in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The file.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// The column in bytes, from 1.
    pub column: usize,
    /// How bad it is.
    pub level: Level,
    /// What it is.
    pub text: String,
}

impl Level {
    /// The word for the level.
    pub const fn word(self) -> &'static str {
        match self {
            Level::Error => "error",
            Level::Warning => "warning",
        }
    }
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}:{}: {}: {}", self.file, self.line, self.column, self.level.word(), self.text)
    }
}

/// A finding before its location is looked up.
#[derive(Clone, Debug)]
struct Note {
    location: source_file::Location,
    level: Level,
    text: String,
}

#[cfg(test)]
mod tests;
