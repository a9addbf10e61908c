//! Sets that are made of operands.

/// A set made of operands.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// An operand, by its place.
    Operand(usize),
    /// What is in any of these; nothing if there are none.
    Union(Vec<Expression>),
    /// What is in all of these; everything if there are none.
    Intersection(Vec<Expression>),
    /// What is in the first and not in the second.
    Difference(Box<[Expression; 2]>),
    /// What is in an odd number of these.
    SymmetricDifference(Vec<Expression>),
}

impl Expression {
    /// The first operand less the second.
    pub fn difference(one: Expression, two: Expression) -> Expression {
        Expression::Difference(Box::new([one, two]))
    }

    /// Whether a point is in the set.
    ///
    /// - `inside`: whether it is in each operand; an operand that is not there has no points.
    pub fn contains(&self, inside: &[bool]) -> bool {
        match self {
            Expression::Operand(index) => inside.get(*index).copied().unwrap_or(false),
            Expression::Union(all) => all.iter().any(|e| e.contains(inside)),
            Expression::Intersection(all) => all.iter().all(|e| e.contains(inside)),
            Expression::Difference(both) => both[0].contains(inside) && !both[1].contains(inside),
            Expression::SymmetricDifference(all) => all.iter().filter(|e| e.contains(inside)).count() % 2 == 1,
        }
    }
}
