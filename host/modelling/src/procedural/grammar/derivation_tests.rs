//! What strings grammars derive.

use super::alphabet::ModuleString;
use super::error::{ArithmeticProblem, DerivationError, EvaluationError, TextPlace};
use super::figures::ABOP_FIGURES;
use super::lsystem::LSystem;
use super::rewriting::MOST_MODULES;
use super::specimen::Specimen;
use super::turtle::{EmptyEnvironment, TurtlePose};
use crate::procedural::{Varied, VariedError};

fn specimen(text: &str) -> Specimen {
    let system = LSystem::parse(text).expect("a grammar");
    Specimen::new(&system, 5, &[]).expect("a specimen")
}

fn try_string(text: &str, steps: u32) -> Result<ModuleString, DerivationError> {
    specimen(text).derive(Some(steps), &EmptyEnvironment)
}

fn string(text: &str, steps: u32) -> String {
    try_string(text, steps).expect("a string").to_string()
}

#[test]
fn algae_of_lindenmayer_have_fibonacci_numbers() {
    let text = "axiom: A\nA -> AB\nB -> A";
    assert_eq!(string(text, 5), "ABAABABAABAAB");
    let lengths = [0, 1, 2, 3, 4, 5, 25].map(|steps| string(text, steps).len());
    assert_eq!(lengths, [1, 2, 3, 5, 8, 13, 196_418]);
}

/// The string that the book derives from its parametric example, equation 1.4.
#[test]
fn the_parametric_example_of_the_book_is_derived() {
    let text = "axiom: B(2)A(4,4)\nA(x,y) : y<=3 -> A(x*2,x+y)\nA(x,y) : y>3 -> B(x)A(x/y,0)\n\
        B(x) : x<1 -> C\nB(x) : x>=1 -> B(x-1)";
    let expected = ["B(2)A(4,4)", "B(1)B(4)A(1,0)", "B(0)B(3)A(2,1)", "CB(2)A(4,3)", "CB(1)A(8,7)"];
    for (steps, expected) in expected.into_iter().enumerate() {
        assert_eq!(string(text, steps as u32), expected);
    }
}

/// The example of section 1.8: contexts see past brackets.
#[test]
fn contexts_see_past_brackets_as_in_the_book() {
    let with = |production: &str| string(&format!("axiom: ABC[DE][SG[HI[JK]L]MNO]\n{production}"), 1);
    let replaced = "ABC[DE][XG[HI[JK]L]MNO]";
    for production in ["BC < S > G[H]M -> X", "ABC<S->X", "S > G[HI[J]L]MN -> X", "S > GMNO -> X", "C < S > G[H] -> X"]
    {
        assert_eq!(with(production), replaced, "{production}");
    }
    for production in
        ["E < S -> X", "S > H -> X", "S > G[I] -> X", "S > GMNOP -> X", "S > G[H][M] -> X", "[S] < G -> X"]
    {
        let found = LSystem::parse(&format!("axiom: ABC[DE][SG[HI[JK]L]MNO]\n{production}"));
        if found.is_ok() {
            assert_eq!(with(production), "ABC[DE][SG[HI[JK]L]MNO]", "{production}");
        }
    }
    // The second of two branches matches, past modules that are ignored.
    let text = "#ignore: + -\naxiom: S+[A]-[+B C]-D\nS > [B]D -> X";
    assert_eq!(string(text, 1), "X+[A]-[+BC]-D");
    assert_eq!(string("#consider: S D\naxiom: S+[A]-Q D\nS > D -> X", 1), "X+[A]-QD");
    assert_eq!(string("axiom: S+D\nS > D -> X", 1), "S+D");
}

#[test]
fn parameters_of_contexts_are_bound_in_the_order_of_the_text() {
    let text = "#ignore: +\naxiom: A(1)B(2,3)+C(4)[D(5)E(6)]F(7)\nA(a)B(b,c) < C(d) > [D(e)]F(g) -> X(a,b,c,d,e,g)";
    assert_eq!(string(text, 1), "A(1)B(2,3)+X(1,2,3,4,5,7)[D(5)E(6)]F(7)");
}

