//! The contract of the table of operate commands: what each row promises.

use super::{
    OperateKind,
    table::{BEGINNINGS, words_after},
};
use crate::command::{
    BinaryDecoder,
    binary::Opcode,
    encode, parse, print,
    reference::{name_of, name_of_operate, rows},
    syntax::{Command, Object, Operate},
    words::{COMPLETE, OBJECTS, Word},
};
use proptest::{
    strategy::{Strategy, ValueTree},
    test_runner::TestRunner,
};
use std::collections::BTreeSet;

/// Random commands of a kind.
fn some(kind: OperateKind) -> Vec<Operate> {
    let mut runner = TestRunner::deterministic();
    (0..100).map(|_| kind.any().new_tree(&mut runner).unwrap().current()).collect()
}

fn definition(operate: Operate) -> Command {
    Command::Define { name: None, object: Object::Operate { operate, applied_to: None } }
}

fn printed(command: &Command) -> String {
    let mut text = Vec::new();
    print(command, &mut text);
    String::from_utf8(text).unwrap()
}

#[test]
fn each_command_is_printed_parsed_back_and_named() {
    for &kind in OperateKind::ALL {
        for operate in some(kind) {
            assert_eq!(operate.kind(), kind);
            assert_eq!(name_of_operate(&operate), kind.name());
            let command = definition(operate);
            assert_eq!(name_of(&command), kind.name());
            let text = printed(&command);
            assert_eq!(parse(text.as_bytes()), Ok(command), "{text}");
        }
    }
}

#[test]
fn each_command_is_encoded_and_decoded() {
    for &kind in OperateKind::ALL {
        for operate in some(kind) {
            let command = definition(operate);
            let mut record = Vec::new();
            encode(&command, &mut record).unwrap();
            assert_eq!(record[0], kind.code().unwrap_or(Opcode::Text.code()), "{}", kind.name());
            let mut decoder = BinaryDecoder::default();
            let decoded: Vec<_> = decoder.push(&record).collect();
            assert_eq!(decoded, [Ok(command)]);
        }
    }
}

#[test]
fn each_record_has_an_opcode_of_its_own() {
    let codes: Vec<u8> = OperateKind::ALL.iter().filter_map(|kind| kind.code()).collect();
    for &code in &codes {
        let kind = OperateKind::from_code(code).unwrap();
        assert_eq!(kind.code(), Some(code), "{} has the opcode of a row before it", kind.name());
        assert_eq!(Opcode::from_code(code), Some(Opcode::Operate(kind)), "{code:02x} is that of another record");
    }
    assert_eq!(codes.iter().collect::<BTreeSet<_>>().len(), codes.len());
}

#[test]
fn each_command_is_described_once_with_an_example() {
    for &kind in OperateKind::ALL {
        let described: Vec<_> = rows().filter(|row| row.name == kind.name()).collect();
        let [row] = described[..] else { panic!("{} has {} entries", kind.name(), described.len()) };
        assert!(!row.summary.is_empty() && !row.syntax.is_empty(), "{}", row.name);
        let shown = row.example.lines().filter(|line| parse(line.as_bytes()).is_ok_and(|c| name_of(&c) == row.name));
        assert!(shown.count() > 0, "{}", row.name);
    }
}

#[test]
fn no_two_rows_begin_with_the_same_words() {
    let distinct: BTreeSet<&[Word]> = BEGINNINGS.iter().copied().collect();
    assert_eq!(distinct.len(), BEGINNINGS.len());
    assert!(BEGINNINGS.iter().all(|words| !words.is_empty()));
}

#[test]
fn no_abbreviation_means_two_words_behind_the_same_words() {
    for beginning in BEGINNINGS {
        for depth in 0..beginning.len() {
            let same = BEGINNINGS.iter().filter(|words| words.len() > depth && words[..depth] == beginning[..depth]);
            let words: BTreeSet<Word> = same.map(|words| words[depth]).collect();
            for word in &words {
                for length in word.shortest()..=word.capitals().len() {
                    let text = &word.capitals().as_bytes()[..length];
                    let matches = words.iter().filter(|word| word.accepts(text)).count();
                    assert_eq!(matches, 1, "{:?} behind {:?}", word, &beginning[..depth]);
                }
            }
        }
    }
}

#[test]
fn first_words_begin_objects_and_lead_to_what_follows_them() {
    for beginning in BEGINNINGS {
        assert!(OBJECTS.contains(&beginning[0]), "{:?} begins no object", beginning[0]);
        assert!(beginning.len() < 2 || words_after(beginning[0]).contains(&beginning[1]));
    }
    assert!(words_after(Word::Nil).is_empty());
}

#[test]
fn a_command_of_one_word_is_no_name_of_another_object() {
    for &kind in OperateKind::ALL {
        let alone = some(kind).into_iter().all(|operate| printed(&definition(operate)) == format!("{};", kind.name()));
        let word = Word::find(OBJECTS, kind.name().as_bytes());
        if let Some(word) = word.filter(|_| alone) {
            assert!(COMPLETE.contains(&word), "{word:?}");
        }
    }
}
