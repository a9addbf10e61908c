//! Prototypes that are made when rays come to them, and what that is seen from.

use super::super::Ray;
use super::aggregates::AggregateView;
use super::octree::InstanceOctree;
use super::path::PlacedSurface;

/// A ray, and where hits of it count.
#[derive(Clone, Copy, Debug)]
pub struct RayInterval<'r> {
    /// The ray.
    pub ray: &'r Ray,
    /// The lengths between which hits count, in lengths of its direction.
    pub between: [f64; 2],
}

/// Makes those prototypes of instances that are not stored, [`Prototype::made`](super::Prototype::made), and knows the
/// views from which what is far away is aggregated, [`InstanceOctree::aggregated`].
///
/// What it gives is the same whenever it is asked, and for all rays.
pub trait PrototypeMaker {
    /// Gives what a prototype is made of, in coordinates of the prototype and within the box that was told; nothing if it
    /// cannot be made.
    ///
    /// - `model`: number of the prototype among those that are made.
    /// - `placed`: how it is placed; it may be made as finely as it is seen there.
    /// - `along`: the ray for which it is asked: it need not be given if this passes by. None for all of it.
    fn give(
        &self,
        model: u32,
        placed: &PlacedSurface,
        along: Option<RayInterval<'_>>,
        to: &mut dyn FnMut(&InstanceOctree),
    );

    /// From where instances in cells are seen for which aggregates may stand in; nothing if all are to be met as they
    /// are.
    ///
    /// - `number`: of their octree among those that have aggregates.
    fn aggregate_views(&self, number: u32) -> &[AggregateView];
}

/// Makes nothing and knows no views, for instances whose prototypes are all stored and met as they are.
pub(super) struct NothingMade;

impl PrototypeMaker for NothingMade {
    fn give(&self, _: u32, _: &PlacedSurface, _: Option<RayInterval<'_>>, _: &mut dyn FnMut(&InstanceOctree)) {}

    fn aggregate_views(&self, _: u32) -> &[AggregateView] {
        &[]
    }
}