/// Derives as the definition says, by looking for neighbours letter by letter.
fn derived_by_definition(text: &str, steps: u32) -> String {
    let rows: Vec<(Vec<char>, String)> = text
        .lines()
        .filter_map(|line| line.split_once(" -> "))
        .map(|(left, right)| (left.chars().filter(|c| !" <>".contains(*c)).collect(), right.to_owned()))
        .collect();
    let mut letters: Vec<char> = "F1F1F1".chars().collect();
    let is_state = |c: char| c == '0' || c == '1';
    for _ in 0..steps {
        let mut next = String::new();
        for (at, letter) in letters.iter().enumerate() {
            let (mut depth, mut left) = (0, None);
            for c in letters[..at].iter().rev() {
                match c {
                    ']' => depth += 1,
                    '[' if depth > 0 => depth -= 1,
                    c if depth == 0 && is_state(*c) => {
                        left = Some(*c);
                        break;
                    }
                    _ => {}
                }
            }
            let (mut depth, mut right) = (0, None);
            for c in &letters[at + 1..] {
                match c {
                    '[' => depth += 1,
                    ']' if depth == 0 => break,
                    ']' => depth -= 1,
                    c if depth == 0 && is_state(*c) => {
                        right = Some(*c);
                        break;
                    }
                    _ => {}
                }
            }
            let applies = |row: &&(Vec<char>, String)| match row.0[..] {
                [l, own, r] => Some(l) == left && own == *letter && Some(r) == right,
                [own] => own == *letter,
                _ => false,
            };
            match rows.iter().find(applies) {
                Some((_, successor)) => next.push_str(successor),
                None => next.push(*letter),
            }
        }
        letters = next.chars().collect();
    }
    letters.into_iter().collect()
}

#[test]
fn plants_of_two_cell_states_are_those_of_the_definition() {
    let figures: Vec<_> = ABOP_FIGURES.iter().filter(|figure| figure.name.starts_with("hogeweg")).collect();
    assert_eq!(figures.len(), 5);
    for figure in figures {
        let steps = specimen(figure.grammar).steps();
        assert_eq!(string(figure.grammar, steps), derived_by_definition(figure.grammar, steps), "{}", figure.title);
    }
}

/// Makes 2^15 modules that draw what they become.
const CHANCE: &str =
    "axiom: S(15)\nS(n) : n>0 -> S(n-1)S(n-1)\nS(n) : n=0 -> B(ran(1)) : 0.3\nS(n) : n=0 -> C(nran(0,1)) : 0.7";

#[test]
fn probabilities_are_met_and_depend_on_the_seed_alone() {
    let system = LSystem::parse(CHANCE).expect("a grammar");
    let of = |seed| {
        Specimen::new(&system, seed, &[]).expect("a specimen").derive(Some(16), &EmptyEnvironment).expect("a string")
    };
    let first = of(1);
    let share = first.count("B") as f64 / first.len() as f64;
    // Three standard errors of 32768 draws.
    assert!(first.len() == 1 << 15 && (share - 0.3).abs() < 3.0 * (0.21_f64 / 32768.0).sqrt(), "{share}");
    assert!(first == of(1) && first != of(2));
    let uniform: Vec<f64> =
        first.modules().filter(|(name, _)| *name == "B").map(|(_, parameters)| parameters[0]).collect();
    let mean = uniform.iter().sum::<f64>() / uniform.len() as f64;
    assert!((mean - 0.5).abs() < 0.01, "{mean}");
}

#[test]
fn strings_are_the_same_for_any_number_of_threads() {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let [one, three] = [1, 3].map(|threads| pool(threads).install(|| try_string(CHANCE, 16).expect("a string")));
    assert!(one == three && one.len() > 1 << 14);
}

