//! Grammars within grammars.

use super::error::{DerivationError, TextPlace};
use super::lsystem::LSystem;
use super::specimen::Specimen;
use super::turtle::EmptyEnvironment;
use crate::procedural::Varied;
use crate::procedural::drawing::PlantDrawing;
use glam::DVec3;

fn try_draw(text: &str, given: &[(&str, Varied)]) -> Result<PlantDrawing, DerivationError> {
    let specimen = Specimen::new(&LSystem::parse(text).expect("a grammar"), 1, given)?;
    specimen.draw(&specimen.derive(None, &EmptyEnvironment)?)
}

fn draw(text: &str) -> PlantDrawing {
    try_draw(text, &[]).expect("a drawing")
}

/// A leaf that grows by a segment with two side branches a step.
const LEAF: &str = "grammar leaf:\nderivation length: 2\nangle: 30\nwidth: 0.2\naxiom: X\nX -> F[+F][-F]X";

#[test]
fn a_grammar_is_drawn_where_its_module_stands() {
    let written = draw("width: 0.2\naxiom: F+(90)F[F[+(30)F][-(30)F]F[+(30)F][-(30)F]]F");
    assert_eq!(draw(&format!("width: 0.2\naxiom: F+F~leaf F\n{LEAF}")), written);
    // It may stand in what interpretation makes, and its own axiom may be interpreted.
    let text = format!("width: 0.2\naxiom: F+F L F\ninterpretation:\nL -> ~leaf\n{}", LEAF.replace("[-F]", "S"));
    assert_eq!(draw(&format!("{text}\ninterpretation:\nS -> [-F]")), written);
}

#[test]
fn settings_productions_and_contexts_of_grammars_are_their_own() {
    // F means another length and angle in each, and has another production.
    let text = "derivation length: 1\nlength: 2\nangle: 90\naxiom: +F~in(1,1)\nF -> FF\n\
        grammar in:\nlength: 1\nangle: 45\naxiom: -F G\nF < G -> F F";
    let ends: Vec<DVec3> = draw(text).strokes().map(|stroke| stroke[stroke.len() - 1].position).collect();
    let expected = DVec3::NEG_X * 4.0 + DVec3::new(-1.0, 1.0, 0.0) * (3.0 / 2.0_f64.sqrt());
    assert!(ends.len() == 2 && (ends[1] - expected).length() < 1e-12, "{ends:?}");
}

#[test]
fn modules_say_how_large_and_how_old_a_grammar_is() {
    let lines = |module: &str| {
        let drawing = draw(&format!("axiom: {module}\n{LEAF}"));
        drawing.nodes.len() - drawing.strokes.len()
    };
    assert_eq!(["~leaf", "~leaf(1)", "~leaf(1,0)", "~leaf(1,1)", "~leaf(1,5.9)"].map(lines), [6, 6, 0, 3, 15]);
    assert_eq!(["~leaf(1,0-3)", "~leaf(0)", "~leaf(0-1)"].map(lines), [0; 3]);
    let (one, twice) = (draw(&format!("axiom: ~leaf\n{LEAF}")), draw(&format!("axiom: ~leaf(2)\n{LEAF}")));
    for (one, twice) in one.nodes.iter().zip(&twice.nodes) {
        assert!((twice.position - 2.0 * one.position).length() < 1e-12 && twice.radius == 2.0 * one.radius);
    }
    // Scales multiply, of lines, spheres and surfaces alike.
    let text = "axiom: ~a(4)\ngrammar a:\naxiom: f(1)~b(2)\ngrammar b:\naxiom: F(1)@O(1)~plate(1)\n\
        surface plate:\n  polygon (0,0,0) (1,0,0) (0,1,0)";
    let drawing = draw(text);
    assert_eq!((drawing.nodes[1].position, drawing.nodes[1].radius), (DVec3::Y * 12.0, 0.4));
    assert_eq!((drawing.spheres[0].centre, drawing.spheres[0].radius), (DVec3::Y * 12.0, 4.0));
    let placement = drawing.placed[0].placement;
    assert!((placement.transform_point3(DVec3::Y) - DVec3::Y * 20.0).length() < 1e-12);
}

