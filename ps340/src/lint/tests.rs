//! Tests of what is found.

use super::*;

fn findings(text: &str) -> Vec<String> {
    lint(&[("f".into(), text.as_bytes().to_vec())]).iter().map(Finding::to_string).collect()
}

/// The only finding.
fn one(text: &str) -> String {
    let found = findings(text);
    assert_eq!(found.len(), 1, "{found:#?}");
    found[0].clone()
}

#[test]
fn programs_that_work_are_clean() {
    assert_eq!(findings(""), [""; 0]);
    for example in crate::example::EXAMPLES {
        assert_eq!(findings(example.text), [""; 0], "{}", example.name);
    }
}

#[test]
fn syntax_errors_have_their_place_in_the_file() {
    assert_eq!(one("{ a }\n A := NIL;\n  DISPLAY 7;"), "f:3:11: error: expected a name, found `7`");
    assert!(one("@ dial 1 1\nA := ROATE IN X 3;").starts_with("f:2:6: error: "));
    assert!(
        one("A := ROATE IN X 3; DISPLAY A; SEND 1 TO <1>A;").contains("did you mean ROTATE"),
        "one slip, one finding"
    );
    assert_eq!(one("A := NIL;\nDISPLAY A"), "f:2:1: error: the last statement has no ;");
    assert_eq!(one("S := BEGIN_STRUCTURE\n A := NIL;"), "f:1:1: error: BEGIN_STRUCTURE of S has no END_STRUCTURE");
}

#[test]
fn names_that_nothing_defines_are_told_with_the_nearest_one() {
    assert_eq!(
        one("CUBE := NIL;\nDISPLAY CUEB;"),
        "f:2:9: error: CUEB is used by DISPLAY and never defined; did you mean CUBE?"
    );
    assert_eq!(
        one("A := F:NOP; CONNECT DAILS<1>:<1>A;"),
        "f:1:21: error: DAILS is used by CONNECT and never defined; did you mean DIALS?"
    );
    assert_eq!(one("A := F:ADDD;"), "f:1:8: error: there is no function F:ADDD; did you mean F:ADD?");
    assert_eq!(
        one("W := BEGIN_S R := ROTATE IN X 1; INSTANCE OF L; END_S; L := NIL; DISPLAY W; SEND 1 TO <1>R;"),
        "f:1:90: error: R is used by SEND and never defined; did you mean W.R?"
    );
    assert_eq!(findings("W := BEGIN_S A := INSTANCE OF B; B := NIL; END_S; DISPLAY W; DISPLAY W.B;"), [""; 0]);
}

#[test]
fn inputs_and_outputs_must_exist() {
    assert_eq!(
        one("A := F:NOP; CONNECT DIALS<9>:<1>A; SEND 1 TO <1>A;"),
        "f:1:21: error: DIALS (turns of the dials since the last sample; 1 is a whole turn clockwise) has no output <9>; \
         its outputs are <1> to <8>"
    );
    assert_eq!(
        one("A := F:ADD; SEND 1 TO <1>A; SEND 1 TO <2>A; CONNECT DIALS<1>:<3>A;"),
        "f:1:65: error: A (F:ADD) has no input <3>; its inputs are <1> to <2>"
    );
    assert_eq!(
        one("W := BEGIN_S R := ROTATE IN X 1; END_S; CONNECT DIALS<1>:<1>W;"),
        "f:1:61: error: W takes no messages; nodes inside it do: W.R"
    );
    assert_eq!(
        one("A := F:ADD; SEND 1 TO <1>A; SEND 1 TO <2>A; SEND 1 TO <3>A;"),
        "f:1:45: warning: No such input <3> of A; its inputs are <1> to <2> (W 9)"
    );
}

#[test]
fn a_message_to_an_input_whose_arc_clashes_is_told_too() {
    let found = findings("T := TRANSLATE BY 0,0,0; CONNECT DIALS<1>:<1>T;\nSEND 5 TO <1>T;");
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(
        found[0].starts_with("f:1:34: error: DIALS<1> sends real") && found[1].starts_with("f:2:1: error: Bad message")
    );
}

#[test]
fn data_and_operate_nodes_send_no_messages() {
    assert_eq!(one("V := NIL; P := F:PRINT; CONNECT V<1>:<1>P;"), "f:1:33: error: V is a NIL; it sends no messages");
    assert_eq!(
        one("T := TRANSLATE BY 1,1; CONNECT DIALS<1>:<2>T;"),
        "f:1:44: error: T is a TRANSLATE and has no input <2>; it has <1>"
    );
    let rendering = "S := SURFACE_RENDERING THEN N; N := NIL; P := F:PRINT; CONNECT S<1>:<1>P;";
    assert_eq!(findings(rendering), [""; 0]);
}

#[test]
fn what_is_left_open_is_placed_where_it_was_opened() {
    assert_eq!(one("A := NIL;\nB := { here\nNIL;"), "f:2:6: error: the comment has no closing brace");
    assert_eq!(one("SEND 'it's' TO <1>HOST_MESSAGE;"), "f:1:11: error: the text has no closing quote");
}

#[test]
fn faults_and_odd_numbers_inside_a_structure_are_told_at_their_command() {
    let text = "S := BEGIN_STRUCTURE\nLOOK AT 0,0,0 FROM 0,0,0;\nSET COLOR 500,1;\nEND_STRUCTURE;\nDISPLAY S;";
    let found = findings(text);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].starts_with("f:2:1: error: Value out of range in a LOOK inside S: "), "{found:?}");
    assert_eq!(found[1], "f:3:1: warning: Value out of range in a SET COLOR inside S: hue 500 counts as 140 (W 6)");
}

