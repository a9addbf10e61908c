//! What moves on the workstation: nodes that turn and move objects, and the network of a clock that drives them.
//!
//! # Method
//! A motion takes a point p to `T(c + t b) R(a, t w) T(-c) p`: b is the velocity, a the axis, which goes through c, and w
//! the angle in a unit of time, which is a second. With z negated that is `T(t b') M Z(t w) M^-1 p`, where M brings z to
//! the axis and Z turns about z. M stays, so that the network sends a vector and a rotation about z, whatever the axis. One
//! clock counts frames for all; after a period the count begins anew. What moves alike has the same nodes.

use super::drawing::MotionPeriod;
use super::facets::mirrored;
use super::names::ROOT;
use super::network::{Build, Question, label};
use super::structure_commands::{DrawnMotion, FRAMES_PER_SECOND, StructureCommands};
use crate::scene::{Motion, Scene};
use glam::{DAffine3, DMat3, DVec3};
use protocol::{
    Value,
    command::{Axis, Command, Operate},
};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// The least and the greatest period that is chosen, seconds.
const CHOSEN_SECONDS: [f64; 2] = [1.0, 600.0];
/// The period where nothing comes back by itself, seconds.
const OTHERWISE_SECONDS: f64 = 4.0;
/// Something is back where it was, if it is so many turns off at most: less than a thousandth of a degree.
const TURN_TOLERANCE: f64 = 1e-6;
/// So many turns of what turns slowest are tried as periods at most.
const MOST_TRIED: u32 = 10_000;

/// The function key that stops what moves, or lets it go on, and its label.
pub const MOTION_KEY: (i32, &str) = (5, "MOTION");
/// The clock, which sends the number of each frame.
const CLOCK: &str = "PERIS_MOTION";
/// The function that gives the frame of the period, from 0.
pub(super) const FRAME: &str = "PERIS_MOTION_FRAME";
/// The function that gives the time of the motions, seconds.
const TIME: &str = "PERIS_MOTION_TIME";
/// The function that tells the host the frame of the period when it gets TRUE at `<1>`.
const FRAME_TRIGGER: &str = "PERIS_MOTION_NOW";
/// The function that gives the frame of the period as text.
const FRAME_TEXT: &str = "PERIS_MOTION_TEXT";
/// What the text begins with; the number follows.
const FRAME_PREFIX: &str = "FRAME ";
/// Asks for the frame of the period.
pub(super) const FRAME_NOW: Question = Question::new("the time of what moves", FRAME_TRIGGER, FRAME_TEXT, FRAME_PREFIX);
/// What all names of the network begin with, and none of another.
pub(super) const NETWORK_PREFIX: &str = CLOCK;
/// What the names of the nodes that hold moving objects begin with, and none of another.
pub(super) const NODE_PREFIX: &str = "MOVE";

/// Objects that move alike.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MovingGroup {
    motion: Motion,
    /// Their numbers in the scene, from 0.
    pub(super) objects: Vec<usize>,
}

/// The objects that move, those of each motion together, in the order of the first of each.
pub(super) fn groups(scene: &Scene) -> Vec<MovingGroup> {
    let mut groups: Vec<MovingGroup> = Vec::new();
    let mut known = HashMap::new();
    let inside = scene.motions.iter().filter(|(object, _)| (*object as usize) < scene.objects.len());
    for &(object, motion) in inside {
        // What does not turn moves alike whatever its axis is.
        let axis = if motion.angle == 0.0 { [DVec3::ZERO, DVec3::Z] } else { [motion.through, motion.axis] };
        let motion = Motion { through: axis[0], axis: axis[1], ..motion };
        if motion.by == DVec3::ZERO && motion.angle == 0.0 {
            continue;
        }
        let key = [motion.by, motion.through, motion.axis].map(|vector| vector.to_array().map(f64::to_bits));
        let number = *known.entry((key, motion.angle.to_bits())).or_insert(groups.len());
        match groups.get_mut(number) {
            Some(group) => group.objects.push(object as usize),
            None => groups.push(MovingGroup { motion, objects: vec![object as usize] }),
        }
    }
    groups
}

