//! Tests of PREFIX, FOLLOW, INCLUDE and their opposites.

use super::{DOT, told};

#[test]
fn a_prefix_stands_above_what_the_name_denotes() {
    let mut desk = told(&format!("{DOT} DISPLAY A; A := INSTANCE OF D; PREFIX A WITH ROTATE IN Z 90;"));
    assert_eq!(desk.picture(), [[0.0, 0.5]]);
    assert!(desk.tell("SEND M3D(1,0,0 0,1,0 0,0,1) TO <1>A;").is_empty(), "the name denotes the prefix");
    assert_eq!(desk.picture(), [[0.5, 0.0]]);
    assert!(desk.tell("PREFIX A WITH ROTATE IN Z 180; REMOVE PREFIX OF A; REMOVE PREFIX OF A;").is_empty());
    assert_eq!(desk.picture(), [[0.5, 0.0]]);
    assert_eq!(desk.tell("REMOVE PREFIX OF A;"), ["E 4 *** A is a name without a prefix"]);
}

#[test]
fn the_last_prefix_goes_first() {
    let mut desk = told(&format!(
        "{DOT} DISPLAY D; PREFIX D WITH TRANSLATE BY 0.25,0; PREFIX D WITH SCALE BY 0.5; PREFIX D WITH SCALE BY 0.5;"
    ));
    assert_eq!(desk.picture(), [[0.188, 0.0]], "(0.5 + 0.25) / 4");
    desk.tell("REMOVE PREFIX OF D;");
    assert_eq!(desk.picture(), [[0.375, 0.0]]);
    desk.tell("REMOVE PREFIX OF D;");
    assert_eq!(desk.picture(), [[0.75, 0.0]]);
    desk.tell("REMOVE PREFIX OF D;");
    assert_eq!(desk.picture(), [[0.5, 0.0]]);
}

#[test]
fn inside_a_structure_a_prefix_applies_to_all_that_follows() {
    let structure = "S := BEGIN_STRUCTURE VECTOR_LIST DOTS 0.5,0,0; T := TRANSLATE BY 0.25,0,0;
                     VECTOR_LIST DOTS 0.5,0,0; VECTOR_LIST DOTS 0.5,0.5,0; END_STRUCTURE; DISPLAY S;";
    let mut desk = told(structure);
    let plain = desk.picture();
    assert_eq!(plain, [[0.5, 0.0], [0.75, 0.0], [0.75, 0.5]]);
    assert!(desk.tell("PREFIX S.T WITH SCALE BY 0.5;").is_empty());
    assert_eq!(desk.picture(), [[0.5, 0.0], [0.375, 0.0], [0.375, 0.25]]);
    assert!(desk.tell("FOLLOW S.T WITH SCALE BY 2;").is_empty(), "between prefix and translation");
    assert_eq!(desk.picture(), [[0.5, 0.0], [0.75, 0.0], [0.75, 0.5]]);
    assert!(desk.tell("REMOVE PREFIX OF S.T;").is_empty());
    assert_eq!(desk.picture(), plain, "what follows the prefix goes with it");
    assert_eq!(desk.tell("REMOVE FOLLOWER OF S.T;").len(), 1);
}

#[test]
fn a_follower_stands_directly_below_an_operate_node() {
    let mut desk = told(&format!("{DOT} A := TRANSLATE BY 0.25,0 APPLIED TO D; DISPLAY A;"));
    assert_eq!(desk.picture(), [[0.75, 0.0]]);
    desk.tell("FOLLOW A WITH SCALE BY 0.5; FOLLOW A WITH ROTATE IN Z 90;");
    assert_eq!(desk.picture(), [[0.25, 0.25]], "scaled, then rotated, then moved");
    desk.tell("PREFIX A WITH SCALE BY 2; REMOVE FOLLOWER OF A;");
    assert_eq!(desk.picture(), [[1.0, 0.0]]);
    desk.tell("REMOVE FOLLOWER OF A; REMOVE PREFIX OF A;");
    assert_eq!(desk.picture(), [[0.75, 0.0]]);
    assert_eq!(desk.tell("REMOVE FOLLOWER OF A;"), ["E 4 *** A is a name without a follower"]);
}

#[test]
fn a_structure_that_begins_with_an_operate_node_can_be_followed() {
    let mut desk =
        told("S := BEGIN_STRUCTURE TRANSLATE BY 0.25,0; VECTOR_LIST DOTS 0.5,0,0; END_STRUCTURE; DISPLAY S;");
    assert!(desk.tell("FOLLOW S WITH SCALE BY 0.5;").is_empty());
    assert_eq!(desk.picture(), [[0.5, 0.0]]);
    assert!(desk.tell("REMOVE FOLLOWER OF S;").is_empty());
    assert_eq!(desk.picture(), [[0.75, 0.0]]);
}

