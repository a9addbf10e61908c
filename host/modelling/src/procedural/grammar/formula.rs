//! Arithmetic and conditions, compiled for a stack of numbers.

use super::error::{EvaluationError, TextPlace};
use super::function::{MathFunction, ModuleRandom};

/// Most numbers that a formula holds at once.
pub(super) const MOST_HELD: usize = 24;

/// A step of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StackOperation {
    /// Puts a number on the stack.
    Number(f64),
    /// Puts a parameter of the modules at which a production is applied on the stack.
    Formal(u8),
    /// Puts a constant or a parameter of the grammar on the stack.
    Global(u16),
    /// Replaces operands by the value of a function.
    Apply(MathFunction),
    /// Takes a number away; if it is 0, puts 0 and passes over so many operations.
    And(u16),
    /// Takes a number away; if it is not 0, puts 1 and passes over so many operations.
    Or(u16),
}

/// A compiled expression.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Formula {
    operations: Vec<StackOperation>,
    /// Where each operation stands in the text.
    places: Vec<TextPlace>,
}

impl Formula {
    /// Appends an operation.
    pub fn push(&mut self, operation: StackOperation, place: TextPlace) {
        self.operations.push(operation);
        self.places.push(place);
    }

    /// Appends `and` or `or` with the second operand.
    pub fn push_second(&mut self, is_and: bool, mut second: Formula, place: TextPlace) {
        second.push(StackOperation::Apply(MathFunction::Truth), place);
        self.push_guarded(is_and, second, place);
    }

    fn push_guarded(&mut self, is_and: bool, second: Formula, place: TextPlace) {
        let length = second.operations.len() as u16;
        self.push(if is_and { StackOperation::And(length) } else { StackOperation::Or(length) }, place);
        self.operations.extend(second.operations);
        self.places.extend(second.places);
    }

    /// How many operations there are.
    pub fn len(&self) -> usize {
        self.operations.len()
    }

    /// Where it begins in the text.
    pub fn place(&self) -> TextPlace {
        self.places.first().copied().unwrap_or_default()
    }

    /// Where a parameter of a module or a random number is in it: then it may not stand outside of productions.
    pub fn place_of_module(&self) -> Option<TextPlace> {
        let is_of_module = |operation: &StackOperation| match operation {
            StackOperation::Formal(_) => true,
            StackOperation::Apply(function) => !function.is_pure(),
            _ => false,
        };
        self.operations.iter().position(is_of_module).map(|at| self.places[at])
    }

    /// The constants and parameters of the grammar that it names.
    pub fn globals(&self) -> impl Iterator<Item = usize> {
        self.operations.iter().filter_map(|operation| match operation {
            StackOperation::Global(global) => Some(usize::from(*global)),
            _ => None,
        })
    }

    /// The value of a formula of the whole grammar.
    ///
    /// - `globals`: the values of those that it names.
    pub fn value(&self, globals: &[f64]) -> Result<f64, EvaluationError> {
        self.bound(globals).evaluate(&[], &mut ModuleRandom::new(0))
    }

    /// Most numbers that are on the stack at once.
    pub fn held(&self) -> usize {
        let (mut now, mut most) = (0_usize, 0);
        for operation in &self.operations {
            match operation {
                StackOperation::Apply(function) => now = now + 1 - function.arity(),
                StackOperation::And(_) | StackOperation::Or(_) => now -= 1,
                _ => now += 1,
            }
            most = most.max(now);
        }
        most
    }

    /// The only number that it can be, if it is a number and nothing else.
    pub fn constant(&self) -> Option<f64> {
        match self.operations[..] {
            [StackOperation::Number(number)] => Some(number),
            _ => None,
        }
    }

    /// The only formal parameter that it is, if it is one and nothing else.
    pub fn formal(&self) -> Option<u8> {
        match self.operations[..] {
            [StackOperation::Formal(formal)] => Some(formal),
            _ => None,
        }
    }

    /// The formula with numbers in place of constants and parameters of the grammar; what follows from numbers alone is
    /// worked out. What has no value is left, so that it is a fault only where it is needed.
    pub fn bound(&self, globals: &[f64]) -> Formula {
        let mut bound = Formula::default();
        let mut random = ModuleRandom::new(0);
        // Operands before this are not always worked out.
        let mut sure_from = 0;
        let mut next = 0;
        while next < self.operations.len() {
            let place = self.places[next];
            next += 1;
            match self.operations[next - 1] {
                StackOperation::Global(global) => {
                    bound.push(StackOperation::Number(globals[usize::from(global)]), place);
                }
                StackOperation::Apply(function) if function.is_pure() => {
                    let first =
                        bound.operations.len().checked_sub(function.arity()).filter(|first| *first >= sure_from);
                    let operands = first.and_then(|first| match bound.operations[first..] {
                        [StackOperation::Number(a)] => Some((a, 0.0)),
                        [StackOperation::Number(a), StackOperation::Number(b)] => Some((a, b)),
                        _ => None,
                    });
                    let value = operands.and_then(|(a, b)| function.apply(a, b, &mut random).ok());
                    match (value, first) {
                        (Some(value), Some(first)) => {
                            bound.operations.truncate(first);
                            bound.places.truncate(first);
                            bound.push(StackOperation::Number(value), place);
                        }
                        _ => bound.push(StackOperation::Apply(function), place),
                    }
                }
                StackOperation::And(length) | StackOperation::Or(length) => {
                    let is_and = matches!(self.operations[next - 1], StackOperation::And(_));
                    let end = next + usize::from(length);
                    let second = Formula {
                        operations: self.operations[next..end].to_vec(),
                        places: self.places[next..end].to_vec(),
                    };
                    bound.push_guarded(is_and, second.bound(globals), place);
                    sure_from = bound.operations.len();
                    next = end;
                }
                other => bound.push(other, place),
            }
        }
        bound
    }

    /// The value.
    ///
    /// - `frame`: the formal parameters; each that it names is there.
    ///
    /// # Errors
    /// The first operation without a finite value.
    #[inline]
    pub fn evaluate(&self, frame: &[f64], random: &mut ModuleRandom) -> Result<f64, EvaluationError> {
        let mut stack = [0.0; MOST_HELD + 1];
        let mut top = 0;
        let mut next = 0;
        while let Some(operation) = self.operations.get(next) {
            match *operation {
                StackOperation::Number(number) => {
                    top += 1;
                    stack[top] = number;
                }
                StackOperation::Formal(formal) => {
                    top += 1;
                    stack[top] = frame[usize::from(formal)];
                }
                StackOperation::Global(_) => unreachable!("formulas are evaluated after they are bound"),
                StackOperation::Apply(function) => {
                    let second = if function.arity() == 2 { stack[top] } else { 0.0 };
                    top = top + 1 - function.arity();
                    let fault = |problem| EvaluationError { place: self.places[next], problem };
                    stack[top] = function.apply(stack[top], second, random).map_err(fault)?;
                }
                StackOperation::And(length) if stack[top] == 0.0 => next += usize::from(length),
                StackOperation::Or(length) if stack[top] != 0.0 => {
                    stack[top] = 1.0;
                    next += usize::from(length);
                }
                StackOperation::And(_) | StackOperation::Or(_) => top -= 1,
            }
            next += 1;
        }
        Ok(stack[top])
    }
}
