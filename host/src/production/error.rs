//! Errors of the main job.

use crate::render::RenderError;
use crate::scene::SceneError;
use crate::workstation::WorkstationError;

/// A reason for which the main job failed.
#[derive(Debug, thiserror::Error)]
pub enum ProductionError {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The workstation, or the way there, failed.
    #[error(transparent)]
    Workstation(#[from] WorkstationError),
    /// The image cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// No thread can be had to render with, or it failed.
    #[error("the rendering cannot go on: {0}")]
    Thread(String),
}
