//! How long strings become where that follows from the kinds of modules alone.

use super::error::DerivationError;
use super::rewriting::MOST_MODULES;
use super::rules::{Action, RuleSet};
use crate::memory;

/// Modules of each kind.
type Counts = [u128; 256];

/// How many modules of each kind there are a step later: the growth matrix times how many there are. Numbers beyond
/// those of 128 bits stay at the highest.
fn grown(rules: &RuleSet, counts: &Counts) -> Counts {
    let mut next = [0_u128; 256];
    for (kind, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let mut add = |kind: usize| next[kind] = next[kind].saturating_add(*count);
        match rules.actions[kind] {
            Action::Always(rule) => {
                rules.rules[usize::from(rule)].modules.iter().for_each(|made| add(usize::from(*made)))
            }
            _ => add(kind),
        }
    }
    next
}

fn sum(numbers: impl Iterator<Item = u128>) -> u128 {
    numbers.fold(0, u128::saturating_add)
}

/// Works out how long the string becomes if that follows from the kinds of modules alone, and refuses strings for which
/// there is no room at any step. Nothing is refused where productions have contexts, conditions or probabilities.
///
/// - `axiom`: its kinds.
/// - `arities`: parameters of modules by their kinds.
///
/// # Errors
/// The count after all steps, or the bytes of the step that finds no memory.
///
/// # Source
/// Growth functions of D0L-systems by their matrix: Szilard 1971.
pub(super) fn check_growth(
    rules: &RuleSet,
    axiom: &[u8],
    arities: &[u8; 256],
    steps: u32,
) -> Result<(), DerivationError> {
    if !rules.is_fixed() {
        return Ok(());
    }
    let mut counts = [0_u128; 256];
    axiom.iter().for_each(|kind| counts[usize::from(*kind)] += 1);
    let mut bytes_before = axiom.len() as u64;
    for step in 1..=steps {
        let next = grown(rules, &counts);
        if next == counts {
            break;
        }
        counts = next;
        let modules = sum(counts.iter().copied());
        let parameters = sum(counts.iter().zip(arities).map(|(count, arity)| count.saturating_mul(u128::from(*arity))));
        if modules.max(parameters) > u128::from(MOST_MODULES) {
            for _ in step..steps {
                counts = grown(rules, &counts);
                if counts.contains(&u128::MAX) {
                    break;
                }
            }
            let modules = sum(counts.into_iter()).max(parameters);
            return Err(DerivationError::TooManyModules { step: steps, modules, most: MOST_MODULES });
        }
        // Both are below 2^32.
        let bytes = modules as u64 + size_of::<f64>() as u64 * parameters as u64;
        memory::reserve(bytes_before + bytes, || format!("step {step} of the derivation, {modules} modules,"))?;
        bytes_before = bytes;
    }
    Ok(())
}
