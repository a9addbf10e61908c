//! The cursor of the parser: the tokens of one statement, with one token of lookahead, and the words tried in vain.

use crate::command::{
    error::{Fault, Problem},
    spelling::edits,
    token::{Lexer, Token, TokenKind},
    words::Word,
};

/// The tokens of one statement.
pub(in crate::command) struct Parser<'t> {
    pub(super) lexer: Lexer<'t>,
    pub(super) token: Token,
    /// Where the last token that was taken begins and ends.
    pub(super) last_start: usize,
    pub(super) last_end: usize,
    missed: TriedWords,
    /// What was left out of the command.
    pub(super) warnings: Vec<Fault>,
}

/// The words that the current token was compared with; what an error suggests comes from them.
#[derive(Clone, Copy, Default)]
struct TriedWords {
    lists: [&'static [Word]; TriedWords::MAX_TRIED],
    count: usize,
}

impl TriedWords {
    /// Lists that are kept for one token; those that come later are forgotten.
    const MAX_TRIED: usize = 12;

    fn note(&mut self, words: &'static [Word]) {
        if let Some(list) = self.lists.get_mut(self.count) {
            *list = words;
            self.count += 1;
        }
    }

    /// What is wrong with a word that is none of the lists.
    fn problem(&self, text: &[u8]) -> Problem {
        let words = || self.lists[..self.count].iter().copied().flatten().copied();
        let begins = |word: &Word| {
            let form = word.form().as_bytes();
            // One letter is rather a name than the beginning of a word.
            (2..word.shortest()).contains(&text.len()) && form[..text.len()].eq_ignore_ascii_case(text)
        };
        if let Some(word) = words().filter(begins).min_by_key(|word| word.shortest()) {
            return Problem::TooShort(word);
        }
        let near = words().filter_map(|word| Some((edits(text, word.form().as_bytes())?, word)));
        near.min_by_key(|(edits, _)| *edits).map_or(Problem::Unexpected, |(_, word)| Problem::Misspelt(word))
    }
}

impl<'t> Parser<'t> {
    /// A parser of `text` from offset `at` on.
    pub(super) fn new(text: &'t [u8], at: usize) -> Self {
        let mut lexer = Lexer::new(text, at);
        let token = lexer.token();
        Parser { lexer, token, last_start: at, last_end: at, missed: TriedWords::default(), warnings: Vec::new() }
    }

    /// Takes the current token.
    pub(super) fn advance(&mut self) -> Token {
        self.last_start = self.token.start;
        self.last_end = self.token.end;
        self.missed.count = 0;
        std::mem::replace(&mut self.token, self.lexer.token())
    }

    /// Continues at offset `at` of the text.
    pub(super) fn jump(&mut self, at: usize) {
        self.last_end = at;
        self.missed.count = 0;
        self.lexer = Lexer::new(self.lexer.text(), at);
        self.token = self.lexer.token();
    }

    /// The token after the current one.
    pub(super) fn ahead(&self) -> Token {
        { self.lexer }.token()
    }

    pub(super) fn text(&self, token: Token) -> &'t [u8] {
        &self.lexer.text()[token.span()]
    }

    /// Whether nothing but the end of the statement follows `kind`.
    pub(super) const fn ends(kind: TokenKind) -> bool {
        matches!(kind, TokenKind::Semicolon | TokenKind::End)
    }

    /// The fault that the current token is not what was expected.
    pub(in crate::command) fn fail(&self, expected: &'static [&'static str]) -> Fault {
        let problem = match self.token.kind {
            TokenKind::Bad(problem) => problem,
            TokenKind::Name => self.missed.problem(self.text(self.token)),
            _ => Problem::Unexpected,
        };
        Fault { span: self.token.span(), problem, expected }
    }

    /// The fault that the current token is understood and not allowed.
    pub(in crate::command) fn refuse(&self, problem: Problem) -> Fault {
        Fault { span: self.token.span(), problem, expected: &[] }
    }

    pub(in crate::command) fn accept(&mut self, kind: TokenKind) -> bool {
        let found = self.token.kind == kind;
        if found {
            self.advance();
        }
        found
    }

    pub(in crate::command) fn expect(
        &mut self,
        kind: TokenKind,
        expected: &'static [&'static str],
    ) -> Result<(), Fault> {
        if self.accept(kind) { Ok(()) } else { Err(self.fail(expected)) }
    }

    /// Whether the current token is a word.
    pub(in crate::command) fn is(&mut self, word: Word) -> bool {
        self.find(word.alone()).is_some()
    }

    /// The one of some words that the current token is.
    pub(in crate::command) fn find(&mut self, words: &'static [Word]) -> Option<Word> {
        if self.token.kind != TokenKind::Name {
            return None;
        }
        let found = Word::find(words, self.text(self.token));
        if found.is_none() {
            self.missed.note(words);
        }
        found
    }

    pub(in crate::command) fn accept_word(&mut self, word: Word) -> bool {
        self.accept_one_of(word.alone()).is_some()
    }

    /// Takes the current token if it is one of some words.
    pub(in crate::command) fn accept_one_of(&mut self, words: &'static [Word]) -> Option<Word> {
        let word = self.find(words)?;
        self.advance();
        Some(word)
    }

    pub(in crate::command) fn expect_word(
        &mut self,
        word: Word,
        expected: &'static [&'static str],
    ) -> Result<(), Fault> {
        if self.accept_word(word) { Ok(()) } else { Err(self.fail(expected)) }
    }

    /// Takes the current token if it is one of some words, or fails with what was expected.
    pub(in crate::command) fn expect_one_of(
        &mut self,
        words: &'static [Word],
        expected: &'static [&'static str],
    ) -> Result<Word, Fault> {
        self.accept_one_of(words).ok_or_else(|| self.fail(expected))
    }

    /// Skips a word without meaning before a name; it is itself the name if none follows.
    pub(super) fn skip_before_name(&mut self, word: Word) {
        if self.is(word) && matches!(self.ahead().kind, TokenKind::Name | TokenKind::Less) {
            self.advance();
        }
    }

    /// Takes a letter that stands before a number, also directly (`S1,2,3`).
    pub(super) fn accept_letter(&mut self, letter: Word) -> bool {
        if self.token.kind != TokenKind::Name {
            return false;
        }
        let text = self.text(self.token);
        let found = text[..1].eq_ignore_ascii_case(letter.form().as_bytes())
            && text.get(1).is_none_or(|b| b.is_ascii_digit() || *b == b'.');
        if found {
            self.jump(self.token.start + 1);
        }
        found
    }
}
