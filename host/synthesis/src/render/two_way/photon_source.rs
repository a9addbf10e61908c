//! Lamps that emit photons, with their photon targets.

use super::projection_map::ProjectionMap;

/// A lamp with its photon targets.
#[derive(Clone, Debug)]
pub(super) struct PhotonSource {
    /// An index into the sources.
    pub(super) source: usize,
    pub(super) targets: Vec<PhotonTarget>,
    /// Flux that its photons store, W; none before some were traced.
    pub(super) stored_flux: Option<f64>,
    /// The name of its photons in a database, less the pass; none without one.
    pub(super) name: Option<String>,
}

/// A bounding sphere towards which a lamp emits photons.
#[derive(Clone, Debug)]
pub(super) struct PhotonTarget {
    pub(super) sphere: usize,
    /// Probability that a photon of the lamp is sent there; all together are 1.
    pub(super) part: f64,
    /// How many photon paths are sent there.
    pub(super) count: u32,
    /// The cells of it that are worth photons.
    pub(super) map: ProjectionMap,
}
