//! A scene that is a function of the time, on the workstation: its pictures one after the other, as those of a flip-book.
//!
//! # Method
//! What is the same in all pictures is sent once, as ever. Of an object that changes, each form that it takes is sent once:
//! one, if nothing but its place changes. For each picture a structure places the forms, a matrix each, and is drawn at a
//! level of detail of its own. The clock that moves things counts, and a network makes the level of its count.

use super::names::ROOT;
use super::network::Build;
use super::structure_commands::{DrawnMotion, FRAMES_PER_SECOND, StructureCommands, placing};
use super::{WorkstationError, motion};
use crate::scene::{Object, Scene, Shape};
use glam::DAffine3;
use protocol::{
    Value,
    command::{Command, Comparison, Operate},
};
use std::iter;

/// Most points of all forms of all objects that change.
const MOST_POINTS: usize = 1_000_000;
/// The node of the root below which the pictures are.
pub(super) const PICTURES: &str = "PICTURES";
/// What the names of the structures of pictures and forms begin with, and none of another.
pub(super) const STRUCTURE_PREFIX: &str = "PERIS_PICTURE";

/// A scene at several times, one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipBook {
    first: Scene,
    rest: Vec<Scene>,
    rate: u32,
}

/// An object that is not the same in all pictures.
pub(super) struct ChangingObject<'a> {
    /// Its number in the scenes, from 0.
    pub(super) index: usize,
    /// The forms that it takes, each where it is at first.
    pub(super) forms: Vec<&'a Object>,
    /// For each picture in which it is, the number of its form, and from where that is at first to where it is.
    places: Vec<Option<(usize, DAffine3)>>,
}

impl FlipBook {
    /// The flip-book of scenes that follow each other.
    ///
    /// - `first`: the scene of the first picture, which says how it is seen and lit. `rest`: those of the others.
    /// - `rate`: pictures in a second, 1..=60; what is beyond is the nearest of these.
    pub fn new(first: Scene, rest: Vec<Scene>, rate: u32) -> FlipBook {
        FlipBook { first, rest, rate: rate.clamp(1, FRAMES_PER_SECOND) }
    }

    /// The scene of the first picture.
    pub fn first(&self) -> &Scene {
        &self.first
    }

    /// The scene of the picture that is shown some time after the first one, in seconds; the last for later times.
    pub fn scene(&self, seconds: f64) -> &Scene {
        // A whole number of frames may be less by its rounding.
        let number = (seconds * f64::from(self.rate) + 1e-6) as usize;
        let (index, last) = (number.checked_sub(1), self.rest.last());
        index.and_then(|index| self.rest.get(index).or(last)).unwrap_or(&self.first)
    }

    /// The objects that are not the same in all pictures.
    ///
    /// # Errors
    /// [`WorkstationError::Scene`], if instances are other ones.
    pub(super) fn changing(&self) -> Result<Vec<ChangingObject<'_>>, WorkstationError> {
        let scenes = || iter::once(&self.first).chain(&self.rest);
        let most = scenes().map(|scene| scene.objects.len()).max().unwrap_or(0);
        let mut changing = Vec::new();
        for index in 0..most {
            let all: Vec<Option<&Object>> = scenes().map(|scene| scene.objects.get(index)).collect();
            let stays = |pair: &[Option<&Object>]| match pair {
                [Some(one), Some(other)] => one.transform == other.transform && has_form_of(one, other),
                _ => false,
            };
            if !all.windows(2).all(stays) {
                changing.push(ChangingObject::new(index, &all)?);
            }
        }
        Ok(changing)
    }

    /// The network that turns the pages: it runs at once, and a key stops it and lets it go on.
    ///
    /// - `objects`: how many change.
    pub(super) fn network(&self, objects: usize) -> (Vec<Command>, DrawnMotion) {
        let pictures = 1 + self.rest.len();
        let seconds = pictures as f64 / f64::from(self.rate);
        let frames = motion::frames_of(seconds);
        let mut build = Build::default();
        let [product, level] = ["PERIS_MOTION_PRODUCT", "PERIS_MOTION_LEVEL"];
        // Of integers, so that no picture comes a frame too late.
        build.function(product, "MULC");
        build.send(Value::Integer(self.rate as i32), 2, product);
        build.connect(motion::FRAME, 1, 1, product);
        build.function(level, "DIVC");
        build.send(Value::Integer(FRAMES_PER_SECOND as i32), 2, level);
        build.connect(product, 1, 1, level);
        build.connect(level, 1, 1, &format!("{ROOT}.{PICTURES}.LEVEL"));
        motion::clock(frames, &mut build);
        (build.commands, DrawnMotion { objects, motions: 0, pictures, frames })
    }
}

