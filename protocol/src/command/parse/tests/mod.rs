//! Facts about the parser.

mod data;
mod language;

use super::*;
use crate::{
    Name, Value,
    command::{
        reader::CommandReader,
        syntax::{Axis, Input, NamePattern, Operate, VectorClass, VectorList},
    },
};
use glam::{DVec3, DVec4};

fn object(text: &str) -> Object {
    match parse(text.as_bytes()) {
        Ok(Command::Define { object, .. }) => object,
        other => panic!("{text}: {other:?}"),
    }
}

fn operate(text: &str) -> Operate {
    match object(text) {
        Object::Operate { operate, .. } => operate,
        other => panic!("{text}: {other:?}"),
    }
}

fn list(text: &str) -> VectorList {
    match object(text) {
        Object::VectorList(list) => list,
        other => panic!("{text}: {other:?}"),
    }
}

fn message(text: &str) -> String {
    parse(text.as_bytes()).expect_err(text).to_string()
}

fn same(a: &str, b: &str) {
    assert_eq!(parse(a.as_bytes()).expect(a), parse(b.as_bytes()).expect(b), "{a} / {b}");
}

#[test]
fn a_name_before_the_sign_of_definition_is_always_a_name() {
    let Command::Define { name: Some(name), object } = parse(b"IF := WINDOW X=-1:1 Y=-1:1;").unwrap() else {
        panic!("a definition was expected");
    };
    assert_eq!(name.as_str(), "IF");
    assert!(matches!(object, Object::Operate { operate: Operate::Window { .. }, applied_to: None }));
    for word in ["SEND", "DISPLAY", "END_STRUCTURE", "NIL", "F", "VECTOR_LIST", "IN"] {
        assert!(parse(format!("{word} := NIL;").as_bytes()).is_ok(), "{word}");
    }
}

#[test]
fn words_may_be_names_where_names_stand() {
    same("INCLUDE IN IN IN;", "include IN in;");
    same("REMOVE FROM FROM FROM;", "REM FROM from FROM");
    same("DISPLAY SEND;", "DISP send;");
    same("A := ROTATE IN X 3 APPLIED TO TO;", "A := ROT X 3 APPL TO;");
    same("A := ROTATE IN X 3 THEN TO;", "A := ROT X 3 THEN to;");
    assert_eq!(object("A := INSTANCE OF OF, B;"), Object::Instance(vec![name("OF"), name("B")]));
}

fn name(text: &str) -> Name {
    Name::new(text).unwrap()
}

#[test]
fn abbreviations_and_missing_words_mean_the_same() {
    same("V := VEC ITEM N=2 P0,0 L1,1;", "V := vector_list itemized n = 2 p 0,0 l 1,1 ;");
    same(
        "W := VIEW HOR -1:1 VERT=-1:1 INTEN=0:1 APPL A;",
        "W := VIEWPORT HORIZONTAL=-1:1 VERTICAL -1:1 INTENSITY 0:1 THEN A",
    );
    same("SCA 2;", "SCALE BY 2,2,2;");
    same("SCA 2 3;", "SCALE BY 2,3,1;");
    same("TRAN 1 2;", "TRANSLATE BY 1,2,0;");
    same("CONN A<1>:<2>B;", "connect a < 1 > : < 2 > b");
    same("SEND 1 <1>A;", "SEND 1 TO <1>A;");
    same("INIT CONN;", "INITIALIZE CONNECTIONS;");
    same("DISCONN A:ALL;", "DISCONNECT A;");
    same("MATRIX_2 1,0 0,1;", "MATRIX_2X2 1 0 0 1");
    same("FIELD_OF_VIEW 30 FRONT BOUNDARY = 1 BACK 2;", "FIELD_OF_VIEW 30 FRONT=1 BACK=2;");
    same("WINDOW X -1:1 Y = -1:1 FRONT 1E-15 BACK BOUND 1E15;", "WINDOW X=-1:1Y=-1:1FRONT=1E-15 BACK=1E15;");
    same("CHAR 'A';", "CHARACTERS 0,0,0 STEP 1,0 'A';");
}

