//! An axiom with productions, as it stands in a text and bound to numbers: the grammar itself, or one within it.

use super::alphabet::{Alphabet, ModuleWord};
use super::error::DerivationError;
use super::formula::Formula;
use super::production::ProductionSet;
use super::rules::RuleSet;
use std::collections::BTreeSet;

/// How often decomposition and interpretation apply to what they made, where the text does not say.
const DEPTH: u32 = 50;

/// Which modules contexts see.
#[derive(Clone, Debug, Default)]
pub(super) enum ContextSight {
    #[default]
    All,
    Ignored(BTreeSet<String>),
    Considered(BTreeSet<String>),
}

/// A number that is set: its heading, the range in which it must lie, and what it is without a word.
pub(super) struct SettingRow {
    pub heading: &'static str,
    pub range: &'static str,
    pub is_in_range: fn(f64) -> bool,
    pub default: f64,
}

/// The settings; [`Setting`] names their rows.
pub(super) const SETTINGS: [SettingRow; 9] = [
    SettingRow {
        heading: "derivation length",
        range: "a whole number, 0 and more",
        is_in_range: |n| n >= 0.0 && n.fract() == 0.0 && n < 4e9,
        default: 1.0,
    },
    SettingRow { heading: "angle", range: "finite", is_in_range: f64::is_finite, default: 90.0 },
    SettingRow { heading: "length", range: "finite", is_in_range: f64::is_finite, default: 1.0 },
    SettingRow { heading: "width", range: "0 or more", is_in_range: |n| n >= 0.0, default: 0.1 },
    SettingRow { heading: "narrowing", range: "0 or more", is_in_range: |n| n >= 0.0, default: 0.707 },
    SettingRow { heading: "elasticity", range: "finite", is_in_range: f64::is_finite, default: 0.0 },
    SettingRow { heading: "tropism x", range: "finite", is_in_range: f64::is_finite, default: 0.0 },
    SettingRow { heading: "tropism y", range: "finite", is_in_range: f64::is_finite, default: -1.0 },
    SettingRow { heading: "tropism z", range: "finite", is_in_range: f64::is_finite, default: 0.0 },
];

/// The rows of [`SETTINGS`].
#[derive(Clone, Copy, Debug)]
pub(super) enum Setting {
    DerivationLength,
    Angle,
    Length,
    Width,
    Narrowing,
    Elasticity,
    TropismX,
    TropismY,
    TropismZ,
}

/// An axiom with productions and settings as they stand in a text.
#[derive(Clone, Debug, Default)]
pub(super) struct RewritingSystem {
    /// By which modules place it; empty for the grammar itself.
    pub name: String,
    pub settings: [Option<Formula>; SETTINGS.len()],
    pub axiom: ModuleWord,
    pub sight: ContextSight,
    pub productions: ProductionSet,
    pub decomposition: ProductionSet,
    pub interpretation: ProductionSet,
}

/// An axiom with productions and settings, bound to numbers.
#[derive(Clone, Debug)]
pub(super) struct BoundSystem {
    pub name: String,
    pub settings: [f64; SETTINGS.len()],
    pub axiom: ModuleWord,
    pub is_seen: Box<[bool; 256]>,
    pub productions: RuleSet,
    pub decomposition: RuleSet,
    pub decomposition_depth: u32,
    pub interpretation: RuleSet,
    pub interpretation_depth: u32,
}

impl RewritingSystem {
    /// Binds it to the values of constants and parameters.
    ///
    /// # Errors
    /// A setting without a value or out of its range.
    pub fn bound(&self, alphabet: &Alphabet, globals: &[f64]) -> Result<BoundSystem, DerivationError> {
        let rules = |set: &ProductionSet| RuleSet::new(&set.productions, alphabet, globals);
        Ok(BoundSystem {
            name: self.name.clone(),
            settings: settings(&self.settings, globals)?,
            axiom: self.axiom.bound(globals),
            is_seen: alphabet.table(true, |kind| match &self.sight {
                ContextSight::All => true,
                ContextSight::Ignored(names) => !names.contains(&kind.name),
                ContextSight::Considered(names) => names.contains(&kind.name),
            }),
            productions: rules(&self.productions),
            decomposition: rules(&self.decomposition),
            decomposition_depth: self.decomposition.depth.unwrap_or(DEPTH),
            interpretation: rules(&self.interpretation),
            interpretation_depth: self.interpretation.depth.unwrap_or(DEPTH),
        })
    }
}

/// The numbers that are set.
fn settings(
    set: &[Option<Formula>; SETTINGS.len()],
    globals: &[f64],
) -> Result<[f64; SETTINGS.len()], DerivationError> {
    let mut values = [0.0; SETTINGS.len()];
    for ((value, row), formula) in values.iter_mut().zip(&SETTINGS).zip(set) {
        *value = match formula {
            Some(formula) => formula.value(globals)?,
            None => row.default,
        };
        if !(row.is_in_range)(*value) {
            let place = formula.as_ref().map(|formula| formula.place()).unwrap_or_default();
            let (what, range) = (row.heading, row.range);
            return Err(DerivationError::OutOfRange { place, what, value: *value, range });
        }
    }
    Ok(values)
}
