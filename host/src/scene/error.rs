//! What can be wrong with a scene.

use super::ShapeError;

/// What is wrong with a scene, and with which part of it.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// An object has an impossible value.
    #[error("{object}: {problem}")]
    Object {
        /// The object's name.
        object: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A light has an impossible value.
    #[error("light {number}: {problem}")]
    Light {
        /// The number of the light, counted from 1.
        number: usize,
        /// What is wrong with it.
        problem: String,
    },
    /// The camera cannot see.
    #[error("camera: {0}")]
    Camera(String),
    /// A setting of the whole scene is impossible.
    #[error("{0}")]
    Setting(String),
    /// More of something than PERIS takes.
    #[error("more than {limit} {what}")]
    Limit {
        /// Of what.
        what: &'static str,
        /// How many are allowed.
        limit: u64,
    },
    /// The triangles of an object cannot be made or read.
    #[error("{object}: {source}")]
    Shape {
        /// The object's name.
        object: String,
        /// What is wrong with the shape.
        source: Box<ShapeError>,
    },
    /// An object is wrong that a script asks for at a place.
    #[error("{place}: {source}")]
    Placed {
        /// File, line and column of the script.
        place: String,
        /// What is wrong.
        source: Box<SceneError>,
    },
}
