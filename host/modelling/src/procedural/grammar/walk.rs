//! The way of the turtle along a string, with interpretation productions applied to modules as it comes to them.

use super::alphabet::{Alphabet, CLOSE, MOST_PARAMETERS, ModuleString, OPEN};
use super::error::DerivationError;
use super::function::ModuleRandom;
use super::lsystem::{SETTINGS, Setting};
use super::rules::{Action, KEEP, RuleSet};
use super::sight::StringView;
use super::turtle::{COMMANDS, Environment, TurtleCommand, TurtlePose};
use crate::memory;
use crate::numeric::sampling::mix;
use crate::procedural::drawing::PredefinedSurface;
use crate::procedural::drawing::{DrawingBuilder, DrawnSphere, PlacedSurface, StrokeNode, append};
use glam::{DAffine3, DMat3, DVec3};

/// Most modules that are interpreted.
const MOST_INTERPRETED: u64 = 1 << 32;
/// Separates the random numbers of interpretation from those of derivation.
const KEY: u64 = 0x7475_7274_6c65;

/// What a kind of modules means to the turtle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    Nothing,
    Command(TurtleCommand),
    Surface(u32),
}

/// The meaning of each kind.
pub(super) fn meanings(alphabet: &Alphabet, surfaces: &[PredefinedSurface]) -> Box<[Meaning; 256]> {
    alphabet.table(Meaning::Nothing, |kind| {
        let command = COMMANDS.iter().find(|(name, ..)| *name == kind.name).map(|(_, command, _)| *command);
        let placed = kind.name.strip_prefix('~').and_then(|name| surfaces.iter().position(|one| one.name == name));
        let placed = || placed.map(|number| Meaning::Surface(number as u32));
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

/// What is the same along the whole way.
pub(super) struct WalkRules<'a> {
    pub meanings: &'a [Meaning; 256],
    pub arities: &'a [u8; 256],
    pub interpretation: &'a RuleSet,
    /// How often interpretation productions may apply to what they made.
    pub depth: u32,
    pub settings: &'a [f64; SETTINGS.len()],
    pub seed: u64,
}

/// The turtle with all that a branch changes.
#[derive(Clone, Copy)]
struct Turtle {
    pose: TurtlePose,
    width: f64,
    colour: u32,
    elasticity: f64,
    /// The stroke that ends where it stands.
    stroke: Option<u32>,
}

/// A turtle on its way.
pub(super) struct TurtleWalk<'a> {
    rules: &'a WalkRules<'a>,
    turtle: Turtle,
    branches: Vec<Turtle>,
    polygons: Vec<Vec<DVec3>>,
    builder: Option<&'a mut DrawingBuilder>,
    interpreted: u64,
}

impl<'a> TurtleWalk<'a> {
    /// A turtle at its start.
    ///
    /// - `builder`: what it draws on; nothing is drawn without one.
    pub fn new(rules: &'a WalkRules<'a>, builder: Option<&'a mut DrawingBuilder>) -> TurtleWalk<'a> {
        let set = |setting: Setting| rules.settings[setting as usize];
        let turtle = Turtle {
            pose: TurtlePose::default(),
            width: set(Setting::Width),
            colour: 0,
            elasticity: set(Setting::Elasticity),
            stroke: None,
        };
        TurtleWalk { rules, turtle, branches: Vec::new(), polygons: Vec::new(), builder, interpreted: 0 }
    }

    /// Goes along a string.
    pub fn draw(mut self, string: &ModuleString) -> Result<(), DerivationError> {
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
        let mut random = ModuleRandom::new(mix(self.rules.seed ^ KEY ^ mix(at as u64)));
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
        let rules = self.rules;
        let choice = match rules.interpretation.actions[usize::from(kind)] {
            Action::Keep => KEEP,
            Action::Always(rule) => rule,
            Action::Choose(row) => {
                let kinds = [kind];
                let is_seen = &[true; 256];
                let view =
                    StringView { modules: &kinds, parameters, arities: rules.arities, is_seen, neighbours: None };
                rules.interpretation.choose(row, &view, 0, 0, random)?
            }
        };
        let Some(rule) = rules.interpretation.rules.get(usize::from(choice)) else {
            return self.obey(kind, parameters.first().copied());
        };
        if depth == rules.depth {
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
    fn obey(&mut self, kind: u8, parameter: Option<f64>) -> Result<(), DerivationError> {
        use TurtleCommand as T;
        let command = match self.rules.meanings[usize::from(kind)] {
            Meaning::Nothing => return Ok(()),
            Meaning::Surface(number) => return self.place(number, parameter.unwrap_or(1.0)),
            Meaning::Command(command) => command,
        };
        let set = |setting: Setting| self.rules.settings[setting as usize];
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
                let radius = 0.5 * parameter.unwrap_or(self.turtle.width).max(0.0);
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
        self.turtle.pose.position = from + self.turtle.pose.heading * length;
        let is_line = match command {
            TurtleCommand::Draw => self.polygons.is_empty(),
            command => command == TurtleCommand::DrawBeside,
        };
        if !is_line {
            self.turtle.stroke = None;
        } else if let Some(builder) = &mut self.builder
            && self.turtle.pose.position.is_finite()
        {
            let Turtle { pose, width, colour, stroke, .. } = self.turtle;
            let end = StrokeNode { position: pose.position, radius: 0.5 * width, colour };
            self.turtle.stroke = Some(builder.line(stroke, from, end)?);
        }
        if matches!(command, TurtleCommand::Draw | TurtleCommand::Move) {
            self.corner()?;
        }
        if self.turtle.elasticity != 0.0 {
            let set = |setting: Setting| self.rules.settings[setting as usize];
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
        let axes = DMat3::from_cols(-left, heading, up) * scale;
        let placement = DAffine3::from_mat3_translation(axes, position);
        let surface = PlacedSurface { surface: number as usize, placement, colour: self.turtle.colour };
        if let Some(builder) = &mut self.builder {
            append(&mut builder.drawing.placed, surface, "surfaces")?;
        }
        Ok(())
    }
}
