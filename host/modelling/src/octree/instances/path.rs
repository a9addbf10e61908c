//! What a ray hits of nested instances, and by which of them.

use super::error::MOST_LEVELS;
use super::placement::{Instance, longest};
use crate::numeric::ray::Hit;
use glam::DAffine3;

/// The instances that a surface is placed by, the outermost first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct InstancePath {
    numbers: [u64; MOST_LEVELS],
    levels: u8,
}

impl InstancePath {
    /// The numbers of the instances in their octrees, which count them in an order of their own.
    pub fn numbers(&self) -> &[u64] {
        &self.numbers[..usize::from(self.levels)]
    }

    /// Goes on to an instance within; not past [`MOST_LEVELS`].
    pub(super) fn push(&mut self, number: u64) {
        if let Some(place) = self.numbers.get_mut(usize::from(self.levels)) {
            *place = number;
            self.levels += 1;
        }
    }
}

/// A hit of a ray on a surface that is placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstanceHit {
    /// Where, with the triangle in the octree of the surface.
    pub hit: Hit,
    /// By which instances the surface is placed.
    pub path: InstancePath,
}

/// How a surface is placed by the instances of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedSurface {
    /// From coordinates of the surface to those of the octree at the beginning of the path.
    pub placement: DAffine3,
    /// The sum of the variations of all instances of the path, modulo 2^16.
    pub variation: u16,
    /// The largest distance that placing it adds on the way, in coordinates of that octree: of this, times the precision
    /// of numbers, points are rounded.
    pub largest: f64,
}

impl PlacedSurface {
    /// What is not placed by any instance.
    pub(super) const UNPLACED: PlacedSurface =
        PlacedSurface { placement: DAffine3::IDENTITY, variation: 0, largest: 0.0 };

    /// This, for what an instance within it places.
    pub(super) fn then(&self, instance: &Instance) -> PlacedSurface {
        let PlacedSurface { placement: outer, variation, largest } = *self;
        PlacedSurface {
            placement: outer * instance.placement,
            variation: variation.wrapping_add(instance.variation),
            largest: largest + longest(&outer.matrix3) * instance.placement.translation.length(),
        }
    }
}
