//! Tokens of the command language, with the bytes that they span.

use super::{error::Problem, number::Decimal};
use crate::name::is_name_character;
use std::ops::Range;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// A name or a keyword.
    Name,
    /// A number.
    Number(Decimal),
    /// A text in quotes.
    String,
    /// `:=`
    Assign,
    /// `:`
    Colon,
    /// `,`
    Comma,
    /// `=`
    Equal,
    /// `<`
    Less,
    /// `>`
    Greater,
    /// `(`
    Open,
    /// `)`
    Close,
    /// `*`
    Star,
    /// `/`
    Slash,
    /// `!`
    Bang,
    /// `[`
    OpenBracket,
    /// `]`
    CloseBracket,
    /// `->`
    Arrow,
    /// `;`
    Semicolon,
    /// The end of the text.
    End,
    /// Bytes that are no token.
    Bad(Problem),
}

/// A token and its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// What it is.
    pub kind: TokenKind,
    /// Offset of its first byte.
    pub start: usize,
    /// Offset after its last byte.
    pub end: usize,
}

impl Token {
    /// Its bytes.
    pub fn span(&self) -> Range<usize> {
        self.start..self.end
    }
}

/// Cuts a text into tokens; blanks, control characters and comments stand between them.
#[derive(Clone, Copy, Debug)]
pub struct Lexer<'t> {
    text: &'t [u8],
    at: usize,
}

impl<'t> Lexer<'t> {
    /// A lexer of `text` from offset `at` on.
    pub fn new(text: &'t [u8], at: usize) -> Self {
        Lexer { text, at: at.min(text.len()) }
    }

    /// The text.
    pub fn text(&self) -> &'t [u8] {
        self.text
    }

    /// The next token; [`TokenKind::End`] for ever at the end.
    pub fn token(&mut self) -> Token {
        let start = match blanks(self.text, self.at) {
            Ok(start) => start,
            Err(open) => return self.cut(open, self.text.len(), TokenKind::Bad(Problem::OpenComment)),
        };
        let Some(&byte) = self.text.get(start) else {
            return self.cut(start, start, TokenKind::End);
        };
        let single = match byte {
            b'A'..=b'Z' | b'a'..=b'z' => {
                let length = self.text[start..].iter().position(|&b| !is_name_character(b));
                let end = length.map_or(self.text.len(), |length| start + length);
                return self.cut(start, end, TokenKind::Name);
            }
            b'-' if self.text.get(start + 1) == Some(&b'>') => return self.cut(start, start + 2, TokenKind::Arrow),
            _ if Decimal::begins_with(byte) => return self.number(start),
            b'\'' => return self.string(start),
            b':' if self.text.get(start + 1) == Some(&b'=') => return self.cut(start, start + 2, TokenKind::Assign),
            b':' => TokenKind::Colon,
            b',' => TokenKind::Comma,
            b'=' => TokenKind::Equal,
            b'<' => TokenKind::Less,
            b'>' => TokenKind::Greater,
            b'(' => TokenKind::Open,
            b')' => TokenKind::Close,
            b'*' => TokenKind::Star,
            b'/' => TokenKind::Slash,
            b'!' => TokenKind::Bang,
            b'[' => TokenKind::OpenBracket,
            b']' => TokenKind::CloseBracket,
            b';' => TokenKind::Semicolon,
            _ => TokenKind::Bad(Problem::BadCharacter),
        };
        self.cut(start, start + 1, single)
    }

    fn cut(&mut self, start: usize, end: usize, kind: TokenKind) -> Token {
        self.at = end;
        Token { kind, start, end }
    }

    fn number(&mut self, start: usize) -> Token {
        if let Some((decimal, end)) = Decimal::scan(self.text, start) {
            return self.cut(start, end, TokenKind::Number(decimal));
        }
        let rest = &self.text[start..];
        let length = rest.iter().position(|&b| !Decimal::begins_with(b)).unwrap_or(rest.len());
        self.cut(start, start + length, TokenKind::Bad(Problem::BadNumber))
    }

    fn string(&mut self, start: usize) -> Token {
        let mut at = start + 1;
        while let Some(length) = self.text[at..].iter().position(|&b| b == b'\'') {
            at += length + 1;
            if self.text.get(at) != Some(&b'\'') {
                return self.cut(start, at, TokenKind::String);
            }
            at += 1;
        }
        self.cut(start, self.text.len(), TokenKind::Bad(Problem::OpenString))
    }
}

