//! The files of cases: text, line by line.

use super::case::{Case, Expected, Step, StrokeLine, Tag};
use std::fmt;

/// Largest number of an `each` step.
const MAX_EACH: usize = 1_000_000;

/// The reason why a file of cases cannot be read, with its location.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {problem}")]
pub struct CaseError {
    /// The file.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// What is wrong.
    pub problem: Problem,
}

/// What is wrong on a line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Problem {
    /// The first word of the line means nothing.
    #[error("'{0}' begins no step; see CONFORMANCE.md")]
    Unknown(String),
    /// A step or a fact outside a case.
    #[error("this line stands in no case")]
    NoCase,
    /// A case before any section.
    #[error("a case needs a 'section' line before it")]
    NoSection,
    /// Something is missing or cannot be read.
    #[error("expected {0}")]
    Expected(&'static str),
    /// Two cases with one name.
    #[error("the case '{0}' stands twice")]
    Twice(String),
    /// A case that expects nothing.
    #[error("the case '{0}' expects nothing")]
    Idle(String),
    /// A case that only expects that nothing comes.
    #[error("the case '{0}' expects only silence; a broken line would pass it, too: add what is to be heard or seen")]
    Silent(String),
    /// A wrong escape in a text.
    #[error("'\\{0}' is no escape; there are \\\\ \\r \\n \\t \\e \\s \\\" and \\xHH")]
    Escape(String),
}

/// Reads the cases of one file.
///
/// - `file`: its name, for errors and reports.
///
/// # Errors
/// [`CaseError`] for the first line that is wrong.
pub fn parse(file: &str, text: &str) -> Result<Vec<Case>, CaseError> {
    let mut reader = Reader { file, section: None, cases: Vec::new(), any_order: 0 };
    for (index, line) in text.lines().enumerate() {
        let error = |problem| CaseError { file: file.into(), line: index + 1, problem };
        reader.line(index + 1, line).map_err(error)?;
    }
    let end = text.lines().count();
    reader.finish_case().map_err(|problem| CaseError { file: file.into(), line: end, problem })?;
    Ok(reader.cases)
}

struct Reader<'f> {
    file: &'f str,
    section: Option<String>,
    cases: Vec<Case>,
    /// Expectations that still belong to the latest `<&`.
    any_order: usize,
}

impl Reader<'_> {
    fn line(&mut self, number: usize, line: &str) -> Result<(), Problem> {
        let trimmed = line.trim_start();
        if trimmed.is_empty() || trimmed.starts_with('#') {
            return Ok(());
        }
        let (word, rest) = trimmed.split_once(' ').unwrap_or((trimmed, ""));
        if self.any_order > 0 && !word.starts_with('<') {
            return Err(Problem::Expected("another expectation of '<&'"));
        }
        match word {
            "section" => {
                self.finish_case()?;
                self.section = Some(required(rest, "the section of the reference")?.into());
                return Ok(());
            }
            "case" => return self.begin_case(number, rest),
            "fact" => self.case()?.facts.push(required(rest, "the number of a fact")?.into()),
            "text-only" => self.case()?.text_only = true,
            "long" => self.case()?.is_long = true,
            "tolerance" => {
                let given = rest.trim().parse().ok().filter(|t| (0.0..1.0).contains(t));
                self.case()?.tolerance = given.ok_or(Problem::Expected("a tolerance, 0 to 1"))?;
            }
            "/" => {
                let stroke = stroke(rest)?;
                match self.case()?.steps.last_mut() {
                    Some((_, Step::Strokes { lines, .. })) => lines.push(stroke),
                    _ => return Err(Problem::Expected("'strokes' before the first '/'")),
                }
            }
            "<&" => {
                let count = rest.trim().parse().ok().filter(|n| (2..100).contains(n));
                self.any_order = count.ok_or(Problem::Expected("how many messages come in any order"))?;
                self.push(number, Step::Expect(Expected::AnyOrder(Vec::new())))?;
            }
            _ if word.starts_with('<') => self.expect(number, word, rest)?,
            _ => {
                let step = step(word, rest)?;
                self.push(number, step)?;
            }
        }
        Ok(())
    }

    fn case(&mut self) -> Result<&mut Case, Problem> {
        if self.section.is_none() {
            return Err(Problem::NoSection);
        }
        self.cases.last_mut().filter(|case| case.line > 0).ok_or(Problem::NoCase)
    }

    fn push(&mut self, number: usize, step: Step) -> Result<(), Problem> {
        self.case()?.steps.push((number, step));
        Ok(())
    }

    fn begin_case(&mut self, number: usize, rest: &str) -> Result<(), Problem> {
        self.finish_case()?;
        let section = self.section.clone().ok_or(Problem::NoSection)?;
        let mut words = rest.trim().splitn(3, ' ');
        let is_id = |id: &&str| {
            let legal = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
            !id.is_empty() && id.chars().all(legal)
        };
        let id = words.next().filter(is_id).ok_or(Problem::Expected("the name of the case"))?;
        let letter = words.next().unwrap_or_default();
        let tag = Tag::ALL.into_iter().find(|t| t.letter() == letter);
        let tag = tag.ok_or(Problem::Expected("a tag: S, M, U or C"))?;
        let title = required(words.next().unwrap_or_default(), "what the case proves")?;
        if self.cases.iter().any(|case| case.id == id) {
            return Err(Problem::Twice(id.into()));
        }
        let case = Case { file: self.file.into(), line: number, ..Case::new(id, title, &section, tag) };
        self.cases.push(case);
        Ok(())
    }

    /// Checks the case that ends here.
    fn finish_case(&mut self) -> Result<(), Problem> {
        if self.any_order > 0 {
            return Err(Problem::Expected("more expectations of '<&'"));
        }
        let expects = |step: &Step| {
            matches!(step, Step::Expect(_) | Step::Reply(_) | Step::Strokes { .. } | Step::Drop | Step::Silence)
        };
        let is_heard_or_seen = |step: &Step| match step {
            Step::Strokes { count, lines, .. } => count.is_some_and(|count| count > 0) || !lines.is_empty(),
            step => matches!(step, Step::Expect(_) | Step::Reply(_)),
        };
        match self.cases.last() {
            Some(case) if !case.steps.iter().any(|(_, s)| expects(s)) => Err(Problem::Idle(case.id.clone())),
            Some(case) if !case.steps.iter().any(|(_, s)| is_heard_or_seen(s)) => Err(Problem::Silent(case.id.clone())),
            _ => Ok(()),
        }
    }

    fn expect(&mut self, number: usize, word: &str, rest: &str) -> Result<(), Problem> {
        let expected = expectation(word, rest)?;
        if self.any_order == 0 {
            return self.push(number, Step::Expect(expected));
        }
        self.any_order -= 1;
        match self.case()?.steps.last_mut() {
            Some((_, Step::Expect(Expected::AnyOrder(all)))) => all.push(expected),
            _ => return Err(Problem::NoCase),
        }
        Ok(())
    }
}

