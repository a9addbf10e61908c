//! What is wrong with a command text, and where.

use super::{
    MAX_POINTS, MAX_STATEMENT, MAX_TEXT,
    syntax::{Bspline, Pattern, Polygon},
    words::Word,
};
use crate::name::NameError;
use std::{fmt, ops::Range};

/// Longest piece of the offending text that an error quotes, in bytes.
const QUOTED: usize = 40;

/// What can be wrong with a command text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Problem {
    /// Something else was expected here.
    #[error("unexpected")]
    Unexpected,
    /// An abbreviation that is too short for the word that it begins.
    #[error("too short for {}, which needs {}", .0.upper(), .0.least())]
    TooShort(Word),
    /// Nearly a word that can stand here.
    #[error("did you mean {}?", .0.upper())]
    Misspelt(Word),
    /// A byte that begins nothing.
    #[error("this character has no meaning")]
    BadCharacter,
    /// A number such as `1.2.3` or a sign without digits.
    #[error("this is not a number")]
    BadNumber,
    /// A number that is too large to be kept.
    #[error("the number is out of range")]
    OutOfRange,
    /// A whole number that cannot stand here.
    #[error("the number must be {least} to {most}")]
    Outside {
        /// The least that can.
        least: i64,
        /// The largest.
        most: i64,
    },
    /// A text without its second quote.
    #[error("the text has no closing quote")]
    OpenString,
    /// A comment without its brace.
    #[error("the comment has no closing brace")]
    OpenComment,
    /// A text that is too long; the rest of it is left out.
    #[error("the text is longer than {MAX_TEXT} characters and is cut")]
    LongString,
    /// Attributes or an outline after the last polygon of a command; they are left out.
    #[error("no polygon follows, so this has no effect")]
    NoPolygon,
    /// A name that is none.
    #[error(transparent)]
    Name(#[from] NameError),
    /// Numbers without commas or marks do not say where the first vector ends.
    #[error("put commas between the components, so that it is clear where the first vector ends")]
    UnclearVector,
    /// Too many vectors.
    #[error("a list holds at most {MAX_POINTS} vectors")]
    TooManyPoints,
    /// A polygon without an inside.
    #[error("a polygon has at least 3 vertices")]
    FewVertices,
    /// Too many vertices.
    #[error("a polygon has at most {} vertices", Polygon::MAX_VERTICES)]
    ManyVertices,
    /// Normals at some vertices of a polygon only.
    #[error("give a normal for each vertex of a polygon, or for none")]
    MixedNormals,
    /// Colours at some vertices of a polygon only.
    #[error("give a color for each vertex of a polygon, or for none")]
    MixedColors,
    /// Too many vertices or knots of a curve.
    #[error("a curve has at most {} vertices", Bspline::MAX_VERTICES)]
    LongCurve,
    /// Rows of coefficients that do not fit the order.
    #[error("a polynomial of order {order} has {} rows of coefficients", order + 1)]
    Rows {
        /// The order that was given.
        order: u8,
    },
    /// Too many lengths in a pattern.
    #[error("a pattern has at most {} lengths", Pattern::MAX_SEGMENTS)]
    LongPattern,
    /// A statement whose end does not come within the limit.
    #[error("the statement is longer than {MAX_STATEMENT} bytes")]
    LongStatement,
}

/// A fault before its position and text are looked up; small, so that it travels cheaply through the parser.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    pub(super) span: Range<usize>,
    pub(super) problem: Problem,
    pub(super) expected: &'static [&'static str],
}

/// An error in a command text, or a doubt about one that was read.
///
/// It displays as `line:column: problem, expected ..., found ...`; line and column count from 1 at the first character
/// of the text that was parsed: a command, or the whole stream of a [`CommandReader`](super::CommandReader).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CommandError {
    /// The offending bytes, as offsets into the statement.
    pub span: Range<usize>,
    /// Line, from 1.
    pub line: usize,
    /// Column in bytes, from 1.
    pub column: usize,
    /// What could have stood there; may be empty.
    pub expected: &'static [&'static str],
    /// The offending text, at most 40 bytes of it; empty at the end of the statement.
    pub found: String,
    /// What is wrong.
    pub problem: Problem,
}

