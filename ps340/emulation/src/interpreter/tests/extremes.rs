//! Tests of stiff and extreme structures, each with its stated outcome.

use super::{DOT, Desk, MAX_NESTING, told};
use crate::traversal::{self, Requests, UpdateFault};

const DEEP: usize = 3000;

/// An update of the interpreter's picture.
fn update(desk: &Desk) -> traversal::Update {
    traversal::update(&desk.memory.structures, 0, &Requests::default())
}

#[test]
fn structures_nest_thousands_deep_and_go_without_a_trace() {
    let mut desk = told("");
    let text = format!(
        "S := BEGIN_STRUCTURE {} TRANSLATE BY 0.5,0; VECTOR_LIST DOTS 0,0,0; {} END_STRUCTURE; DISPLAY S;",
        "BEGIN_STRUCTURE SCALE BY 1; ".repeat(DEEP),
        "END_STRUCTURE; ".repeat(DEEP)
    );
    assert!(desk.tell(&text).is_empty());
    assert_eq!(desk.picture(), [[0.5, 0.0]]);
    assert!(desk.tell(&text).iter().all(|said| said == "W 3 *** S redefined"));
    desk.tell("DELETE S; REMOVE S;");
    assert_eq!(desk.memory.objects.len(), 1, "only the name is left");
    assert_eq!(desk.memory.structures.bytes(), 0);
}

#[test]
fn deeper_structures_are_left_out_and_their_members_stay() {
    let mut desk = told("");
    let levels = MAX_NESTING + 3;
    let said = desk.tell(&format!(
        "S := {} VECTOR_LIST DOTS 0.5,0,0; {} DISPLAY S;",
        "BEGIN_STRUCTURE ".repeat(levels),
        "END_STRUCTURE; ".repeat(levels)
    ));
    assert_eq!(said, ["E 4 *** structures nest at most 4096 deep"; 3]);
    assert_eq!(desk.picture(), [[0.5, 0.0]]);
    assert_eq!(desk.tell("END_STRUCTURE;").len(), 1, "all are closed");
}

#[test]
fn instances_of_instances_of_instances_are_drawn_and_deleted() {
    let mut desk = told(&format!("{DOT} I0 := INSTANCE OF D; DISPLAY I{DEEP};"));
    let chain: String = (1..=DEEP).map(|n| format!("I{n} := INSTANCE OF I{};", n - 1)).collect();
    assert!(desk.tell(&chain).is_empty());
    assert_eq!(desk.picture(), [[0.5, 0.0]]);
    desk.tell("DELETE I*;");
    assert!(desk.picture().is_empty());
}

#[test]
fn a_structure_that_contains_itself_is_drawn_once_and_named() {
    let desk = told(&format!("{DOT} A := INSTANCE OF D, B; B := INSTANCE OF A, D; DISPLAY A;"));
    let drawn = update(&desk);
    assert_eq!(drawn.fault, Some(UpdateFault::ContainsItself(desk.id("A"))));
    assert_eq!(drawn.strokes.len(), 2);
    let mut desk = told(&format!("{DOT} A := SCALE BY 0.5 APPLIED TO A; DISPLAY A;"));
    assert!(matches!(update(&desk).fault, Some(UpdateFault::ContainsItself(_))));
    desk.tell("DELETE A;");
    assert_eq!(update(&desk).fault, None);
}

#[test]
fn what_is_displayed_may_be_redefined_and_deleted_at_any_time() {
    let mut desk = told(&format!("{DOT} A := INSTANCE OF D; DISPLAY A; DISPLAY D;"));
    let kinds = [
        ("D := VECTOR_LIST DOTS 0,0,0;", 2),
        ("D := CHARACTERS 0.5,0 'I';", 0),
        ("D := F:NOP;", 0),
        ("D := NIL;", 0),
        ("D := BEGIN_STRUCTURE D := VECTOR_LIST DOTS 0,0,0; END_STRUCTURE;", 2),
        ("D := A;", 0),
        ("DELETE D;", 0),
        (DOT, 0),
        ("DISPLAY D;", 1),
        ("INCLUDE D IN A;", 2),
    ];
    for (command, strokes) in kinds {
        desk.tell(command);
        let drawn = update(&desk).strokes.len();
        assert!(drawn == strokes || (command.contains("CHARACTERS") && drawn > 0), "{command}: {drawn}");
    }
}

#[test]
fn a_member_that_cannot_be_made_is_left_out() {
    let mut desk = told("");
    let said = desk.tell(
        "S := BEGIN_STRUCTURE W := WINDOW X = 0:0 Y = -1:1; COPY NOTHING 1,1; VECTOR_LIST DOTS 0.5,0,0; END_STRUCTURE;
         DISPLAY S;",
    );
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(said[0].starts_with("E 6 *** Value out of range in S.W: WINDOW needs"), "{said:?}");
    assert_eq!(desk.picture(), [[0.5, 0.0]]);
}

#[test]
fn a_name_given_twice_in_a_structure_has_its_later_definition() {
    let mut desk = told("");
    let said = desk.tell("S := BEGIN_STRUCTURE A := NIL; A := VECTOR_LIST DOTS 0.5,0,0; END_STRUCTURE; DISPLAY S;");
    assert_eq!(said, ["W 3 *** S.A redefined"]);
    assert_eq!(desk.picture(), [[0.5, 0.0], [0.5, 0.0]], "both places show it");
}
