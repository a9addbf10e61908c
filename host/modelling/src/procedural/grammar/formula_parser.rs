//! Expressions of a grammar into formulas.

use super::error::{GrammarError, GrammarProblem};
use super::formula::{Formula, MOST_HELD, StackOperation};
use super::function::{FUNCTIONS, MathFunction, OPERATORS};
use super::scanner::Cursor;
use crate::spelling;

/// Most expressions in one another.
const MOST_NESTED: usize = 40;
/// Most operations of a formula.
const MOST_OPERATIONS: usize = 1000;
/// How strongly `or`, `and`, a sign and a power bind, beside [`OPERATORS`].
const OR: u8 = 1;
const AND: u8 = 2;
const SIGN: u8 = 7;
const POWER: u8 = 8;

/// The names that an expression may use.
#[derive(Clone, Copy, Debug)]
pub(super) struct Names<'a> {
    /// Parameters of the modules at which a production applies.
    pub formals: &'a [String],
    /// Constants and parameters of the grammar.
    pub globals: &'a [String],
}

impl Names<'_> {
    fn operation(&self, name: &str) -> Option<StackOperation> {
        let position = |names: &[String]| names.iter().position(|known| known == name);
        let formal = position(self.formals).map(|index| StackOperation::Formal(index as u8));
        formal.or_else(|| position(self.globals).map(|index| StackOperation::Global(index as u16)))
    }
}

/// Reads an expression.
pub(super) fn formula(cursor: &mut Cursor, names: Names) -> Result<Formula, GrammarError> {
    let mut formula = Formula::default();
    let start = cursor.clone();
    expression(cursor, names, 0, 0, &mut formula)?;
    if formula.len() > MOST_OPERATIONS {
        return Err(start.fault(GrammarProblem::TooMany { what: "operations in an expression", most: MOST_OPERATIONS }));
    }
    if formula.held() > MOST_HELD {
        return Err(start.fault(GrammarProblem::TooMany { what: "numbers held by an expression", most: MOST_HELD }));
    }
    Ok(formula)
}

/// Reads operands and operators that bind more strongly than `least`.
fn expression(
    cursor: &mut Cursor,
    names: Names,
    least: u8,
    depth: usize,
    out: &mut Formula,
) -> Result<(), GrammarError> {
    if depth > MOST_NESTED {
        return Err(cursor.fault(GrammarProblem::TooMany { what: "expressions in one another", most: MOST_NESTED }));
    }
    operand(cursor, names, depth, out)?;
    loop {
        cursor.skip_blanks();
        if cursor.is_at_arrow() || cursor.is_at("+/-") {
            return Ok(());
        }
        let place = cursor.place();
        let guarded = [("&&", true, AND), ("&", true, AND), ("||", false, OR), ("|", false, OR)];
        let found = guarded.into_iter().find(|(sign, _, binding)| cursor.is_at(sign) && *binding > least);
        if let Some((sign, is_and, binding)) = found {
            cursor.take(sign);
            let mut second = Formula::default();
            expression(cursor, names, binding, depth + 1, &mut second)?;
            out.push_second(is_and, second, place);
            continue;
        }
        // The longest sign decides, even if it binds too weakly here.
        let operator = OPERATORS.iter().find(|(sign, ..)| cursor.is_at(sign));
        let Some((sign, binding, function)) = operator.filter(|(_, binding, _)| *binding > least) else {
            return Ok(());
        };
        cursor.take(sign);
        // Powers are taken from the right.
        let least = if *binding == POWER { POWER - 1 } else { *binding };
        expression(cursor, names, least, depth + 1, out)?;
        out.push(StackOperation::Apply(*function), place);
        if out.len() > MOST_OPERATIONS {
            let problem = GrammarProblem::TooMany { what: "operations in an expression", most: MOST_OPERATIONS };
            return Err(GrammarError { place, problem });
        }
    }
}

/// Reads a number, a name, a call, a sign with its operand, or an expression in brackets.
fn operand(cursor: &mut Cursor, names: Names, depth: usize, out: &mut Formula) -> Result<(), GrammarError> {
    cursor.skip_blanks();
    let place = cursor.place();
    if let Some(number) = cursor.take_number()? {
        out.push(StackOperation::Number(number), place);
        return Ok(());
    }
    for (sign, function, binding) in [("-", MathFunction::Negate, SIGN), ("!", MathFunction::Not, SIGN)] {
        if !cursor.is_at_arrow() && cursor.take(sign) {
            expression(cursor, names, binding, depth + 1, out)?;
            out.push(StackOperation::Apply(function), place);
            return Ok(());
        }
    }
    if cursor.take("(") {
        expression(cursor, names, 0, depth + 1, out)?;
        return cursor.require(")");
    }
    let before = cursor.clone();
    let Some(name) = cursor.take_name() else { return Err(before.expected("a number, a name or `(`")) };
    if cursor.peek() == Some('(') {
        let Some((_, function)) = FUNCTIONS.iter().find(|(known, _)| *known == name) else {
            let known: Vec<&str> = FUNCTIONS.iter().map(|(known, _)| *known).collect();
            return Err(before.fault(unknown("function", name, &known)));
        };
        cursor.require("(")?;
        for operand in 0..function.arity() {
            if operand > 0 {
                cursor.require(",")?;
            }
            expression(cursor, names, 0, depth + 1, out)?;
        }
        cursor.require(")")?;
        out.push(StackOperation::Apply(*function), place);
        return Ok(());
    }
    match names.operation(&name) {
        Some(operation) => out.push(operation, place),
        None => {
            let known: Vec<&str> = names.formals.iter().chain(names.globals).map(String::as_str).collect();
            return Err(GrammarError { place, problem: unknown("parameter or constant", name, &known) });
        }
    }
    Ok(())
}