fn required<'t>(text: &'t str, what: &'static str) -> Result<&'t str, Problem> {
    let text = text.trim();
    if text.is_empty() { Err(Problem::Expected(what)) } else { Ok(text) }
}

fn expectation(word: &str, rest: &str) -> Result<Expected, Problem> {
    Ok(match word {
        "<" => Expected::Exact(unescape(rest)?),
        "<=" => Expected::Numbers(required(rest, "words and numbers")?.into()),
        // Leading blanks belong to the message.
        "<~" => Expected::Glob(required(rest, "a pattern").map(|_| rest.into())?),
        "<!" | "<?" => {
            let class = if word == "<!" { 'E' } else { 'W' };
            let (first, text) = rest.trim().split_once(' ').unwrap_or((rest.trim(), ""));
            let (number, text) = match first.parse() {
                Ok(number) => (Some(number), text.trim()),
                Err(_) => (None, rest.trim()),
            };
            Expected::Fault { class, number, text: (!text.is_empty()).then(|| text.into()) }
        }
        other => return Err(Problem::Unknown(other.into())),
    })
}

fn step(word: &str, rest: &str) -> Result<Step, Problem> {
    Ok(match word {
        ">" => Step::Send(format!("{rest}\n")),
        "raw" => Step::Raw(quoted(rest)?),
        "each" => each(rest)?,
        "watch" => watch(rest)?,
        "@" => Step::OperatorCommand(required(rest, "an order of the operator")?.into()),
        "@~" => Step::Reply(required(rest, "a pattern")?.into()),
        "frames" => Step::Frames(rest.trim().parse().map_err(|_| Problem::Expected("a number of frames"))?),
        "strokes" => strokes(rest.trim())?,
        "drop" => Step::Drop,
        "quiet" => Step::Silence,
        other => return Err(Problem::Unknown(other.into())),
    })
}

/// Bytes in double quotes, with escapes.
fn quoted(text: &str) -> Result<Vec<u8>, Problem> {
    let inside = text.trim().strip_prefix('"').and_then(|text| text.strip_suffix('"'));
    unescape(inside.ok_or(Problem::Expected("bytes in double quotes"))?)
}

