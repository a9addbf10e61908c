//! The lines of a command file that is played.

use super::pattern::matches;
use crate::operator::{self, OperatorCommand, OperatorCommandError, unescape};

/// A command file, line by line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Script {
    /// The name of the file, for reports.
    pub file: String,
    /// Its lines; empty ones are text too.
    pub lines: Vec<ScriptLine>,
}

/// A line of a command file.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptLine {
    /// Its number, from 1.
    pub number: usize,
    /// What it does.
    pub step: Step,
}

/// What a line does.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Goes to the machine as it is, with its line end.
    Text(Vec<u8>),
    /// An operator command, and its text.
    OperatorCommand(OperatorCommand, String),
    /// Waits for something.
    Expect {
        /// For what.
        expected: Expected,
        /// For how many frames at most; none for as many as usual.
        within: Option<u64>,
    },
    /// A directive that is a comment.
    Nothing,
}

/// What a line waits for.
#[derive(Clone, Debug, PartialEq)]
pub enum Expected {
    /// The next message to the host is this text.
    Text(Vec<u8>),
    /// The next message to the host matches the pattern, in which `*` is any text.
    Pattern(Vec<u8>),
    /// The next message to the host is a number.
    Number {
        /// The number that is expected.
        value: f64,
        /// How far from it the message may be.
        tolerance: f64,
    },
    /// The next message of the machine of this class begins with the pattern, such as `E 5 *** Bad`.
    Error(Vec<u8>),
    /// The terminal sends these characters to the host, as its keyboard was typed on.
    Typed(Vec<u8>),
    /// No message comes to the host.
    None,
}

/// A directive that cannot be read, with its line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}:{line}: {problem}")]
pub struct ScriptError {
    /// The file.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// What is wrong.
    pub problem: ScriptProblem,
}

/// What can be wrong with a directive.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ScriptProblem {
    /// It is no operator command.
    #[error(transparent)]
    OperatorCommand(#[from] OperatorCommandError),
    /// What it waits for cannot be read.
    #[error(
        "'{0}' is nothing to expect; write 'TEXT', /PATTERN*/, NUMBER [TOLERANCE], typed 'TEXT', error E 5 ..., or none \
         [FRAMES]"
    )]
    Expected(String),
    /// No number of frames after `within`.
    #[error("'{0}' is no number of frames")]
    Frames(String),
    /// A directive that is not text.
    #[error("the directive is not text")]
    Encoding,
}

impl Script {
    /// Reads a command file.
    ///
    /// # Errors
    /// All directives that cannot be read.
    pub fn read(file: &str, bytes: &[u8]) -> Result<Script, Vec<ScriptError>> {
        let mut script = Script { file: file.into(), lines: Vec::new() };
        let mut errors = Vec::new();
        for (number, line) in (1..).zip(bytes.split_inclusive(|byte| *byte == b'\n')) {
            let step = match line.strip_prefix(b"@") {
                None => Ok(Step::Text(line.to_vec())),
                Some(directive) => match std::str::from_utf8(directive) {
                    Ok(directive) => read_directive(directive.trim()),
                    Err(_) => Err(ScriptProblem::Encoding),
                },
            };
            match step {
                Ok(step) => script.lines.push(ScriptLine { number, step }),
                Err(problem) => errors.push(ScriptError { file: file.into(), line: number, problem }),
            }
        }
        if errors.is_empty() { Ok(script) } else { Err(errors) }
    }
}

fn read_directive(text: &str) -> Result<Step, ScriptProblem> {
    if text.is_empty() || text.starts_with('#') {
        return Ok(Step::Nothing);
    }
    match text.split_once(char::is_whitespace).unwrap_or((text, "")) {
        ("expect", rest) => read_expected(rest.trim()),
        _ => Ok(Step::OperatorCommand(operator::parse(text)?, text.into())),
    }
}

