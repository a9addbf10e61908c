//! What a script is given, and what it makes.

use super::definition::ParameterAssignment;
use crate::scene::Scene;
use std::path::PathBuf;

/// What a script is given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    /// Values for parameters that it asks for.
    pub definitions: Vec<ParameterAssignment>,
    /// Folders below which it may read, beside its own.
    pub allowed: Vec<PathBuf>,
    /// The time of the picture, seconds: scenes are functions of it.
    pub time: f64,
    /// When the shutter opens and closes if the script does not say it, seconds from `time`. Without it, what moves by
    /// itself is seen from 0 to 1, and what a script moves stands still.
    pub shutter: Option<[f64; 2]>,
}

/// What a script made.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    /// The scene.
    pub scene: Scene,
    /// Name of the script, for titles and messages.
    pub name: String,
    /// What the script printed, line by line.
    pub printed: Vec<String>,
    /// Whether something in it depends on the time: the script asks for it, or an object moves.
    pub is_timed: bool,
    /// The files that it read, in the order in which it named them.
    pub files: Vec<PathBuf>,
}