#[test]
fn functions_that_fire_once_although_they_are_fed_are_told() {
    let finding = findings("A := F:ADD; CONNECT DIALS<1>:<1>A; SEND 1 TO <2>A;");
    assert_eq!(
        finding,
        ["f:1:1: warning: A (F:ADD) fires once only: <1> is fed again and again, but <2> gets no more than what SEND \
          gives it; F:ADDC keeps it"]
    );
    assert!(one("A := F:ADD; CONNECT DIALS<1>:<1>A; SEND 1 TO <2>A; SEND 2 TO <2>A;").contains("fires 2 times only"));
    for fed in [
        "A := F:ADDC; CONNECT DIALS<1>:<1>A; SEND 1 TO <2>A;",
        "A := F:ADD; CONNECT DIALS<1>:<1>A; SEND 1 TO <2>A; SETUP CNESS TRUE <2>A;",
        "A := F:ADD; CONNECT DIALS<1>:<1>A; SEND 1 TO <2>A; CONNECT A<1>:<2>A;",
        "A := F:ADD; SEND 1 TO <1>A; SEND 1 TO <2>A;",
        "N := F:NOP; SEND 1 TO <1>N; A := F:ADD; CONNECT N<1>:<1>A; SEND 1 TO <2>A;",
    ] {
        assert_eq!(findings(fed), [""; 0], "{fed}");
    }
    // What a clock or a function between them does goes on too.
    let through = "N := F:NOP; CONNECT DIALS<1>:<1>N; A := F:ADD; CONNECT N<1>:<2>A; SEND 1 TO <1>A;";
    assert!(one(through).contains("<2> is fed again and again, but <1>"));
}

#[test]
fn functions_that_never_fire_are_told_once_with_their_cause() {
    assert_eq!(
        findings("M := F:MULC; CONNECT DIALS<1>:<1>M;\nN := F:NOP; CONNECT M<1>:<1>N; CONNECT N<1>:<1>M;"),
        [
            "f:1:1: warning: M (F:MULC) never fires: nothing feeds its input <2> (second factor)",
            "f:2:1: warning: N (F:NOP) never fires: <1> waits for M, which never sends"
        ]
    );
    // A loop without a first message.
    let circle = "A := F:NOP; B := F:NOP; CONNECT A<1>:<1>B; CONNECT B<1>:<1>A;";
    assert_eq!(findings(circle).len(), 2);
    assert_eq!(findings(&format!("{circle} SEND 1 TO <1>A;")), [""; 0]);
}

#[test]
fn kinds_that_an_input_refuses_are_found_through_functions() {
    assert_eq!(
        one("V := F:XVECTOR; CONNECT DIALS<1>:<1>V; R := F:XROTATE; CONNECT V<1>:<1>R;"),
        "f:1:64: error: V<1> sends 3D vector, but <1>R takes integer or real"
    );
    assert_eq!(
        one("T := TRANSLATE BY 0,0,0; CONNECT DIALS<1>:<1>T;"),
        "f:1:34: error: DIALS<1> sends real, but <1>T takes 2D vector or 3D vector"
    );
    // The sum of vectors is a vector, and that of numbers a number.
    let sum = |value: &str| {
        format!("A := F:ADDC; SEND {value} TO <2>A; SEND {value} TO <1>A; R := F:XROTATE; CONNECT A<1>:<1>R;")
    };
    assert_eq!(findings(&sum("1")), [""; 0]);
    assert!(findings(&sum("V3D(1,2,3)")).iter().any(|f| f.contains("A<1> sends 3D vector, but <1>R takes")));
    // F:CONSTANT sends whatever it holds.
    assert!(
        one("C := F:CONSTANT; SEND 'x' TO <2>C; CONNECT FKEYS<1>:<1>C; CONNECT C<1>:<1>ONBUTTONLIGHTS;")
            .contains("C<1> sends string")
    );
}

#[test]
fn values_out_of_range_are_found() {
    let finding = one("SEND FIX(33) TO <1>ONBUTTONLIGHTS;");
    assert!(finding.starts_with("f:1:1: error: Value out of range at <1>ONBUTTONLIGHTS"), "{finding}");
    assert_eq!(
        one("S := F:CROUTE(3); SEND FIX(4) TO <1>S; CONNECT DIALS<1>:<2>S;"),
        "f:1:1: error: whatever arrives: Value out of range at <1>S"
    );
    assert_eq!(findings("S := F:CROUTE(3); SEND FIX(3) TO <1>S; CONNECT DIALS<1>:<2>S;"), [""; 0]);
    assert!(one("SEND 'a' TO <1>ONBUTTONLIGHTS;").contains("Bad message type"));
}

#[test]
fn a_program_ends_at_initialize_and_goes_on_from_file_to_file() {
    let two = |a: &str, b: &str| lint(&[("a".into(), a.into()), ("b".into(), b.into())]).len();
    assert_eq!(two("L := NIL;", "DISPLAY L;"), 0);
    assert_eq!(two("DISPLAY L;", "L := NIL;"), 0);
    assert_eq!(two("L := NIL;", "INITIALIZE; DISPLAY L;"), 1);
    assert_eq!(one("L := NIL;\nL := NIL;"), "f:2:1: warning: L is defined again, it was defined at f:1");
}

#[test]
fn a_structure_that_contains_itself_is_found() {
    let finding = one("A := INSTANCE OF B;\nB := INSTANCE OF A;\nDISPLAY A;");
    assert!(finding.starts_with("f:3:1: error: ") && finding.contains("A contains itself"), "{finding}");
}
