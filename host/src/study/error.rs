//! What keeps a study from being made.

use crate::illumination::distribution::DistributionError;
use crate::octree::OctreeError;
use crate::picture::PictureError;
use crate::render::RenderError;
use crate::scene::{SceneError, ShapeError};
use crate::subdivision::SubdivisionError;
use crate::surface::{TessellationError, TrimError};

/// A fault that keeps a study from being made.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A picture cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Two pictures cannot be compared.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// An octree cannot be built.
    #[error(transparent)]
    Octree(#[from] OctreeError),
    /// A polyhedron cannot be subdivided.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// A surface cannot be approximated.
    #[error(transparent)]
    Trim(#[from] TrimError),
    /// An object has no triangles.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A surface cannot be approximated by grids, or not be measured.
    #[error(transparent)]
    Tessellation(#[from] TessellationError),
    /// A distribution cannot be made.
    #[error(transparent)]
    Distribution(#[from] DistributionError),
    /// There is nothing to be studied.
    #[error("nothing to study: {0}")]
    Nothing(&'static str),
    /// Stopped from outside.
    #[error("interrupted")]
    Interrupted,
}