#[test]
fn grammars_that_explode_are_refused_with_the_count() {
    let fault = |text: &str, steps| try_string(text, steps).expect_err("too long");
    let expected = DerivationError::TooManyModules { step: 100, modules: 1 << 100, most: MOST_MODULES };
    assert_eq!(fault("axiom: F\nF -> FF", 100), expected);
    assert!(matches!(fault("axiom: F\nF -> FF", 1000), DerivationError::TooManyModules { modules: u128::MAX, .. }));
    // Where a condition decides, each step is counted before it is written.
    let text = format!("axiom: F(1)\nF(x) : x>0 -> {}", "F(x)".repeat(2000));
    let expected = DerivationError::TooManyModules { step: 3, modules: 8_000_000_000, most: MOST_MODULES };
    assert_eq!(fault(&text, 3), expected);
    assert_eq!(fault("axiom: F", 4_000_000), DerivationError::TooManySteps { steps: 4_000_000, most: 100_000 });
}

#[test]
fn nothing_gives_nothing() {
    assert_eq!(string("axiom: *\nF -> FF", 1000), "");
    assert_eq!(string("axiom: FF\nF -> *", 1), "");
    let specimen = specimen("axiom: *");
    let drawing = specimen.draw(&specimen.derive(None, &EmptyEnvironment).expect("a string")).expect("a drawing");
    assert!(drawing.bounds().is_empty() && drawing.mesh(0.1).is_ok_and(|mesh| mesh.triangles.is_empty()));
}

#[test]
fn faults_of_formulas_and_probabilities_have_places() {
    let fault = |text: &str| try_string(text, 3).expect_err("a fault");
    let place = TextPlace { line: 2, column: 13 };
    let problem = ArithmeticProblem::DivisionByZero;
    assert_eq!(
        fault("axiom: F(2)\nF(x) -> F(1/(x-2))"),
        DerivationError::Evaluation(EvaluationError { place: TextPlace { line: 2, column: 12 }, problem })
    );
    assert_eq!(
        fault("axiom: F(2)\nF(x) : x > 1/(x-2) -> F"),
        DerivationError::Evaluation(EvaluationError { place, problem })
    );
    let place = TextPlace { line: 2, column: 1 };
    assert_eq!(fault("axiom: F\nF -> F : 0.5\nF -> FF : 0.4"), DerivationError::Probability { place, sum: 0.9 });
    assert_eq!(fault("axiom: F\nF -> F : 0-0.5"), DerivationError::NegativeProbability { place, value: -0.5 });
    let many = |count: usize| format!("axiom: F{}", format!("\nF -> F : 1/{count}").repeat(count));
    assert_eq!(try_string(&many(64), 3).expect("as many as there may be").len(), 1);
    let place = TextPlace { line: 66, column: 1 };
    assert_eq!(fault(&many(65)), DerivationError::TooManyChances { place, most: 64 });
    assert_eq!(
        fault("axiom: F\ndecomposition:\nmaximum depth: 9\nF -> FG"),
        DerivationError::EndlessDecomposition { depth: 9 }
    );
    let endless = specimen("axiom: F\ninterpretation:\nF -> FF");
    let drawn = endless.draw(&endless.derive(Some(1), &EmptyEnvironment).expect("a string"));
    assert_eq!(drawn, Err(DerivationError::EndlessInterpretation { depth: 50 }));
    let system = LSystem::parse("derivation length: 1-2\naxiom: F").expect("a grammar");
    let error = Specimen::new(&system, 1, &[]).expect_err("out of range").to_string();
    assert_eq!(error, "line 1, column 20: derivation length is -1, which is not a whole number, 0 and more");
}

