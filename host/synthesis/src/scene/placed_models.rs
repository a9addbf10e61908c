//! What of a prepared scene depends on the views: its terrains, the procedural models that instances place, and the
//! aggregates that stand in for these.

use super::object::Procedural;
use super::scatter::PlacedGrid;
use super::terrain::Terrain;
use crate::illumination::Material;
use glam::DAffine3;
use std::any::Any;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// A procedural model that instances of a prepared scene place.
#[derive(Clone, Debug)]
pub(super) struct PlacedModel {
    pub(super) model: Procedural,
    /// The material of objects that have none.
    pub(super) whole: Option<Material>,
    /// The object of the scene that has its materials.
    pub(super) object: u32,
    /// These materials.
    pub(super) materials: Vec<Material>,
}

/// Instances in cells for which aggregates stand in.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedAggregates {
    /// The object of the scene that they are.
    pub(super) object: u32,
    /// Their cells, placed in the scene; but for the box, which is in coordinates of the object.
    pub(super) grid: PlacedGrid,
    /// How many pixels the largest of them spans where aggregates begin.
    pub(super) pixels: f64,
}

/// A terrain that stands in the scene, an open surface that rays may meet exactly.
#[derive(Clone, Debug)]
pub(super) struct PlacedTerrain {
    /// The object of the scene that it is.
    pub(super) object: u32,
    /// What messages call it.
    pub(super) name: String,
    pub(super) terrain: Terrain,
    /// From its coordinates to those of the scene.
    pub(super) to_scene: DAffine3,
}

/// What is made of models, kept by the scene that has them: it does not know what that is, since it is made of scenes.
pub(super) type KeptDetails = Arc<dyn Any + Send + Sync>;

/// The details that were asked for last, and what details may take.
#[derive(Debug, Default)]
pub(super) struct LastDetails {
    last: Mutex<Option<KeptDetails>>,
    most_bytes: OnceLock<u64>,
}

impl LastDetails {
    pub(super) fn last(&self) -> MutexGuard<'_, Option<KeptDetails>> {
        self.last.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How many bytes they may take, if that was told.
    pub(super) fn most_bytes(&self) -> Option<u64> {
        self.most_bytes.get().copied()
    }

    /// Tells how many bytes they may take, once.
    pub(super) fn limit(&self, most_bytes: u64) {
        _ = self.most_bytes.set(most_bytes);
    }
}