/// The problem of a name that is not known.
pub(super) fn unknown(what: &'static str, name: String, known: &[&str]) -> GrammarProblem {
    let advice = spelling::advice(&name, known);
    GrammarProblem::UnknownName { what, name, advice }
}

#[cfg(test)]
mod tests {
    use super::super::error::ArithmeticProblem;
    use super::super::function::ModuleRandom;
    use super::super::scanner::statements;
    use super::*;

    fn read(text: &str) -> Result<Formula, GrammarError> {
        let names = |names: [&str; 2]| names.map(str::to_owned);
        let (formals, globals) = (names(["x", "y"]), names(["c", "d"]));
        let statements = statements(text)?;
        let mut cursor = statements[0].cursor();
        let found = formula(&mut cursor, Names { formals: &formals, globals: &globals })?;
        cursor.require_end()?;
        Ok(found)
    }

    /// The value with x = 3, y = 5, c = 7, d = 0, both before and after it is bound.
    fn value(text: &str) -> Result<f64, ArithmeticProblem> {
        let formula = read(text).expect("a formula").bound(&[7.0, 0.0]);
        formula.evaluate(&[3.0, 5.0], &mut ModuleRandom::new(1)).map_err(|error| error.problem)
    }

    #[test]
    fn operators_bind_as_in_mathematics() {
        let rows = [
            ("1 + 2 * 3", 7.0),
            ("2 * 3 ^ 2", 18.0),
            ("-2 ^ 2", -4.0),
            ("2 ^ -1", 0.5),
            ("2 ^ 3 ^ 2", 512.0),
            ("10 - 4 - 3", 3.0),
            ("12 / 2 / 3", 2.0),
            ("x + y * c", 38.0),
            ("(x + y) * c", 56.0),
            ("17 % 5 + 1", 3.0),
            ("x < y & y < c", 1.0),
            ("x > y | y = 5 && c >= 7", 1.0),
            ("!(x > y) + 1", 2.0),
            ("(x == 3 | 1/d) + 1", 2.0),
            ("(x != 3 & 1/d) + (2 & 3)", 1.0),
            ("sin(30) + cos(60)", 1.0),
            ("floor(2.7) + ceil(0.2) * pow(2, x)", 10.0),
            ("min(x, y) + max(x, y) - abs(-8) + sign(-2)", -1.0),
            ("atan2(1, 1) + 1.5e1", 60.0),
        ];
        for (text, expected) in rows {
            let found = value(text);
            assert!(found.is_ok_and(|found| (found - expected).abs() < 1e-12), "{text}: {found:?}");
        }
    }

    #[test]
    fn what_has_no_value_is_said_where_it_is_needed_and_only_there() {
        assert_eq!(value("x / (y - 5)"), Err(ArithmeticProblem::DivisionByZero));
        assert_eq!(value("1 / d"), Err(ArithmeticProblem::DivisionByZero));
        assert_eq!(value("x % d"), Err(ArithmeticProblem::DivisionByZero));
        assert_eq!(value("sqrt(d - 1)"), Err(ArithmeticProblem::NotFinite("sqrt")));
        assert_eq!(value("exp(1000)"), Err(ArithmeticProblem::NotFinite("exp")));
        assert_eq!(value("d != 0 && 1 / d > 3"), Ok(0.0));
        let error = read("x +\n  1 / d").expect("a formula").bound(&[7.0, 0.0]);
        let error = error.evaluate(&[0.0, 0.0], &mut ModuleRandom::new(1)).expect_err("no value");
        assert_eq!(error.to_string(), "line 2, column 5: division by zero");
    }

    #[test]
    fn faults_say_what_was_expected_and_what_was_found() {
        let fault = |text: &str| read(text).expect_err("a fault").to_string();
        assert_eq!(fault("1 + * 2"), "line 1, column 5: expected a number, a name or `(`, found `*`");
        assert_eq!(fault("(1 + 2"), "line 1, column 7: expected `)`, found the end of the statement");
        assert_eq!(fault("min(1)"), "line 1, column 6: expected `,`, found `)`");
        assert_eq!(fault("flor(1)"), "line 1, column 1: there is no function `flor`; did you mean floor?");
        assert_eq!(fault("x + z"), "line 1, column 5: there is no parameter or constant `z`; there are x, y, c, d");
        assert!(fault(&"(".repeat(100)).contains("expressions in one another"));
        assert!(fault(&format!("1{}", "^1".repeat(100))).contains("expressions in one another"));
        assert!(fault(&format!("1{}", "+1".repeat(2000))).contains("operations"));
    }
}
