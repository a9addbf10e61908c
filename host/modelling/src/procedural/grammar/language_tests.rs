//! What is said of texts that are no grammars.

use super::error::GrammarProblem;
use super::lsystem::LSystem;

fn fault(text: &str) -> String {
    LSystem::parse(text).expect_err("a fault").to_string()
}

#[test]
fn faults_have_places_and_say_what_was_expected_and_found() {
    let rows = [
        ("", "line 1, column 1: the grammar has no axiom"),
        ("# nothing\n\n", "line 1, column 1: the grammar has no axiom"),
        (
            "axiom: F\nF F",
            "line 2, column 1: expected a production with `->`, or a heading such as `axiom:`, found `F`",
        ),
        ("axiom: F\nFG -> F", "line 2, column 4: expected one module as the strict predecessor, found `->`"),
        ("axiom: F\nF(x -> F", "line 2, column 5: expected `)`, found `->`"),
        ("axiom: F\nF(2) -> F", "line 2, column 3: expected the name of a parameter, found `2)`"),
        ("axiom: F\nF(x) : x> -> F", "line 2, column 11: expected a number, a name or `(`, found `->`"),
        ("axiom: F\nF(x) -> F(y)", "line 2, column 11: there is no parameter or constant `y`; there are x"),
        ("axiom: F\nF -> F[+F", "line 2, column 6: `[` has no partner in this word"),
        ("axiom: F\nF -> F]+[F", "line 2, column 6: `]` has no partner in this word"),
        ("axiom: F\nF -> ~leef", "line 2, column 7: there is no surface or grammar `leef`; there are none"),
        ("axiom: F\n[A] < F -> G", "line 2, column 1: `[` may not stand in a left context"),
        ("axiom: F\n[ -> G", "line 2, column 1: `[` may not stand in a strict predecessor"),
        ("axiom: F\naxiom: G", "line 2, column 7: `axiom` is given twice"),
        ("angle: 3\nangle: 4\naxiom: F", "line 2, column 1: `angle` is given twice"),
        ("#define a 1\n#define a 2\naxiom: F", "line 2, column 9: `a` is given twice"),
        ("axiom: F\nF(x) < F(x) -> G", "line 2, column 13: `x` is given twice"),
        ("parameter a = 1 +/- -2\naxiom: F", "line 1, column 15: the deviation is below 0"),
        (
            "parameter a = 1\nparameter b = a\naxiom: F",
            "line 2, column 15: expected a number that no parameter is part of, found `a`",
        ),
        ("parameter a = 1/0\naxiom: F", "line 1, column 16: division by zero"),
        (
            "angle: ran(3)\naxiom: F",
            "line 1, column 8: expected a number without `ran` and `nran`, which only productions may draw, \
            found one of them",
        ),
        (
            "axiom: F\ndecomposition:\nA < F -> G",
            "line 3, column 1: expected a production without contexts in decomposition and interpretation, found `A`",
        ),
        (
            "axiom: F\nmaximum depth: 0",
            "line 2, column 16: maximum depth is 0, which is not a whole number of 1 to 200",
        ),
        ("axiom: F\nsurface leaf:\n  circle", "line 3, column 3: expected `polygon` or `patch`, found `circle`"),
        (
            "axiom: F\nsurface leaf:\n  patch (0,0,0)",
            "line 3, column 3: expected `patch` with 16 points, found `patch`",
        ),
        ("axiom: F\nF -> F : 0.5 0.5", "line 2, column 14: expected the end of the statement, found `0.5`"),
    ];
    for (text, expected) in rows {
        assert_eq!(fault(text), expected, "{text}");
    }
    assert!(fault("axiom: F\nsurface a:\n polygon (0,0,0) (1,0,0) (2,0,0)").contains("the polygon cannot be filled"));
}

#[test]
fn more_than_there_may_be_is_refused() {
    let letters: String = (0..300).map(|n| char::from_u32(0x4e00 + n).expect("a letter")).collect();
    let problem = |text: &str| LSystem::parse(text).expect_err("too many").problem;
    assert_eq!(problem(&format!("axiom: {letters}")), GrammarProblem::TooMany { what: "kinds of modules", most: 256 });
    let parameters = vec!["1"; 17].join(",");
    let expected = GrammarProblem::TooMany { what: "parameters of a module", most: 16 };
    assert_eq!(problem(&format!("axiom: F({parameters})")), expected);
    let expected = GrammarProblem::TooMany { what: "modules of a word", most: 1 << 16 };
    assert_eq!(problem(&format!("axiom: {}", "F".repeat((1 << 16) + 1))), expected);
    assert!(LSystem::parse(&"x".repeat(1 << 21)).is_err());
}

#[test]
fn no_cut_of_a_grammar_and_no_changed_letter_makes_the_reader_stumble() {
    let text = "parameter a = 1 +/- 0.1 \"x\"\nnames: seg\nsurface leaf:\n polygon (0,0,0) (1,0,0) (0,1,0)\n\
        #ignore: + -\naxiom: F(a)seg[+~leaf(2)]?P(0,0,0)\n\
        A(x)<F(y)>[B]C : x>y && y/2^3<=1 -> F(y+ran(1))% : 0.5\ninterpretation:\nmaximum depth: 3\nseg -> F";
    assert!(LSystem::parse(text).is_ok());
    for end in 0..text.len() {
        let _ = LSystem::parse(&text[..end]);
        for letter in ["(", "]", "-", ":", "<", "\"", "é", "~", "9e9"] {
            let _ = LSystem::parse(&format!("{}{letter}{}", &text[..end], &text[end + 1..]));
        }
    }
}

#[test]
fn comments_long_lines_and_arrows_of_all_forms_are_understood() {
    let forms = ["F->FF", "F --> FF", "F → FF", "* < F > * : * -> F\n  F", "F -> FF  # twice as long", "F -> FF : 1"];
    for form in forms {
        let system = LSystem::parse(&format!("# a comment\n#\naxiom: F\n{form}\n")).expect(form);
        let specimen = super::Specimen::new(&system, 1, &[]).expect("a specimen");
        let made = specimen.derive(Some(3), &super::EmptyEnvironment).expect("a string");
        assert_eq!(made.to_string(), "FFFFFFFF", "{form}");
    }
}
