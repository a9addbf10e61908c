//! The table says what the parser does.

use super::{row::pieces, *};
use crate::command::{Command, CommandReader, strategy::commands};
use proptest::{strategy::ValueTree, test_runner::TestRunner};
use std::collections::BTreeSet;

/// The commands of the example of a row.
fn example(row: &CommandRow) -> Vec<Command> {
    let mut reader = CommandReader::default();
    reader.push(row.example.as_bytes());
    let commands = reader.by_ref().map(|item| item.unwrap_or_else(|error| panic!("{}: {error}", row.name)).command);
    let commands = commands.collect();
    assert!(!reader.is_unfinished(), "{}", row.name);
    commands
}

#[test]
fn each_example_shows_its_command() {
    for row in rows() {
        let names: Vec<&str> = example(row).iter().map(name_of).collect();
        assert!(names.contains(&row.name), "{}: {names:?}", row.name);
    }
}

#[test]
fn each_command_has_one_row() {
    let mut names = BTreeSet::new();
    for row in rows() {
        assert!(names.insert(row.name), "{} stands there twice", row.name);
        assert!(!row.summary.is_empty() && !row.summary.ends_with('.') && !row.syntax.is_empty(), "{}", row.name);
        assert!(row.section.contains('.'), "{}", row.name);
    }
    let mut runner = TestRunner::deterministic();
    let mut seen = BTreeSet::new();
    for _ in 0..4_000 {
        let command = proptest::strategy::Strategy::new_tree(&commands(), &mut runner).unwrap().current();
        let name = name_of(&command);
        assert!(names.contains(name), "{name} has no row");
        seen.insert(name);
    }
    // The random commands are of every kind, or their tests would prove less than they say.
    assert_eq!(seen, names);
}

#[test]
fn each_keyword_belongs_to_a_row_and_each_row_has_true_keywords() {
    let mut used = BTreeSet::new();
    for row in rows() {
        used.extend(row.words());
        for piece in row.syntax.iter().flat_map(|line| pieces(line)) {
            let is_keyword = piece.starts_with(|c: char| c.is_ascii_uppercase());
            let known = Word::ALL.iter().any(|word| word.form() == piece);
            assert!(!is_keyword || known, "{}: {piece} is no keyword", row.name);
        }
    }
    let unused: Vec<&Word> = Word::ALL.iter().filter(|word| !used.contains(word)).collect();
    assert!(unused.is_empty(), "no row has {unused:?}");
}

#[test]
fn a_row_is_found_by_its_name_its_beginning_or_a_keyword() {
    let names = |name: &str| find(name).map(|rows| rows.iter().map(|row| row.name).collect::<Vec<_>>());
    assert_eq!(names("rotate"), Ok(vec!["ROTATE"]));
    assert_eq!(names("vec"), Ok(vec!["VECTOR_LIST"]));
    assert_eq!(names("set  pick id"), Ok(vec!["SET PICKING IDENTIFIER"]));
    assert_eq!(names("if").map(|rows| rows.len()), Ok(3));
    assert_eq!(names("store"), Ok(vec!["SEND"]));
    assert_eq!(names("begin structure"), Ok(vec!["BEGIN_STRUCTURE"]));
    assert_eq!(names("END STRUC"), Ok(vec!["BEGIN_STRUCTURE"]));
    assert_eq!(names("set level of detail"), Ok(vec!["SET LEVEL_OF_DETAIL"]));
    let error = find("ROTTATE").unwrap_err();
    assert_eq!(error.to_string(), "there is no command ROTTATE; did you mean ROTATE?");
    assert_eq!(find("STROE").unwrap_err().nearest, Some("SEND"));
    assert_eq!(find("PICTURE").unwrap_err().to_string(), "there is no command PICTURE");
    assert!(find("").is_err());
}

#[test]
fn the_list_and_the_entries_have_everything() {
    let list = list();
    for row in rows() {
        assert!(list.contains(row.name) && list.contains(row.summary));
        let entry = row.to_string();
        for part in row.syntax.iter().chain(row.routines).copied().chain(row.example.lines()) {
            assert!(entry.contains(part), "{part}");
        }
        for option in row.options {
            assert!(entry.contains(option.form) && entry.contains(option.meaning) && entry.contains(option.default));
        }
        assert!(row.inputs.iter().all(|input| entry.contains(input.effect)));
    }
}