fn read_expected(text: &str) -> Result<Step, ScriptProblem> {
    let bad = || ScriptProblem::Expected(text.into());
    let word = |word: &str| {
        let rest = text.strip_prefix(word)?;
        (rest.is_empty() || rest.starts_with(char::is_whitespace)).then(|| rest.trim())
    };
    if let Some(rest) = word("none") {
        let within = (!rest.is_empty()).then(|| read_frames(rest)).transpose()?;
        return Ok(Step::Expect { expected: Expected::None, within });
    }
    if let Some(rest) = word("error") {
        let class = rest.bytes().next().filter(|class| b"EWI".contains(class));
        class.ok_or_else(bad)?;
        return Ok(Step::Expect { expected: Expected::Error(rest.into()), within: None });
    }
    let typed = word("typed");
    for (quote, pattern) in [('\'', false), ('/', true)] {
        let Some(inner) = typed.filter(|_| !pattern).unwrap_or(text).strip_prefix(quote) else { continue };
        let end = inner.rfind(quote).ok_or_else(bad)?;
        let (inside, rest) = (&inner[..end], inner[end + 1..].trim());
        let plain = inside.replace("''", "'");
        let expected = match (pattern, typed) {
            (true, _) => Expected::Pattern(inside.into()),
            (false, Some(_)) => Expected::Typed(unescape(&plain)),
            (false, None) => Expected::Text(plain.into()),
        };
        return Ok(Step::Expect { expected, within: read_within(rest, bad)? });
    }
    let mut words = text.splitn(3, char::is_whitespace);
    let number = |word: Option<&str>| word.and_then(|w| w.parse::<f64>().ok()).filter(|n| n.is_finite());
    let value = number(words.next()).ok_or_else(bad)?;
    let (tolerance, rest) = match words.next() {
        None => (0.0, String::new()),
        Some("within") => (0.0, format!("within {}", words.next().unwrap_or_default())),
        tolerance => (number(tolerance).filter(|t| *t >= 0.0).ok_or_else(bad)?, words.next().unwrap_or("").into()),
    };
    Ok(Step::Expect { expected: Expected::Number { value, tolerance }, within: read_within(rest.trim(), bad)? })
}

/// Reads `within FRAMES`, or nothing.
fn read_within(text: &str, bad: impl Fn() -> ScriptProblem) -> Result<Option<u64>, ScriptProblem> {
    if text.is_empty() {
        return Ok(None);
    }
    read_frames(text.strip_prefix("within").ok_or_else(bad)?.trim()).map(Some)
}

fn read_frames(text: &str) -> Result<u64, ScriptProblem> {
    text.parse().map_err(|_| ScriptProblem::Frames(text.into()))
}

impl Expected {
    /// Whether a message to the host is what is expected.
    pub fn is(&self, message: &[u8]) -> bool {
        match self {
            Expected::Text(text) => text == message,
            Expected::Pattern(pattern) => matches(pattern, message),
            Expected::Number { value, tolerance } => {
                let read = std::str::from_utf8(message).ok().and_then(|text| text.trim().parse::<f64>().ok());
                read.is_some_and(|number| (number - value).abs() <= *tolerance)
            }
            Expected::Error(_) | Expected::Typed(_) | Expected::None => false,
        }
    }

    /// Whether a message of the machine is what is expected.
    pub fn is_error(&self, message: &str) -> bool {
        let Expected::Error(pattern) = self else { return false };
        let longer = [pattern, &b" *"[..]].concat();
        matches(pattern, message.as_bytes()) || matches(&longer, message.as_bytes())
    }
}

impl std::fmt::Display for Expected {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        match self {
            Expected::Text(t) => write!(f, "'{}'", text(t)),
            Expected::Pattern(pattern) => write!(f, "/{}/", text(pattern)),
            Expected::Number { value, tolerance } if *tolerance == 0.0 => write!(f, "{value}"),
            Expected::Number { value, tolerance } => write!(f, "{value} within {tolerance}"),
            Expected::Error(pattern) => write!(f, "error {}", text(pattern)),
            Expected::Typed(characters) => write!(f, "typed '{}'", characters.escape_ascii()),
            Expected::None => f.write_str("no message"),
        }
    }
}