impl CommandError {
    /// Looks up the position of a fault in the statement `text`.
    pub(super) fn new(text: &[u8], fault: Fault) -> CommandError {
        let start = fault.span.start.min(text.len());
        let end = fault.span.end.clamp(start, text.len());
        let before = &text[..start];
        let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |at| at + 1);
        let quoted = &text[start..end.min(start + QUOTED)];
        CommandError {
            span: start..end,
            line: 1 + before.iter().filter(|&&b| b == b'\n').count(),
            column: 1 + start - line_start,
            expected: fault.expected,
            found: quoted.iter().fold(String::new(), readable),
            problem: fault.problem,
        }
    }

    /// This error in a text that has `lines` lines before the statement, and `columns` bytes in the line in which
    /// it begins.
    pub(super) fn behind(mut self, lines: usize, columns: usize) -> CommandError {
        if self.line == 1 {
            self.column += columns;
        }
        self.line += lines;
        self
    }

    /// The message without the position.
    pub fn message(&self) -> String {
        let mut message = String::new();
        let hint = match self.problem {
            Problem::TooShort(_) => format!(", {}", self.problem),
            Problem::Misspelt(_) => format!("; {}", self.problem),
            _ => String::new(),
        };
        if self.problem != Problem::Unexpected && hint.is_empty() {
            message = format!("{}, ", self.problem);
        }
        match self.expected {
            [] => {}
            [one] => message += &format!("expected {one}, "),
            [first @ .., last] => message += &format!("expected {} or {last}, ", first.join(", ")),
        }
        if self.found.is_empty() {
            message += "found the end of the command";
        } else {
            message += &format!("found `{}`", self.found);
        }
        message + &hint
    }
}

/// Appends a byte: itself if it can be printed, else its escape.
fn readable(mut text: String, byte: &u8) -> String {
    match byte {
        b' '..=b'~' => text.push(char::from(*byte)),
        _ => text += &byte.escape_ascii().to_string(),
    }
    text
}

impl fmt::Display for CommandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.line, self.column, self.message())
    }
}

impl std::error::Error for CommandError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_message_names_place_expectation_and_text() {
        let text = b"A := ROTATE\n  IN Q 3";
        let fault = Fault { span: 17..18, problem: Problem::Unexpected, expected: &["X", "Y", "Z"] };
        let error = CommandError::new(text, fault);
        assert_eq!(error.to_string(), "2:6: expected X, Y or Z, found `Q`");
    }

    #[test]
    fn the_message_says_which_word_was_meant() {
        let message =
            |problem| CommandError::new(b"CHA", Fault { span: 0..3, problem, expected: &["a command"] }).to_string();
        assert_eq!(
            message(Problem::TooShort(Word::Characters)),
            "1:1: expected a command, found `CHA`, too short for CHARACTERS, which needs CHAR"
        );
        assert_eq!(
            message(Problem::Misspelt(Word::Characters)),
            "1:1: expected a command, found `CHA`; did you mean CHARACTERS?"
        );
    }

    #[test]
    fn a_fault_behind_the_text_is_at_its_end() {
        let error = CommandError::new(b"AB", Fault { span: 90..91, problem: Problem::BadNumber, expected: &[] });
        assert_eq!(error.span, 2..2);
        assert_eq!(error.to_string(), "1:3: this is not a number, found the end of the command");
    }

    #[test]
    fn an_error_moves_with_what_stands_before_its_statement() {
        let error = |at: usize| {
            CommandError::new(b"A\nB", Fault { span: at..at + 1, problem: Problem::Unexpected, expected: &[] })
        };
        assert_eq!(error(0).behind(4, 7).to_string(), "5:8: found `A`");
        assert_eq!(error(2).behind(4, 7).to_string(), "6:1: found `B`");
    }
}
