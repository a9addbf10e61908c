//! `ps340 commands` prints the table of commands.

use std::process::{Command, Output};

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ps340")).args(arguments).output().expect("the program runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn without_a_name_all_commands_are_listed() {
    let output = run(&["commands"]);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(0), protocol::command::reference::list()));
}

#[test]
fn a_name_gives_its_entry_and_may_be_abbreviated() {
    let output = run(&["commands", "set", "pick", "id"]);
    let entry = text(&output.stdout);
    assert!(output.status.success() && entry.starts_with("SET PICKING IDENTIFIER: "), "{entry}");
    assert!(entry.contains("SET PICKing IDentifier = id") && entry.contains("PSEPID"), "{entry}");
}

#[test]
fn an_unknown_name_suggests_the_nearest() {
    let output = run(&["commands", "TRANSALTE"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(text(&output.stderr), "ps340: there is no command TRANSALTE; did you mean TRANSLATE?\n");
}
