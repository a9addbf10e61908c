//! `ps340 functions` prints the table of functions.

use std::process::{Command, Output};

fn functions(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ps340")).arg("functions").args(arguments).output().expect("the program runs")
}

#[test]
fn a_table_without_a_name_and_a_page_with_one() {
    let table = functions(&[]);
    let text = String::from_utf8_lossy(&table.stdout);
    assert!(table.status.success() && text.contains("\n  F:ROUTE(n)        the message <2>"), "{text}");
    let page = functions(&["f:pickinfo"]);
    let text = String::from_utf8_lossy(&page.stdout);
    assert!(page.status.success() && text.contains("<9> the other identifiers"), "{text}");
}

#[test]
fn an_unknown_name_is_a_usage_error_with_a_proposal() {
    let output = functions(&["ROTE"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "ps340: there is no function ROTE; did you mean ROUTE?\n");
    assert!(output.stdout.is_empty());
}