/// The offset of the first byte from `at` on that is no blank, control character or comment. An error is the offset of
/// a comment that does not end.
#[inline]
pub(super) fn blanks(text: &[u8], mut at: usize) -> Result<usize, usize> {
    loop {
        match text.get(at) {
            Some(b'\0'..=b' ' | b'\x7f') => at += 1,
            Some(b'{') => match text[at..].iter().position(|&b| b == b'}') {
                Some(length) => at += length + 1,
                None => return Err(at),
            },
            _ => return Ok(at),
        }
    }
}

/// The text of a string token: without its quotes, doubled quotes as one.
pub fn unquoted(token: &[u8]) -> Box<[u8]> {
    let inner = token.strip_prefix(b"'").unwrap_or(token);
    let inner = inner.strip_suffix(b"'").unwrap_or(inner);
    let mut text = Vec::with_capacity(inner.len());
    let mut rest = inner;
    while let Some(at) = rest.iter().position(|&b| b == b'\'') {
        text.extend_from_slice(&rest[..=at]);
        rest = rest.get(at + 2..).unwrap_or(&[]);
    }
    text.extend_from_slice(rest);
    text.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Vec<(TokenKind, &str)> {
        let mut lexer = Lexer::new(text.as_bytes(), 0);
        std::iter::from_fn(|| Some(lexer.token()).filter(|token| token.kind != TokenKind::End))
            .map(|token| (token.kind, &text[token.span()]))
            .collect()
    }

    #[test]
    fn a_connection_is_cut_into_its_tokens() {
        let texts: Vec<&str> = tokens("CONNECT A.B<1>:<append>c$_1;").into_iter().map(|t| t.1).collect();
        assert_eq!(texts, ["CONNECT", "A.B", "<", "1", ">", ":", "<", "append", ">", "c$_1", ";"]);
    }

    #[test]
    fn an_arrow_is_one_token_and_no_sign_of_a_number() {
        let kinds: Vec<TokenKind> = tokens("[1]->A/!").into_iter().map(|t| t.0).collect();
        assert!(matches!(
            kinds[..],
            [
                TokenKind::OpenBracket,
                TokenKind::Number(_),
                TokenKind::CloseBracket,
                TokenKind::Arrow,
                TokenKind::Name,
                TokenKind::Slash,
                TokenKind::Bang
            ]
        ));
    }

    #[test]
    fn comments_and_control_characters_are_blanks() {
        let texts: Vec<&str> = tokens("A{;'}:={x{y}\x00\x0f1:-2").into_iter().map(|t| t.1).collect();
        assert_eq!(texts, ["A", ":=", "1", ":", "-2"]);
    }

    #[test]
    fn doubled_quotes_are_one() {
        assert_eq!(tokens("'it''s'';' x")[0], (TokenKind::String, "'it''s'';'"));
        assert_eq!(*unquoted(b"'it''s'';'"), *b"it's';");
        assert_eq!(*unquoted(b"''"), *b"");
        assert_eq!(*unquoted(b"''''"), *b"'");
    }

    #[test]
    fn what_is_no_token_says_why() {
        assert_eq!(tokens("#")[0].0, TokenKind::Bad(Problem::BadCharacter));
        assert_eq!(tokens("+-3 4"), [(TokenKind::Bad(Problem::BadNumber), "+-3"), tokens("4")[0]]);
        assert_eq!(tokens("'a''").last(), Some(&(TokenKind::Bad(Problem::OpenString), "'a''")));
        assert_eq!(tokens("A {b"), [(TokenKind::Name, "A"), (TokenKind::Bad(Problem::OpenComment), "{b")]);
    }
}