/// `FIRST LAST TEXT`
fn each(rest: &str) -> Result<Step, Problem> {
    const FORM: Problem = Problem::Expected("the first and the last number, then commands with #");
    let mut words = rest.trim_start().splitn(3, ' ');
    let mut number = || words.next().and_then(|word| word.parse::<usize>().ok());
    let (first, last) = (number().ok_or(FORM)?, number().ok_or(FORM)?);
    let text = words.next().filter(|_| first <= last && last <= MAX_EACH).ok_or(FORM)?;
    Ok(Step::Each { first, last, text: format!("{text}\n") })
}

/// `[N [over M]]`
fn strokes(rest: &str) -> Result<Step, Problem> {
    let (count, frames) = rest.split_once(" over ").unwrap_or((rest, "1"));
    let frames = frames.trim().parse().ok().filter(|frames| (1..10_000).contains(frames));
    let count = match count.trim() {
        "" => None,
        count => Some(count.parse().map_err(|_| Problem::Expected("a number of strokes"))?),
    };
    let frames = frames.ok_or(Problem::Expected("a number of frames behind 'over'"))?;
    Ok(Step::Strokes { count, frames, lines: Vec::new() })
}

/// `NAME<output> [as WORD]`
fn watch(rest: &str) -> Result<Step, Problem> {
    const FORM: Problem = Problem::Expected("NAME<output>, or NAME<output> as WORD");
    let (source, word) = match rest.trim().split_once(" as ") {
        Some((source, word)) => (source.trim(), Some(word.trim().to_string())),
        None => (rest.trim(), None),
    };
    let (name, output) = source.strip_suffix('>').and_then(|s| s.split_once('<')).ok_or(FORM)?;
    let output = output.trim().parse().map_err(|_| FORM)?;
    Ok(Step::Watch { name: name.trim().into(), output, word })
}

/// `x,y [x,y [i,i [r,g,b]]]`
fn stroke(rest: &str) -> Result<StrokeLine, Problem> {
    const FORM: Problem = Problem::Expected("x,y of the start, x,y of the end, intensities, red,green,blue");
    let numbers: Result<Vec<f64>, _> = rest.split([',', ' ']).filter(|w| !w.is_empty()).map(str::parse).collect();
    let n = numbers.map_err(|_| FORM)?;
    let start = [*n.first().ok_or(FORM)?, *n.get(1).ok_or(FORM)?];
    Ok(match n.len() {
        2 => StrokeLine { start, end: start, intensity: None, color: None },
        4 => StrokeLine { start, end: [n[2], n[3]], intensity: None, color: None },
        6 => StrokeLine { start, end: [n[2], n[3]], intensity: Some([n[4], n[5]]), color: None },
        9 => {
            let (intensity, color) = (Some([n[4], n[5]]), Some([n[6], n[7], n[8]]));
            StrokeLine { start, end: [n[2], n[3]], intensity, color }
        }
        _ => return Err(FORM),
    })
}

