//! Tests of data objects: copies, curves, patterns, fonts, blocks.

use super::{Message, told};
use crate::structure::Node;

const LIST: &str = "V := VECTOR_LIST ITEMIZED P 0,0,0 L 0.1,0,0 P 0.2,0,0 L 0.3,0,0;";

#[test]
fn a_copy_begins_with_a_position() {
    let desk = told(&format!("{LIST} C := COPY V START = 2 COUNT = 3;"));
    assert_eq!(desk.points("C"), [[0.1, 0.0, 0.0], [0.2, 0.0, 0.0], [0.3, 0.0, 0.0]]);
    assert_eq!(desk.lines("C"), [false, false, true]);
}

#[test]
fn a_copy_of_separate_lines_keeps_what_is_a_line() {
    let desk = told("V := VECTOR_LIST SEPARATE 0,0 1,0 2,0 3,0 4,0 5,0; A := COPY V 3, 2; B := COPY V 2, 4;");
    assert_eq!(desk.lines("A"), [false, true]);
    assert_eq!(desk.lines("B"), [false, false, true, false], "vectors 2 to 5: L P L P, the first made P");
}

#[test]
fn characters_and_labels_are_copied_and_other_things_are_not() {
    let mut desk = told(
        "T := CHARACTERS 0.5,0 'HELLO'; L := LABELS 0,0 'A' 1,0 'B' 2,0 'C'; R := ROTATE IN X 1;
                         U := COPY T 2, 3; M := COPY L 2, 2;",
    );
    let Node::Characters(text) = desk.node("U") else { panic!() };
    assert_eq!(&text.text[..], b"ELL");
    let Node::Labels(block) = desk.node("M") else { panic!() };
    assert_eq!(block.labels.iter().map(|l| &l.0.text[..]).collect::<Vec<_>>(), [b"B", b"C"]);
    assert_eq!(desk.tell("X := COPY T 4, 3;"), ["E 6 *** Value out of range in T: there are 5 elements"]);
    assert_eq!(desk.tell("X := COPY NOTHING 1, 1;"), ["E 2 *** Name not found: NOTHING"]);
    assert_eq!(desk.tell("X := COPY R 1, 1;").len(), 1);
    assert!(!desk.memory.objects.find("X").is_some_and(|id| desk.memory.is_defined(id)));
}

