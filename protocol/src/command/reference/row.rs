//! One row of the command table.

use crate::command::words::Word;

/// How well a command is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Confidence {
    /// Seen in programs of the time.
    Confirmed,
    /// Recalled from the manuals; details may be off.
    Remembered,
    /// Known to have existed, and little more.
    Uncertain,
}

impl Confidence {
    /// The word for it in the printed table.
    pub const fn word(self) -> &'static str {
        match self {
            Confidence::Confirmed => "confirmed by programs of the time",
            Confidence::Remembered => "remembered from the manuals",
            Confidence::Uncertain => "uncertain",
        }
    }
}

/// An option or a parameter of a command.
#[derive(Clone, Copy, Debug)]
pub struct OptionRow {
    /// As it stands in the syntax.
    pub form: &'static str,
    /// Its text.
    pub meaning: &'static str,
    /// The values; empty if any number, name or text.
    pub range: &'static str,
    /// What holds without it; empty if it must be given.
    pub default: &'static str,
}

/// An input of the node that a command makes.
#[derive(Clone, Copy, Debug)]
pub struct InputRow {
    /// Such as `<1>` or `<append>`.
    pub input: &'static str,
    /// The kinds of value that it takes.
    pub takes: &'static str,
    /// What they do.
    pub effect: &'static str,
}

/// One command of the language.
#[derive(Clone, Copy, Debug)]
pub struct CommandRow {
    /// Its words in full, capitals.
    pub name: &'static str,
    /// The section of the reference that describes it.
    pub section: &'static str,
    /// How well it is known.
    pub confidence: Confidence,
    /// What it does, in one line without a full stop.
    pub summary: &'static str,
    /// Its forms as the manuals write them: the capitals of a keyword are its shortest form, parameters are small,
    /// `[...]` may be left out, `|` separates alternatives.
    pub syntax: &'static [&'static str],
    /// Options and parameters.
    pub options: &'static [OptionRow],
    /// Inputs of the node.
    pub inputs: &'static [InputRow],
    /// Names of the routines of the FORTRAN library that make it.
    pub routines: &'static [&'static str],
    /// Statements that use it.
    pub example: &'static str,
}

/// What the rows have in common.
pub(in crate::command) const PLAIN: CommandRow = CommandRow {
    name: "",
    section: "",
    confidence: Confidence::Remembered,
    summary: "",
    syntax: &[],
    options: &[],
    inputs: &[],
    routines: &[],
    example: "",
};

/// A row of options.
pub(in crate::command) const fn option(
    form: &'static str,
    meaning: &'static str,
    range: &'static str,
    default: &'static str,
) -> OptionRow {
    OptionRow { form, meaning, range, default }
}

/// A row of inputs.
pub(in crate::command) const fn input(input: &'static str, takes: &'static str, effect: &'static str) -> InputRow {
    InputRow { input, takes, effect }
}

impl CommandRow {
    /// The keywords in the syntax.
    pub fn words(&self) -> impl Iterator<Item = Word> {
        let pieces = self.syntax.iter().flat_map(|line| pieces(line));
        pieces.filter_map(|piece| Word::ALL.iter().copied().find(|word| word.form() == piece))
    }
}

/// The words of a line of syntax, keywords and parameters.
pub(super) fn pieces(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).filter(|piece| !piece.is_empty())
}
