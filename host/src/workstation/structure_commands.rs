//! Commands of a display structure, as they are gathered.

use super::names::name;
use glam::{DAffine3, DMat4, DVec3};
use protocol::{
    Name,
    command::{Command, Object as Node, Operate},
};

/// Steps of detail in which instances are drawn: in full, coarse, as outlines, as strokes.
pub const DETAILS: usize = 4;
/// Frames that clocks of the workstation count in a second.
pub const FRAMES_PER_SECOND: u32 = 60;

/// What a scene becomes on the workstation.
#[derive(Clone, Debug, Default)]
pub struct StructureCommands {
    /// The commands, to be sent in order.
    pub commands: Vec<Command>,
    /// Vectors drawn, or corners of polygons.
    pub lines: usize,
    /// Points sent: lines and moves.
    pub points: usize,
    /// Whether front and back clip.
    pub depth_clipping: bool,
    /// What is drawn of the instances, in a scene that has any.
    pub instances: Option<DrawnInstances>,
    /// What moves, in a scene where something does.
    pub motion: Option<DrawnMotion>,
}

/// What of the instances of a scene is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DrawnInstances {
    /// How many there are in the scene; those inside of others count once.
    pub count: u64,
    /// How many are drawn in full, coarse, as outlines and as strokes.
    pub drawn: [u64; DETAILS],
    /// Vectors, or corners of polygons, that draw them.
    pub lines: usize,
}

/// The node that places something, in the left-handed space of the workstation.
///
/// - `placement`: in the space of scenes.
pub(super) fn placing(placement: &DAffine3) -> Operate {
    let mirror = DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
    Operate::Matrix4x3(mirror * DMat4::from(*placement) * mirror)
}

/// What of a scene moves on the workstation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawnMotion {
    /// Objects that move.
    pub objects: usize,
    /// Motions that are different from each other.
    pub motions: usize,
    /// Pictures that follow each other where objects change otherwise than by such motions; else 0.
    pub pictures: usize,
    /// Frames of 1/60 s after which all begin anew.
    pub frames: i32,
}

impl StructureCommands {
    /// `structure := BEGIN_STRUCTURE`
    pub(super) fn begin(&mut self, structure: &str) {
        self.commands.push(Command::Define { name: Some(name(structure)), object: Node::BeginStructure });
    }

    /// `END_STRUCTURE`
    pub(super) fn end(&mut self) {
        self.commands.push(Command::EndStructure);
    }

    /// An operate node, for what follows it in its structure.
    pub(super) fn operate(&mut self, node: Option<&str>, operate: Operate) {
        let name: Option<Name> = node.map(name);
        self.commands.push(Command::Define { name, object: Node::Operate { operate, applied_to: None } });
    }

    /// An operate node for a structure, and for nothing else.
    pub(super) fn operate_on(&mut self, structure: &str, operate: Operate) {
        let applied_to = Some(name(structure));
        self.commands.push(Command::Define { name: None, object: Node::Operate { operate, applied_to } });
    }
}

impl DrawnInstances {
    /// What is drawn and what is left out, in one line.
    pub fn describe(&self) -> String {
        let words = ["in full", "coarse", "as outlines", "as strokes"];
        let parts = self.drawn.iter().zip(words).filter(|(count, _)| **count > 0);
        let parts: Vec<String> = parts.map(|(count, word)| format!("{count} {word}")).collect();
        let parts = if parts.is_empty() { String::new() } else { format!(": {}", parts.join(", ")) };
        let all: u64 = self.drawn.iter().sum();
        let left = self.count - all.min(self.count);
        let left = if left > 0 { format!("; {left} are left out, the smallest in the picture") } else { String::new() };
        format!("{all} of {} instances drawn{parts}{left}", self.count)
    }
}

impl DrawnMotion {
    /// How long all move before they begin anew, seconds.
    pub fn seconds(&self) -> f64 {
        f64::from(self.frames) / f64::from(FRAMES_PER_SECOND)
    }

    /// What moves, and how long, in one line.
    pub fn describe(&self) -> String {
        let counted = |count: usize, word: &str| format!("{count} {word}{}", if count == 1 { "" } else { "s" });
        let objects = counted(self.objects, "object");
        let motions = match self.pictures {
            0 => counted(self.motions, "motion"),
            pictures => counted(pictures, "picture"),
        };
        format!("{objects} in {motions}, which begin anew every {} s", (self.seconds() * 1e3).round() / 1e3)
    }
}