impl MovingGroup {
    /// Begins the structure of its objects with its nodes: `T` moves them, `R` turns them.
    ///
    /// - `number`: of the group, from 1.
    pub(super) fn begin(&self, number: usize, out: &mut StructureCommands) {
        out.begin(&format!("{NODE_PREFIX}{number}"));
        if self.motion.by != DVec3::ZERO {
            out.operate(Some("T"), Operate::Translate(DVec3::ZERO));
        }
        if self.motion.angle != 0.0 {
            let to_axis = self.to_axis();
            out.operate(None, Operate::Matrix4x3(to_axis.into()));
            out.operate(Some("R"), Operate::Rotate { axis: Axis::Z, angle: 0.0 });
            out.operate(None, Operate::Matrix4x3(to_axis.inverse().into()));
        }
    }

    /// Brings z to the axis, in the coordinates of the workstation.
    fn to_axis(&self) -> DAffine3 {
        // A mirror turns the sense of a rotation: the axis of that is opposite.
        let axis = -mirrored(self.motion.axis).normalize_or(DVec3::Z);
        let (x, y) = axis.any_orthonormal_pair();
        DAffine3::from_mat3_translation(DMat3::from_cols(x, y, axis), mirrored(self.motion.through))
    }

    /// Sends the time of all to its nodes.
    ///
    /// - `number`: of the group, from 1.
    fn drive(&self, number: usize, build: &mut Build) {
        let node = |name: &str| format!("{ROOT}.{NODE_PREFIX}{number}.{name}");
        if self.motion.by != DVec3::ZERO {
            let moved = format!("PERIS_MOTION_T{number}");
            build.function(&moved, "MULC");
            build.send(Value::Vector3(mirrored(self.motion.by)), 2, &moved);
            build.connect(TIME, 1, 1, &moved);
            build.connect(&moved, 1, 1, &node("T"));
        }
        if self.motion.angle != 0.0 {
            let [degrees, turn] = ["D", "R"].map(|letter| format!("PERIS_MOTION_{letter}{number}"));
            build.function(&degrees, "MULC");
            build.send(Value::Real(self.motion.angle.to_degrees()), 2, &degrees);
            build.connect(TIME, 1, 1, &degrees);
            build.function(&turn, "ZROTATE");
            build.connect(&degrees, 1, 1, &turn);
            build.connect(&turn, 1, 1, &node("R"));
        }
    }
}

/// The network that moves groups, whose structures have begun with [`MovingGroup::begin`].
pub(super) fn network(groups: &[MovingGroup], period: MotionPeriod) -> (Vec<Command>, DrawnMotion) {
    let frames = frames(groups, period);
    let mut build = Build::default();
    build.function(TIME, "MULC");
    build.connect(FRAME, 1, 1, TIME);
    build.send(Value::Real(1.0 / f64::from(FRAMES_PER_SECOND)), 2, TIME);
    for (number, group) in (1..).zip(groups) {
        group.drive(number, &mut build);
    }
    clock(frames, &mut build);
    let objects = groups.iter().map(|group| group.objects.len()).sum();
    (build.commands, DrawnMotion { objects, motions: groups.len(), pictures: 0, frames })
}

