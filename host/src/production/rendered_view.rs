//! An image of a view with what it took.

use crate::picture::Picture;
use crate::render::Rendering;

/// An image of the view that is set on the workstation.
#[derive(Debug)]
pub struct RenderedView {
    /// The image, with what it took.
    pub rendering: Rendering,
    /// Memory of the octree that the rays went through, bytes a triangle; none if the view needs no triangles.
    pub octree_bytes: Option<f64>,
    /// Until octree and tables stood, seconds.
    pub build_seconds: f64,
    /// The image as a display shows it.
    pub shown: Picture,
    /// Its exposure, stops.
    pub stops: f64,
}
