//! The text of a grammar as statements, and a cursor that reads one.

use super::error::{GrammarError, GrammarProblem, TextPlace};

/// Most letters of a grammar.
const MOST_LETTERS: usize = 1 << 20;
/// Letters of what was found that a message shows.
const SHOWN: usize = 20;
/// Signs that may part a predecessor from its successor; the longer stands first.
const ARROWS: [&str; 3] = ["-->", "->", "→"];

/// A statement: letters with their places. Comments are left out, and lines that go on are joined by a blank.
#[derive(Clone, Debug)]
pub(super) struct Statement {
    letters: Vec<(char, TextPlace)>,
}

/// Divides a text into statements. A statement begins in the first column; lines that begin with a blank go on with it.
/// `#` with a blank or the end of the line after it begins a comment.
pub(super) fn statements(text: &str) -> Result<Vec<Statement>, GrammarError> {
    if text.chars().nth(MOST_LETTERS).is_some() {
        let problem = GrammarProblem::TooMany { what: "letters", most: MOST_LETTERS };
        return Err(GrammarError { place: TextPlace { line: 1, column: 1 }, problem });
    }
    let mut statements: Vec<Statement> = Vec::new();
    for (line, content) in text.lines().enumerate() {
        let comment =
            content.match_indices('#').find(|(at, _)| content[at + 1..].chars().next().is_none_or(char::is_whitespace));
        let content = comment.map_or(content, |(at, _)| &content[..at]).trim_end();
        if content.is_empty() {
            continue;
        }
        let at = |column: usize| TextPlace { line: line as u32 + 1, column: column as u32 + 1 };
        let letters = content.chars().enumerate().map(|(column, letter)| (letter, at(column)));
        match statements.last_mut().filter(|_| content.starts_with(char::is_whitespace)) {
            Some(statement) => statement.letters.extend(letters),
            None => statements.push(Statement { letters: letters.collect() }),
        }
    }
    Ok(statements)
}

impl Statement {
    /// A cursor before its first letter.
    pub fn cursor(&self) -> Cursor<'_> {
        Cursor { letters: &self.letters, next: 0 }
    }

    /// Whether it holds an arrow, as productions do.
    pub fn has_arrow(&self) -> bool {
        let mut cursor = self.cursor();
        while cursor.next < self.letters.len() {
            if cursor.is_at_arrow() {
                return true;
            }
            cursor.next += 1;
        }
        false
    }
}

/// A place in a statement that is being read.
#[derive(Clone, Debug)]
pub(super) struct Cursor<'a> {
    letters: &'a [(char, TextPlace)],
    next: usize,
}

