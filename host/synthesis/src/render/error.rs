//! Errors of rendering.

use crate::illumination::material::MaterialError;
use crate::memory::MemoryExceeded;
use crate::picture::PictureError;
use crate::scene::AccelerationError;

/// A reason for which there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The octree cannot be built.
    #[error("octree: {0}")]
    Octree(#[from] AccelerationError),
    /// The picture cannot be made.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A material is impossible.
    #[error("{object}: {source}")]
    Material {
        /// The object.
        object: String,
        /// The fault of the material.
        source: MaterialError,
    },
    /// Instances are placed that were to be copied.
    #[error("{object}: instances must be copied for this renderer, and the scene was prepared with them placed")]
    PlacedInstances {
        /// The object that has them.
        object: String,
    },
    /// A procedural model cannot be made.
    #[error("{0}")]
    Model(String),
    /// The view flattens space to a line or a point, or is not finite.
    #[error("the view has no directions for the pixels: its matrix is singular or not finite")]
    View,
    /// Radiosity has no solution.
    #[error("radiosity: {0}")]
    Radiosity(#[from] RadiosityError),
    /// There is too little memory.
    #[error(transparent)]
    Memory(#[from] MemoryExceeded),
    /// The threads cannot be started.
    #[error("threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// A reason for which radiosity has no solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RadiosityError {
    /// Light that nothing takes away.
    #[error("light comes to surfaces that reflect all of it and from which none escapes: it would grow without end")]
    NoLoss,
    /// A value that is not finite, or a fraction that is none.
    #[error("reflectance {reflectance} or exitance {exitance} is out of range")]
    Value {
        /// The greatest reflectance.
        reflectance: f64,
        /// The greatest exitance, W/m².
        exitance: f64,
    },
}
