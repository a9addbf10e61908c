//! The way of the turtle along a string, with interpretation productions applied to modules as it comes to them.

use super::alphabet::{Alphabet, CLOSE, MOST_PARAMETERS, ModuleString, OPEN};
use super::error::DerivationError;
use super::function::ModuleRandom;
use super::rules::{Action, KEEP};
use super::sight::StringView;
use super::system::{BoundSystem, RewritingSystem, Setting};
use super::turtle::{COMMANDS, Environment, TurtleCommand, TurtlePose};
use crate::memory;
use crate::numeric::sampling::mix;
use crate::procedural::channel;
use crate::procedural::drawing::PredefinedSurface;
use crate::procedural::drawing::{DrawingBuilder, DrawnSphere, PlacedPredefined, StrokeNode, append};
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;
use std::sync::Arc;

/// Most modules that are interpreted.
const MOST_INTERPRETED: u64 = 1 << 32;
/// Most grammars within one another, with the interpretation productions between them.
const MOST_NESTED: u32 = 100;
/// Bytes of strings of grammars within the grammar that are kept for the next place.
const MOST_KEPT: u64 = 1 << 26;
/// Separates the random numbers of interpretation from those of derivation.
const KEY: u64 = 0x7475_7274_6c65;

/// What a kind of modules means to the turtle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    Nothing,
    Command(TurtleCommand),
    Surface(u32),
    /// A grammar within the grammar.
    System(u32),
}

/// The meaning of each kind.
pub(super) fn meanings(
    alphabet: &Alphabet,
    surfaces: &[PredefinedSurface],
    systems: &[RewritingSystem],
) -> Box<[Meaning; 256]> {
    alphabet.table(Meaning::Nothing, |kind| {
        let command = COMMANDS.iter().find(|(name, ..)| *name == kind.name).map(|(_, command, _)| *command);
        let placed = || {
            let name = kind.name.strip_prefix('~')?;
            let surface = surfaces.iter().position(|one| one.name == name).map(|one| Meaning::Surface(one as u32));
            let system = || systems.iter().position(|one| one.name == name).map(|one| Meaning::System(one as u32));
            surface.or_else(system)
        };
        command.map(Meaning::Command).or_else(placed).unwrap_or(Meaning::Nothing)
    })
}

impl Meaning {
    /// Whether modules take what the turtle tells as parameters.
    pub fn is_query(self) -> bool {
        use TurtleCommand::{QueryEnvironment, QueryHeading, QueryLeft, QueryPosition, QueryUp};
        let Meaning::Command(command) = self else { return false };
        matches!(command, QueryPosition | QueryHeading | QueryUp | QueryLeft | QueryEnvironment)
    }
}

/// A grammar within the grammar as a module places it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct SystemPlacement {
    /// Its number.
    pub system: usize,
    /// Derivation steps; those that it sets for none.
    pub steps: Option<u32>,
    /// Bits of the number that tells those of one grammar apart.
    variant: u64,
}

impl SystemPlacement {
    /// From which its random numbers come.
    ///
    /// - `seed`: of the plant.
    pub fn seed(&self, seed: u64, system: &BoundSystem) -> u64 {
        mix(seed ^ mix(channel(&system.name) ^ mix(self.variant)))
    }
}

/// What is the same along the whole way.
pub(super) struct WalkRules<'a> {
    pub meanings: &'a [Meaning; 256],
    pub arities: &'a [u8; 256],
    /// The grammar itself, and after it those within it.
    pub systems: &'a [BoundSystem],
    /// Derives the string of one of them.
    pub derive: &'a dyn Fn(&SystemPlacement) -> Result<ModuleString, DerivationError>,
    pub seed: u64,
}

/// The turtle with all that a branch changes.
#[derive(Clone, Copy)]
struct Turtle {
    pose: TurtlePose,
    width: f64,
    colour: u32,
    elasticity: f64,
    /// Factor of lengths and widths.
    scale: f64,
    /// The stroke that ends where it stands.
    stroke: Option<u32>,
}

/// A turtle on its way.
pub(super) struct TurtleWalk<'a> {
    rules: &'a WalkRules<'a>,
    /// Whose string it obeys, and from which random numbers come meanwhile.
    system: &'a BoundSystem,
    seed: u64,
    /// Within how many others and interpretation productions that stands.
    nested: u32,
    turtle: Turtle,
    branches: Vec<Turtle>,
    polygons: Vec<Vec<DVec3>>,
    builder: Option<&'a mut DrawingBuilder>,
    interpreted: u64,
    /// Strings of grammars within the grammar, and their bytes.
    kept: HashMap<SystemPlacement, Arc<ModuleString>>,
    kept_bytes: u64,
}

