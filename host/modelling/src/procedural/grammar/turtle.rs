//! The turtle: where it is, how it turns, and the modules that it obeys.

use super::function::sin_cos_degrees;
use glam::DVec3;

/// What a module tells the turtle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TurtleCommand {
    Draw,
    Move,
    DrawBeside,
    MoveBeside,
    TurnLeft,
    TurnRight,
    PitchDown,
    PitchUp,
    RollLeft,
    RollRight,
    TurnAround,
    Level,
    Width,
    Colour,
    Elasticity,
    Push,
    Pop,
    BeginPolygon,
    EndPolygon,
    Vertex,
    Sphere,
    QueryPosition,
    QueryHeading,
    QueryUp,
    QueryLeft,
    QueryEnvironment,
}

use TurtleCommand as T;

/// The modules that the turtle obeys, and what they tell it. A module without a parameter takes the number that the
/// grammar sets. `~NAME` besides places a predefined surface, its parameter times as large as it is, or a grammar.
pub(super) const COMMANDS: [(&str, TurtleCommand, &str); 26] = [
    ("F", T::Draw, "moves ahead by a length and draws a line; in a polygon it sets a corner and draws none"),
    ("f", T::Move, "moves ahead by a length; in a polygon it sets a corner"),
    ("G", T::DrawBeside, "moves ahead by a length and draws a line, without a corner of a polygon"),
    ("g", T::MoveBeside, "moves ahead by a length, without a corner of a polygon"),
    ("+", T::TurnLeft, "turns left by an angle"),
    ("-", T::TurnRight, "turns right by an angle"),
    ("&", T::PitchDown, "pitches down by an angle"),
    ("^", T::PitchUp, "pitches up by an angle"),
    ("\\", T::RollLeft, "rolls left by an angle"),
    ("/", T::RollRight, "rolls right by an angle"),
    ("|", T::TurnAround, "turns around"),
    ("$", T::Level, "rolls until its left is level"),
    ("!", T::Width, "sets the width of lines, or narrows it by the set factor"),
    ("'", T::Colour, "sets the number of the colour, or takes the next"),
    ("_", T::Elasticity, "sets how strongly branches bend to the tropism"),
    ("[", T::Push, "begins a branch"),
    ("]", T::Pop, "ends a branch and goes back to where it began"),
    ("{", T::BeginPolygon, "begins a polygon"),
    ("}", T::EndPolygon, "fills the polygon"),
    (".", T::Vertex, "sets a corner of the polygon"),
    ("@O", T::Sphere, "draws a sphere with a diameter"),
    ("?P", T::QueryPosition, "takes the position of the turtle as its parameters"),
    ("?H", T::QueryHeading, "takes the heading of the turtle as its parameters"),
    ("?U", T::QueryUp, "takes the up vector of the turtle as its parameters"),
    ("?L", T::QueryLeft, "takes the left vector of the turtle as its parameters"),
    ("?E", T::QueryEnvironment, "takes what the environment answers to its parameters as its parameters"),
];

/// The modules that a turtle obeys, each with what it does; surfaces and grammars that `~NAME` places come
/// besides.
pub fn turtle_modules() -> impl Iterator<Item = (&'static str, &'static str)> {
    COMMANDS.iter().map(|(name, _, description)| (*name, *description))
}

/// Where a turtle is and how it is turned; the three vectors have unit length and heading x left = up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurtlePose {
    /// Its place, units of length.
    pub position: DVec3,
    /// Where it goes.
    pub heading: DVec3,
    /// Its left side.
    pub left: DVec3,
    /// Its upper side.
    pub up: DVec3,
}

impl Default for TurtlePose {
    /// In the origin, upright: it goes up along y, and z is its upper side.
    fn default() -> TurtlePose {
        TurtlePose { position: DVec3::ZERO, heading: DVec3::Y, left: DVec3::NEG_X, up: DVec3::Z }
    }
}

/// Two vectors turned in their plane, the first towards the second.
fn turned(first: DVec3, second: DVec3, (sin, cos): (f64, f64)) -> (DVec3, DVec3) {
    (first * cos + second * sin, second * cos - first * sin)
}

impl TurtlePose {
    /// Turns left about the up vector, degrees.
    pub(super) fn turn(&mut self, angle: f64) {
        (self.heading, self.left) = turned(self.heading, self.left, sin_cos_degrees(angle));
    }

    /// Pitches up about the left vector, degrees.
    pub(super) fn pitch(&mut self, angle: f64) {
        (self.heading, self.up) = turned(self.heading, self.up, sin_cos_degrees(angle));
    }

    /// Rolls right about the heading, degrees: the left side goes up.
    pub(super) fn roll(&mut self, angle: f64) {
        (self.left, self.up) = turned(self.left, self.up, sin_cos_degrees(angle));
    }

    /// Rolls until the left vector is level and the up vector looks up; nothing for a heading straight up or down.
    ///
    /// # Source
    /// Prusinkiewicz and Lindenmayer 1990, section 2.2: L = V x H / |V x H|.
    pub(super) fn level(&mut self) {
        if let Some(left) = DVec3::Y.cross(self.heading).try_normalize() {
            self.left = left;
            self.up = self.heading.cross(left).normalize_or(self.up);
        }
    }

    /// Turns the heading towards a direction about the axis H x T, by e |H x T| radians.
    ///
    /// # Source
    /// Prusinkiewicz and Lindenmayer 1990, section 2.1.
    pub(super) fn bend(&mut self, tropism: DVec3, elasticity: f64) {
        let torque = self.heading.cross(tropism);
        let Some(axis) = torque.try_normalize() else { return };
        let (sin, cos) = (elasticity * torque.length()).sin_cos();
        let rotated = |v: DVec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
        self.heading = rotated(self.heading).normalize_or(self.heading);
        let left = rotated(self.left);
        self.left = (left - self.heading * left.dot(self.heading)).normalize_or(self.left);
        self.up = self.heading.cross(self.left);
    }
}

/// What surrounds a plant: light, neighbours, a box in which it may grow.
pub trait Environment: Sync {
    /// Answers a module `?E`.
    ///
    /// - `pose`: of the turtle at the module.
    /// - `parameters`: what the module asks; the answer stands there afterwards. Numbers that are not finite are
    ///   refused by who asks.
    fn answer(&self, pose: &TurtlePose, parameters: &mut [f64]);
}

impl<A: Fn(&TurtlePose, &mut [f64]) + Sync> Environment for A {
    fn answer(&self, pose: &TurtlePose, parameters: &mut [f64]) {
        self(pose, parameters);
    }
}

/// Nothing around a plant: modules `?E` keep their parameters.
#[derive(Clone, Copy, Debug, Default)]
pub struct EmptyEnvironment;

impl Environment for EmptyEnvironment {
    fn answer(&self, _: &TurtlePose, _: &mut [f64]) {}
}
