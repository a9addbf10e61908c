//! What can be wrong with a grammar, with its derivation and with its interpretation, and where.

use crate::memory::MemoryExceeded;
use crate::procedural::VariedError;
use std::fmt;

/// A place in the text of a grammar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct TextPlace {
    /// The line, from 1.
    pub line: u32,
    /// The letter of the line, from 1.
    pub column: u32,
}

impl fmt::Display for TextPlace {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "line {}, column {}", self.line, self.column)
    }
}

/// A fault in the text of a grammar.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct GrammarError {
    /// Where it is.
    pub place: TextPlace,
    /// What is wrong there.
    pub problem: GrammarProblem,
}

/// What can be wrong in the text of a grammar.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GrammarProblem {
    /// One thing stands where another must stand.
    #[error("expected {expected}, found {found}")]
    Expected {
        /// What may stand there.
        expected: String,
        /// What stands there, in quotes, or the end of the statement.
        found: String,
    },
    /// A name that nothing bears.
    #[error("there is no {what} `{name}`; {advice}")]
    UnknownName {
        /// What was looked for.
        what: &'static str,
        /// The name.
        name: String,
        /// Names that it may have meant.
        advice: String,
    },
    /// A name that is given twice.
    #[error("`{0}` is given twice")]
    Twice(String),
    /// A grammar without an axiom, or one within it.
    #[error("the grammar has no axiom")]
    NoAxiom,
    /// A bracket or brace without its partner.
    #[error("`{0}` has no partner in this word")]
    Unbalanced(char),
    /// A bracket where none may be.
    #[error("`{bracket}` may not stand in {what}")]
    Bracket {
        /// The bracket.
        bracket: char,
        /// In what it stands.
        what: &'static str,
    },
    /// More than there may be.
    #[error("more than {most} {what}")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// The limit.
        most: usize,
    },
    /// A number that is out of its range.
    #[error("{what} is {value}, which is not {range}")]
    OutOfRange {
        /// What the number says.
        what: &'static str,
        /// The number.
        value: f64,
        /// Where it must lie.
        range: &'static str,
    },
    /// A constant that has no value.
    #[error(transparent)]
    Arithmetic(#[from] ArithmeticProblem),
    /// A parameter that cannot be drawn.
    #[error(transparent)]
    Varied(#[from] VariedError),
    /// A polygon that cannot be filled.
    #[error("the polygon cannot be filled: {0}")]
    Polygon(String),
    /// More memory than is left.
    #[error(transparent)]
    Memory(#[from] MemoryExceeded),
}

/// An operation of an expression that has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ArithmeticProblem {
    /// A quotient or a remainder.
    #[error("division by zero")]
    DivisionByZero,
    /// A function outside of where it is defined, or a number that is too large.
    #[error("`{0}` has no finite value here")]
    NotFinite(&'static str),
}

/// A fault while a formula is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct EvaluationError {
    /// The operation.
    pub place: TextPlace,
    /// What is wrong with it.
    pub problem: ArithmeticProblem,
}

/// A reason for which a string cannot be derived or interpreted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DerivationError {
    /// A formula without a value.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// Probabilities that are none.
    #[error("{place}: the probabilities of the productions that apply add up to {sum}, not to 1")]
    Probability {
        /// The first of the productions.
        place: TextPlace,
        /// The sum.
        sum: f64,
    },
    /// A probability below 0.
    #[error("{place}: the probability is {value}")]
    NegativeProbability {
        /// The production.
        place: TextPlace,
        /// The probability.
        value: f64,
    },
    /// More productions with a probability that apply to a module than one is drawn of.
    #[error("{place}: more than {most} productions with a probability apply to one module")]
    TooManyChances {
        /// The first that is too much.
        place: TextPlace,
        /// How many there may be.
        most: usize,
    },
    /// A parameter that the grammar does not declare.
    #[error("the grammar has no parameter `{name}`; {advice}")]
    UnknownParameter {
        /// Its name.
        name: String,
        /// Names that it may have meant.
        advice: String,
    },
    /// A parameter that cannot be drawn.
    #[error("parameter `{name}`: {problem}")]
    Parameter {
        /// Its name.
        name: String,
        /// What is wrong with it.
        problem: VariedError,
    },
    /// A number of the grammar that is out of its range with these parameters.
    #[error("{place}: {what} is {value}, which is not {range}")]
    OutOfRange {
        /// Where the number stands.
        place: TextPlace,
        /// What it says.
        what: &'static str,
        /// The number.
        value: f64,
        /// Where it must lie.
        range: &'static str,
    },
    /// More steps than there may be.
    #[error("{steps} derivation steps are more than {most}")]
    TooManySteps {
        /// How many.
        steps: u32,
        /// How many there may be.
        most: u32,
    },
    /// A string that would be too long.
    #[error("step {step} of the derivation gives {modules} modules, more than {most}")]
    TooManyModules {
        /// The step, from 1.
        step: u32,
        /// Modules, or their parameters where these are more; [`u128::MAX`] stands for all that are more.
        modules: u128,
        /// How many there may be.
        most: u64,
    },
    /// Decomposition that does not come to its end.
    #[error("decomposition goes on after {depth} rounds; `maximum depth` sets how many there may be")]
    EndlessDecomposition {
        /// The rounds.
        depth: u32,
    },
    /// Interpretation productions that do not come to their end.
    #[error(
        "interpretation productions apply to what they make more than {depth} times; `maximum depth` sets the most"
    )]
    EndlessInterpretation {
        /// The depth.
        depth: u32,
    },
    /// Grammars that place each other without an end.
    #[error("grammars stand more than {most} deep within one another and within interpretation productions")]
    EndlessNesting {
        /// How deep they may stand.
        most: u32,
    },
    /// Interpretation productions that make more than can be looked at.
    #[error("more than {most} modules are interpreted")]
    TooMuchInterpreted {
        /// How many there may be.
        most: u64,
    },
    /// A place of the turtle that is not finite.
    #[error("the turtle leaves the finite at module {module} of the string")]
    NotFinite {
        /// The module, from 0.
        module: usize,
    },
    /// More memory than is left.
    #[error(transparent)]
    Memory(#[from] MemoryExceeded),
}