impl Cursor<'_> {
    /// The next letter, blanks included.
    pub fn peek(&self) -> Option<char> {
        self.letters.get(self.next).map(|(letter, _)| *letter)
    }

    /// Passes over the next letter.
    pub fn advance(&mut self) {
        self.next += 1;
    }

    /// Passes over the next letter, and hands on what it was read as.
    pub fn advance_over<T>(&mut self, read: T) -> T {
        self.advance();
        read
    }

    /// Passes over blanks.
    pub fn skip_blanks(&mut self) {
        while self.peek().is_some_and(char::is_whitespace) {
            self.next += 1;
        }
    }

    /// Whether nothing but blanks is left.
    pub fn is_at_end(&mut self) -> bool {
        self.skip_blanks();
        self.peek().is_none()
    }

    /// Where the next letter stands; the last letter at the end.
    pub fn place(&self) -> TextPlace {
        let last =
            || self.letters.last().map(|(_, TextPlace { line, column })| TextPlace { line: *line, column: column + 1 });
        self.letters.get(self.next).map(|(_, place)| *place).or_else(last).unwrap_or_default()
    }

    /// Whether these letters come next.
    pub fn is_at(&self, text: &str) -> bool {
        let mut letters = self.letters[self.next.min(self.letters.len())..].iter();
        text.chars().all(|wanted| letters.next().is_some_and(|(letter, _)| *letter == wanted))
    }

    /// Whether an arrow comes next.
    pub fn is_at_arrow(&self) -> bool {
        ARROWS.iter().any(|arrow| self.is_at(arrow))
    }

    /// Passes over these letters if they come next, after blanks.
    pub fn take(&mut self, text: &str) -> bool {
        self.skip_blanks();
        let found = self.is_at(text);
        if found {
            self.next += text.chars().count();
        }
        found
    }

    /// Passes over an arrow if one comes next, after blanks.
    pub fn take_arrow(&mut self) -> bool {
        ARROWS.iter().any(|arrow| self.take(arrow))
    }

    /// Passes over words that are parted by blanks, if they come next and a `:` after them; over that, too.
    pub fn take_heading(&mut self, heading: &str) -> bool {
        let before = self.next;
        let found = heading.split(' ').all(|word| self.take(word)) && self.take(":");
        if !found {
            self.next = before;
        }
        found
    }

    /// Passes over letters that must come next, after blanks.
    pub fn require(&mut self, text: &str) -> Result<(), GrammarError> {
        if self.take(text) { Ok(()) } else { Err(self.expected(&format!("`{text}`"))) }
    }

    /// Requires that nothing is left.
    pub fn require_end(&mut self) -> Result<(), GrammarError> {
        if self.is_at_end() { Ok(()) } else { Err(self.expected("the end of the statement")) }
    }

    /// A name of letters, digits and `_` that begins with no digit, after blanks; none if there is none.
    pub fn take_name(&mut self) -> Option<String> {
        self.skip_blanks();
        self.peek().filter(|letter| letter.is_alphabetic() || *letter == '_')?;
        let mut name = String::new();
        while let Some(letter) = self.peek().filter(|letter| letter.is_alphanumeric() || *letter == '_') {
            name.push(letter);
            self.next += 1;
        }
        Some(name)
    }

    /// A number without a sign, after blanks; none if there is none.
    pub fn take_number(&mut self) -> Result<Option<f64>, GrammarError> {
        self.skip_blanks();
        let at = |cursor: &Cursor, ahead: usize| cursor.letters.get(cursor.next + ahead).map(|(letter, _)| *letter);
        let is_digit = |letter: Option<char>| letter.is_some_and(|letter| letter.is_ascii_digit());
        if !(is_digit(self.peek()) || self.peek() == Some('.') && is_digit(at(self, 1))) {
            return Ok(None);
        }
        let before = self.clone();
        let mut text = String::new();
        while let Some(letter) = self.peek() {
            let is_exponent = matches!(letter, 'e' | 'E')
                && (is_digit(at(self, 1)) || matches!(at(self, 1), Some('+' | '-')) && is_digit(at(self, 2)));
            if is_exponent {
                text.extend(at(self, 1).map(|second| [letter, second]).into_iter().flatten());
                self.next += 2;
            } else if letter.is_ascii_digit() || letter == '.' {
                text.push(letter);
                self.next += 1;
            } else {
                break;
            }
        }
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(before.expected("a finite number")),
        }
    }

    /// A text in double quotes, after blanks; none if there is none.
    pub fn take_quoted(&mut self) -> Result<Option<String>, GrammarError> {
        if !self.take("\"") {
            return Ok(None);
        }
        let mut text = String::new();
        while let Some(letter) = self.peek() {
            self.next += 1;
            if letter == '"' {
                return Ok(Some(text));
            }
            text.push(letter);
        }
        Err(self.expected("`\"` at the end of the text"))
    }

    /// The fault that something else comes next.
    pub fn expected(&self, expected: &str) -> GrammarError {
        let mut shown = self.clone();
        shown.skip_blanks();
        let rest = &shown.letters[shown.next.min(shown.letters.len())..];
        let word: String =
            rest.iter().map(|(letter, _)| *letter).take_while(|c| !c.is_whitespace()).take(SHOWN).collect();
        let found = if word.is_empty() { "the end of the statement".into() } else { format!("`{word}`") };
        let problem = GrammarProblem::Expected { expected: expected.into(), found };
        GrammarError { place: shown.place(), problem }
    }

    /// A fault at the next letter.
    pub fn fault(&self, problem: GrammarProblem) -> GrammarError {
        GrammarError { place: self.place(), problem }
    }
}