#[test]
fn curves_are_lists_of_points_with_a_range_of_the_parameter() {
    let mut desk = told(
        "B := BSPLINE ORDER = 2 VERTICES = 0,0 1,0 1,1 CHORDS = 4;
         P := POLYNOMIAL ORDER = 1 COEFFICIENTS = 1,0,0 0,0,0 CHORDS = 2; DISPLAY B; DISPLAY P;",
    );
    assert_eq!(desk.points("B"), [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.5, 0.0], [1.0, 1.0, 0.0]]);
    assert_eq!(desk.points("P"), [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    let Node::Vectors(curve) = desk.node("P") else { panic!() };
    assert_eq!(curve.parameters, Some([0.0, 1.0]));
    assert!(desk.tell("SEND V2D(0.5,0.5) TO <2>B;").is_empty(), "its points take messages");
    assert_eq!(desk.points("B")[1], [0.5, 0.5, 0.0]);
    let said = desk.tell("B := BSPLINE ORDER = 4 VERTICES = 0,0 1,0 CHORDS = 4;");
    assert!(said.len() == 1 && said[0].starts_with("E 6 *** Value out of range in B: this B-spline needs"), "{said:?}");
    assert_eq!(desk.points("B").len(), 5, "the name keeps its definition");
}

#[test]
fn a_pattern_is_drawn_until_it_is_erased() {
    let mut desk = told(
        "K := BEGIN_STRUCTURE D := VECTOR_LIST 0,0 0.8,0; END_STRUCTURE; DISPLAY K;
         P := PATTERN 1 1 LENGTH 0.2; PATTERN K.D WITH P;",
    );
    assert_eq!(desk.picture(), [[0.0, 0.0], [0.2, 0.0], [0.4, 0.0], [0.6, 0.0]]);
    let bytes = desk.memory.bytes();
    assert!(desk.tell("SEND V2D(0.4,0) TO <2>K.D;").is_empty());
    assert!(desk.memory.structures.renew_dashes().is_empty());
    assert_eq!(desk.picture(), [[0.0, 0.0], [0.2, 0.0]], "the dashes follow the list");
    assert!(desk.memory.bytes() < bytes);
    assert!(desk.tell("ERASE PATTERN FROM K.D;").is_empty());
    assert_eq!(desk.picture(), [[0.0, 0.0]]);
    assert_eq!(desk.tell("ERASE PATTERN FROM K.D;"), ["E 4 *** K.D is a name without a pattern"]);
    assert_eq!(desk.tell("PATTERN K.D WITH K;"), ["E 4 *** K is no pattern"]);
    assert_eq!(desk.tell("PATTERN K WITH P;"), ["E 4 *** K is no vector list or curve"]);
    assert_eq!(desk.tell("PATTERN K.D WITH NOTHING;"), ["E 2 *** Name not found: NOTHING"]);
}

#[test]
fn a_list_that_outgrows_its_pattern_loses_it() {
    let mut desk = told("V := VECTOR_LIST 0,0 1,0; P := PATTERN 1 1 LENGTH 0.001; PATTERN V WITH P;");
    assert!(desk.tell("SEND V2D(1E9,0) TO <append>V;").is_empty());
    let faults = desk.memory.structures.renew_dashes();
    assert_eq!(faults.iter().map(|f| f.0).collect::<Vec<_>>(), [desk.id("V")]);
    let Node::Vectors(list) = desk.node("V") else { panic!() };
    assert!(list.dashed.is_none() && list.list.points.len() == 3);
}

#[test]
fn fonts_are_read_character_by_character() {
    let mut desk = told("F := BEGIN_FONT C[65]: N = 2 P 0,0 L 1,1; C[66]: P 0,0 L 1,0; C[65]: P 0,0 L 0,1; END_FONT;");
    let Node::Font(font) = desk.node("F") else { panic!() };
    assert_eq!(font.keys().copied().collect::<Vec<_>>(), [65, 66]);
    assert_eq!(font[&65].points[1].0, [0.0, 1.0], "the later character counts");
    assert_eq!(desk.tell("C[65]: P 0,0 L 1,1;").len(), 1);
    assert_eq!(desk.tell("END_FONT;"), ["E 4 *** END_FONT without BEGIN_FONT"]);
    assert_eq!(desk.tell("G := BEGIN_FONT H := BEGIN_FONT END_FONT;").len(), 1);
}

#[test]
fn blocks_of_memory_have_a_limit() {
    let mut desk = told("B := RAWBLOCK 1000;");
    assert_eq!(desk.node("B"), &Node::RawBlock(vec![0; 1000]));
    assert_eq!(desk.tell("C := RAWBLOCK 2000000000;"), ["E 8 *** Insufficient memory"]);
}

#[test]
fn polygons_of_the_binary_form_are_checked_too() {
    use protocol::{
        Name,
        command::{Command, CornerColor, Object, Polygon, PolygonVertex},
    };
    let corner = |normal| PolygonVertex { soft: false, position: [0.0; 3], normal, color: None };
    let red = Some(CornerColor { front: [120.0, 1.0, 1.0], back: None });
    let polygon = |vertices| Polygon { attributes: None, outline: None, coplanar: false, vertices };
    let bad = [
        vec![corner(None); 2],
        vec![corner(None); Polygon::MAX_VERTICES + 1],
        vec![corner(None), corner(Some([0.0, 0.0, 1.0])), corner(None)],
        vec![corner(None), PolygonVertex { color: red, ..corner(None) }, corner(None)],
    ];
    let mut desk = told("");
    for vertices in bad {
        let object = Object::Polygons(vec![polygon(vec![corner(None); 3]), polygon(vertices)]);
        let command = Command::Define { name: Name::new("P").ok(), object };
        desk.interpreter.execute(command, &mut desk.memory, &mut desk.messages);
        let said: Vec<String> = desk.messages.drain(..).map(|m: Message| m.to_string()).collect();
        assert!(said.len() == 1 && said[0].starts_with("E 6 *** Value out of range in P: polygon 2 has"), "{said:?}");
    }
}
