//! A plant of a grammar: its parameters are drawn, its string is derived and drawn.

use super::alphabet::{Alphabet, CLOSE, ModuleString, OPEN};
use super::error::DerivationError;
use super::function::ModuleRandom;
use super::growth::check_growth;
use super::lsystem::{GlobalValue, LSystem};
use super::rewriting::Rewriting;
use super::rules::RuleSet;
use super::sight::StringView;
use super::system::{BoundSystem, Setting};
use super::turtle::{EmptyEnvironment, Environment};
use super::walk::{Meaning, SystemPlacement, TurtleWalk, WalkRules, meanings};
use crate::numeric::sampling::mix;
use crate::procedural::drawing::PredefinedSurface;
use crate::procedural::drawing::{DrawingBuilder, PlantDrawing};
use crate::procedural::{Varied, channel};
use crate::spelling;
use std::sync::Arc;

/// Most steps of a derivation.
const MOST_STEPS: u32 = 100_000;

/// One plant of a grammar: its parameters are drawn from a seed.
#[derive(Clone, Debug)]
pub struct Specimen {
    alphabet: Arc<Alphabet>,
    surfaces: Arc<[PredefinedSurface]>,
    parameters: Vec<f64>,
    arities: Box<[u8; 256]>,
    meanings: Box<[Meaning; 256]>,
    cut: Option<u8>,
    /// The grammar itself, and after it those within it.
    systems: Vec<BoundSystem>,
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
        let systems = system.systems.iter().map(|system| system.bound(alphabet, &globals));
        Ok(Specimen {
            systems: systems.collect::<Result<_, _>>()?,
            arities: alphabet.table(0, |kind| kind.arity),
            meanings: meanings(alphabet, &system.surfaces, &system.systems),
            cut: alphabet.kinds().iter().position(|kind| kind.name == "%" && kind.arity == 0).map(|cut| cut as u8),
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
        self.systems[0].settings[Setting::DerivationLength as usize] as u32
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
        Derivation { specimen: self, system: &self.systems[0], seed: self.seed }.string(steps, environment)
    }

    /// Draws what a turtle draws as it obeys a string of this grammar; grammars within it are derived as the turtle
    /// comes to them.
    ///
    /// # Errors
    /// Interpretation productions without an end, formulas without a value, places that are not finite, and less memory
    /// than the drawing takes.
    pub fn draw(&self, string: &ModuleString) -> Result<PlantDrawing, DerivationError> {
        let mut builder = DrawingBuilder::default();
        builder.drawing.surfaces = Arc::clone(&self.surfaces);
        let derive = |placement: &SystemPlacement| self.derive_placed(placement);
        TurtleWalk::new(&self.walk_rules(&derive), Some(&mut builder)).draw(string)?;
        Ok(builder.finish()?)
    }

    /// Derives the string of a grammar within this one.
    fn derive_placed(&self, placement: &SystemPlacement) -> Result<ModuleString, DerivationError> {
        let system = &self.systems[placement.system];
        let steps = placement.steps.unwrap_or(system.settings[Setting::DerivationLength as usize] as u32);
        Derivation { specimen: self, system, seed: placement.seed(self.seed, system) }.string(steps, &EmptyEnvironment)
    }

    fn walk_rules<'a>(
        &'a self,
        derive: &'a dyn Fn(&SystemPlacement) -> Result<ModuleString, DerivationError>,
    ) -> WalkRules<'a> {
        WalkRules { meanings: &self.meanings, arities: &self.arities, systems: &self.systems, derive, seed: self.seed }
    }
}

/// The growth of one axiom of a plant.
struct Derivation<'a> {
    specimen: &'a Specimen,
    system: &'a BoundSystem,
    seed: u64,
}

impl Derivation<'_> {
    /// The string after so many steps.
    fn string(&self, steps: u32, environment: &dyn Environment) -> Result<ModuleString, DerivationError> {
        if steps > MOST_STEPS {
            return Err(DerivationError::TooManySteps { steps, most: MOST_STEPS });
        }
        let productions = &self.system.productions;
        if self.system.decomposition.is_empty() && self.specimen.cut.is_none() {
            check_growth(productions, &self.system.axiom.modules, &self.specimen.arities, steps)?;
        }
        let mut string = self.axiom()?;
        self.complete(&mut string, 0, environment)?;
        for step in 1..=steps {
            if self.rewrite(&mut string, productions, 2 * u64::from(step), step)? {
                self.complete(&mut string, step, environment)?;
            } else if productions.is_fixed() {
                // Where kinds decide, what no production changes now stays as it is.
                break;
            }
        }
        Ok(string)
    }

    /// The string of the axiom.
    fn axiom(&self) -> Result<ModuleString, DerivationError> {
        let mut random = ModuleRandom::new(mix(self.seed));
        let axiom = &self.system.axiom;
        let values = axiom.arguments.iter().map(|formula| formula.evaluate(&[], &mut random));
        let parameters = values.collect::<Result<Vec<f64>, _>>()?;
        let alphabet = Arc::clone(&self.specimen.alphabet);
        Ok(ModuleString { alphabet, modules: axiom.modules.clone(), parameters })
    }

    /// Whether modules ask for the pose of the turtle or the environment.
    fn asks(&self) -> bool {
        self.specimen.meanings.iter().any(|meaning| meaning.is_query())
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
            arities: &self.specimen.arities,
            is_seen: &self.system.is_seen,
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
        if !self.system.decomposition.is_empty() {
            let mut round = 0;
            let part = |round: u32| (u64::from(step) << 32) | (2 * u64::from(round) + 1);
            let depth = self.system.decomposition_depth;
            while self.rewrite(string, &self.system.decomposition, part(round), step)? {
                round += 1;
                if round > depth {
                    return Err(DerivationError::EndlessDecomposition { depth });
                }
            }
        }
        if let Some(cut) = self.specimen.cut {
            self.cut_off(string, cut);
        }
        if self.asks() {
            let derive = |placement: &SystemPlacement| self.specimen.derive_placed(placement);
            let rules = WalkRules { seed: self.seed, ..self.specimen.walk_rules(&derive) };
            TurtleWalk::of(&rules, self.system, None).answer(string, environment)?;
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
            let arity = usize::from(self.specimen.arities[usize::from(kind)]);
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
