//! Error against run time: what a quality setting costs, and what it buys.
//!
//! A [`Knob`] is one quality setting that can be swept. [`KNOBS`] lists those that the program offers, but for the
//! [`RENDER_KNOBS`] of the renderers, which are studied together.

mod composite;
mod division;
mod illumination;
mod meeting;
mod octree;
mod plot;
mod rendering;
mod residual;
mod sweep;
mod tessellation;

#[cfg(test)]
mod tests;

pub use illumination::{IlluminationRow, IlluminationStudy, illumination};
pub use plot::{Axis, Plot, PlotError, Point, Series};
pub use rendering::{
    Bend, KnobStudy, Measures, RENDER_KNOBS, RENDER_OPTIONS, RenderKnob, RenderRow, RenderStudy, renderers, studied,
    usual,
};
pub use sweep::{Knob, Row, Study, Trial, sweep};

use crate::illumination::distribution::DistributionError;
use crate::octree::OctreeError;
use crate::picture::PictureError;
use crate::render::{RenderError, Watch};
use crate::scene::{Scene, SceneError, ShapeError};
use crate::subdivision::SubdivisionError;
use crate::surface::{TessellationError, TrimError};
use std::num::NonZeroUsize;

/// How a study is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Columns of the pictures; the rows follow from the shape of the scene's picture.
    pub width: u32,
    /// Samples in each pixel of the reference, or of every picture where the samples are not what is studied.
    pub samples: u32,
    /// How many settings are tried.
    pub settings: u32,
    /// Threads; every core without a number.
    pub threads: Option<NonZeroUsize>,
}

/// A study that the program offers.
pub struct KnobRow {
    /// What it is called on the command line.
    pub name: &'static str,
    /// What it sweeps.
    pub summary: &'static str,
    /// Options that give a useful curve within a minute.
    pub options: Options,
    /// Makes the study of a scene.
    pub run: fn(&Scene, &Options, &Watch<'_>) -> Result<Study, StudyError>,
}

/// The studies that the program offers.
pub const KNOBS: &[KnobRow] = &[
    KnobRow {
        name: "tessellate",
        summary: "tessellation tolerance against a far finer tessellation and the exact surfaces",
        options: Options { width: 160, samples: 4, settings: 7, threads: None },
        run: tessellation::study,
    },
    KnobRow {
        name: "octree",
        summary: "triangles in a leaf of the octree; hits against a search of all triangles",
        options: Options { width: 160, samples: 1, settings: 9, threads: None },
        run: octree::leaf_size,
    },
    KnobRow {
        name: "depth",
        summary: "levels of the octree; hits against a search of all triangles",
        options: Options { width: 160, samples: 1, settings: 10, threads: None },
        run: octree::depth,
    },
    KnobRow {
        name: "subdivide",
        summary: "steps of subdivision, from coarse triangles of each object, against the limit surface",
        options: Options { width: 160, samples: 1, settings: 4, threads: None },
        run: division::study,
    },
    KnobRow {
        name: "boolean",
        summary: "tolerance of the operands of composites against results of far finer ones",
        options: Options { width: 160, samples: 1, settings: 6, threads: None },
        run: composite::study,
    },
    KnobRow {
        name: "surface",
        summary: "tolerance of triangles, adaptive where surfaces are whole, against the exact surfaces",
        options: Options { width: 160, samples: 1, settings: 8, threads: None },
        run: residual::study,
    },
    KnobRow {
        name: "intersect",
        summary: "tolerance of the triangles of objects that meet; their exact curves, and how near lines between the points are",
        options: Options { width: 160, samples: 1, settings: 6, threads: None },
        run: meeting::triangles,
    },
    KnobRow {
        name: "newton",
        summary: "tolerance of the iteration for exact curves in which objects meet",
        options: Options { width: 160, samples: 1, settings: 7, threads: None },
        run: meeting::newton,
    },
];

/// Why there is no study.
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

/// The scene with the picture size of a study.
fn resized(scene: &Scene, options: &Options) -> Scene {
    let mut scene = scene.clone();
    let settings = &mut scene.settings;
    let width = options.width.max(1);
    let rows = f64::from(settings.image.height) * f64::from(width) / f64::from(settings.image.width.max(1));
    settings.image.height = (rows.round() as u32).max(1);
    settings.image.width = width;
    scene
}