#[test]
fn shorter_than_the_shortest_form_is_an_error() {
    assert_eq!(message("DISPL A; X"), "1:10: expected the end, found `X`");
    for (text, hint) in [
        ("DIS A;", "1:1: expected a command or `name :=`, found `DIS`, too short for DISPLAY, which needs DISP"),
        (
            "V := VE 1,1;",
            "1:6: expected what the name is to be (such as VECTOR_LIST), found `VE`, too short for VECTOR_LIST, which \
             needs VEC",
        ),
        ("ROT X 3 APP TO A;", "1:9: expected the end, found `APP`, too short for APPLIED, which needs APPL"),
    ] {
        assert_eq!(message(text), hint);
    }
}

#[test]
fn a_misspelt_word_suggests_the_nearest() {
    for (text, hint) in [
        ("DISPALY A;", "found `DISPALY`; did you mean DISPLAY?"),
        ("A := ROATE IN X 3;", "found `ROATE`; did you mean ROTATE?"),
        ("SET COLOUR 120,1;", "found `COLOUR`; did you mean COLOR?"),
        ("ROT X 3 APLIED TO A;", "found `APLIED`; did you mean APPLIED?"),
        ("VEC ITEMISED P 0,0;", "found `ITEMISED`; did you mean ITEMIZED?"),
        ("SEND TREU TO <1>A;", "found `TREU`; did you mean TRUE?"),
        ("PICTURE A;", "found `PICTURE`"),
    ] {
        assert!(message(text).ends_with(hint), "{}", message(text));
    }
}

#[test]
fn a_name_that_cannot_be_one_and_a_sign_that_is_not_the_right_one_are_told_as_such() {
    for (text, told) in [
        ("A-B := NIL;", "1:1: '-' cannot stand in a name, which has letters, digits, _, $ and ., found `A-B`"),
        ("1A:=NIL;", "1:1: a name begins with a letter, found `1A`"),
        (
            "DISPLAY-2 := NIL;",
            "1:1: '-' cannot stand in a name, which has letters, digits, _, $ and ., found `DISPLAY-2`",
        ),
        ("Q = F:PRINT;", "1:3: expected `:=`, found `=`"),
        ("R: = NIL;", "1:2: expected `:=`, found `:`"),
        ("A B := NIL;", "1:1: expected a command or `name :=`, found `A`"),
        ("SEND 1 A;", "1:8: expected TO or an input such as `<1>`, found `A`"),
        ("SEND 1 TO A;", "1:11: expected an input such as `<1>`, found `A`"),
        ("CONNECT A:B;", "1:10: expected an output such as `<1>`, found `:`"),
    ] {
        assert_eq!(message(text), told);
    }
}

#[test]
fn look_takes_its_points_in_both_orders() {
    same("LOOK AT 0,0,0 FROM 0,0,-10;", "LOOK FROM 0,0,-10 AT 0,0,0;");
    let Operate::Look { at, from, up } = operate("LOOK AT 1,2,3 FROM 4,5,6 UP 7,8,9;") else { panic!("LOOK") };
    assert_eq!((at, from, up), (DVec3::new(1., 2., 3.), DVec3::new(4., 5., 6.), Some(DVec3::new(7., 8., 9.))));
}

#[test]
fn rows_of_the_machine_become_columns() {
    let Operate::Matrix4x3(m) = operate("MATRIX_4X3 1,0,0 0,1,0 0,0,1 5,6,7;") else { panic!("MATRIX_4X3") };
    // p M with row vectors: the fourth row is the translation.
    assert_eq!(m * DVec4::new(1.0, 1.0, 1.0, 1.0), DVec4::new(6.0, 7.0, 8.0, 1.0));
    let Operate::Rotate { axis, angle } = operate("ROTATE IN Z -90;") else { panic!("ROTATE") };
    assert_eq!((axis, angle), (Axis::Z, -90.0));
}

