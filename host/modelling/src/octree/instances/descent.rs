//! Where a ray is on its way down through nested instances.

use super::octree::InstanceOctree;
use super::path::{InstancePath, PlacedSurface};
use super::placement::Instance;

/// An instance that a ray has been taken into, and those around it: a path that is not written down before it is asked
/// for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Descent<'d> {
    /// The octree that has the instance.
    pub(super) octree: &'d InstanceOctree,
    pub(super) number: u64,
    /// The instance as the ray met it, where the octree may know it otherwise.
    pub(super) met: Option<&'d Instance>,
    pub(super) outer: Option<&'d Descent<'d>>,
}

impl Descent<'_> {
    /// The path to here.
    pub(super) fn path(&self) -> InstancePath {
        let mut path = match self.outer {
            Some(outer) => outer.path(),
            None => InstancePath::default(),
        };
        path.push(self.number);
        path
    }

    /// How what is here is placed.
    pub(super) fn placed(&self) -> PlacedSurface {
        let outer = self.outer.map_or(PlacedSurface::UNPLACED, Descent::placed);
        let instance = self.met.copied().or_else(|| self.octree.instance(self.number));
        instance.map_or(outer, |instance| outer.then(&instance))
    }
}
