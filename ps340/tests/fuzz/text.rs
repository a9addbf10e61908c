//! Target: the text parser, the printer, and the reader that finds statements in a stream.

use crate::{campaign::Target, chance::Chance, pool::Features, seeds, vocabulary::pairs};
use protocol::command::{Command, CommandError, CommandReader, Spanned, parse, print, reference::name_of};

pub static TEXT: Target = Target { name: "text", seeds: seeds::texts, run };

type Item = Result<Spanned<Command>, CommandError>;

fn run(input: &[u8], features: &mut Features) {
    let (whole, open) = read(&[input]);
    let mut chance = Chance::new(input.len() as u64);
    let longest = 1 + chance.below(60);
    let mut pieces = Vec::new();
    let mut rest = input;
    while !rest.is_empty() {
        let (piece, behind) = rest.split_at((1 + chance.below(longest)).min(rest.len()));
        pieces.push(piece);
        rest = behind;
    }
    let (cut, open_cut) = read(&pieces);
    assert_eq!(whole, cut, "the same commands however the text is cut");
    assert_eq!(open, open_cut, "the same unfinished statement however the text is cut");
    for item in &whole {
        observe(item, features);
        if let Ok(item) = item {
            check(&item.command);
        }
    }
    if let Ok(command) = parse(input) {
        check(&command);
    }
}

/// What the reader gives, and whether something is left unfinished.
fn read(pieces: &[&[u8]]) -> (Vec<Item>, bool) {
    let mut reader = CommandReader::default();
    let mut items = Vec::new();
    for piece in pieces {
        reader.push(piece);
        while let Some(item) = reader.next() {
            let statement = reader.statement();
            match &item {
                Ok(item) => assert!(item.span.start <= item.span.end && item.span.end <= statement.len()),
                Err(error) => assert!(error.span.end <= statement.len() || statement.is_empty(), "{error:?}"),
            }
            items.push(item);
        }
    }
    (items, reader.is_unfinished())
}

/// A command that was read prints, and what is printed is read as the same.
fn check(command: &Command) {
    let mut text = Vec::new();
    print(command, &mut text);
    let again = parse(&text).unwrap_or_else(|error| panic!("{}: {error}", text.escape_ascii()));
    assert_eq!(&again, command, "{}", text.escape_ascii());
    let mut twice = Vec::new();
    print(&again, &mut twice);
    assert_eq!(text, twice, "printed the same");
}

fn observe(item: &Item, features: &mut Features) {
    match item {
        Ok(item) => {
            features.saw(("command", name_of(&item.command)));
            pairs(&item.command, |before, word| features.saw((before, word)));
        }
        Err(error) => {
            let found = error.found.bytes().next().map(|byte| byte.is_ascii_alphabetic());
            features.saw(("error", error.expected, std::mem::discriminant(&error.problem), found));
        }
    }
}
