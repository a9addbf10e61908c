//! One step: all modules of a string are replaced at once.
//!
//! A first pass finds which production applies to each module, and so how long the new string is, before memory for it
//! is taken; a second pass writes it. Both go over chunks of the string side by side. Random numbers are a function of
//! the seed, the step and the place of the module, and so the result does not depend on the number of threads.

use super::error::DerivationError;
use super::function::ModuleRandom;
use super::production::MOST_FORMALS;
use super::rules::{Action, KEEP, RuleSet};
use super::sight::{Neighbours, StringView};
use crate::memory;
use crate::numeric::sampling::mix;
use rayon::prelude::*;

/// Modules of a chunk.
const CHUNK: usize = 1 << 14;
/// Most modules of a string, and most parameters.
pub(super) const MOST_MODULES: u64 = u32::MAX as u64 - 1;

/// Modules and parameters that a step made.
#[derive(Clone, Debug, Default)]
pub(super) struct Rewritten {
    pub modules: Vec<u8>,
    pub parameters: Vec<f64>,
}

/// What is the same for all modules of a step.
pub(super) struct Rewriting<'a> {
    pub rules: &'a RuleSet,
    pub view: StringView<'a>,
    /// From which random numbers come.
    pub key: u64,
    /// The number of the step, for messages, from 1.
    pub step: u32,
}

/// Modules and parameters: of a chunk, or before it.
type Lengths = (usize, usize);

/// How many modules and parameters there are before each chunk, and in all.
fn running_sums(lengths: &[Lengths]) -> (Vec<Lengths>, Lengths) {
    let mut sum = (0_usize, 0_usize);
    let before = lengths.iter().map(|(modules, parameters)| {
        let before = sum;
        sum = (sum.0.saturating_add(*modules), sum.1.saturating_add(*parameters));
        before
    });
    (before.collect(), sum)
}

