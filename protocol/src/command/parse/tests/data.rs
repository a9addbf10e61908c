//! Facts about data commands: vectors, polygons, curves, text.

use super::*;
use crate::command::syntax::{Bspline, CornerColor, Fourth, Polygon, Polynomial, SurfaceColor};

fn polygons(text: &str) -> Vec<Polygon> {
    match object(text) {
        Object::Polygons(polygons) => polygons,
        other => panic!("{text}: {other:?}"),
    }
}

fn bspline(text: &str) -> Bspline {
    match object(text) {
        Object::Bspline(curve) => curve,
        other => panic!("{text}: {other:?}"),
    }
}

fn polynomial(text: &str) -> Polynomial {
    match object(text) {
        Object::Polynomial(curve) => curve,
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn colour_and_table_replace_the_intensity_of_a_vector() {
    let blended = list("VEC COLOR ITEM P 0,0 H=120 L 1,1 H 480 L 2,2;");
    assert_eq!((blended.fourth, blended.class), (Fourth::Hue, VectorClass::Itemized));
    assert_eq!(blended.points.iter().map(|p| p[3]).collect::<Vec<_>>(), [120.0, 480.0, 0.0]);
    assert_eq!(list("VEC COLOR SEP 0,0 1,1 h=3;").points[1][3], 3.0);
    let tabulated = list("VEC TAB P0,0,0 T=7 L1,1,1;");
    assert_eq!((tabulated.fourth, tabulated.class, tabulated.dimension), (Fourth::Table, VectorClass::Itemized, 3));
    assert_eq!(tabulated.points[0][3], 7.0);
    assert_eq!(message("VEC COLOR 0,0 I=1;"), "1:15: expected a vector or `;`, found `I`");
    assert_eq!(message("VEC 0,0 H=1;"), "1:9: expected a vector or `;`, found `H`");
}

#[test]
fn internal_units_have_marks() {
    let list = list("VEC INTERNAL_UNITS P -32767,5 L 100,7;");
    assert!(list.internal_units);
    assert_eq!((list.class, &list.lines[..]), (VectorClass::Itemized, &[false, true][..]));
}

#[test]
fn polygons_have_soft_edges_normals_attributes_and_outlines() {
    let all = polygons(
        "SOLID := WITH ATTR MAT OUTLINE 120 POLYG 0,0,0 S 1,0,0 s0,1,0 \
         POLYGON COPLAN 0,0,0 N 0,0,-1 1 1 0 N0,0,-1 S 2,2,0 N 0,0,1 \
         OUTLINE 3 WITH OTHER POLYGON 1,1,1 2,2,2 3,3,3;",
    );
    assert_eq!(all.len(), 3);
    assert_eq!((all[0].attributes.clone(), all[0].outline, all[0].coplanar), (Some(name("MAT")), Some(120.0), false));
    assert_eq!(all[0].vertices.iter().map(|v| v.soft).collect::<Vec<_>>(), [false, true, true]);
    assert_eq!(all[0].vertices[2].position, [0.0, 1.0, 0.0]);
    assert_eq!((all[1].attributes.clone(), all[1].outline, all[1].coplanar), (None, None, true));
    assert_eq!(all[1].vertices[1].normal, Some([0.0, 0.0, -1.0]));
    assert_eq!((all[2].attributes.clone(), all[2].outline), (Some(name("OTHER")), Some(3.0)));
}

#[test]
fn corners_of_polygons_have_colours_with_their_commas_on_one_side_or_on_both() {
    let all = polygons(
        "POLYGON 0,0,0 C 120 S 1,0,0 C240,.5 0,1,0 c 3,.25,.75
         POLYGON 0,0,0 N 0,0,-1 C 120,1,.5 AND 60 1,0,0 N 0,0,-1 C 0,0,1 AND 0,0,0 0 1 0 N 0 0 -1 C 1;",
    );
    let colors = |k: usize| all[k].vertices.iter().map(|v| v.color.unwrap()).collect::<Vec<_>>();
    let both = |front, back| CornerColor { front, back };
    assert_eq!(
        colors(0),
        [both([120.0, 1.0, 1.0], None), both([240.0, 0.5, 1.0], None), both([3.0, 0.25, 0.75], None)]
    );
    assert_eq!(
        colors(1),
        [
            both([120.0, 1.0, 0.5], Some([60.0, 1.0, 1.0])),
            both([0.0, 0.0, 1.0], Some([0.0; 3])),
            both([1.0, 1.0, 1.0], None)
        ]
    );
    assert!(all[1].vertices.iter().all(|v| v.normal == Some([0.0, 0.0, -1.0])));
    assert_eq!(message("POLYGON 0,0,0 C;"), "1:16: expected a number, found `;`");
    assert_eq!(message("POLYGON 0,0,0 C 1, S 0,0,0;"), "1:20: expected a number, found `S`");
    assert_eq!(
        message("POLYGON 0,0,0 C 1e99 1,1,1 C 1 2,2,2 C 1;"),
        message("POLYGON 1e99,0,0;").replace("1:9", "1:17")
    );
}

#[test]
fn attributes_of_polygons_may_have_the_names_of_words() {
    for (text, expected) in [
        ("WITH ATTRIBUTES POLYGON 0,0,0 1,1,1 2,2,2;", "ATTRIBUTES"),
        ("WITH ATTRIBUTES POLYGON POLYGON 0,0,0 1,1,1 2,2,2;", "POLYGON"),
        ("WITH OUTLINE POLYGON 0,0,0 1,1,1 2,2,2;", "OUTLINE"),
        ("WITH ATTRIBUTES OUTLINE OUTLINE 3 POLYGON 0,0,0 1,1,1 2,2,2;", "OUTLINE"),
        ("WITH MAT POLYGON 0,0,0 1,1,1 2,2,2;", "MAT"),
    ] {
        assert_eq!(polygons(text)[0].attributes, Some(name(expected)), "{text}");
    }
}

#[test]
fn an_outline_may_have_a_with() {
    let [with, without] = ["WITH ", ""].map(|with| {
        let text =
            format!("{with}OUTLINE 120 POLYGON 1,2,3 4,5,6 7,8,0 WITH A {with}OUTLINE 3 POLYGON 1,2,3 4,5,6 7,8,0;");
        polygons(&text)
    });
    assert_eq!(with, without);
    assert_eq!(
        (with[0].outline, with[1].outline, with[1].attributes.clone()),
        (Some(120.0), Some(3.0), Some(name("A")))
    );
    let named = polygons("WITH OUTLINE POLYGON 1,2,3 4,5,6 7,8,0;");
    assert_eq!((named[0].attributes.clone(), named[0].outline), (Some(name("OUTLINE")), None));
}

#[test]
fn attributes_behind_the_last_polygon_are_left_out_with_a_warning() {
    for rest in ["WITH ATTRIBUTES A", "WITH A", "OUTLINE 3", "WITH OUTLINE 3 WITH A"] {
        let mut reader = CommandReader::default();
        reader.push(format!("P := POLYGON 1,2,3 4,5,6 7,8,0 {rest};").as_bytes());
        let read = reader.next().unwrap().unwrap();
        assert_eq!(read.command, parse(b"P := POLYGON 1,2,3 4,5,6 7,8,0;").unwrap(), "{rest}");
        let [warning] = &read.warnings[..] else { panic!("{:?}", read.warnings) };
        assert_eq!(warning.to_string(), format!("1:32: no polygon follows, so this has no effect, found `{rest}`"));
    }
}

#[test]
fn polygons_have_3_to_250_vertices() {
    let vertices = |count: usize| "1,2,3 ".repeat(count);
    assert_eq!(polygons(&format!("POLYGON {};", vertices(250)))[0].vertices.len(), 250);
    assert_eq!(
        message(&format!("POLYGON {};", vertices(251))),
        "1:1509: a polygon has at most 250 vertices, found `1`"
    );
    assert_eq!(message("POLYGON 1,2,3 4,5,6;"), "1:20: a polygon has at least 3 vertices, found `;`");
    assert_eq!(message("POLYGON;"), "1:8: expected a vertex or COPLANAR, found `;`");
    assert_eq!(message("POLYGON 1,2 3,4;"), "1:14: a polygon has at least 3 vertices, found `,`");
    assert!(message("POLYGON 0,0,0 N 1,0,0 1,0,0 1,1,0;").starts_with("1:29: give a normal for each vertex"));
    assert!(message("POLYGON 0,0,0 C 120 1,0,0 1,1,0;").starts_with("1:27: give a color for each vertex"));
    assert!(message("WITH MAT OUTLINE 3;").starts_with("1:19: expected POLYGON, WITH or OUTLINE"));
}

#[test]
fn attributes_have_two_sides_and_defaults() {
    let Object::Attributes(both) = object("ATTR COLOR 120 SPEC 5 OPAQUE .6 AND DIFFUSE 0.5 COLOR 240,0.3;") else {
        panic!("ATTRIBUTES");
    };
    let front = SurfaceColor { color: [120.0, 1.0, 1.0], specular: 5, opaque: 0.6, ..SurfaceColor::default() };
    assert_eq!(both.front, front);
    let back = SurfaceColor { color: [240.0, 0.3, 1.0], diffuse: 0.5, ..SurfaceColor::default() };
    assert_eq!(both.back, Some(back));
    let Object::Attributes(plain) = object("M := ATTRIBUTES;") else { panic!("ATTRIBUTES") };
    assert_eq!((plain.front, plain.back), (SurfaceColor::default(), None));
    assert_eq!(message("ATTRIBUTES SPECULAR 11;"), "1:21: the number must be 0 to 10, found `11`");
}

#[test]
fn a_light_is_white_and_fully_ambient_unless_said() {
    let Object::Illumination(light) = object("ILLUM 0,0,-1;") else { panic!("ILLUMINATION") };
    assert_eq!((light.direction, light.color, light.ambient), (DVec3::NEG_Z, [0.0, 0.0, 1.0], 1.0));
    let Object::Illumination(light) = object("ILLUM 1 2 3 AMBIENT .7 COLOR 0,0,.9;") else { panic!("ILLUMINATION") };
    assert_eq!((light.color, light.ambient), ([0.0, 0.0, 0.9], 0.7));
}

#[test]
fn options_of_a_curve_come_in_any_order() {
    let ball = bspline("BSPLINE ORDER=4 CLOSED PERIODIC N=4 VERTICES = 1,0  0,1  -1,0  0,-1  CHORDS=40;");
    assert_eq!((ball.order, ball.closed, ball.periodic, ball.estimate), (4, true, true, Some(4)));
    assert_eq!((ball.dimension, ball.chords, ball.knots.as_ref()), (2, 40, None));
    assert_eq!(ball.vertices, [[1., 0., 0., 1.], [0., 1., 0., 1.], [-1., 0., 0., 1.], [0., -1., 0., 1.]]);
    same(
        "BSPLINE ORDER=4 CLOSED PERIODIC N=4 VERTICES = 1,0  0,1  -1,0  0,-1  CHORDS=40;",
        "BS CHORDS 40 CLOSED ORDER 4 N 4 1,0 0 1 -1,0 0 -1;",
    );
    let open = bspline("BSPLINE ORDER 3 1,0,0 0,1,0 0,0,1 KNOTS = 0,0,0 1 1 1 CHORDS = 9;");
    assert_eq!((open.closed, open.periodic, open.dimension), (false, false, 3));
    assert_eq!(open.knots, Some(vec![0., 0., 0., 1., 1., 1.]));
    assert!(!bspline("BSPLINE ORDER 3 CLOSED NONPERIODIC 1,0 0,1 1,1 CHORDS 3;").periodic);
    let weighted = bspline("RATIONAL BSPLINE ORDER = 3 VERTICES = 1,0,1 1,1,.5 0,1,1 CHORDS = 8;");
    assert_eq!((weighted.rational, weighted.dimension), (true, 2));
    assert_eq!(weighted.vertices[1], [1.0, 1.0, 0.0, 0.5]);
}

#[test]
fn what_is_missing_in_a_curve_is_named() {
    assert_eq!(message("BSPLINE 1,0 0,1 CHORDS 3;"), "1:25: expected ORDER, found `;`");
    assert_eq!(message("BSPLINE ORDER 3 CHORDS 3;"), "1:25: expected VERTICES, found `;`");
    assert_eq!(message("BSPLINE ORDER 3 1,0 0,1;"), "1:24: expected CHORDS, found `;`");
    assert_eq!(message("BSPLINE ORDER 11;"), "1:15: the number must be 1 to 10, found `11`");
    assert_eq!(message("BSPLINE ORDER 3 1,0 0,1 CHORDS 0;"), "1:32: the number must be 1 to 1048576, found `0`");
    assert!(message("BSPLINE ORDER 3 1 0 0 1 CHORDS 3;").starts_with("1:19: put commas between the components"));
    assert!(message("BSPLINE ORDER 3 CHORD 3;").ends_with("found `CHORD`, too short for CHORDS, which needs CHORDS"));
}

#[test]
fn rows_of_a_polynomial_fit_its_order() {
    let line = polynomial("POLY ORDER = 1 COEFF = 1,2 3,4 CHORDS = 1;");
    assert_eq!(line.coefficients, [[1., 2., 0., 0.], [3., 4., 0., 1.]]);
    assert_eq!((line.order, line.dimension, line.rational), (Some(1), 2, false));
    let circle = polynomial("RATIONAL POLYNOMIAL COEFFICIENTS = -1,0,1 0,2,0 1,0,1 CHORDS = 20;");
    assert_eq!((circle.order, circle.dimension, circle.rational), (None, 2, true));
    assert_eq!(circle.coefficients, [[-1., 0., 0., 1.], [0., 2., 0., 0.], [1., 0., 0., 1.]]);
    assert!(
        message("POLY ORDER = 2 COEFF = 1,2 3,4 CHORDS = 1;")
            .starts_with("1:24: a polynomial of order 2 has 3 rows of coefficients")
    );
    let rows = "1,1 ".repeat(12);
    assert!(message(&format!("POLY COEFF = {rows} CHORDS 3;")).contains("order 10 has 11 rows"));
}

#[test]
fn labels_are_pairs_of_place_and_text() {
    let Object::Labels(labels) = object("LABELS 0,0 'a' 1,1,1 'it''s' , 2 2 '';") else { panic!("LABELS") };
    let texts: Vec<&[u8]> = labels.labels.iter().map(|label| &*label.text).collect();
    assert_eq!(texts, [&b"a"[..], b"it's", b""]);
    assert_eq!(labels.labels[1].position, DVec3::ONE);
    assert_eq!(message("LABELS;"), "1:7: expected a number, found `;`");
    assert_eq!(message("LABELS 1,1;"), "1:11: expected a text in quotes, found `;`");
}

#[test]
fn texts_have_at_most_240_characters() {
    assert!(parse(format!("CHAR '{}';", "a".repeat(240)).as_bytes()).is_ok());
    assert!(parse(format!("CHAR '{}';", "''".repeat(240)).as_bytes()).is_ok());
    for (text, rest) in
        [("CHAR ", ""), ("LABELS 0,0 ", ""), ("A := CHARACTERS 0,0 STEP 1,0 ", ""), ("SEND ", " TO <1>A")]
    {
        let [long, whole] = [241, 240].map(|length| {
            let mut reader = CommandReader::default();
            reader.push(format!("{text}'{}'{rest};", "a".repeat(length)).as_bytes());
            reader.next().unwrap().unwrap()
        });
        assert_eq!(long.command, whole.command, "the rest is cut off");
        assert_eq!(whole.warnings, []);
        let [warning] = &long.warnings[..] else { panic!("{:?}", long.warnings) };
        assert_eq!((warning.problem, warning.span.clone()), (Problem::LongString, text.len()..text.len() + 243));
    }
}

#[test]
fn characters_of_a_font_are_itemized_lists_in_the_plane() {
    let Ok(Command::FontCharacter(character)) = parse(b"C[65]: N = 3 L 0,0 L .5,1 P 1 0;") else { panic!("font") };
    assert_eq!((character.code, character.estimate), (65, Some(3)));
    // The first is a position whatever its mark.
    assert_eq!(character.points, [([0.0, 0.0], false), ([0.5, 1.0], true), ([1.0, 0.0], false)]);
    assert!(matches!(parse(b"c[0]:;"), Ok(Command::FontCharacter(empty)) if empty.points.is_empty()));
    assert_eq!(message("C[128]: P 0,0;"), "1:3: the number must be 0 to 127, found `128`");
    assert_eq!(message("C[1]: P 0,0 I=1;"), "1:13: expected P, L or `;`, found `I`");
    assert!(matches!(parse(b"C := BEGIN_F;"), Ok(Command::Define { object: Object::BeginFont, .. })));
}

#[test]
fn a_pattern_is_an_object_before_numbers_and_a_command_before_a_name() {
    let Object::Pattern(dashes) = object("DASH := PATTERN 1 3 AROUND NOMATCH LENGTH 1;") else { panic!("PATTERN") };
    assert_eq!((&dashes.segments[..], dashes.around_corners, dashes.matched), (&[1.0, 3.0][..], true, false));
    let Object::Pattern(dashes) = object("PAT 1,2,3 LEN=.5;") else { panic!("PATTERN") };
    assert_eq!((dashes.segments.len(), dashes.matched, dashes.length), (3, true, 0.5));
    let expected = Command::PatternWith { name: name("A"), pattern: name("B") };
    assert_eq!(parse(b"PATTERN A WITH B;"), Ok(expected));
    let with = Command::PatternWith { name: name("WITH"), pattern: name("WITH") };
    assert_eq!(parse(b"PAT WITH WITH WITH;"), Ok(with));
    assert_eq!(parse(b"ERASE PAT FROM A.B;"), Ok(Command::ErasePattern(name("A.B"))));
    assert!(message("PATTERN 1 2;").starts_with("1:12: expected LENGTH"));
    assert!(message(&format!("PATTERN {}LENGTH 1;", "1 ".repeat(33))).contains("at most 32 lengths"));
}

#[test]
fn a_copy_says_where_it_starts_and_how_much_it_takes() {
    same("A := COPY B START = 2 COUNT = 3;", "A := copy b 2, 3;");
    same("A := COPY START START = 2 COUNT = 3;", "A := COPY START 2 3;");
    assert_eq!(object("COPY B 1 5;"), Object::Copy { source: name("B"), start: 1, count: 5 });
    assert_eq!(message("COPY B 0 5;"), "1:8: the number must be 1 to 4294967295, found `0`");
    assert_eq!(object("R := RAWBLOCK 1000;"), Object::RawBlock(1000));
}
