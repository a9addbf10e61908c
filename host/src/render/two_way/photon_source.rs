//! Lamps with what their light paths are aimed at.

use super::projection_map::ProjectionMap;

/// A lamp with what it is aimed at.
#[derive(Clone, Debug)]
pub(super) struct PhotonSource {
    /// An index into the sources.
    pub(super) source: usize,
    pub(super) targets: Vec<PhotonTarget>,
    /// What is caught of its flux, W; none before some of it was.
    pub(super) stored_flux: Option<f64>,
    /// The name of its light in a database, less the pass; none without one.
    pub(super) name: Option<String>,
}

/// Ways from a lamp to a bounding sphere.
#[derive(Clone, Debug)]
pub(super) struct PhotonTarget {
    pub(super) sphere: usize,
    /// How probable it is that a way of the lamp goes there; all together are 1.
    pub(super) part: f64,
    /// How many do.
    pub(super) count: u32,
    /// Where it is best aimed at.
    pub(super) map: ProjectionMap,
}