#[test]
fn growing_parts_are_placed_by_their_age() {
    let text = format!(
        "derivation length: 3\naxiom: A\nA -> F L(0)A\nL(t) -> L(t+1)\n\
        interpretation:\nL(t) -> ~leaf(0.1,t)\n{LEAF}"
    );
    // Three internodes in one stroke; leaves of ages 2, 1 and 0.
    let drawing = draw(&text);
    assert_eq!(drawing.nodes.len() - drawing.strokes.len(), 3 + 6 + 3);
    assert_eq!(drawing.strokes().next().map(<[_]>::len), Some(4));
}

#[test]
fn variants_differ_by_chance_and_equal_ones_are_alike() {
    let text = "axiom: ~in(1,9,1)f(100)~in(1,9,1)f(100)~in(1,9,2)\n\
        grammar in:\naxiom: F(1)\nF(l) -> F(l)F(ran(1)) : 0.5\nF(l) -> F(l) : 0.5";
    let drawing = draw(text);
    let lengths: Vec<Vec<f64>> = drawing
        .strokes()
        .map(|stroke| stroke.windows(2).map(|pair| (pair[1].position - pair[0].position).length()).collect())
        .collect();
    let alike = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    assert_eq!(lengths.len(), 3);
    assert!(alike(&lengths[0], &lengths[1]) && !alike(&lengths[0], &lengths[2]));
    assert_eq!(drawing, draw(text));
}

#[test]
fn grammars_within_share_constants_parameters_and_surfaces() {
    let text = "parameter a = 3\n#define b a*2\naxiom: ~in\ngrammar in:\n#define c b+1\naxiom: F(c)";
    let end = |given: &[(&str, Varied)]| try_draw(text, given).expect("a drawing").nodes[1].position;
    assert_eq!(end(&[]), DVec3::Y * 7.0);
    assert_eq!(end(&[("a", Varied { mean: 5.0, deviation: 0.0 })]), DVec3::Y * 11.0);
}

#[test]
fn grammars_that_place_each_other_need_an_end() {
    let tree = "axiom: ~tree(1,3)\ngrammar tree:\naxiom: A(3)\nA(n) -> A(n-1)\n\
        interpretation:\nA(n) : n<3 -> F[+~tree(0.5,2-n)]";
    assert!(try_draw(tree, &[]).is_ok());
    let endless = try_draw("axiom: ~a\ngrammar a:\naxiom: F~b\ngrammar b:\naxiom: ~a", &[]);
    assert_eq!(endless, Err(DerivationError::EndlessNesting { most: 100 }));
    let exploding = try_draw("axiom: ~a(1,100)\ngrammar a:\naxiom: F\nF -> FF", &[]);
    assert!(matches!(exploding, Err(DerivationError::TooManyModules { step: 100, .. })));
    assert_eq!(
        try_draw("axiom: ~a(1,1e9)\ngrammar a:\naxiom: F", &[]),
        Err(DerivationError::TooManySteps { steps: 1_000_000_000, most: 100_000 })
    );
}

#[test]
fn faults_within_grammars_have_places() {
    let rows = [
        ("axiom: F\ngrammar leaf:\nF -> FF", "line 2, column 1: the grammar has no axiom"),
        ("axiom: F\ngrammar leaf\naxiom: F", "line 2, column 13: expected `:`, found the end of the statement"),
        ("axiom: F\ngrammar a:\naxiom: F\ngrammar a:\naxiom: F", "line 4, column 8: `a` is given twice"),
        ("axiom: ~b\ngrammar a:\naxiom: F", "line 1, column 9: there is no surface or grammar `b`; there are a"),
        ("axiom: F\ngrammar a:\naxiom: F\naxiom: G", "line 4, column 7: `axiom` is given twice"),
    ];
    for (text, expected) in rows {
        assert_eq!(LSystem::parse(text).expect_err("a fault").to_string(), expected, "{text}");
    }
    let fault = try_draw("axiom: ~a\ngrammar a:\nangle: 1\nwidth: 0-1\naxiom: F", &[]).expect_err("a fault");
    let DerivationError::OutOfRange { place, .. } = fault else { panic!("{fault}") };
    assert_eq!(place, TextPlace { line: 4, column: 8 });
}
