//! The files that are read, and locations in them.

use crate::operator::parse;
use protocol::capture::{CaptureReader, Event, Record, is_capture};
use protocol::command::token::{Lexer, TokenKind};
use std::ops::Range;

/// A location in the files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Location {
    /// The file.
    pub(super) file: usize,
    /// Offset in it, in bytes.
    pub(super) at: usize,
}

/// A file.
#[derive(Clone, Debug)]
pub(super) struct SourceFile {
    pub(super) name: String,
    /// The text; lines of directives for the player, and all of a capture, are blank.
    pub(super) text: Vec<u8>,
    /// Where each line begins.
    lines: Vec<usize>,
    /// Operator commands of directives or of a capture that write files or end the machine, and where they stand.
    pub(super) outgoing: Vec<(usize, String)>,
}

impl SourceFile {
    /// A file as it was read.
    pub(super) fn new(name: &str, text: &[u8]) -> SourceFile {
        let mut text = text.to_vec();
        let (mut lines, mut outgoing) = (vec![0], Vec::new());
        let is_capture = is_capture(&text);
        let mut records = CaptureReader::default();
        for line in text.split_inclusive_mut(|byte| *byte == b'\n') {
            let begin = *lines.last().unwrap_or(&0);
            lines.push(begin + line.len());
            let mut note = |order: &str| {
                if parse(order).is_ok_and(|order| order.reaches_out()) {
                    outgoing.push((begin, order.to_owned()));
                }
            };
            if is_capture {
                records.push(line);
                for record in records.by_ref() {
                    if let Ok(Record { event: Event::OperatorCommand(order), .. }) = record {
                        note(&order);
                    }
                }
            } else if line.first() == Some(&b'@') {
                note(String::from_utf8_lossy(&line[1..]).trim());
            }
            if is_capture || line.first() == Some(&b'@') {
                let end = line.iter().rposition(|byte| *byte != b'\n').map_or(0, |last| last + 1);
                line[..end].fill(b' ');
            }
        }
        SourceFile { name: name.into(), text, lines, outgoing }
    }

    /// Line and column of an offset, from 1.
    pub(super) fn line_and_column(&self, at: usize) -> (usize, usize) {
        let line = self.lines.partition_point(|start| *start <= at).max(1);
        (line, at - self.lines[line - 1] + 1)
    }
}

/// The offset of a name in a command, from its beginning; the beginning if it does not stand there.
pub(super) fn first_offset(command: &[u8], name: &str) -> usize {
    occurrences(command, name).next().map_or(0, |span| span.start)
}

/// The last offset of a name in a command.
pub(super) fn last_offset(command: &[u8], name: &str) -> usize {
    occurrences(command, name).last().map_or(0, |span| span.start)
}

fn occurrences<'t>(command: &'t [u8], name: &str) -> impl Iterator<Item = Range<usize>> + use<'t> {
    let name = name.to_owned();
    let mut lexer = Lexer::new(command, 0);
    let tokens = std::iter::from_fn(move || Some(lexer.token()).filter(|token| token.kind != TokenKind::End));
    let names = tokens.filter(|token| token.kind == TokenKind::Name).map(|token| token.span());
    names.filter(move |span| command[span.clone()].eq_ignore_ascii_case(name.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_become_lines_and_columns_and_directives_are_blank() {
        let source = SourceFile::new("f", b"A;\n@ dial 1 1\n B;");
        assert_eq!(source.text, b"A;\n          \n B;");
        assert_eq!(source.line_and_column(0), (1, 1));
        assert_eq!(source.line_and_column(2), (1, 3));
        assert_eq!(source.line_and_column(15), (3, 2));
    }

    #[test]
    fn names_are_found_outside_of_texts_and_comments() {
        let command = b"CONNECT { a } A<1>:<1>AB, <2>'a' a";
        assert_eq!((first_offset(command, "A"), last_offset(command, "A")), (14, 33));
        assert_eq!(first_offset(command, "NONE"), 0);
    }
}