#[test]
fn parameters_are_drawn_about_their_means_or_given() {
    let text = "parameter a = 10 +/- 2 \"an angle\"\nparameter n = 3\n#define b a*2\naxiom: F(a,b,n)";
    let system = LSystem::parse(text).expect("a grammar");
    assert_eq!(system.parameters()[0].description, "an angle");
    assert_eq!(system.parameters()[0].default, Varied { mean: 10.0, deviation: 2.0 });
    let of = |seed, given: &[(&str, Varied)]| {
        Specimen::new(&system, seed, given).map(|specimen| specimen.parameters().to_vec())
    };
    let drawn: Vec<f64> = (0..200).map(|seed| of(seed, &[]).expect("drawn")[0]).collect();
    assert!(drawn.iter().all(|a| (8.0..=12.0).contains(a)));
    assert!(drawn.iter().any(|a| *a < 8.2) && drawn.iter().any(|a| *a > 11.8));
    let exact = Varied { mean: 4.0, deviation: 0.0 };
    assert_eq!(of(1, &[("a", exact)]), Ok(vec![4.0, 3.0]));
    let made = Specimen::new(&system, 1, &[("a", exact)]).expect("drawn").derive(Some(0), &EmptyEnvironment);
    assert_eq!(made.expect("a string").to_string(), "F(4,8,3)");
    let unknown = of(1, &[("m", exact)]).expect_err("unknown").to_string();
    assert_eq!(unknown, "the grammar has no parameter `m`; there are a, n");
    let negative = Varied { mean: 1.0, deviation: -1.0 };
    let expected = DerivationError::Parameter { name: "a".into(), problem: VariedError::NegativeDeviation };
    assert_eq!(of(1, &[("a", negative)]), Err(expected));
}

#[test]
fn cuts_take_away_the_rest_of_their_branch() {
    assert_eq!(string("axiom: AB[C[D]X(1)E[F]G(2)]H(3)\nX(n) -> %", 1), "AB[C[D]]H(3)");
    assert_eq!(string("axiom: A[B]XC\nX -> %", 1), "A[B]");
    assert_eq!(string("axiom: AX[B]\nX -> [%C]", 1), "A[][B]");
}

#[test]
fn decomposition_follows_each_step_to_its_end() {
    // Each step adds a metamer; its parts come from decomposition, some of them in two rounds.
    let text = "axiom: A\nA -> MA\ndecomposition:\nM -> IB\nB -> [L]";
    assert_eq!(string(text, 2), "I[L]I[L]A");
}

/// The growth of a hedge in a box: a module asks where it is, and shoots that leave the box are cut and wake a bud
/// below.
///
/// # Source
/// Prusinkiewicz, James and Mech 1994, "Synthetic topiary".
#[test]
fn shoots_are_pruned_where_they_leave_a_box() {
    let text =
        "axiom: F A?P(0,0,0)\nA > ?P(x,y,z) : y<4.5 -> +(60)F A\nA > ?P(x,y,z) : y>=4.5 -> T\n?P(x,y,z) -> ?P(x,y,z)";
    let text = text.replace("+(60)F", "F");
    let made = try_string(&text, 12).expect("a string");
    // It stands at 1 after the axiom and grows by 1 a step until it has reached 5.
    assert_eq!(made.to_string(), "FFFFFT?P(0,5,0)");
    let directions = try_string("axiom: +(90)F(2)?H(0,0,0)?U(0,0,0)?L(0,0,0)?P(0,0)", 0).expect("a string");
    let expected = [-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0, -2.0, 0.0];
    let found = &directions.parameters()[2..];
    assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-15), "{found:?}");
}

#[test]
fn the_environment_answers_at_the_place_of_the_turtle() {
    // Light falls off with height; buds grow while there is enough of it.
    let light = |pose: &TurtlePose, parameters: &mut [f64]| parameters[0] = 10.0 - pose.position.y;
    let specimen = specimen("axiom: A?E(0)\nA > ?E(l) : l>7 -> F A");
    let made = specimen.derive(Some(10), &light).expect("a string");
    assert_eq!(made.to_string(), "FFFA?E(7)");
    let wrong = |_: &TurtlePose, parameters: &mut [f64]| parameters[0] = f64::NAN;
    assert_eq!(specimen.derive(Some(1), &wrong), Err(DerivationError::NotFinite { module: 1 }));
}
