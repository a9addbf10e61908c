//! Set operations on a command line: `A union B`, `A - B * C`, or the operation first, `difference A B C`.

use crate::solid::Expression;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A set operation on two or more solids.
struct Operation {
    name: &'static str,
    /// The sign that stands for it in scripts.
    sign: &'static str,
    /// Those with more are done first; as in scripts.
    binding: u8,
    /// The expression for all that it combines, two or more.
    of: fn(Vec<Expression>) -> Expression,
}

const OPERATIONS: [Operation; 4] = [
    Operation { name: "union", sign: "+", binding: 2, of: Expression::Union },
    Operation { name: "intersection", sign: "*", binding: 3, of: Expression::Intersection },
    Operation { name: "difference", sign: "-", binding: 2, of: less },
    Operation { name: "symmetric-difference", sign: "^", binding: 1, of: Expression::SymmetricDifference },
];

/// What a command line may say, for its help.
pub(super) const HELP: &str =
    "Closed meshes (.obj, .stl, .ply, .gltf, .glb, .cmesh) with an operation between each two, or with one in front of
them all; their groups stay, one without has its name.

  union, +                 what is in any of the solids
  intersection, *          what is in all of them
  difference, -            what is in the first and in none of the others
  symmetric-difference, ^  what is in an odd number of them

Between solids, * comes first, then + and - from left to right, then ^, as in scripts: a.stl - b.stl * c.stl takes from a
what b and c share. Quote '*', so that the shell leaves it alone. An operation in front combines all solids behind it.";

/// A fault that keeps words from being a formula.
#[derive(Debug, Error, PartialEq)]
pub(super) enum FormulaError {
    /// An operation in the place of a mesh.
    #[error("`{0}` is an operation and stands where a mesh is expected{1}")]
    NotAMesh(String, &'static str),
    /// A mesh in the place of an operation.
    #[error(
        "`{0}` stands where an operation is expected: union (+), intersection ('*', quoted), difference (-) \
         or symmetric-difference (^)"
    )]
    NotAnOperation(String),
    /// The last operation has nothing behind it.
    #[error("a mesh is missing behind `{0}`")]
    Unfinished(String),
    /// A mesh alone, or an operation with less than two.
    #[error("two or more meshes are needed")]
    TooFew,
}

/// The meshes of a formula, and what it makes of them.
pub(super) fn parse(words: &[PathBuf]) -> Result<(Vec<PathBuf>, Expression), FormulaError> {
    let text = |word: &PathBuf| word.to_string_lossy().into_owned();
    if let Some((operation, meshes)) = words.split_first().and_then(|(word, rest)| Some((operation(word)?, rest))) {
        if let Some(other) = meshes.iter().find(|word| self::operation(word).is_some()) {
            return Err(FormulaError::NotAMesh(text(other), "; with an operation in front, all others are meshes"));
        }
        if meshes.len() < 2 {
            return Err(FormulaError::TooFew);
        }
        let all = (0..meshes.len()).map(Expression::Operand).collect();
        return Ok((meshes.to_vec(), (operation.of)(all)));
    }
    let (mut meshes, mut operations) = (Vec::new(), Vec::new());
    for (word, place) in words.iter().zip(0..) {
        match (operation(word), place % 2 == 0) {
            (None, true) => meshes.push(word.clone()),
            (Some(operation), false) => operations.push(operation),
            (Some(_), true) => return Err(FormulaError::NotAMesh(text(word), "")),
            (None, false) => return Err(FormulaError::NotAnOperation(text(word))),
        }
    }
    match words.last() {
        Some(last) if operations.len() == meshes.len() => Err(FormulaError::Unfinished(text(last))),
        _ if operations.is_empty() => Err(FormulaError::TooFew),
        _ => Ok((meshes, combined(0, &operations))),
    }
}

fn operation(word: &Path) -> Option<&'static Operation> {
    OPERATIONS.iter().find(|operation| word.as_os_str() == operation.name || word.as_os_str() == operation.sign)
}

