//! Octrees over a prepared scene: one over the static objects, one for each motion, and the same of instances.

use super::Motion;
use crate::octree::{InstanceOctree, Octree, Prototype};
use glam::DAffine3;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The octrees that rays go through. They know triangles of the scene, no renderer and no settings.
#[derive(Debug, Default)]
pub struct Acceleration {
    /// Over the static objects; none if there are none.
    pub still: Option<SceneOctree>,
    /// Over the objects that move while the shutter is open, where they are in the middle of that time; one for each
    /// motion.
    pub moving: Vec<(Motion, SceneOctree)>,
    /// Over the instances that stand still; none if there are none. Hits name triangles of the scene.
    pub placed: Option<InstanceOctree>,
    /// Over the instances of objects that move, as for those that have triangles.
    pub placed_moving: Vec<(Motion, InstanceOctree)>,
    /// How long it took to build them.
    pub build: Duration,
}

/// An octree over some triangles of a scene.
#[derive(Debug)]
pub struct SceneOctree {
    /// It numbers its triangles from 0.
    pub octree: Octree,
    /// The triangle of the scene behind each of its triangles; empty if it holds the whole scene.
    pub(super) triangle_of: Vec<u32>,
}

/// The instances of an object.
#[derive(Clone, Debug)]
pub(super) struct PlacedInstances {
    /// The object.
    pub object: u32,
    /// The instances, in coordinates of the object.
    pub prototype: Prototype,
    /// From these to scene coordinates.
    pub transform: DAffine3,
}

/// The objects of a scene that octrees are built over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AccelerationKey {
    /// Whether each object of the scene counts.
    pub objects: Vec<bool>,
    /// Whether motions count; without them everything is where it is in the middle of the time in which the shutter is
    /// open.
    pub motions: bool,
}

/// The octrees that were built last, for whoever asks for the same again.
#[derive(Debug, Default)]
pub(super) struct AccelerationCache {
    last: Mutex<Option<(AccelerationKey, Arc<Acceleration>)>>,
    times: AtomicU32,
}

impl SceneOctree {
    /// The triangle of the scene behind one of its triangles.
    #[inline]
    pub fn triangle(&self, own: u32) -> u32 {
        self.triangle_of.get(own as usize).copied().unwrap_or(own)
    }

    /// The triangles of the scene that it holds, in the order of its own.
    pub fn triangles(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.octree.triangle_count() as u32).map(|own| self.triangle(own))
    }
}

impl AccelerationCache {
    fn last(&self) -> MutexGuard<'_, Option<(AccelerationKey, Arc<Acceleration>)>> {
        self.last.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The octrees over the objects that are included, if they were built last.
    pub(super) fn get(&self, key: &AccelerationKey) -> Option<Arc<Acceleration>> {
        self.last().as_ref().filter(|(of, _)| of == key).map(|(_, acceleration)| acceleration.clone())
    }

    /// Stores octrees that were built in the place of those before.
    pub(super) fn store(&self, key: AccelerationKey, acceleration: &Arc<Acceleration>) {
        self.times.fetch_add(1, Ordering::Relaxed);
        *self.last() = Some((key, acceleration.clone()));
    }

    /// How often octrees were built.
    pub(super) fn times(&self) -> u32 {
        self.times.load(Ordering::Relaxed)
    }
}