impl Turtle {
    /// At its start, with what a grammar sets.
    fn new(system: &BoundSystem) -> Turtle {
        let set = |setting: Setting| system.settings[setting as usize];
        Turtle {
            pose: TurtlePose::default(),
            width: set(Setting::Width),
            colour: 0,
            elasticity: set(Setting::Elasticity),
            scale: 1.0,
            stroke: None,
        }
    }
}

impl<'a> TurtleWalk<'a> {
    /// A turtle at its start that obeys strings of the grammar itself.
    ///
    /// - `builder`: what it draws on; nothing is drawn without one.
    pub fn new(rules: &'a WalkRules<'a>, builder: Option<&'a mut DrawingBuilder>) -> TurtleWalk<'a> {
        TurtleWalk::of(rules, &rules.systems[0], builder)
    }

    /// A turtle at its start that obeys strings of one of the grammars.
    pub fn of(
        rules: &'a WalkRules<'a>,
        system: &'a BoundSystem,
        builder: Option<&'a mut DrawingBuilder>,
    ) -> TurtleWalk<'a> {
        TurtleWalk {
            rules,
            system,
            seed: rules.seed,
            nested: 0,
            turtle: Turtle::new(system),
            branches: Vec::new(),
            polygons: Vec::new(),
            builder,
            interpreted: 0,
            kept: HashMap::new(),
            kept_bytes: 0,
        }
    }

    /// Goes along a string.
    pub fn draw(mut self, string: &ModuleString) -> Result<(), DerivationError> {
        self.along(string)
    }

    fn along(&mut self, string: &ModuleString) -> Result<(), DerivationError> {
        self.reserve_branches(&string.modules)?;
        let mut offset = 0;
        for (at, kind) in string.modules.iter().enumerate() {
            let arity = usize::from(self.rules.arities[usize::from(*kind)]);
            self.step(at, *kind, &string.parameters[offset..offset + arity])?;
            offset += arity;
        }
        Ok(())
    }

    /// Goes along a string and answers the modules that ask.
    pub fn answer(mut self, string: &mut ModuleString, environment: &dyn Environment) -> Result<(), DerivationError> {
        self.reserve_branches(&string.modules)?;
        let mut offset = 0;
        for (at, kind) in string.modules.iter().enumerate() {
            let arity = usize::from(self.rules.arities[usize::from(*kind)]);
            let parameters = &mut string.parameters[offset..offset + arity];
            let pose = &self.turtle.pose;
            let answer = match self.rules.meanings[usize::from(*kind)] {
                Meaning::Command(TurtleCommand::QueryPosition) => Some(pose.position),
                Meaning::Command(TurtleCommand::QueryHeading) => Some(pose.heading),
                Meaning::Command(TurtleCommand::QueryUp) => Some(pose.up),
                Meaning::Command(TurtleCommand::QueryLeft) => Some(pose.left),
                Meaning::Command(TurtleCommand::QueryEnvironment) => {
                    environment.answer(pose, parameters);
                    None
                }
                _ => None,
            };
            if let Some(vector) = answer {
                parameters.iter_mut().zip(vector.to_array()).for_each(|(parameter, value)| *parameter = value);
            }
            if parameters.iter().any(|parameter| !parameter.is_finite()) {
                return Err(DerivationError::NotFinite { module: at });
            }
            self.step(at, *kind, &string.parameters[offset..offset + arity])?;
            offset += arity;
        }
        Ok(())
    }

    /// Asks for the memory of branches in one another.
    fn reserve_branches(&self, modules: &[u8]) -> Result<(), DerivationError> {
        let (mut depth, mut most) = (0_u64, 0);
        for kind in modules {
            match *kind {
                OPEN => depth += 1,
                CLOSE => depth = depth.saturating_sub(1),
                _ => {}
            }
            most = most.max(depth);
        }
        Ok(memory::reserve(2 * most * size_of::<Turtle>() as u64, || format!("{most} branches in one another"))?)
    }

    /// Obeys a module of the string.
    fn step(&mut self, at: usize, kind: u8, parameters: &[f64]) -> Result<(), DerivationError> {
        let mut random = ModuleRandom::new(mix(self.seed ^ KEY ^ mix(at as u64)));
        self.module(kind, parameters, 0, &mut random)?;
        let is_finite = self.turtle.pose.position.is_finite();
        if is_finite { Ok(()) } else { Err(DerivationError::NotFinite { module: at }) }
    }

