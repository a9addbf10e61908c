//! Productions ready to be applied: bound to numbers, and sorted by their predecessors.

use super::alphabet::{Alphabet, ModuleWord};
use super::error::{DerivationError, EvaluationError, TextPlace};
use super::formula::Formula;
use super::function::ModuleRandom;
use super::production::{GrammarProduction, MOST_CONTEXT, MOST_FORMALS};
use super::sight::{ContextMatch, StringView};

/// No production: the module stays as it is.
pub(super) const KEEP: u16 = u16::MAX;
/// Most productions with a probability that apply to a module at once.
const MOST_CHANCES: usize = 64;
/// How far a sum of probabilities may be from 1.
const ROUNDING: f64 = 1e-6;

/// A parameter of a successor.
#[derive(Clone, Debug)]
pub(super) enum Argument {
    Number(f64),
    Formal(u8),
    Formula(Formula),
}

impl Argument {
    fn of(formula: &Formula) -> Argument {
        let number = formula.constant().map(Argument::Number);
        let formal = || formula.formal().map(Argument::Formal);
        number.or_else(formal).unwrap_or_else(|| Argument::Formula(formula.clone()))
    }

    /// Its value.
    #[inline]
    pub fn value(&self, frame: &[f64], random: &mut ModuleRandom) -> Result<f64, EvaluationError> {
        match self {
            Argument::Number(number) => Ok(*number),
            Argument::Formal(formal) => Ok(frame[usize::from(*formal)]),
            Argument::Formula(formula) => formula.evaluate(frame, random),
        }
    }
}

/// A production that is bound to numbers.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    place: TextPlace,
    left: Vec<u8>,
    right: Vec<u8>,
    condition: Option<Formula>,
    probability: Option<Formula>,
    pub modules: Vec<u8>,
    pub arguments: Vec<Argument>,
}

impl Rule {
    fn of(production: &GrammarProduction, globals: &[f64]) -> Rule {
        let bound = |formula: &Option<Formula>| formula.as_ref().map(|formula| formula.bound(globals));
        let ModuleWord { modules, arguments, .. } = production.successor.bound(globals);
        Rule {
            place: production.place,
            left: production.left.clone(),
            right: production.right.clone(),
            condition: bound(&production.condition),
            probability: bound(&production.probability),
            modules,
            arguments: arguments.iter().map(Argument::of).collect(),
        }
    }

    fn is_context_free(&self) -> bool {
        self.left.is_empty() && self.right.is_empty()
    }

    /// The formal parameters for a module; none if its neighbours are others than the contexts.
    ///
    /// - `offset`: of the parameters of the module.
    /// - `buffer`: where they are gathered if contexts have some.
    #[inline]
    pub fn frame<'a>(
        &self,
        view: &StringView<'a>,
        at: usize,
        offset: usize,
        buffer: &'a mut [f64; MOST_FORMALS],
    ) -> Option<&'a [f64]> {
        let own = &view.parameters[offset..offset + usize::from(view.arities[usize::from(view.modules[at])])];
        if self.is_context_free() {
            return Some(own);
        }
        let mut found = ContextMatch { places: [0; 2 * MOST_CONTEXT], count: 0 };
        if !(view.matches_left(at, &self.left, &mut found) && view.matches_right(at, &self.right, &mut found)) {
            return None;
        }
        if !view.has_parameters() {
            return Some(own);
        }
        buffer[..own.len()].copy_from_slice(own);
        let mut filled = own.len();
        for place in &found.places[..found.count] {
            let parameters = view.parameters_of(*place as usize);
            buffer[filled..filled + parameters.len()].copy_from_slice(parameters);
            filled += parameters.len();
        }
        Some(&buffer[..filled])
    }

    /// The formal parameters for a module to which it applies: neighbours are the contexts, and the condition holds.
    #[inline]
    fn frame_if_applies<'a>(
        &self,
        view: &StringView<'a>,
        at: usize,
        offset: usize,
        buffer: &'a mut [f64; MOST_FORMALS],
        random: &mut ModuleRandom,
    ) -> Result<Option<&'a [f64]>, EvaluationError> {
        let Some(frame) = self.frame(view, at, offset, buffer) else { return Ok(None) };
        let Some(condition) = &self.condition else { return Ok(Some(frame)) };
        Ok((condition.evaluate(frame, random)? != 0.0).then_some(frame))
    }

    /// The probability, where it has one.
    #[inline]
    fn chance(&self, frame: &[f64], random: &mut ModuleRandom) -> Result<Option<f64>, DerivationError> {
        let Some(probability) = &self.probability else { return Ok(None) };
        let value = probability.evaluate(frame, random)?;
        if value < 0.0 {
            return Err(DerivationError::NegativeProbability { place: self.place, value });
        }
        Ok(Some(value))
    }
}

