//! Tests of names: aliases, units, wildcards, scopes.

use super::{DOT, told};
use crate::structure::Node;

#[test]
fn an_alias_takes_messages_for_its_object_and_shows_it() {
    let mut desk = told(&format!("{DOT} B := A; A := TRANSLATE BY 0.25,0 APPLIED TO D; DISPLAY B;"));
    assert_eq!(desk.picture(), [[0.75, 0.0]]);
    assert!(desk.tell("SEND V2D(0,0.25) TO <1>B;").is_empty());
    assert_eq!(desk.picture(), [[0.5, 0.25]]);
    assert_eq!(desk.tell("A := TRANSLATE BY 0,0 APPLIED TO D;"), ["W 3 *** A redefined"]);
    assert_eq!(desk.picture(), [[0.5, 0.0]], "an alias follows its object");
    assert!(desk.tell("DELETE B;").is_empty());
    assert!(desk.picture().is_empty());
    assert!(matches!(desk.node("A"), Node::Operate { .. }), "only the other name is gone");
    desk.tell("B := VECTOR_LIST DOTS 0,0,0;");
    assert!(desk.picture().is_empty(), "it is another object, which is not displayed");
}

#[test]
fn an_alias_of_a_function_connects_it() {
    let mut desk = told("F := F:NOP; G := F; VARIABLE V; CONNECT G<1>:<1>V; SEND 3 TO <1>G;");
    assert_eq!(desk.delivered(), [protocol::Value::Real(3.0)]);
    assert!(desk.tell("DISCONNECT G:ALL; SEND 3 TO <1>F;").is_empty());
    assert!(desk.delivered().is_empty());
}

#[test]
fn no_name_is_another_name_of_itself() {
    let mut desk = told("A := B; B := C;");
    for command in ["C := A;", "D := D;", "C := B;"] {
        let said = desk.tell(command);
        assert!(said.len() == 1 && said[0].ends_with("is no other name of itself"), "{command}: {said:?}");
    }
}

#[test]
fn a_unit_is_forgotten_with_all_its_names() {
    let mut desk = told(
        "S := BEGIN_STRUCTURE T := TRANSLATE BY 0.25,0; Q := BEGIN_STRUCTURE P := VECTOR_LIST DOTS 0,0,0;
         END_STRUCTURE; END_STRUCTURE; SX := NIL; DISPLAY S; FORGET (S);",
    );
    assert_eq!(desk.picture(), [[0.25, 0.0]], "what is displayed stays");
    for name in ["S", "S.T", "S.Q", "S.Q.P"] {
        assert_eq!(desk.memory.objects.find(name), None, "{name}");
    }
    assert!(desk.memory.objects.find("SX").is_some());
    assert_eq!(desk.tell("FORGET (S);"), ["E 2 *** Name not found: S"]);
}

#[test]
fn delete_goes_on_after_a_name_that_is_not_there() {
    let mut desk = told(&format!("{DOT} A := NIL; L1 := NIL; L2 := NIL;"));
    assert_eq!(desk.tell("DELETE A, X, D, L*;"), ["E 2 *** Name not found: X"]);
    for name in ["A", "D", "L1", "L2"] {
        assert_eq!(desk.memory.objects.find(name), None, "{name}");
    }
}

#[test]
fn two_conditions_of_a_structure_reach_their_own_targets() {
    // The cursor of a client of the time, as it makes it.
    let mut desk = told(
        "XCU := VECTOR_LIST DOTS 0.25,0,0; BCU := VECTOR_LIST DOTS 0.5,0,0;
         CURSOR := BEGIN_STRUCTURE VIS := SET CONDITIONAL_BIT 2 ON; IF CONDITIONAL_BIT 2 IS ON THEN CUD;
         CUD := SET CONDITIONAL_BIT 1 OFF; IF CONDITIONAL_BIT 1 IS ON THEN XCU; IF CONDITIONAL_BIT 1 IS OFF THEN BCU;
         END_STRUCTURE; DISPLAY CURSOR;",
    );
    let off = desk.picture();
    assert!(!off.is_empty() && off.iter().all(|p| *p == [0.5, 0.0]), "{off:?}");
    assert!(desk.tell("SEND TRUE TO <1>CURSOR.CUD;").is_empty());
    let on = desk.picture();
    assert!(!on.is_empty() && on.iter().all(|p| *p == [0.25, 0.0]), "{on:?}");
}

#[test]
fn references_of_fonts_attributes_and_descendants_are_scoped() {
    let desk = told(
        "S := BEGIN_STRUCTURE
           L := BEGIN_FONT C[65]: P 0,0 L 1,1; END_FONT;
           CHARACTER FONT L; CHARACTERS 'A';
           Q := ATTRIBUTES COLOR 120,1,1;
           P := WITH ATTRIBUTES Q POLYGON 0,0,0 1,0,0 0,1,0 POLYGON 0,0,0 1,0,0 0,1,0
                WITH ATTRIBUTES OTHER POLYGON 0,0,0 1,0,0 0,1,0;
         END_STRUCTURE; DISPLAY S;",
    );
    assert_eq!(desk.picture().len(), 1 + 9, "one line of the font's own A, and the edges of three triangles");
    let Node::Polygons(polygons) = desk.node("S.P") else { panic!() };
    let (own, other) = (Some(desk.id("S.Q")), Some(desk.id("OTHER")));
    assert_eq!(polygons.attributes, [own, own, other], "attributes hold until others are named");
}

#[test]
fn what_is_deleted_loses_the_arcs_to_it() {
    let mut desk = told("A := F:NOP; B := F:NOP; VARIABLE V; CONNECT A<1>:<1>B; CONNECT A<1>:<1>V; DELETE B;");
    desk.tell("B := F:NOP; CONNECT B<1>:<1>V; SEND 1 TO <1>A;");
    assert_eq!(desk.delivered().len(), 1, "straight to V, not by B");
    desk.tell("DELETE V; VARIABLE V; SEND 1 TO <1>A;");
    assert!(desk.delivered().is_empty());
    desk.tell("CONNECT A<1>:<1>V; SEND 1 TO <1>A;");
    assert_eq!(desk.delivered().len(), 1);
}

#[test]
fn a_message_for_a_name_without_definition_says_so() {
    let mut desk = told("I := INSTANCE OF A;");
    let (id, input) = (desk.id("A"), protocol::command::Input::Append);
    let fault = desk.memory.accept(id, input, protocol::Value::Integer(1)).unwrap_err();
    assert_eq!((fault.number(), fault.text("A").as_str()), (2, "Name not found: A, for a message at <append>"));
}