    /// Obeys a module, or what interpretation productions make of it.
    fn module(
        &mut self,
        kind: u8,
        parameters: &[f64],
        depth: u32,
        random: &mut ModuleRandom,
    ) -> Result<(), DerivationError> {
        self.interpreted += 1;
        if self.interpreted > MOST_INTERPRETED {
            return Err(DerivationError::TooMuchInterpreted { most: MOST_INTERPRETED });
        }
        let (rules, system) = (self.rules, self.system);
        let choice = match system.interpretation.actions[usize::from(kind)] {
            Action::Keep => KEEP,
            Action::Always(rule) => rule,
            Action::Choose(row) => {
                let kinds = [kind];
                let is_seen = &[true; 256];
                let view =
                    StringView { modules: &kinds, parameters, arities: rules.arities, is_seen, neighbours: None };
                system.interpretation.choose(row, &view, 0, 0, random)?
            }
        };
        let Some(rule) = system.interpretation.rules.get(usize::from(choice)) else {
            return self.obey(kind, parameters, depth);
        };
        if depth == system.interpretation_depth {
            return Err(DerivationError::EndlessInterpretation { depth });
        }
        let mut arguments = rule.arguments.iter();
        for made in &rule.modules {
            let mut values = [0.0; MOST_PARAMETERS];
            let arity = usize::from(rules.arities[usize::from(*made)]);
            for (value, argument) in values[..arity].iter_mut().zip(&mut arguments) {
                *value = argument.value(parameters, random)?;
            }
            self.module(*made, &values[..arity], depth + 1, random)?;
        }
        Ok(())
    }

    /// Obeys a module that no interpretation production replaces.
    fn obey(&mut self, kind: u8, parameters: &[f64], depth: u32) -> Result<(), DerivationError> {
        use TurtleCommand as T;
        let parameter = parameters.first().copied();
        let command = match self.rules.meanings[usize::from(kind)] {
            Meaning::Nothing => return Ok(()),
            Meaning::Surface(number) => return self.place(number, parameter.unwrap_or(1.0)),
            Meaning::System(number) => return self.place_system(number, parameters, depth),
            Meaning::Command(command) => command,
        };
        let set = |setting: Setting| self.system.settings[setting as usize];
        let angle = || parameter.unwrap_or(set(Setting::Angle));
        let length = || parameter.unwrap_or(set(Setting::Length));
        match command {
            T::Draw | T::Move | T::DrawBeside | T::MoveBeside => self.advance(command, length())?,
            T::TurnLeft => self.turtle.pose.turn(angle()),
            T::TurnRight => self.turtle.pose.turn(-angle()),
            T::PitchDown => self.turtle.pose.pitch(-angle()),
            T::PitchUp => self.turtle.pose.pitch(angle()),
            T::RollLeft => self.turtle.pose.roll(-angle()),
            T::RollRight => self.turtle.pose.roll(angle()),
            T::TurnAround => self.turtle.pose.turn(180.0),
            T::Level => self.turtle.pose.level(),
            T::Width => self.turtle.width = parameter.unwrap_or(self.turtle.width * set(Setting::Narrowing)).max(0.0),
            T::Colour => self.turtle.colour = parameter.map_or(self.turtle.colour.saturating_add(1), |n| n as u32),
            T::Elasticity => self.turtle.elasticity = parameter.unwrap_or(set(Setting::Elasticity)),
            T::Push => {
                self.branches.push(self.turtle);
                self.turtle.stroke = None;
            }
            T::Pop => self.turtle = self.branches.pop().unwrap_or(self.turtle),
            T::BeginPolygon => self.polygons.push(Vec::new()),
            T::Vertex => self.corner()?,
            T::EndPolygon => {
                let corners = self.polygons.pop().unwrap_or_default();
                if let Some(builder) = &mut self.builder {
                    builder.polygon(&corners, self.turtle.colour)?;
                }
            }
            T::Sphere => {
                let radius = 0.5 * parameter.unwrap_or(self.turtle.width).max(0.0) * self.turtle.scale;
                let sphere = DrawnSphere { centre: self.turtle.pose.position, radius, colour: self.turtle.colour };
                if let Some(builder) = &mut self.builder {
                    append(&mut builder.drawing.spheres, sphere, "spheres")?;
                }
            }
            T::QueryPosition | T::QueryHeading | T::QueryUp | T::QueryLeft | T::QueryEnvironment => {}
        }
        Ok(())
    }

