//! A scene at a time: what its script places as a function of the time moves while the shutter is open.

use super::engine::{self, ScriptRun};
use super::error::ScriptError;
use super::evaluated::{Evaluated, Inputs};
use crate::scene::{Motion, Scene};
use std::path::Path;

/// Runs a script: the scene in the middle of the time in which the shutter is open.
///
/// A script that asks for the time is run again when the shutter opens and when it closes. What differs in nothing but
/// its place, and that by a rigid motion, moves so in between. All else stays as it is in the middle: what changes its
/// shape, size or material, what emits light, lights and the camera.
///
/// - `text`: the script.
/// - `name`: what messages call it.
/// - `folder`: where the relative paths in it begin.
/// - `inputs`: what it is given.
///
/// # Errors
/// [`ScriptError`], with line and column where there are any.
pub fn evaluate(text: &str, name: &str, folder: &Path, inputs: &Inputs) -> Result<Evaluated, ScriptError> {
    let run = |now: f64| engine::run(text, name, folder, inputs, now);
    let [open, close] = inputs.shutter.unwrap_or_default();
    let guessed = inputs.time + 0.5 * (open + close);
    let first = run(guessed)?;
    let [open, close] = first.shutter;
    if !first.asked_time || open == close && inputs.time + open == guessed {
        return Ok(first.made);
    }
    let middle = inputs.time + 0.5 * (open + close);
    let ScriptRun { mut made, .. } = if middle == guessed { first } else { run(middle)? };
    if open < close {
        let [begin, end] = [open, close].map(|offset| run(inputs.time + offset));
        add_motions(&mut made.scene, [begin?.made.scene, end?.made.scene], close - open);
    }
    Ok(made)
}

/// Lets objects move from where they are in the one scene to where they are in the other.
///
/// - `duration`: of the motion, in whose middle `scene` is; seconds.
fn add_motions(scene: &mut Scene, [begin, end]: [Scene; 2], duration: f64) {
    if [&begin, &end].iter().any(|other| other.objects.len() != scene.objects.len()) {
        // Which of the objects are the same is not known.
        return;
    }
    for (index, object) in scene.objects.iter().enumerate() {
        let (first, last) = (&begin.objects[index], &end.objects[index]);
        let stands = first.transform == last.transform;
        let moves_already = scene.motions.iter().any(|(moving, _)| *moving as usize == index);
        if stands || moves_already || object.emits() || first.name != object.name || last.name != object.name {
            continue;
        }
        let is_rigid = first.shape == object.shape && last.shape == object.shape;
        let places = [first.transform, object.transform, last.transform];
        let motion = is_rigid.then(|| Motion::through(&places, duration)).flatten();
        scene.motions.extend(motion.map(|motion| (index as u32, motion)));
    }
}