#[test]
fn every_class_of_vector_list_is_read() {
    let itemized = list("VEC ITEM P 0 0 1 L 1,1,1 I=.5 L 2 , 2 2 P3,3,3;");
    assert_eq!((itemized.class, itemized.dimension), (VectorClass::Itemized, 3));
    assert_eq!(itemized.lines, [false, true, true, false]);
    assert_eq!(itemized.points[1], [1.0, 1.0, 1.0, 0.5]);
    assert_eq!(itemized.points[2], [2.0, 2.0, 2.0, 1.0]);
    let separate = list("VEC SEP N=4 0,0 1,1 I=500 0,1 { diagonal } 1,0;");
    assert_eq!((separate.class, separate.dimension, separate.estimate), (VectorClass::Separate, 2, Some(4)));
    assert_eq!(separate.points.len(), 4);
    assert_eq!(separate.points[1], [1.0, 1.0, 0.0, 500.0]);
    assert_eq!(list("VEC DOTS 1,2;").class, VectorClass::Dots);
    assert_eq!(list("VEC BLOCK CONN 1,2 3,4;").class, VectorClass::Connected);
    assert!(list("VEC BLOCK 1,2 3,4;").block_normalized);
    assert!(list("VEC;").points.is_empty());
}

#[test]
fn defaults_grow_from_vector_to_vector() {
    let grown = list("VEC Y = 1 DY = 0.5 0 1 2 I=0.25 3;");
    assert_eq!(grown.dimension, 2);
    assert_eq!(grown.points, [[0., 1., 0., 1.], [1., 1.5, 0., 1.], [2., 2., 0., 0.25], [3., 2.5, 0., 1.]]);
    let deep = list("VEC ITEM Y=0 Z=-1 DZ=2 P 5 L 6;");
    assert_eq!((deep.dimension, deep.lines), (3, vec![false, true]));
    assert_eq!(deep.points, [[5., 0., -1., 1.], [6., 0., 1., 1.]]);
    assert_eq!(list("VEC Z=4 1,2 3,4;").points, [[1., 2., 4., 1.], [3., 4., 4., 1.]]);
}

#[test]
fn bad_vectors_say_what_is_missing() {
    assert_eq!(message("VEC 0,0 1,1,1;"), "1:12: expected a vector or `;`, found `,`");
    assert!(message("VEC 1 2 3 4;").starts_with("1:7: put commas between the components"));
    assert_eq!(message("VEC ITEM P 1,2 3,4;"), "1:17: expected P, L or `;`, found `,`");
    assert_eq!(message("VEC ITEM 1,2;"), "1:10: expected P, L or `;`, found `1`");
    assert_eq!(message("VEC ITEM P 1,2 LINE 3,4;"), "1:16: expected P, L or `;`, found `LINE`");
    assert_eq!(message("VEC 1,2 1E39,1;"), "1:9: the number is out of range, found `1E39`");
    assert_eq!(message("VEC 1,2 3,;"), "1:11: expected a number, found `;`");
    assert_eq!(message("VEC 1,2 3"), "1:10: expected a number, found the end of the command");
    assert_eq!(message("VEC 5;"), "1:6: expected the y component, found `;`");
    assert_eq!(message("VEC 1,2 {"), "1:9: the comment has no closing brace, expected a vector or `;`, found `{`");
}