#[test]
fn what_cannot_be_prefixed_or_followed_says_why() {
    let mut desk = told(&format!("{DOT} F := F:ADD; I := INSTANCE OF D;"));
    let cases = [
        ("PREFIX X WITH SCALE BY 2;", "E 2 *** Name not found: X"),
        ("FOLLOW X WITH SCALE BY 2;", "E 2 *** Name not found: X"),
        ("PREFIX F WITH SCALE BY 2;", "E 4 *** F is a function and no display node"),
        ("FOLLOW I WITH SCALE BY 2;", "E 4 *** I is no operate node that could be followed"),
        ("REMOVE PREFIX OF X;", "E 2 *** Name not found: X"),
        ("PREFIX D WITH FIELD_OF_VIEW 200;", "E 6 *** Value out of range in D: FIELD_OF_VIEW needs"),
    ];
    for (command, expected) in cases {
        let said = desk.tell(command);
        assert!(said.len() == 1 && said[0].starts_with(expected), "{command}: {said:?}");
    }
}

#[test]
fn a_new_definition_or_a_deletion_takes_prefixes_and_followers_away() {
    let mut desk = told(DOT);
    let objects = desk.memory.objects.len();
    let bytes = desk.memory.bytes();
    for _ in 0..2000 {
        desk.tell("PREFIX D WITH SCALE BY 2; FOLLOW D WITH SCALE BY 2; PREFIX D WITH SCALE BY 2;");
        desk.tell(DOT);
    }
    assert_eq!((desk.memory.objects.len(), desk.memory.bytes()), (objects, bytes));
    let structure = "S := BEGIN_STRUCTURE T := SCALE BY 2; INSTANCE OF D; END_STRUCTURE;";
    desk.tell(structure);
    let (objects, bytes) = (desk.memory.objects.len(), desk.memory.bytes());
    desk.tell("PREFIX S.T WITH SCALE BY 2; FOLLOW S.T WITH SCALE BY 2; PREFIX S WITH SCALE BY 2; DELETE S;");
    desk.tell(structure);
    desk.memory.reuse_deleted();
    assert_eq!((desk.memory.objects.len(), desk.memory.bytes()), (objects, bytes));
}

#[test]
fn include_and_remove_edit_instances_structures_and_what_is_not_there_yet() {
    let mut desk = told(&format!(
        "{DOT} DISPLAY A; INCLUDE D IN A; INCLUDE D IN A;
         S := BEGIN_STRUCTURE TRANSLATE BY 0.25,0; END_STRUCTURE; INCLUDE D IN S; INCLUDE S IN A;"
    ));
    assert_eq!(desk.picture(), [[0.5, 0.0], [0.5, 0.0], [0.75, 0.0]]);
    assert!(desk.tell("REMOVE D FROM A; REMOVE D FROM S; REMOVE D FROM S; REMOVE X FROM Y;").is_empty());
    assert_eq!(desk.picture(), [[0.5, 0.0]]);
    assert_eq!(
        desk.tell("INCLUDE A IN D;"),
        ["E 4 *** D is a VECTOR_LIST and cannot include A: only INSTANCE OF and structures can"]
    );
}

#[test]
fn members_of_the_open_structure_are_told_to_be_out_of_reach() {
    let mut desk = told("ROBOT := BEGIN_STRUCTURE ARM := ROTATE IN X 20; D := VECTOR_LIST DOTS 0,0;");
    for command in
        ["PREFIX ARM WITH SCALE 2;", "FOLLOW ARM WITH SCALE 2;", "SEND 1 TO <1>ROBOT.ARM;", "INCLUDE X IN ARM;"]
    {
        let said = desk.tell(command);
        assert!(
            said.len() == 1 && said[0].starts_with("E 4 *** ") && said[0].ends_with("of ROBOT.ARM"),
            "{command}: {said:?}"
        );
    }
    assert_eq!(
        desk.tell("INCLUDE D IN PICTURE;"),
        ["E 4 *** D is inside ROBOT, which is still open: say this after END_STRUCTURE, of ROBOT.D"]
    );
    assert!(desk.tell("INCLUDE ROBOT.D IN PICTURE;").is_empty(), "a full name is known later");
    assert!(desk.tell("END_STRUCTURE; PREFIX ROBOT.ARM WITH SCALE 2;").is_empty());
}
