//! Tests of variables, of what is sent to lists, and of rendering nodes.

use super::{DOT, told};
use protocol::Value;

#[test]
fn a_variable_gives_what_was_stored_in_it() {
    let mut desk = told(&format!("{DOT} A := TRANSLATE BY 0,0 APPLIED TO D; DISPLAY A; VARIABLE V, W;"));
    assert_eq!(desk.tell("SEND VALUE(V) TO <1>A;"), ["E 2 *** Name not found: a value in V"]);
    assert!(desk.tell("STORE V2D(0.25,0) IN V; SEND VALUE(V) TO <1>A;").is_empty());
    assert_eq!(desk.picture(), [[0.75, 0.0]]);
    assert_eq!(desk.tell("SEND VALUE(A) TO <1>A;"), ["E 4 *** A is no variable"]);
    assert_eq!(desk.tell("SEND VALUE(X) TO <1>A;"), ["E 2 *** Name not found: X"]);
    assert_eq!(desk.tell("SEND 1 TO <2>V;"), ["W 9 *** No such input <2> of V; a VARIABLE has <1>"]);
    assert_eq!(desk.tell("VARIABLE V;"), ["W 3 *** V redefined"]);
    assert_eq!(desk.memory.variable(&protocol::Name::new("V").unwrap()), Ok(None));
}

#[test]
fn a_variable_is_no_part_of_the_picture() {
    let mut desk = told("VARIABLE V;");
    let version = desk.memory.structures.version();
    let bytes = desk.memory.bytes();
    desk.tell("STORE 'SOME TEXT' IN V;");
    assert_eq!(desk.memory.structures.version(), version);
    assert_eq!(desk.memory.bytes(), bytes + 9);
}

const TWO: &str = "A := VECTOR_LIST ITEMIZED N=2 P 1,1,1 L 2,2,2; B := VECTOR_LIST 0,0,0 5,0,0 6,0,0;";

#[test]
fn vectors_of_a_list_go_over_those_of_another() {
    let mut desk = told(&format!("{TWO} SEND VL(A) TO <2>B;"));
    assert_eq!(desk.points("B"), [[0.0; 3], [1.0; 3], [2.0; 3]]);
    assert_eq!(desk.lines("B"), [false, false, true]);
    assert!(desk.tell("SEND VL(A) TO <append>B; SEND VL(A) TO <last>B;").is_empty());
    assert_eq!(desk.points("B"), [[0.0; 3], [1.0; 3], [2.0; 3], [1.0; 3], [1.0; 3], [2.0; 3]]);
    assert!(desk.tell("SEND VL(B) TO <append>B;").is_empty(), "also to itself");
    assert_eq!(desk.points("B").len(), 12);
    assert_eq!(desk.tell("SEND VL(A) TO <14>B;"), ["E 6 *** Value out of range at <14>B"]);
    assert_eq!(desk.tell("F := F:NOP; SEND VL(A) TO <1>F;"), ["E 5 *** Bad message type at <1>F: vectors"]);
}

#[test]
fn connected_lists_stay_so_and_2d_lists_stay_flat() {
    let desk = told("A := VECTOR_LIST 1,1,1 2,2,2; B := VECTOR_LIST 0,0 5,0; SEND VL(A) TO <append>B;");
    assert_eq!(desk.points("B"), [[0.0; 3], [5.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0]]);
    let crate::structure::Node::Vectors(list) = desk.node("B") else { panic!() };
    assert_eq!(list.list.class, protocol::command::VectorClass::Connected);
}

#[test]
fn vectors_are_marked_as_lines_and_positions() {
    let mut desk = told("V := VECTOR_LIST 0,0 1,0 2,0 3,0; SEND 2*P TO <2>V;");
    assert_eq!(desk.lines("V"), [false, false, false, true]);
    assert!(desk.tell("SEND 1*L TO <3>V; SEND 1*P TO <last>V;").is_empty());
    assert_eq!(desk.lines("V"), [false, false, true, false]);
    assert_eq!(desk.tell("SEND 2*P TO <4>V;"), ["E 6 *** Value out of range at <4>V"]);
    assert_eq!(desk.tell("SEND 2*P TO <append>V;"), ["W 9 *** No such input <append> of V"]);
    let said = desk.tell(&format!("{DOT} SEND 1*L TO <1>D;"));
    assert_eq!(said, ["E 5 *** Bad message type at <1>D: dots are neither lines nor positions"]);
}

