//! A plant of a grammar: its parameters are drawn, its string is derived and drawn.

use super::alphabet::{Alphabet, CLOSE, ModuleString, ModuleWord, OPEN};
use super::error::DerivationError;
use super::function::ModuleRandom;
use super::growth::check_growth;
use super::lsystem::{ContextSight, GlobalValue, LSystem, SETTINGS, Setting};
use super::production::ProductionSet;
use super::rewriting::Rewriting;
use super::rules::RuleSet;
use super::sight::StringView;
use super::turtle::Environment;
use super::walk::{Meaning, TurtleWalk, WalkRules, meanings};
use crate::numeric::sampling::mix;
use crate::procedural::drawing::PredefinedSurface;
use crate::procedural::drawing::{DrawingBuilder, PlantDrawing};
use crate::procedural::{Varied, channel};
use crate::spelling;
use std::sync::Arc;

/// Most steps of a derivation.
const MOST_STEPS: u32 = 100_000;
/// How often decomposition and interpretation apply to what they made, where the grammar does not say.
const DEPTH: u32 = 50;

/// One plant of a grammar: its parameters are drawn from a seed.
#[derive(Clone, Debug)]
pub struct Specimen {
    alphabet: Arc<Alphabet>,
    surfaces: Arc<[PredefinedSurface]>,
    parameters: Vec<f64>,
    settings: [f64; SETTINGS.len()],
    axiom: ModuleWord,
    arities: Box<[u8; 256]>,
    is_seen: Box<[bool; 256]>,
    meanings: Box<[Meaning; 256]>,
    cut: Option<u8>,
    productions: RuleSet,
    decomposition: RuleSet,
    decomposition_depth: u32,
    interpretation: RuleSet,
    interpretation_depth: u32,
    seed: u64,
}

impl Specimen {
    /// Draws the parameters of a grammar.
    ///
    /// - `seed`: of the plant; with it come the parameters and all random numbers of its growth.
    /// - `given`: names of parameters with what they are in place of the defaults of the grammar.
    ///
    /// # Errors
    /// A parameter that the grammar does not declare or that cannot be drawn, a constant without a value, and a setting
    /// out of its range.
    pub fn new(system: &LSystem, seed: u32, given: &[(&str, Varied)]) -> Result<Specimen, DerivationError> {
        let known: Vec<&str> = system.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
        if let Some((name, _)) = given.iter().find(|(name, _)| !known.contains(name)) {
            let advice = spelling::advice(name, &known);
            return Err(DerivationError::UnknownParameter { name: (*name).to_owned(), advice });
        }
        let mut parameters = Vec::new();
        for parameter in &system.parameters {
            let own = given.iter().rev().find(|(name, _)| *name == parameter.name);
            let varied = own.map_or(parameter.default, |(_, varied)| *varied);
            let name = || parameter.name.clone();
            varied.check().map_err(|problem| DerivationError::Parameter { name: name(), problem })?;
            parameters.push(varied.draw(seed, channel(&parameter.name)));
        }
        let mut globals = Vec::new();
        for (value, _) in &system.globals {
            globals.push(match value {
                GlobalValue::Parameter(number) => parameters[*number],
                GlobalValue::Constant(formula) => formula.value(&globals)?,
            });
        }
        let alphabet = &system.alphabet;
        let rules = |set: &ProductionSet| RuleSet::new(&set.productions, alphabet, &globals);
        Ok(Specimen {
            settings: settings(system, &globals)?,
            axiom: system.axiom.bound(&globals),
            arities: alphabet.table(0, |kind| kind.arity),
            is_seen: alphabet.table(true, |kind| match &system.sight {
                ContextSight::All => true,
                ContextSight::Ignored(names) => !names.contains(&kind.name),
                ContextSight::Considered(names) => names.contains(&kind.name),
            }),
            meanings: meanings(alphabet, &system.surfaces),
            cut: alphabet.kinds().iter().position(|kind| kind.name == "%" && kind.arity == 0).map(|cut| cut as u8),
            productions: rules(&system.productions),
            decomposition: rules(&system.decomposition),
            decomposition_depth: system.decomposition.depth.unwrap_or(DEPTH),
            interpretation: rules(&system.interpretation),
            interpretation_depth: system.interpretation.depth.unwrap_or(DEPTH),
            alphabet: Arc::clone(alphabet),
            surfaces: Arc::clone(&system.surfaces),
            parameters,
            seed: mix(u64::from(seed)),
        })
    }

    /// The values of the parameters that the grammar declares, in their order.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// How many derivation steps the grammar asks for with these parameters.
    pub fn steps(&self) -> u32 {
        self.settings[Setting::DerivationLength as usize] as u32
    }