/// The clock of a network, from whose function [`FRAME`] the arcs to the others are there already. It runs at once, and a
/// key stops it and lets it go on.
///
/// - `frames`: of the period.
pub(super) fn clock(frames: i32, build: &mut Build) {
    build.function(FRAME, "MODC");
    build.send(Value::Integer(frames), 2, FRAME);
    build.function(CLOCK, "CLFRAMES");
    build.send(Value::Integer(1), 1, CLOCK);
    build.send(Value::Boolean(true), 3, CLOCK);
    build.send(Value::Integer(1), 6, CLOCK);
    build.connect(CLOCK, 1, 1, FRAME);
    build.function(FRAME_TRIGGER, "CONSTANT");
    build.connect(FRAME, 1, 2, FRAME_TRIGGER);
    build.function("PERIS_MOTION_PRINT", "PRINT");
    build.connect(FRAME_TRIGGER, 1, 1, "PERIS_MOTION_PRINT");
    build.function(FRAME_TEXT, "CCONCATENATE");
    build.send(Value::string(FRAME_PREFIX), 1, FRAME_TEXT);
    build.connect("PERIS_MOTION_PRINT", 1, 2, FRAME_TEXT);
    let (key, text) = MOTION_KEY;
    build.function("PERIS_MOTION_KEY", "EQC");
    build.send(Value::Integer(key), 2, "PERIS_MOTION_KEY");
    build.connect("FKEYS", 1, 1, "PERIS_MOTION_KEY");
    // Whether the clock runs: the key makes it the opposite, other keys leave it as it is.
    build.function("PERIS_MOTION_RUN", "XORC");
    build.send(Value::Boolean(true), 2, "PERIS_MOTION_RUN");
    build.connect("PERIS_MOTION_KEY", 1, 1, "PERIS_MOTION_RUN");
    build.connect("PERIS_MOTION_RUN", 1, 2, "PERIS_MOTION_RUN");
    build.connect("PERIS_MOTION_RUN", 1, 4, CLOCK);
    build.commands.push(label(key, text));
    build.commands.extend(restart());
    build.send(Value::Boolean(true), 4, CLOCK);
}

/// Lets all motions begin anew, whether they are stopped or not.
pub fn restart() -> Vec<Command> {
    let mut build = Build::default();
    build.send(Value::Integer(1), 5, CLOCK);
    build.send(Value::Integer(0), 1, FRAME);
    build.commands
}

/// Frames of a period.
fn frames(groups: &[MovingGroup], period: MotionPeriod) -> i32 {
    let seconds = match period {
        MotionPeriod::Seconds(seconds) => seconds,
        MotionPeriod::Seamless => seamless_seconds(groups).unwrap_or(OTHERWISE_SECONDS),
    };
    frames_of(seconds)
}

/// Seconds in frames, at least one.
pub(super) fn frames_of(seconds: f64) -> i32 {
    ((seconds * f64::from(FRAMES_PER_SECOND)).round() as i32).max(1)
}

