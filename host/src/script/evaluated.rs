//! What a script is given, and what it makes.

use super::definition::ParameterAssignment;
use crate::scene::Scene;
use std::path::PathBuf;

/// What a script is given.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Values for parameters that it asks for.
    pub definitions: Vec<ParameterAssignment>,
    /// Folders below which it may read, beside its own.
    pub allowed: Vec<PathBuf>,
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
    /// The files that it read, in the order in which it named them.
    pub files: Vec<PathBuf>,
}