/// What becomes of modules of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Action {
    /// They stay.
    Keep,
    /// One production applies to all of them.
    Always(u16),
    /// Which production applies is found out for each; the number of a row of candidates.
    Choose(u16),
}

/// Productions of one purpose.
#[derive(Clone, Debug)]
pub(super) struct RuleSet {
    pub rules: Vec<Rule>,
    pub actions: Box<[Action; 256]>,
    /// Rows of productions that may apply, in the order of the text.
    candidates: Vec<Vec<u16>>,
    /// Whether contexts look to the left or right, and whether into side branches.
    pub sees_neighbours: bool,
    pub sees_branches: bool,
}

impl RuleSet {
    /// Binds productions.
    pub fn new(productions: &[GrammarProduction], alphabet: &Alphabet, globals: &[f64]) -> RuleSet {
        let rules: Vec<Rule> = productions.iter().map(|production| Rule::of(production, globals)).collect();
        let mut actions = alphabet.table(Action::Keep, |_| Action::Keep);
        let mut candidates = Vec::new();
        for kind in 0..alphabet.kinds().len() {
            let is_own = |index: &usize| usize::from(productions[*index].predecessor) == kind;
            let own: Vec<u16> = (0..rules.len()).filter(is_own).map(|index| index as u16).collect();
            let Some(first) = own.first() else { continue };
            let Rule { condition, probability, .. } = &rules[usize::from(*first)];
            let is_always =
                rules[usize::from(*first)].is_context_free() && condition.is_none() && probability.is_none();
            if is_always {
                actions[kind] = Action::Always(*first);
            } else {
                actions[kind] = Action::Choose(candidates.len() as u16);
                candidates.push(own);
            }
        }
        let sees_neighbours = rules.iter().any(|rule| !rule.is_context_free());
        let sees_branches = rules.iter().any(|rule| rule.right.contains(&super::alphabet::OPEN));
        RuleSet { rules, actions, candidates, sees_neighbours, sees_branches }
    }

    /// Whether nothing can apply.
    pub fn is_empty(&self) -> bool {
        self.rules.is_empty()
    }

    /// Whether what becomes of a module is a function of its kind alone.
    pub fn is_fixed(&self) -> bool {
        self.candidates.is_empty()
    }

    /// The production that applies to a module of a kind for which one is chosen; [`KEEP`] if none does.
    ///
    /// The first that applies does. If it has a probability, all that apply and have one share the chance.
    pub fn choose(
        &self,
        row: u16,
        view: &StringView,
        at: usize,
        offset: usize,
        random: &mut ModuleRandom,
    ) -> Result<u16, DerivationError> {
        let candidates = &self.candidates[usize::from(row)];
        for (number, candidate) in candidates.iter().enumerate() {
            let rule = &self.rules[usize::from(*candidate)];
            let mut buffer = [0.0; MOST_FORMALS];
            let Some(frame) = rule.frame_if_applies(view, at, offset, &mut buffer, random)? else { continue };
            let Some(chance) = rule.chance(frame, random)? else { return Ok(*candidate) };
            return self.draw((*candidate, chance), &candidates[number + 1..], view, at, offset, random);
        }
        Ok(KEEP)
    }

    /// Draws one of the productions with a probability that apply to a module.
    ///
    /// - `first`: the first of them, and its probability.
    /// - `others`: those that may apply besides.
    #[inline(never)]
    fn draw(
        &self,
        first: (u16, f64),
        others: &[u16],
        view: &StringView,
        at: usize,
        offset: usize,
        random: &mut ModuleRandom,
    ) -> Result<u16, DerivationError> {
        let mut chances = [first; MOST_CHANCES];
        let (mut count, mut sum) = (1, first.1);
        for candidate in others {
            let rule = &self.rules[usize::from(*candidate)];
            let mut buffer = [0.0; MOST_FORMALS];
            let Some(frame) = rule.frame_if_applies(view, at, offset, &mut buffer, random)? else { continue };
            let Some(chance) = rule.chance(frame, random)? else { continue };
            if count == MOST_CHANCES {
                return Err(DerivationError::TooManyChances { place: rule.place, most: MOST_CHANCES });
            }
            sum += chance;
            chances[count] = (*candidate, chance);
            count += 1;
        }
        if (sum - 1.0).abs() > ROUNDING {
            return Err(DerivationError::Probability { place: self.rules[usize::from(first.0)].place, sum });
        }
        let mut rest = random.uniform() * sum;
        for (candidate, chance) in &chances[..count] {
            rest -= chance;
            if rest < 0.0 {
                return Ok(*candidate);
            }
        }
        Ok(chances[count - 1].0)
    }
}
