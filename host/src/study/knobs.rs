//! The studies of knobs that the program offers.

use super::error::StudyError;
use super::options::Options;
use super::sweep::Study;
use super::{composite, division, intersection, octree, residual, tessellation};
use crate::render::Watch;
use crate::scene::Scene;

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
        run: intersection::triangles,
    },
    KnobRow {
        name: "newton",
        summary: "tolerance of the iteration for exact curves in which objects meet",
        options: Options { width: 160, samples: 1, settings: 7, threads: None },
        run: intersection::newton,
    },
];
