//! The contract of the table of operations: what each row promises.

use super::*;
use crate::structure::{
    State,
    value::{FIRST, wrong_kind},
};
use protocol::{
    Kind, Value,
    command::{Command, Object, OperateKind, parse, reference},
};
use std::collections::BTreeSet;

/// The operate commands of the examples in the help.
fn examples() -> Vec<Operate> {
    let statements = reference::rows().flat_map(|row| row.example.split_inclusive(';'));
    let operate = |statement: &str| match parse(statement.as_bytes()) {
        Ok(Command::Define { object: Object::Operate { operate, .. }, .. }) => Some(operate),
        _ => None,
    };
    statements.filter_map(operate).collect()
}

fn made(operate: &Operate) -> Operation {
    Operation::new(operate, Some(ObjectId::new(3)), 0).unwrap_or_else(|fault| panic!("{operate:?}: {fault}"))
}

#[test]
fn each_command_has_an_example_that_makes_an_operation() {
    let examples = examples();
    examples.iter().for_each(|operate| drop(made(operate)));
    let shown: BTreeSet<String> = examples.iter().map(|operate| format!("{:?}", operate.kind())).collect();
    let all: BTreeSet<String> = OperateKind::ALL.iter().map(|kind| format!("{kind:?}")).collect();
    assert_eq!(shown, all);
}

#[test]
fn an_operation_is_called_by_words_that_begin_an_operate_command() {
    for operate in examples() {
        let word = made(&operate).word();
        let known = OperateKind::ALL.iter().any(|kind| word.starts_with(kind.name()) || kind.name().starts_with(word));
        assert!(known, "{word}");
    }
}

#[test]
fn without_a_condition_every_state_is_let_through() {
    for operate in examples() {
        let operation = made(&operate);
        let conditional = operation.word().starts_with("IF ");
        assert!(conditional || operation.admits(&State::default()), "{}", operation.word());
    }
    let off = Operation::IfPhase(false);
    assert!(!off.admits(&State::default()) && off.admits(&State { phase: false, ..State::default() }));
}

#[test]
fn what_sends_messages_leaves_its_first_input_to_the_memory() {
    for operate in examples() {
        let mut operation = made(&operate);
        let value = Value::Boolean(true);
        let given = Given { input: FIRST, value: &value, frame: 0 };
        if operation.takes(FIRST).contains(Kind::Boolean) {
            assert_eq!(operation.accept(given).is_err(), operation.has_output(), "{}", operation.word());
        } else if operation.takes(FIRST) != crate::port::KindSet::NONE {
            assert_eq!(operation.accept(given), Err(wrong_kind(FIRST, &value)), "{}", operation.word());
        }
    }
}

#[test]
fn a_font_that_has_gone_is_nothing() {
    let mut font = Operation::Font(Some(ObjectId::new(3)));
    font.forget(&|id| id == ObjectId::new(4));
    assert_eq!(font.reference(), Some(ObjectId::new(3)));
    font.forget(&|id| id == ObjectId::new(3));
    assert_eq!(font.reference(), Some(ObjectId::NOTHING));
}