impl<'a> ChangingObject<'a> {
    /// Tells the forms of an object apart.
    ///
    /// - `index`: its number in the scenes, from 0. `all`: it in each picture, none where it is not.
    fn new(index: usize, all: &[Option<&'a Object>]) -> Result<ChangingObject<'a>, WorkstationError> {
        let mut forms: Vec<&Object> = Vec::new();
        let mut places = Vec::with_capacity(all.len());
        for &object in all {
            let place = object.map(|object| {
                let number = forms.iter().position(|form| has_form_of(form, object)).unwrap_or_else(|| {
                    forms.push(object);
                    forms.len() - 1
                });
                (number, DAffine3::from_mat4(object.transform * forms[number].transform.inverse()))
            });
            places.push(place);
        }
        let are_others = forms.len() > 1 || all.first().is_none_or(Option::is_none);
        if let Some(placed) = forms.iter().find(|form| matches!(form.shape, Shape::Instances(_)) && are_others) {
            let problem = "its instances are others in other pictures; only all of them together can move";
            return Err(WorkstationError::Scene(format!("{}: {problem}", placed.name)));
        }
        Ok(ChangingObject { index, forms, places })
    }

    /// The name of the structure of a form, by its number from 0.
    pub(super) fn structure(&self, form: usize) -> String {
        format!("{STRUCTURE_PREFIX}_O{}_{}", self.index + 1, form + 1)
    }
}

/// Whether two objects are the same but for their names and places.
fn has_form_of(one: &Object, other: &Object) -> bool {
    one.shape == other.shape && one.material == other.material && one.tolerance == other.tolerance
}

/// Refuses more points than are sent.
///
/// # Errors
/// [`WorkstationError::Scene`] with how many there are already.
pub(super) fn check_points(points: usize) -> Result<(), WorkstationError> {
    if points <= MOST_POINTS {
        return Ok(());
    }
    let problem = format!(
        "{points} points for only a part of its pictures, and the workstation gets {MOST_POINTS} at most; show fewer \
         frames, or coarser ones with --tolerance"
    );
    Err(WorkstationError::Scene(problem))
}

/// Defines the structure of each picture, beside the root.
pub(super) fn define_pictures(changing: &[ChangingObject<'_>], out: &mut StructureCommands) {
    for number in 0..pictures(changing) {
        out.begin(&picture(number));
        for object in changing {
            if let Some((form, place)) = object.places[number] {
                out.operate_on(&object.structure(form), placing(&place));
            }
        }
        out.end();
    }
}

/// Places the pictures in the root, each at its own level of detail.
pub(super) fn place_pictures(changing: &[ChangingObject<'_>], out: &mut StructureCommands) {
    out.begin(PICTURES);
    out.operate(Some("LEVEL"), Operate::SetLevelOfDetail(0));
    for (level, number) in (0..).zip(0..pictures(changing)) {
        out.operate_on(&picture(number), Operate::IfLevelOfDetail { comparison: Comparison::Equal, level });
    }
    out.end();
}

fn pictures(changing: &[ChangingObject<'_>]) -> usize {
    changing.first().map_or(0, |object| object.places.len())
}

/// The name of the structure of a picture, by its number from 0.
fn picture(number: usize) -> String {
    format!("{STRUCTURE_PREFIX}_{number}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_points_than_are_sent_are_refused_with_their_number() {
        assert_eq!(check_points(MOST_POINTS), Ok(()));
        let text = check_points(1_234_567).expect_err("it is too much").to_string();
        assert!(text.contains("1234567 points") && text.contains("1000000 at most"), "{text}");
    }

    #[test]
    fn a_time_has_the_scene_of_its_picture_and_late_ones_that_of_the_last() {
        let scene = |background: f64| Scene { background: glam::DVec3::splat(background), ..Scene::default() };
        let book = FlipBook::new(scene(0.0), vec![scene(1.0), scene(2.0)], 24);
        let shown = [0.0, 0.04, 1.0 / 24.0, 0.08, 2.0 / 24.0, 9.0].map(|seconds| book.scene(seconds).background.x);
        assert_eq!(shown, [0.0, 0.0, 1.0, 1.0, 2.0, 2.0]);
    }
}
