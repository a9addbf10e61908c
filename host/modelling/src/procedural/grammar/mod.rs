//! L-systems: grammars that grow plants. Strings are derived, drawn by a turtle, and made into triangles.
//!
//! [`LSystem::parse`] understands a grammar, [`Specimen::new`] draws its parameters from a seed, [`Specimen::derive`]
//! makes a string of modules, [`Specimen::draw`] lets a turtle obey it, and [`PlantDrawing::mesh`](super::drawing::PlantDrawing::mesh) makes triangles.
//! [`ABOP_FIGURES`] are figures of "The Algorithmic Beauty of Plants" (ABOP) of Prusinkiewicz and Lindenmayer 1990.
//!
//! # Notation
//! The notation is close to that of the book. A statement begins in the first column; lines that begin with a blank go
//! on with it. `#` with a blank after it begins a comment.
//!
//! ```text
//! # A tree that bends.
//! derivation length: 6                      whole number of steps
//! angle: 22.5                               of + - & ^ \ / without a parameter, degrees; 90 without a word
//! length: 1                                 of F f G g without a parameter
//! width: 0.1                                of lines at the beginning
//! narrowing: 0.707                          factor of ! without a parameter
//! tropism: 0, -1, 0                         direction to which branches bend
//! elasticity: 0.22                          how strongly they do; 0 without a word
//! #define d 137.5                           a constant, of numbers and of what stands before it
//! parameter r = 0.9 +/- 0.05 "description"  a parameter: mean, largest deviation, what it is for
//! names: seg leaf                           names of modules with more than one letter
//! #ignore: + -                              modules that contexts do not see; or
//! #consider: A B                            the only modules that contexts see
//! axiom: !(1)F(2)A(0,1)
//! A(t,w) : t < 3 & w > 0.1 -> F(r)[+A(t+1,w*0.7)]A(t+1,w) : 0.7
//! A(t,w) : t < 3 & w > 0.1 -> F(r)A(t,w) : 0.3
//! B(x) < A(t,w) > C[D(y)] -> A(x+y,w)
//! decomposition:                            productions that apply to what each step made, as long as they can
//! interpretation:                           productions that apply as the turtle reads; also `homomorphism:`
//! maximum depth: 20                         how often they apply to what they made; 50 without a word
//! S -> '(1)~petal(2)
//! productions:                              productions of the derivation again
//! surface petal:                            x to the right of the turtle, y ahead, z along its up vector
//!   polygon (0,0,0) (1,1,0) (-1,1,0)        and `patch` with 16 points, row by row
//! grammar leaf:                             a grammar within this one: settings, axiom and productions of its own
//! derivation length: 3                      follow, up to the next `grammar` or the end
//! axiom: X
//! X -> F[+F][-F]X
//! ```
//!
//! A **module** is one letter or sign, a declared name, `~` with the name of a surface or grammar, or `?` or `@` with a
//! letter. It has any number of parameters in brackets, right behind it; modules with other numbers of parameters are
//! other modules. Blanks part modules where that is needed, as in `- > -`.
//!
//! A **production** is `left < predecessor > right : condition -> successor : probability`; all but predecessor, arrow
//! and successor may be left out, or be `*`. `*` is the empty successor. The arrow is `->`, `-->` or `→`. The first
//! production that applies replaces the module. If it has a probability, all productions that apply and have one share
//! the chance; they must add up to 1. Modules to which none applies stay. Predecessor and contexts name parameters;
//! condition, probability and successor use these, the constants and the parameters of the grammar.
//!
//! **Contexts** see past brackets as in section 1.8 of ABOP: the left context lies on the way to the root, the right
//! one on the way to the tip of the same branch, and what stands in brackets in it at the beginning of a side branch.
//!
//! **Grammars within the grammar** are drawn where a module names them: `~leaf(scale, steps, variant)`, of which the
//! last may be left out. `scale` is a factor of lengths and widths, 1 without a word; nothing is drawn for 0 and less.
//! `steps`, of which the whole part counts, is how old it is, else its derivation length. `variant` is any number, 0
//! without a word: those of one variant and age are alike, others draw other random numbers. The turtle begins with
//! the settings of that grammar and with the colour that it has, and is afterwards as it was. Each derives on its own:
//! contexts see the module, not what it stands for. Constants, parameters, names and surfaces are those of the whole
//! text, wherever they stand. Grammars may place each other, up to 100 deep. Modules that ask are answered there as if
//! the grammar grew alone, in the origin and with nothing around it.
//!
//! **Expressions** have `|` or `||`, `&` or `&&`, `==` or `=`, `!=`, `<`, `<=`, `>`, `>=`, `+`, `-`, `*`, `/`, `%`,
//! signs, `!` and `^`, from weak to strong, and the functions sin, cos, tan, asin, acos, atan, atan2 (degrees), exp,
//! log, sqrt, abs, sign, floor, ceil, trunc, round, min, max, pow, `ran(a)`, which is uniform in 0..a, and `nran(mean,
//! deviation)`, which is normal.
//!
//! **The turtle** obeys the modules that [`turtle_modules`] lists. `%` cuts off the rest of its branch after the step
//! that made it. `?P(x,y,z)`, `?H`, `?U` and `?L` take position, heading, up and left vector of the turtle as
//! parameters after each step, `?E` what an [`Environment`] answers.
//!
//! # Source
//! Lindenmayer 1968. Prusinkiewicz and Lindenmayer 1990. Modules that ask and cuts: Prusinkiewicz, James and Mech 1994;
//! environments: Mech and Prusinkiewicz 1996. Decomposition and interpretation as in the program cpfg: Prusinkiewicz,
//! Hanan and Mech 1999. Grammars within grammars after the sub-L-systems of Hanan 1992 and of cpfg, which derive
//! together with the string around them; here the module says how many steps they have had.
//!
//! *Not modelled:* modules with an age between steps, and sub-L-systems that hear of what is around them.

mod error;
mod function;
mod formula;
mod alphabet;
mod scanner;
mod formula_parser;
mod production;
mod word_parser;
mod predefined;
mod sight;
mod rules;
mod system;
mod lsystem;
mod rewriting;
mod growth;
mod turtle;
mod walk;
mod specimen;
mod figures;

pub use alphabet::ModuleString;
pub use error::{ArithmeticProblem, DerivationError, EvaluationError, GrammarError, GrammarProblem, TextPlace};
pub use figures::{ABOP_FIGURES, AbopFigure};
pub use lsystem::{GrammarParameter, LSystem};
pub use specimen::Specimen;
pub use turtle::{EmptyEnvironment, Environment, TurtlePose, turtle_modules};

#[cfg(test)]
mod derivation_tests;
#[cfg(test)]
mod drawing_tests;
#[cfg(test)]
mod language_tests;
#[cfg(test)]
mod nesting_tests;