/// The bytes of a text with escapes.
fn unescape(text: &str) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('\\') {
        bytes.extend_from_slice(before.as_bytes());
        let c = after.chars().next().unwrap_or(' ');
        let mut taken = c.len_utf8().min(after.len());
        match c {
            '\\' | '"' => bytes.push(c as u8),
            'r' => bytes.push(b'\r'),
            'n' => bytes.push(b'\n'),
            't' => bytes.push(b'\t'),
            'e' => bytes.push(0x1b),
            's' => bytes.push(b' '),
            'x' => {
                let byte = after.get(1..3).and_then(|digits| u8::from_str_radix(digits, 16).ok());
                bytes.push(byte.ok_or_else(|| Problem::Escape(after.chars().take(3).collect()))?);
                taken = 3;
            }
            other => return Err(Problem::Escape(other.to_string())),
        }
        rest = &after[taken..];
    }
    bytes.extend_from_slice(rest.as_bytes());
    Ok(bytes)
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Expected::Exact(bytes) => write!(f, "\"{}\"", bytes.escape_ascii()),
            Expected::Numbers(text) => write!(f, "the words and numbers {text}"),
            Expected::Glob(glob) => write!(f, "a message like {glob}"),
            Expected::Fault { class, number, text } => {
                write!(f, "{}", if *class == 'E' { "an error" } else { "a warning" })?;
                number.map_or(Ok(()), |n| write!(f, " with number {n}"))?;
                text.as_ref().map_or(Ok(()), |t| write!(f, " like {t}"))
            }
            Expected::AnyOrder(all) => write!(f, "{} messages in any order", all.len()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{super::case::with_number, *};

    fn one(text: &str) -> Result<Vec<Case>, String> {
        parse("f", text).map_err(|e| e.to_string())
    }

    #[test]
    fn a_case_has_a_section_a_tag_and_steps_with_their_lines() {
        let text = "section B.4\n# a comment\ncase a-b S It does\n fact 3.4\n tolerance 0.01\n\n> A;\n  >B := F:NOP;\n";
        assert_eq!(one(text).unwrap_err(), "f:8: '>B' begins no step; see CONFORMANCE.md");
        let cases = one("section B.4\ncase a-b S It does\n fact 3.4\n> A;\n< x\\x41\\s\n").unwrap();
        let case = &cases[0];
        assert_eq!((case.id.as_str(), case.section.as_str(), case.tag), ("a-b", "B.4", Tag::S));
        assert_eq!((case.title.as_str(), case.facts[0].as_str(), case.line), ("It does", "3.4", 2));
        assert_eq!(case.steps[0], (4, Step::Send("A;\n".into())));
        assert_eq!(case.steps[1], (5, Step::Expect(Expected::Exact(b"xA ".to_vec()))));
    }

    #[test]
    fn wrong_lines_are_named() {
        for (text, error) in [
            ("case a M x\n", "f:1: a case needs a 'section' line before it"),
            ("section B\n> x\n", "f:2: this line stands in no case"),
            ("section B\ncase a X y\n", "f:2: expected a tag: S, M, U or C"),
            ("section B\ncase a M\n", "f:2: expected what the case proves"),
            ("section B\ncase a M x\n> y\n", "f:3: the case 'a' expects nothing"),
            (
                "section B\ncase a M x\n> y\nquiet\n",
                "f:4: the case 'a' expects only silence; a broken line would pass it, too: add what is to be heard or seen",
            ),
            ("section B\ncase a M x\n< y\ncase a M x\n< z", "f:4: the case 'a' stands twice"),
            (
                "section B\ncase a M x\n< \\q",
                "f:3: '\\q' is no escape; there are \\\\ \\r \\n \\t \\e \\s \\\" and \\xHH",
            ),
            ("section B\ncase a M x\n/ 0,0\n", "f:3: expected 'strokes' before the first '/'"),
            ("section B\ncase a M x\n<& 2\n< y\n> z", "f:5: expected another expectation of '<&'"),
            ("section B\ncase a M x\n<& 2\n< y\n", "f:4: expected more expectations of '<&'"),
            (
                "section B\ncase a M x\neach 2 1 A#\n",
                "f:3: expected the first and the last number, then commands with #",
            ),
            ("section B\ncase a M x\nwatch A\n", "f:3: expected NAME<output>, or NAME<output> as WORD"),
        ] {
            assert_eq!(one(text).unwrap_err(), error, "{text}");
        }
    }

    #[test]
    fn each_repeats_commands_with_a_number_and_the_next() {
        let case = one("section B\ncase a M x\neach 8 10 A# := INSTANCE OF A##;\n< y\n").unwrap().remove(0);
        let Step::Each { first: 8, last: 10, text } = &case.steps[0].1 else { panic!("{:?}", case.steps[0]) };
        assert_eq!(with_number(text, 9), "A9 := INSTANCE OF A10;\n");
        assert_eq!(case.text(), "A8 := INSTANCE OF A9;\n");
    }

    #[test]
    fn a_case_may_be_long() {
        assert!(one("section B\ncase a M x\nlong\n< y\n").unwrap()[0].is_long);
        assert!(!one("section B\ncase a M x\n< y\n").unwrap()[0].is_long);
    }

    #[test]
    fn expectations_and_strokes_are_read() {
        let text = "section B\ncase a M x\n<! 2 *found*\n<? 3\n<!\n<\nstrokes 2\n/ 0.5,0\n/ 0,0 1,1 1,0.5 1,0,0\n<& 2\n< a\n< b\n";
        let steps: Vec<Step> = one(text).unwrap().remove(0).steps.into_iter().map(|(_, step)| step).collect();
        let fault = |class, number, text: Option<&str>| {
            Step::Expect(Expected::Fault { class, number, text: text.map(Into::into) })
        };
        assert_eq!(steps[0], fault('E', Some(2), Some("*found*")));
        assert_eq!(steps[1], fault('W', Some(3), None));
        assert_eq!(steps[2], fault('E', None, None));
        assert_eq!(steps[3], Step::Expect(Expected::Exact(Vec::new())));
        let Step::Strokes { count: Some(2), frames: 1, lines } = &steps[4] else { panic!("{:?}", steps[4]) };
        assert_eq!((lines[0].start, lines[0].end), ([0.5, 0.0], [0.5, 0.0]));
        assert_eq!((lines[1].intensity, lines[1].color), (Some([1.0, 0.5]), Some([1.0, 0.0, 0.0])));
        let both = [Expected::Exact(b"a".to_vec()), Expected::Exact(b"b".to_vec())];
        assert_eq!(steps[5], Step::Expect(Expected::AnyOrder(both.to_vec())));
    }
}
