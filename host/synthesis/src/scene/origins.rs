//! Where in a script the objects of a scene got their shapes, for errors that show when these are tessellated.

use super::SceneError;
use std::collections::HashMap;

/// A position in a script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScriptPosition {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
}

/// The calls that gave the objects of a scene their shapes.
///
/// It is no part of what the scene is: scenes that differ in it only are equal, and it is not stored.
#[derive(Clone, Debug, Default)]
pub struct ShapeOrigins {
    /// The script.
    pub file: String,
    /// By the name of the object.
    pub of: HashMap<String, ScriptPosition>,
}

impl PartialEq for ShapeOrigins {
    fn eq(&self, _: &ShapeOrigins) -> bool {
        true
    }
}

impl ShapeOrigins {
    /// An error with the position where the object that it names got its shape, if that is known.
    pub(super) fn located(&self, error: SceneError) -> SceneError {
        let position = match &error {
            SceneError::Object { object, .. } | SceneError::Shape { object, .. } => self.of.get(object),
            _ => None,
        };
        match position {
            Some(ScriptPosition { line, column }) => {
                let place = format!("{}:{line}:{column}", self.file);
                SceneError::Placed { location: place, source: Box::new(error) }
            }
            None => error,
        }
    }
}