#[test]
fn every_form_of_a_value_is_read() {
    let value = |text: &str| match parse(format!("SEND {text} TO <1>A;").as_bytes()) {
        Ok(Command::Send { value, .. }) => value,
        other => panic!("{text}: {other:?}"),
    };
    assert_eq!(value("TRUE"), Value::Boolean(true));
    assert_eq!(value("false"), Value::Boolean(false));
    assert_eq!(value("FIX(-3)"), Value::Integer(-3));
    assert_eq!(value("7"), Value::Real(7.0));
    assert_eq!(value("'a''b;{'"), Value::string("a'b;{"));
    assert_eq!(value("CHAR(0)"), Value::string([0]));
    assert_eq!(value("V3D(1 2,3)"), Value::Vector3(DVec3::new(1.0, 2.0, 3.0)));
    let Value::Matrix2(m) = value("M2D(1,2 3,4)") else { panic!("M2D") };
    assert_eq!(m.to_cols_array(), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(message("SEND FIX(1.5) TO <1>A;"), "1:10: expected a whole number, found `1.5`");
    assert_eq!(message("SEND CHAR(256) TO <1>A;"), "1:11: the number must be 0 to 255, found `256`");
    assert_eq!(message("SEND 1E999 TO <1>A;"), "1:6: the number is out of range, found `1E999`");
    assert!(message("SEND 'a TO <1>A;").starts_with("1:6: the text has no closing quote"));
}

#[test]
fn every_form_of_a_connection_is_read() {
    for text in
        ["DISCONNECT A;", "DISCONNECT A:ALL;", "DISCONNECT A<3>;", "DISCONNECT A<3>:<2>B;", "DISCONNECT A:<1>B.C;"]
    {
        assert!(matches!(parse(text.as_bytes()), Ok(Command::Disconnect { .. })), "{text}");
    }
    let Ok(Command::Connect(arc)) = parse(b"CONN TABLETIN<5>:<APPEND>INK;") else { panic!("CONNECT") };
    assert_eq!((arc.output, arc.destination.input), (5, Input::Append));
    for input in std::iter::once(Input::Number(7)).chain(Input::WORDS.map(|row| row.0)) {
        let text = format!("CONN A<1>:<{}>B;", input.code());
        assert!(
            matches!(parse(text.as_bytes()), Ok(Command::Connect(arc)) if arc.destination.input == input),
            "{text}"
        );
    }
    assert_eq!(message("CONNECT A<1>:<-7>B;"), "1:15: the number must be -6 to 4294967295, found `-7`");
    assert_eq!(message("CONNECT A<0>:<1>B;"), "1:11: the number must be 1 to 65535, found `0`");
    assert!(message("CONNECT A<1>:<insert>B;").starts_with("1:15: expected the number of an input"));
    same("A := F:ROUTE(4);", "a := f : route ( 4 )");
}

#[test]
fn wildcards_stand_directly_behind_their_prefix() {
    let Ok(Command::Delete(patterns)) = parse(b"DELETE T*, A.B, *;") else { panic!("DELETE") };
    let expected = [NamePattern::Prefix("T".into()), NamePattern::Name(name("A.B")), NamePattern::Prefix("".into())];
    assert_eq!(patterns, expected);
    assert_eq!(message("DELETE T *;"), "1:10: expected the end, found `*`");
}

#[test]
fn names_that_are_too_long_are_errors_with_their_place() {
    let text = format!("DISPLAY {};", "A".repeat(257));
    let error = parse(text.as_bytes()).unwrap_err();
    assert_eq!(error.span, 8..265);
    assert!(matches!(error.problem, Problem::Name(_)));
}

#[test]
fn the_dial_example_of_the_reference_is_read() {
    let text = include_bytes!("../dials.ps300");
    let mut reader = CommandReader::default();
    reader.push(text);
    let commands: Vec<Command> = reader.by_ref().map(|item| item.unwrap().command).collect();
    assert!(!reader.is_unfinished());
    assert_eq!(commands.len(), 60);
    let Command::Define { object: Object::VectorList(cube), .. } = &commands[1] else { panic!("CUBE") };
    assert_eq!((cube.points.len(), cube.lines.iter().filter(|line| !**line).count()), (16, 4));
}