/// What operations make of operands that are numbered from `first` on: the last of the weakest is done last.
fn combined(first: usize, operations: &[&Operation]) -> Expression {
    // The first of the reversed, and so the last in order.
    let weakest = operations.iter().enumerate().rev().min_by_key(|(_, operation)| operation.binding);
    let Some((at, operation)) = weakest else { return Expression::Operand(first) };
    let (before, behind) = (&operations[..at], &operations[at + 1..]);
    (operation.of)(vec![combined(first, before), combined(first + at + 1, behind)])
}

fn less(mut all: Vec<Expression>) -> Expression {
    let first = all.remove(0);
    Expression::difference(first, Expression::Union(all))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<(Vec<PathBuf>, Expression), FormulaError> {
        parse(&line.split_whitespace().map(PathBuf::from).collect::<Vec<_>>())
    }

    /// In which of the eight parts that three sets make of space a formula has points.
    fn parts(line: &str) -> Vec<bool> {
        let (meshes, expression) = parsed(line).expect("a formula");
        assert!(
            meshes.iter().map(|mesh| mesh.display().to_string()).eq(["a", "b", "c"][..meshes.len()].iter().copied())
        );
        (0..8).map(|part| expression.contains(&[part & 1 > 0, part & 2 > 0, part & 4 > 0])).collect()
    }

    fn table(contains: fn(bool, bool, bool) -> bool) -> Vec<bool> {
        (0..8).map(|part| contains(part & 1 > 0, part & 2 > 0, part & 4 > 0)).collect()
    }

    #[test]
    fn words_and_signs_mean_the_same_in_front_and_between() {
        for Operation { name, sign, .. } in &OPERATIONS {
            let expected = parts(&format!("{name} a b"));
            for line in [format!("{sign} a b"), format!("a {name} b"), format!("a {sign} b")] {
                assert_eq!(parts(&line), expected, "{line}");
            }
        }
        assert_eq!(parts("a - b"), table(|a, b, _| a && !b));
        assert_eq!(parts("difference a b c"), parts("a - b - c"));
        assert_eq!(parts("symmetric-difference a b c"), parts("a ^ b ^ c"));
    }

    #[test]
    fn intersections_come_first_then_from_left_to_right_and_symmetric_differences_last() {
        assert_eq!(parts("a - b + c"), table(|a, b, c| a && !b || c));
        assert_eq!(parts("a + b - c"), table(|a, b, c| (a || b) && !c));
        assert_eq!(parts("a - b * c"), table(|a, b, c| a && !(b && c)));
        assert_eq!(parts("a * b - c"), table(|a, b, c| a && b && !c));
        assert_eq!(parts("a ^ b + c"), table(|a, b, c| a != (b || c)));
        assert_eq!(parts("a + b ^ c"), table(|a, b, c| (a || b) != c));
    }

    #[test]
    fn what_is_no_formula_is_refused_with_the_word_that_is_wrong() {
        assert_eq!(parsed("a b"), Err(FormulaError::NotAnOperation("b".into())));
        assert_eq!(parsed("a without b"), Err(FormulaError::NotAnOperation("without".into())));
        assert_eq!(parsed("a - b -"), Err(FormulaError::Unfinished("-".into())));
        assert_eq!(parsed("a - - b"), Err(FormulaError::NotAMesh("-".into(), "")));
        assert!(matches!(parsed("union union a"), Err(FormulaError::NotAMesh(word, _)) if word == "union"));
        assert!(matches!(parsed("union a + b"), Err(FormulaError::NotAMesh(word, _)) if word == "+"));
        for few in ["a", "union", "union a"] {
            assert_eq!(parsed(few), Err(FormulaError::TooFew), "{few}");
        }
        // A file that is called as an operation is a mesh with its folder.
        assert_eq!(parsed("./union + b.stl").expect("a formula").0[0], PathBuf::from("./union"));
    }
}