    /// Moves ahead.
    fn advance(&mut self, command: TurtleCommand, length: f64) -> Result<(), DerivationError> {
        let from = self.turtle.pose.position;
        self.turtle.pose.position = from + self.turtle.pose.heading * (length * self.turtle.scale);
        let is_line = match command {
            TurtleCommand::Draw => self.polygons.is_empty(),
            command => command == TurtleCommand::DrawBeside,
        };
        if !is_line {
            self.turtle.stroke = None;
        } else if let Some(builder) = &mut self.builder
            && self.turtle.pose.position.is_finite()
        {
            let Turtle { pose, width, colour, scale, stroke, .. } = self.turtle;
            let end = StrokeNode { position: pose.position, radius: 0.5 * width * scale, colour };
            self.turtle.stroke = Some(builder.line(stroke, from, end)?);
        }
        if matches!(command, TurtleCommand::Draw | TurtleCommand::Move) {
            self.corner()?;
        }
        if self.turtle.elasticity != 0.0 {
            let set = |setting: Setting| self.system.settings[setting as usize];
            let tropism = [Setting::TropismX, Setting::TropismY, Setting::TropismZ].map(set);
            self.turtle.pose.bend(DVec3::from_array(tropism), self.turtle.elasticity);
        }
        Ok(())
    }

    /// Sets a corner of the polygon in which the turtle is.
    fn corner(&mut self) -> Result<(), DerivationError> {
        let position = self.turtle.pose.position;
        if let (Some(polygon), true) = (self.polygons.last_mut(), self.builder.is_some()) {
            append(polygon, position, "corners")?;
        }
        Ok(())
    }

    /// Places a predefined surface.
    fn place(&mut self, number: u32, scale: f64) -> Result<(), DerivationError> {
        let TurtlePose { position, heading, left, up } = self.turtle.pose;
        let axes = DMat3::from_cols(-left, heading, up) * (scale * self.turtle.scale);
        let placement = DAffine3::from_mat3_translation(axes, position);
        let surface = PlacedPredefined { surface: number as usize, placement, colour: self.turtle.colour };
        if let Some(builder) = &mut self.builder {
            append(&mut builder.drawing.placed, surface, "surfaces")?;
        }
        Ok(())
    }

    /// Draws a grammar within the grammar as a branch of its own.
    ///
    /// - `parameters`: scale, steps and variant, as many as there are.
    /// - `depth`: of interpretation productions that made its module.
    fn place_system(&mut self, number: u32, parameters: &[f64], depth: u32) -> Result<(), DerivationError> {
        let scale = self.turtle.scale * parameters.first().copied().unwrap_or(1.0);
        if self.builder.is_none() || scale <= 0.0 {
            return Ok(());
        }
        let nested = self.nested + depth + 1;
        if nested > MOST_NESTED {
            return Err(DerivationError::EndlessNesting { most: MOST_NESTED });
        }
        let steps = parameters.get(1).map(|steps| steps.max(0.0) as u32);
        // The two zeros are one number.
        let variant = (parameters.get(2).copied().unwrap_or(0.0) + 0.0).to_bits();
        let placement = SystemPlacement { system: number as usize, steps, variant };
        let string = self.string_of(&placement)?;
        let (rules, Turtle { pose, colour, .. }) = (self.rules, self.turtle);
        let system = &rules.systems[placement.system];
        let outer = (self.system, self.seed, self.nested, self.turtle, std::mem::take(&mut self.polygons));
        (self.system, self.seed, self.nested) = (system, placement.seed(rules.seed, system), nested);
        self.turtle = Turtle { pose, colour, scale, ..Turtle::new(system) };
        self.along(&string)?;
        (self.system, self.seed, self.nested, self.turtle, self.polygons) = outer;
        Ok(())
    }

    /// The string of a grammar within the grammar: one that is kept, or a new one.
    fn string_of(&mut self, placement: &SystemPlacement) -> Result<Arc<ModuleString>, DerivationError> {
        if let Some(string) = self.kept.get(placement) {
            return Ok(Arc::clone(string));
        }
        let string = Arc::new((self.rules.derive)(placement)?);
        if self.kept_bytes + string.bytes() > MOST_KEPT {
            self.kept.clear();
            self.kept_bytes = 0;
        }
        self.kept_bytes += string.bytes();
        self.kept.insert(*placement, Arc::clone(&string));
        Ok(string)
    }
}
