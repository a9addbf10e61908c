//! Tests of the player.

use super::*;
use crate::example::{EXAMPLES, example};
use crate::machine::Settings;
use files::Sandbox;

/// Collects the transcript.
#[derive(Default)]
struct Heard {
    text: String,
    stop_at: Option<u64>,
}

impl Watcher for Heard {
    fn log(&mut self, sign: char, text: &[u8]) {
        self.text.push_str(&format!("{sign} {}\n", String::from_utf8_lossy(text)));
    }

    fn stops(&mut self, _: &str, _: usize, frame: u64) -> bool {
        self.stop_at.is_some_and(|stop| frame >= stop)
    }
}

/// Files may be anywhere.
fn everywhere() -> Option<Sandbox> {
    Sandbox::open("/").ok()
}

fn run_with(text: &str, options: PlayOptions) -> (PlayEnd, Vec<String>, String) {
    let script = Script::read("a.ps300", text.as_bytes()).unwrap();
    let mut player = Player::new(Settings::default(), options, everywhere());
    let mut heard = Heard::default();
    let end = player.play(&script, &mut heard);
    (end, player.take_failures().iter().map(Failure::to_string).collect(), heard.text)
}

fn run(text: &str) -> (PlayEnd, Vec<String>, String) {
    run_with(text, PlayOptions::default())
}

const ECHO: &str = "P := F:PRINT; CONNECT DIALS<1>:<1>P;\nCONNECT P<1>:<1>HOST_MESSAGE;\n";

#[test]
fn expectations_that_come_true_are_silent() {
    let (end, failures, heard) = run(&format!(
        "{ECHO}@ dial 1 0.25\n@ expect '0.25'\n@ dial 1 0.5\n@ expect 0.49 0.02 within 3\n@# comment\n\
         SEND 'it''s' TO <1>HOST_MESSAGE;\n@ expect 'it''s'\nSEND 'abcd' TO <1>HOST_MESSAGE;\n@ expect /a*d/\n@ expect none 5\n"
    ));
    assert_eq!((end, failures), (PlayEnd::Played, vec![]), "{heard}");
    assert!(heard.contains("@ dial 1 0.25\n= ok\n@ expect '0.25'\n< 0.25\n"), "{heard}");
}

#[test]
fn a_failed_step_says_what_was_expected_and_what_came() {
    let (end, failures, _) = run(&format!("{ECHO}@ dial 1 0.25\n@ expect '0.5'\n@ expect none\n"));
    assert_eq!(end, PlayEnd::Failed);
    assert_eq!(failures, ["a.ps300:4: expected '0.5', got '0.25'"]);
    let (_, failures, _) = run("@ expect 'x' within 7\n");
    assert_eq!(failures, ["a.ps300:1: expected 'x', got nothing in 7 frames"]);
    let (_, failures, _) = run("SEND 'x' TO <1>HOST_MESSAGE;\n@ expect none\n");
    assert_eq!(failures, ["a.ps300:2: expected no message, got 'x'"]);
    let (_, failures, _) = run("@ show NOBODY\n");
    assert_eq!(failures, ["a.ps300:1: there is no NOBODY"]);
}

#[test]
fn what_the_keyboard_sends_to_the_host_can_be_expected() {
    let text =
        "@ mode terminal\n@ type ab\\r\n@ expect typed 'ab\\r'\n@ type cd\n@ expect typed 'c'\n@ expect typed 'x'\n";
    let (_, failures, _) = run(text);
    assert_eq!(failures, ["a.ps300:6: expected typed 'x', got 'd'"]);
    let (_, failures, _) = run("@ expect typed 'a' within 3\n");
    assert_eq!(failures, ["a.ps300:1: expected typed 'a', got nothing in 3 frames"]);
}

#[test]
fn lines_of_the_machines_errors_are_those_of_the_file() {
    let (_, failures, _) = run("@ frames 1\nA := NIL;\n@ # a comment\n\n  DISPLAY 7;\n");
    assert_eq!(failures, ["a.ps300:5: unexpected: E 1 *** 5:11: expected a name, found `7`"]);
}

#[test]
fn errors_fail_a_run_unless_a_step_expects_them() {
    let nonsense = "DISPLAY 7;\nSEND 1 TO <1>NOBODY;\n";
    let (end, failures, _) = run(nonsense);
    assert_eq!((end, failures.len()), (PlayEnd::Played, 2));
    assert!(failures[0].starts_with("a.ps300:1: unexpected: E 1 *** "), "{failures:?}");
    assert_eq!(run(&format!("{nonsense}@ expect error E 1\n@ expect error E 2 *** * NOBODY\n")).1, [""; 0]);
    let (_, failures, _) = run(&format!("{nonsense}@ expect error E 2\n"));
    assert!(failures.iter().any(|f| f.starts_with("a.ps300:3: expected error E 2, got E 1 *** ")), "{failures:?}");
    let forgiving = PlayOptions { keep_going: true, ..PlayOptions::default() };
    assert_eq!(run_with(nonsense, forgiving).1, [""; 0]);
    assert_eq!(run("A := NIL;\nA := NIL;\n@ expect error W 3\n").1, [""; 0]);
}

#[test]
fn a_run_can_go_on_after_a_failure_and_can_be_stopped() {
    let forgiving = PlayOptions { keep_going: true, frames: 2 };
    let (end, failures, _) = run_with("@ expect 'a'\n@ expect 'b'\n", forgiving);
    assert_eq!((end, failures.len()), (PlayEnd::Played, 2));
    let script = Script::read("a", b"@ frames 1000\n").unwrap();
    let mut player = Player::new(Settings::default(), PlayOptions::default(), everywhere());
    let end = player.play(&script, &mut Heard { stop_at: Some(10), ..Heard::default() });
    assert_eq!((end, player.machine().frame()), (PlayEnd::Stopped, 10));
    assert_eq!(run("@ quit\n@ expect 'a'\n").0, PlayEnd::Quit);
}

#[test]
fn bad_directives_are_all_reported_with_their_lines() {
    let text = "A := NIL;\n@ dance\n@ expect\n@ expect error X\n@ expect 'a\n@ expect 1 -1\n@ expect none x\n@ expect 'a' soon\n";
    let errors = Script::read("f", text.as_bytes()).unwrap_err();
    assert_eq!(errors.iter().map(|e| e.line).collect::<Vec<_>>(), [2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(errors[0].to_string(), "f:2: unknown order 'dance'; 'help' lists them");
}

#[test]
fn every_example_plays_without_an_error_and_says_what_it_is() {
    for e in EXAMPLES {
        assert!(!e.summary().is_empty(), "{}", e.name);
        assert_eq!(example(e.name), Ok(e));
        let script = Script::read(e.name, e.text.as_bytes()).unwrap();
        let mut player = Player::new(Settings::default(), PlayOptions::default(), everywhere());
        assert_eq!(player.play(&script, &mut Heard::default()), PlayEnd::Played);
        player.wait(30, &mut Heard::default());
        assert_eq!(player.take_failures(), [], "{}", e.name);
        assert!(!player.machine().latest_update().strokes.is_empty(), "{} draws nothing", e.name);
    }
    assert!(example("dails").unwrap_err().contains("'dials'"));
}