/// The time after which everything is back where it was, seconds, if there is one that is neither short nor long.
fn seamless_seconds(groups: &[MovingGroup]) -> Option<f64> {
    if groups.iter().any(|group| group.motion.by != DVec3::ZERO) {
        return None;
    }
    let turns: Vec<f64> = groups.iter().map(|group| group.motion.angle.abs() / TAU).collect();
    let slowest = turns.iter().copied().reduce(f64::min)?;
    let [least, greatest] = CHOSEN_SECONDS;
    let first = (least * slowest).ceil().max(1.0);
    let periods = (0..MOST_TRIED).map(|k| (first + f64::from(k)) / slowest);
    let is_back = |seconds: f64| {
        turns.iter().map(|turns| turns * seconds).all(|turned| (turned - turned.round()).abs() < TURN_TOLERANCE)
    };
    periods.take_while(|seconds| *seconds <= greatest).find(|seconds| is_back(*seconds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Object;
    use crate::solid::Primitive;
    use glam::DMat4;
    use protocol::command::Object as Node;

    fn motion(by: [f64; 3], axis: [f64; 3], degrees: f64) -> Motion {
        let axis = DVec3::from_array(axis).normalize();
        Motion { by: by.into(), through: DVec3::new(1.0, -2.0, 0.5), axis, angle: degrees.to_radians() }
    }

    fn group(motion: Motion) -> MovingGroup {
        MovingGroup { motion, objects: vec![0] }
    }

    fn object() -> Object {
        Object {
            name: "box".into(),
            shape: Primitive::Box { size: DVec3::ONE }.into(),
            transform: DMat4::IDENTITY,
            material: None,
            tolerance: None,
        }
    }

    /// What the nodes of a group do to a point of the workstation after seconds.
    fn placed(group: &MovingGroup, seconds: f64) -> DMat4 {
        let mut out = StructureCommands::default();
        group.begin(1, &mut out);
        let mut whole = DMat4::IDENTITY;
        for command in &out.commands {
            let Command::Define { object: Node::Operate { operate, .. }, .. } = command else { continue };
            whole *= match operate {
                Operate::Translate(_) => DMat4::from_translation(mirrored(group.motion.by) * seconds),
                Operate::Rotate { .. } => DMat4::from_rotation_z(group.motion.angle * seconds),
                Operate::Matrix4x3(matrix) => *matrix,
                other => panic!("{other:?}"),
            };
        }
        whole
    }

    #[test]
    fn the_nodes_of_a_motion_move_points_as_it_does() {
        let mirror = DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
        let tilted = [[0.3, -0.5, 0.2], [0.3, 0.5, -0.2], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1e-9, 0.0, -1.0]];
        let axes = tilted.into_iter().chain([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]);
        for motion in axes.map(|axis| motion([0.4, 0.1, -0.7], axis, 57.0)) {
            for seconds in [0.0, 0.3, 2.0, 17.5] {
                let expected = mirror * motion.at(seconds).matrix() * mirror;
                let found = placed(&group(motion), seconds);
                assert!(found.abs_diff_eq(expected, 1e-13), "{motion:?} {seconds}: {found} is not {expected}");
            }
        }
    }

    #[test]
    fn what_moves_alike_is_one_group_and_what_does_not_move_is_in_none() {
        let turning = motion([0.0; 3], [0.0, 1.0, 0.0], 30.0);
        let moving = motion([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0.0);
        let elsewhere = Motion { through: DVec3::X, axis: DVec3::Z, ..moving };
        let still = Motion { by: DVec3::ZERO, ..moving };
        let motions = [turning, moving, turning, elsewhere, still];
        let objects = vec![object(); motions.len()];
        let scene = Scene { objects, motions: (0..).zip(motions).collect(), ..Scene::default() };
        let groups: Vec<Vec<usize>> = groups(&scene).into_iter().map(|group| group.objects).collect();
        assert_eq!(groups, [[0, 2], [1, 3]]);
    }

    #[test]
    fn a_period_ends_when_all_that_turns_is_back_where_it_was() {
        let turning = |degrees: f64| group(motion([0.0; 3], [0.0, 0.0, 1.0], degrees));
        let chosen = |degrees: &[f64]| {
            let groups: Vec<MovingGroup> = degrees.iter().map(|degrees| turning(*degrees)).collect();
            frames(&groups, MotionPeriod::Seamless)
        };
        assert_eq!(chosen(&[50.0]), 432, "7.2 s");
        assert_eq!(chosen(&[-90.0, 60.0]), 720, "12 s");
        assert_eq!(chosen(&[3600.0]), 60, "ten turns rather than a tenth of a second");
        assert_eq!(chosen(&[1.0]), 21_600, "six minutes");
        assert_eq!(chosen(&[0.1]), 240, "an hour is too long");
        assert_eq!(chosen(&[1.0, 2f64.sqrt()]), 240, "they never meet");
        let moving = [group(motion([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], 50.0))];
        assert_eq!(frames(&moving, MotionPeriod::Seamless), 240);
        assert_eq!(frames(&moving, MotionPeriod::Seconds(7.21)), 433);
        assert_eq!(frames(&moving, MotionPeriod::Seconds(1e-6)), 1);
    }
}