    /// Derives a string.
    ///
    /// Decomposition applies after the axiom and after each step, as often as it can; then what `%` cuts off is taken
    /// away, and modules that ask are answered.
    ///
    /// - `steps`: derivation steps; those of [`Specimen::steps`] for none.
    /// - `environment`: answers modules `?E`.
    ///
    /// # Errors
    /// [`DerivationError`]; strings for which there is no room are refused before memory is taken, and where the length
    /// follows from the grammar alone before the first step is made.
    pub fn derive(&self, steps: Option<u32>, environment: &dyn Environment) -> Result<ModuleString, DerivationError> {
        let steps = steps.unwrap_or(self.steps());
        if steps > MOST_STEPS {
            return Err(DerivationError::TooManySteps { steps, most: MOST_STEPS });
        }
        if self.decomposition.is_empty() && self.cut.is_none() {
            check_growth(&self.productions, &self.axiom.modules, &self.arities, steps)?;
        }
        let mut string = self.axiom()?;
        self.complete(&mut string, 0, environment)?;
        for step in 1..=steps {
            if self.rewrite(&mut string, &self.productions, 2 * u64::from(step), step)? {
                self.complete(&mut string, step, environment)?;
            } else if self.productions.is_fixed() {
                // Where kinds decide, what no production changes now stays as it is.
                break;
            }
        }
        Ok(string)
    }

    /// Draws what a turtle draws as it obeys a string of this grammar.
    ///
    /// # Errors
    /// Interpretation productions without an end, formulas without a value, places that are not finite, and less memory
    /// than the drawing takes.
    pub fn draw(&self, string: &ModuleString) -> Result<PlantDrawing, DerivationError> {
        let mut builder = DrawingBuilder::default();
        builder.drawing.surfaces = Arc::clone(&self.surfaces);
        TurtleWalk::new(&self.walk_rules(), Some(&mut builder)).draw(string)?;
        Ok(builder.finish()?)
    }

    fn walk_rules(&self) -> WalkRules<'_> {
        WalkRules {
            meanings: &self.meanings,
            arities: &self.arities,
            interpretation: &self.interpretation,
            depth: self.interpretation_depth,
            settings: &self.settings,
            seed: self.seed,
        }
    }

    /// The string of the axiom.
    fn axiom(&self) -> Result<ModuleString, DerivationError> {
        let mut random = ModuleRandom::new(mix(self.seed));
        let values = self.axiom.arguments.iter().map(|formula| formula.evaluate(&[], &mut random));
        let parameters = values.collect::<Result<Vec<f64>, _>>()?;
        Ok(ModuleString { alphabet: Arc::clone(&self.alphabet), modules: self.axiom.modules.clone(), parameters })
    }

    /// Whether modules ask for the pose of the turtle or the environment.
    fn asks(&self) -> bool {
        self.meanings.iter().any(|meaning| meaning.is_query())
    }

    /// Applies productions to all modules; says whether one applied.
    fn rewrite(
        &self,
        string: &mut ModuleString,
        rules: &RuleSet,
        part: u64,
        step: u32,
    ) -> Result<bool, DerivationError> {
        let view = StringView {
            modules: &string.modules,
            parameters: &string.parameters,
            arities: &self.arities,
            is_seen: &self.is_seen,
            neighbours: None,
        };
        let made = Rewriting { rules, view, key: mix(self.seed ^ mix(part)), step }.run()?;
        let applies = made.is_some();
        if let Some(made) = made {
            (string.modules, string.parameters) = (made.modules, made.parameters);
        }
        Ok(applies)
    }

    /// What follows on each step: decomposition, cuts, answers.
    fn complete(
        &self,
        string: &mut ModuleString,
        step: u32,
        environment: &dyn Environment,
    ) -> Result<(), DerivationError> {
        if !self.decomposition.is_empty() {
            let mut round = 0;
            let part = |round: u32| (u64::from(step) << 32) | (2 * u64::from(round) + 1);
            while self.rewrite(string, &self.decomposition, part(round), step)? {
                round += 1;
                if round > self.decomposition_depth {
                    return Err(DerivationError::EndlessDecomposition { depth: self.decomposition_depth });
                }
            }
        }
        if let Some(cut) = self.cut {
            self.cut_off(string, cut);
        }
        if self.asks() {
            TurtleWalk::new(&self.walk_rules(), None).answer(string, environment)?;
        }
        Ok(())
    }

    /// Takes away each `%` and what follows on it in its branch.
    fn cut_off(&self, string: &mut ModuleString, cut: u8) {
        let (mut to, mut written, mut offset) = (0, 0, 0);
        // How many branches have begun since the cut, while one is in force.
        let mut depth: Option<usize> = None;
        for at in 0..string.modules.len() {
            let kind = string.modules[at];
            let arity = usize::from(self.arities[usize::from(kind)]);
            depth = match (depth, kind) {
                (None, kind) if kind == cut => Some(0),
                (Some(0), CLOSE) => None,
                (Some(depth), CLOSE) => Some(depth - 1),
                (Some(depth), OPEN) => Some(depth + 1),
                (depth, _) => depth,
            };
            if depth.is_none() {
                string.modules[to] = kind;
                to += 1;
                string.parameters.copy_within(offset..offset + arity, written);
                written += arity;
            }
            offset += arity;
        }
        string.modules.truncate(to);
        string.parameters.truncate(written);
    }
}

/// The numbers that the grammar sets.
fn settings(system: &LSystem, globals: &[f64]) -> Result<[f64; SETTINGS.len()], DerivationError> {
    let mut values = [0.0; SETTINGS.len()];
    for ((value, row), formula) in values.iter_mut().zip(&SETTINGS).zip(&system.settings) {
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