#[test]
fn rendering_nodes_refuse_what_is_no_request() {
    let mut desk = told(&format!("{DOT} R := SURFACE_RENDERING APPLIED TO D;"));
    assert!(desk.tell("SEND TRUE TO <2>R; SEND FIX(7) TO <1>R; SEND 'SAVED' TO <1>R;").is_empty());
    for number in [9, -1] {
        let command = format!("SEND FIX({number}) TO <1>R;");
        assert_eq!(desk.tell(&command), ["E 6 *** Value out of range at <1>R"]);
    }
    assert_eq!(desk.tell("SEND '' TO <1>R;"), ["E 6 *** Value out of range at <1>R"]);
    assert_eq!(
        desk.tell("SEND 1.5 TO <1>R;"),
        ["E 5 *** Bad message type at <1>R: real; it takes Boolean or integer or string"]
    );
    assert_eq!(desk.tell("SEND FIX(1) TO <2>R;"), ["E 5 *** Bad message type at <2>R: integer; it takes Boolean"]);
}

#[test]
fn one_command_makes_several_arcs() {
    let mut desk = told("F := F:NOP; VARIABLE V, W; CONNECT F<1>:<1>V, <1>W; SEND 2 TO <1>F;");
    assert_eq!(desk.delivered(), [Value::Real(2.0), Value::Real(2.0)]);
}

#[test]
fn numbers_that_are_probably_not_meant_are_taken_with_a_warning() {
    let mut desk = told(DOT);
    assert_eq!(
        desk.tell("C := SET COLOR 500,3 APPLIED TO D; PREFIX D WITH SET RATE 0 0;"),
        [
            "W 6 *** Value out of range in C: hue 500 counts as 140, saturation 3 counts as 1",
            "W 6 *** Value out of range in PREFIX D: both phases last 0 frames, so the phase is always ON",
        ]
    );
    assert_eq!(
        desk.tell(
            "S := BEGIN_STRUCTURE VIEWPORT HORIZONTAL 1:-1 VERTICAL -1:1; INSTANCE OF D; END_STRUCTURE; DISPLAY S;"
        ),
        ["W 6 *** Value out of range in a VIEWPORT inside S: HORIZONTAL 1:-1 is reversed, so the picture is mirrored"]
    );
    assert_eq!(desk.picture(), [[-0.5, 0.0]]);
}

#[test]
fn a_fault_inside_a_structure_is_told_where_it_stands() {
    let mut desk = told("S := BEGIN_STRUCTURE NIL;");
    let said = desk.tell("FIELD_OF_VIEW 200;");
    assert!(
        said.len() == 1 && said[0].starts_with("E 6 *** Value out of range in a FIELD_OF_VIEW inside S: "),
        "{said:?}"
    );
    let said = desk.tell("B := BSPLINE ORDER 3 0,0 1,1 CHORDS 4;");
    assert!(said.len() == 1 && said[0].starts_with("E 6 *** Value out of range in S.B: "), "{said:?}");
    assert!(desk.tell("NIL; END_STRUCTURE;").is_empty());
}

#[test]
fn arcs_of_display_nodes_without_such_a_port_are_warned_about_and_stay() {
    let mut desk =
        told("T := TRANSLATE BY 0,0; S := BEGIN_STRUCTURE NIL; END_STRUCTURE; N := F:NOP; CONNECT N<1>:<9>LATER;");
    assert_eq!(desk.tell("CONNECT N<1>:<2>T;"), ["W 9 *** No such input <2> of T; a TRANSLATE has <1>"]);
    let said = desk.tell("CONNECT N<1>:<1>S;");
    assert!(
        said.len() == 1 && said[0].starts_with("W 9 *** No such input <1> of S; a structure has no inputs"),
        "{said:?}"
    );
    assert_eq!(desk.tell("CONNECT T<1>:<1>N;"), ["W 9 *** T is a TRANSLATE and sends no messages"]);
    assert!(desk.tell("CONNECT N<1>:<1>T;").is_empty());
    assert!(desk.tell("R := SURFACE_RENDERING APPLIED TO T; CONNECT R<1>:<1>N;").is_empty());
    let id = desk.id("N");
    assert_eq!(desk.memory.network.arcs(id).count(), 4, "a later definition may have the inputs");
}