impl Rewriting<'_> {
    /// The new string; none if no production applies to any module.
    ///
    /// # Errors
    /// A formula without a value, probabilities that are none, and a string for which there is no room.
    pub fn run(&self) -> Result<Option<Rewritten>, DerivationError> {
        let rules = self.rules;
        let count = self.view.modules.len();
        let neighbours = match rules.sees_neighbours {
            true => Some(Neighbours::of(&self.view, rules.sees_branches)?),
            false => None,
        };
        let view = StringView { neighbours: neighbours.as_ref(), ..self.view };
        let this = &Rewriting { rules, view, key: self.key, step: self.step };
        let own: Vec<Lengths> = self.view.modules.par_chunks(CHUNK).map(|chunk| this.own_lengths(chunk)).collect();
        let (before, _) = running_sums(&own);
        let mut choices: Vec<u16> = Vec::new();
        let lengths: Result<Vec<(Lengths, bool)>, DerivationError> = if rules.is_fixed() {
            self.view.modules.par_chunks(CHUNK).map(|chunk| Ok(this.fixed_lengths(chunk))).collect()
        } else {
            let bytes = (count * size_of::<u16>()) as u64;
            memory::reserve(bytes, || format!("choosing productions for {count} modules"))?;
            choices.resize(count, KEEP);
            let chunks = choices.par_chunks_mut(CHUNK).enumerate();
            chunks.map(|(chunk, choices)| this.choose(chunk * CHUNK, before[chunk].1, choices)).collect()
        };
        let lengths = lengths?;
        if lengths.iter().all(|(_, applies)| !applies) {
            return Ok(None);
        }
        let lengths: Vec<Lengths> = lengths.into_iter().map(|(lengths, _)| lengths).collect();
        let (_, all) = running_sums(&lengths);
        check_lengths(self.step, all)?;
        let mut new = Rewritten { modules: vec![0; all.0], parameters: vec![0.0; all.1] };
        let mut parts = Vec::with_capacity(lengths.len());
        let (mut modules, mut parameters) = (&mut new.modules[..], &mut new.parameters[..]);
        for (chunk, length) in lengths.iter().enumerate() {
            let (own_modules, other_modules) = modules.split_at_mut(length.0);
            let (own_parameters, other_parameters) = parameters.split_at_mut(length.1);
            (modules, parameters) = (other_modules, other_parameters);
            parts.push((chunk * CHUNK, before[chunk].1, own_modules, own_parameters));
        }
        let write = |(first, offset, modules, parameters)| this.write(first, offset, &choices, modules, parameters);
        parts.into_par_iter().map(write).collect::<Result<(), DerivationError>>()?;
        Ok(Some(new))
    }

    /// How long a chunk is as it is.
    fn own_lengths(&self, chunk: &[u8]) -> Lengths {
        if !self.view.has_parameters() {
            return (chunk.len(), 0);
        }
        (chunk.len(), chunk.iter().map(|kind| usize::from(self.view.arities[usize::from(*kind)])).sum())
    }

    /// How long what a kind turns into is, and whether a production applies to it.
    fn length_of(&self, kind: u8, choice: u16) -> Lengths {
        match self.rules.rules.get(usize::from(choice)) {
            Some(rule) => (rule.modules.len(), rule.arguments.len()),
            None => (1, usize::from(self.view.arities[usize::from(kind)])),
        }
    }

    /// How long a chunk becomes where kinds decide, and whether a production applies.
    fn fixed_lengths(&self, chunk: &[u8]) -> (Lengths, bool) {
        let mut counts = [0_u32; 256];
        for kind in chunk {
            counts[usize::from(*kind)] += 1;
        }
        let (mut sum, mut applies) = ((0, 0), false);
        for (kind, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let choice = match self.rules.actions[kind] {
                Action::Always(rule) => rule,
                _ => KEEP,
            };
            applies |= choice != KEEP;
            let (modules, parameters) = self.length_of(kind as u8, choice);
            sum = (sum.0 + *count as usize * modules, sum.1 + *count as usize * parameters);
        }
        (sum, applies)
    }

    /// Chooses productions for a chunk; says how long it becomes, and whether one applies.
    fn choose(&self, first: usize, offset: usize, choices: &mut [u16]) -> Result<(Lengths, bool), DerivationError> {
        let (mut offset, mut sum, mut applies) = (offset, (0, 0), false);
        for (index, choice) in choices.iter_mut().enumerate() {
            let at = first + index;
            let kind = self.view.modules[at];
            *choice = match self.rules.actions[usize::from(kind)] {
                Action::Keep => KEEP,
                Action::Always(rule) => rule,
                Action::Choose(row) => {
                    let mut random = ModuleRandom::new(mix(self.key ^ at as u64));
                    self.rules.choose(row, &self.view, at, offset, &mut random)?
                }
            };
            applies |= *choice != KEEP;
            offset += usize::from(self.view.arities[usize::from(kind)]);
            let (modules, parameters) = self.length_of(kind, *choice);
            sum = (sum.0 + modules, sum.1 + parameters);
        }
        Ok((sum, applies))
    }

    /// Writes what a chunk becomes.
    ///
    /// - `choices`: of all modules; empty where kinds decide.
    fn write(
        &self,
        first: usize,
        offset: usize,
        choices: &[u16],
        modules: &mut [u8],
        parameters: &mut [f64],
    ) -> Result<(), DerivationError> {
        let chunk = &self.view.modules[first..(first + CHUNK).min(self.view.modules.len())];
        let (mut offset, mut to, mut written) = (offset, 0, 0);
        for (index, kind) in chunk.iter().enumerate() {
            let at = first + index;
            let arity = usize::from(self.view.arities[usize::from(*kind)]);
            let choice = match self.rules.actions[usize::from(*kind)] {
                Action::Keep => KEEP,
                Action::Always(rule) => rule,
                Action::Choose(_) => choices[at],
            };
            if choice == KEEP {
                modules[to] = *kind;
                to += 1;
                if arity > 0 {
                    parameters[written..written + arity].copy_from_slice(&self.view.parameters[offset..offset + arity]);
                    written += arity;
                }
            } else {
                let rule = &self.rules.rules[usize::from(choice)];
                modules[to..to + rule.modules.len()].copy_from_slice(&rule.modules);
                to += rule.modules.len();
                if !rule.arguments.is_empty() {
                    let mut buffer = [0.0; MOST_FORMALS];
                    let frame = rule.frame(&self.view, at, offset, &mut buffer).unwrap_or(&[]);
                    let mut random = ModuleRandom::new(mix(!self.key ^ at as u64));
                    for argument in &rule.arguments {
                        parameters[written] = argument.value(frame, &mut random)?;
                        written += 1;
                    }
                }
            }
            offset += arity;
        }
        Ok(())
    }
}

/// Refuses strings that are too long, and those for which there is no memory.
fn check_lengths(step: u32, (modules, parameters): Lengths) -> Result<(), DerivationError> {
    let most = modules.max(parameters) as u64;
    if most > MOST_MODULES {
        return Err(DerivationError::TooManyModules { step, modules: u128::from(most), most: MOST_MODULES });
    }
    let bytes = modules as u64 + (parameters * size_of::<f64>()) as u64;
    Ok(memory::reserve(bytes, || format!("step {step} of the derivation, {modules} modules,"))?)
}
