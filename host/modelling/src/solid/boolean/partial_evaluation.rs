//! Partial evaluation: what is known of an expression at a point, and on which operands the set still depends.

use super::expression::Expression;

/// How the values of children make that of their parent.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rule {
    /// It is known from outside.
    Operand,
    /// One child of this value decides it: a union or an intersection.
    Absorbing(bool),
    /// It is whether an odd number of them are true.
    Parity,
}

/// A part of the expression.
#[derive(Clone, Debug)]
struct ExpressionNode {
    rule: Rule,
    parent: Option<u32>,
    /// Whether the parent takes the opposite of its value.
    is_negated: bool,
    value: Option<bool>,
    /// Children of which the value is not known.
    unknown: u32,
    /// Children that are true.
    truths: u32,
    children: u32,
}

impl ExpressionNode {
    fn among_children(&self) -> Option<bool> {
        let open = (self.unknown == 0).then_some(());
        match self.rule {
            Rule::Operand => self.value,
            Rule::Absorbing(true) => {
                if self.truths > 0 {
                    Some(true)
                } else {
                    open.map(|()| false)
                }
            }
            Rule::Absorbing(false) => {
                if self.truths + self.unknown < self.children {
                    Some(false)
                } else {
                    open.map(|()| true)
                }
            }
            Rule::Parity => open.map(|()| self.truths % 2 == 1),
        }
    }

    fn for_parent(&self) -> Option<bool> {
        self.value.map(|value| value != self.is_negated)
    }
}

/// An expression with what is known of it at a point. Each change takes time as the expression is deep, not as it is
/// wide.
#[derive(Clone, Debug)]
pub struct PartialEvaluation {
    nodes: Vec<ExpressionNode>,
    /// Where each operand is in the expression.
    leaves_of: Vec<Vec<u32>>,
}

impl PartialEvaluation {
    /// The evaluation at a point outside of all operands.
    pub fn outside(expression: &Expression, operands: usize) -> PartialEvaluation {
        let mut evaluation = PartialEvaluation { nodes: Vec::new(), leaves_of: vec![Vec::new(); operands] };
        evaluation.add(expression, None, false);
        evaluation
    }

    fn add(&mut self, expression: &Expression, parent: Option<u32>, is_negated: bool) {
        let (rule, children): (Rule, &[Expression]) = match expression {
            Expression::Operand(_) => (Rule::Operand, &[]),
            Expression::Union(all) => (Rule::Absorbing(true), all),
            Expression::Intersection(all) => (Rule::Absorbing(false), all),
            Expression::Difference(both) => (Rule::Absorbing(false), &both[..]),
            Expression::SymmetricDifference(all) => (Rule::Parity, all),
        };
        let place = self.nodes.len();
        let value = (rule == Rule::Operand).then_some(false);
        let count = children.len() as u32;
        self.nodes.push(ExpressionNode { rule, parent, is_negated, value, unknown: 0, truths: 0, children: count });
        if let Expression::Operand(index) = expression
            && let Some(places) = self.leaves_of.get_mut(*index)
        {
            places.push(place as u32);
        }
        for (k, child) in children.iter().enumerate() {
            let is_negated = k == 1 && matches!(expression, Expression::Difference(_));
            let number = self.nodes.len();
            self.add(child, Some(place as u32), is_negated);
            let value = self.nodes[number].for_parent();
            self.nodes[place].unknown += u32::from(value.is_none());
            self.nodes[place].truths += u32::from(value == Some(true));
        }
        self.nodes[place].value = self.nodes[place].among_children();
    }

    /// Notes whether the point is in an operand, if that is known.
    pub fn set(&mut self, operand: u32, value: Option<bool>) {
        for k in 0..self.leaves_of[operand as usize].len() {
            let mut part = self.leaves_of[operand as usize][k] as usize;
            let mut value = value;
            loop {
                let before = self.nodes[part].for_parent();
                self.nodes[part].value = value;
                let after = self.nodes[part].for_parent();
                let Some(parent) = self.nodes[part].parent.filter(|_| before != after) else { break };
                part = parent as usize;
                let above = &mut self.nodes[part];
                above.unknown = above.unknown + u32::from(after.is_none()) - u32::from(before.is_none());
                above.truths = above.truths + u32::from(after == Some(true)) - u32::from(before == Some(true));
                value = above.among_children();
            }
        }
    }

    /// Whether the set may still depend on an operand of which nothing is known.
    pub fn depends_on(&self, operand: u32) -> bool {
        self.leaves_of[operand as usize].iter().any(|&place| self.decides(place as usize))
    }

    /// Whether the set may still depend on a part: no other child of a part around it decides that.
    fn decides(&self, place: usize) -> bool {
        let part = &self.nodes[place];
        let Some(parent) = part.parent else { return true };
        let above = &self.nodes[parent as usize];
        let own = part.for_parent();
        let settling = match above.rule {
            Rule::Absorbing(true) => above.truths - u32::from(own == Some(true)),
            Rule::Absorbing(false) => above.children - above.truths - above.unknown - u32::from(own == Some(false)),
            Rule::Operand | Rule::Parity => 0,
        };
        settling == 0 && self.decides(parent as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    fn some(random: &mut rand_pcg::Pcg64Mcg, depth: u32) -> Expression {
        let kind = if depth == 0 { 0 } else { random.random_range(0..6) };
        let all = |random: &mut _| (0..random_count(random)).map(|_| some(random, depth - 1)).collect();
        match kind {
            2 => Expression::Union(all(random)),
            3 => Expression::Intersection(all(random)),
            4 => Expression::SymmetricDifference(all(random)),
            5 => Expression::difference(some(random, depth - 1), some(random, depth - 1)),
            _ => Expression::Operand(random.random_range(0..4)),
        }
    }

    fn random_count(random: &mut rand_pcg::Pcg64Mcg) -> u32 {
        random.random_range(0..4)
    }

    /// Whether the set is the same for both values of an operand, whatever the unknown others are.
    fn is_settled(expression: &Expression, operand: usize, known: [Option<bool>; 4]) -> bool {
        (0..16).filter(|bits| (0..4).all(|k| known[k].is_none_or(|value| value == (bits >> k & 1 == 1)))).all(|bits| {
            let mut inside: [bool; 4] = std::array::from_fn(|k| bits >> k & 1 == 1);
            let [one, other] = [false, true].map(|value| {
                inside[operand] = value;
                expression.contains(&inside)
            });
            one == other
        })
    }

    #[test]
    fn a_set_that_no_longer_depends_on_an_operand_is_the_same_with_and_without_it() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(7);
        let mut settled = [0; 2];
        for _ in 0..2000 {
            let expression = some(&mut random, 3);
            let mut evaluation = PartialEvaluation::outside(&expression, 4);
            let mut known = [Some(false); 4];
            for _ in 0..12 {
                let (operand, value) =
                    (random.random_range(0..4), [None, Some(false), Some(true)][random.random_range(0..3)]);
                evaluation.set(operand as u32, value);
                known[operand] = value;
                for own in 0..4 {
                    let mut others = known;
                    others[own] = None;
                    evaluation.set(own as u32, None);
                    let (depends, is_settled) =
                        (evaluation.depends_on(own as u32), is_settled(&expression, own, others));
                    evaluation.set(own as u32, known[own]);
                    assert!(depends || is_settled, "{expression:?} {known:?} {own}");
                    // The opposite holds where each operand occurs once, as mostly.
                    settled[usize::from(depends == is_settled)] += 1;
                }
            }
        }
        assert!(settled[1] < settled[0], "{settled:?}");
    }
}
