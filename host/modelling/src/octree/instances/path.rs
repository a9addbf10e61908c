//! What a ray hits of nested instances, and by which of them.

use super::error::MOST_LEVELS;
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
}

/// An instance that a ray has been taken into, and those around it: a path that is not written down before it is asked
/// for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Descent<'d> {
    pub(super) number: u64,
    pub(super) outer: Option<&'d Descent<'d>>,
}

impl Descent<'_> {
    /// The path to here; none is longer than [`MOST_LEVELS`].
    pub(super) fn path(&self) -> InstancePath {
        let mut path = match self.outer {
            Some(outer) => outer.path(),
            None => InstancePath::default(),
        };
        if let Some(place) = path.numbers.get_mut(usize::from(path.levels)) {
            *place = self.number;
            path.levels += 1;
        }
        path
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
