//! What solids make together.

use super::boolean::{self, Expression, Outcome};
use super::{Solid, SolidError};
use rayon::prelude::*;

impl Solid {
    /// Evaluates an expression over some solids at once. The result may be empty.
    ///
    /// # Errors
    /// [`SolidError::SelfIntersecting`] if the result crosses itself when it is rounded, and that could not be mended.
    pub fn evaluate(operands: &[&Solid], expression: &Expression) -> Result<(Solid, Outcome), SolidError> {
        // All on threads of the pool, so that this one does not wait for them at each step.
        let mut outcome = rayon::scope(|_| {
            let operands = operands.par_iter().map(|solid| solid.operand()).collect();
            boolean::evaluate(operands, expression)
        })?;
        let mesh = std::mem::take(&mut outcome.mesh);
        Ok((Solid::of(mesh), outcome))
    }

    /// What is in either.
    ///
    /// # Errors
    /// [`SolidError::SelfIntersecting`] if the result crosses itself when it is rounded, and that could not be mended.
    pub fn union(&self, other: &Solid) -> Result<Solid, SolidError> {
        self.with(other, Expression::Union)
    }

    /// What is in both.
    ///
    /// # Errors
    /// [`SolidError::SelfIntersecting`] if the result crosses itself when it is rounded, and that could not be mended.
    pub fn intersection(&self, other: &Solid) -> Result<Solid, SolidError> {
        self.with(other, Expression::Intersection)
    }

    /// What is in this one and not in the other.
    ///
    /// # Errors
    /// [`SolidError::SelfIntersecting`] if the result crosses itself when it is rounded, and that could not be mended.
    pub fn difference(&self, other: &Solid) -> Result<Solid, SolidError> {
        let expression = Expression::difference(Expression::Operand(0), Expression::Operand(1));
        Solid::evaluate(&[self, other], &expression).map(|(solid, _)| solid)
    }

    fn with(&self, other: &Solid, operation: fn(Vec<Expression>) -> Expression) -> Result<Solid, SolidError> {
        let both = vec![Expression::Operand(0), Expression::Operand(1)];
        Solid::evaluate(&[self, other], &operation(both)).map(|(solid, _)| solid)
    }
}
