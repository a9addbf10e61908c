//! Visibility of elements by rays: whether something is between two points, and what is hit in all directions.

use super::node::{HierarchyNode, RadiosityPatch};
use super::openings::Openings;
use crate::numeric::bounds::Bounds;
use crate::numeric::ray::Ray;
use crate::numeric::sampling::cosine_hemisphere;
use crate::numeric::sequence::SobolSequence;
use crate::render::Memo;
use crate::render::world::World;
use glam::DVec3;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Rounding errors, in units of the last place of the largest coordinate, that rays keep clear of.
const CLEARANCE_ULPS: f64 = 64.0;
/// Length of a ray to what it hits, over the distance, so that it does not hit it.
pub(super) const SHORT: f64 = 1.0 - 1e-7;
/// Surfaces that let light straight through and that a ray passes, at the most.
const MOST_PASSABLE: usize = 64;

/// Tests visibility by rays.
pub(super) struct VisibilityTester<'a> {
    pub(super) world: &'a World<'a>,
    pub(super) clearance: f64,
    pub(super) seed: u64,
    pub(super) openings: Openings,
    /// Whether mirrors and panes send light on.
    pub(super) by_mirrors: bool,
    /// The memo in which results are kept, if there is one.
    memo: Option<&'a Memo>,
}

/// The target of a ray from an element.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum RayTarget {
    /// No target: light escapes.
    Nothing,
    /// A lamp that is no object.
    Lamp,
    /// A side of a triangle, the weights of its corners, as the scene orders them, how far it is in lengths of the
    /// ray's direction, the part of light that is let through on the way, 0..=1, and whether an opening is crossed there.
    Side { triangle: u32, outside: bool, weights: [f64; 3], t: f64, transmittance: f64, through_opening: bool },
}

impl<'a> VisibilityTester<'a> {
    pub(super) fn new(world: &'a World<'a>, memo: Option<&'a Memo>) -> VisibilityTester<'a> {
        let prepared = world.appearance.prepared;
        let largest = prepared.vertices.iter().fold(0.0f64, |most, vertex| most.max(vertex.abs().max_element()));
        let clearance = (CLEARANCE_ULPS * f64::EPSILON * largest).max(f64::MIN_POSITIVE);
        let (seed, openings) = (prepared.settings.image.seed, Openings::new(&prepared.portals));
        VisibilityTester { world, clearance, seed, openings, by_mirrors: false, memo }
    }

    /// Maps a function over items, on all threads; see [`Memo::map`].
    pub(super) fn map<T: Sync, R: Serialize + DeserializeOwned + Send>(
        &self,
        items: &[T],
        f: impl Fn(usize, &T) -> R + Sync,
    ) -> Vec<R> {
        Memo::map(self.memo, items, f)
    }

    /// Transmittance from one point to another, in the mean over the lanes, 0..=1.
    ///
    /// Each with its unit normal, on the sides that see each other.
    pub(super) fn transmittance(&self, [from, from_normal]: [DVec3; 2], [to, to_normal]: [DVec3; 2]) -> f64 {
        let origin = from + from_normal * self.clearance;
        let direction = to + to_normal * self.clearance - origin;
        self.along(&Ray { origin, direction }, 1.0)
    }

    /// Transmittance of a ray up to a parameter, in the mean over the lanes, 0..=1.
    pub(super) fn along(&self, ray: &Ray, t_max: f64) -> f64 {
        let transmittance = self.world.transmittance(ray, t_max, usize::MAX, None, 0, 0.0).0;
        let lanes = self.world.appearance.wavelengths.lanes();
        transmittance.0[..lanes].iter().sum::<f64>() / lanes as f64
    }

    /// Whether it is sure that nothing is between two elements.
    pub(super) fn is_clear(&self, one: &HierarchyNode, other: &HierarchyNode) -> bool {
        let prepared = self.world.appearance.prepared;
        // What does not come out of the plane of an element does not occlude its front.
        let is_behind = |corners: &[DVec3; 3], node: &HierarchyNode| {
            corners.iter().all(|corner| (*corner - node.corners[0]).dot(node.normal) <= self.clearance)
        };
        let counts = |triangle: u32| {
            let corners = prepared.corners(triangle);
            !is_behind(&corners, one) && !is_behind(&corners, other)
        };
        self.world.is_clear([one, other].map(|node| Bounds::of(node.corners)), counts)
    }

    /// Traces rays from points of an element in directions that are as dense as their cosine.
    ///
    /// - `place`: a point with its unit normal, told which one and a point of the unit square.
    /// - `number`: of the element: each has directions of its own. `count`: of directions.
    /// - `trace`: tells what a ray hits; it is given numbers in 0..1 for what is by chance on the way.
    pub(super) fn trace_hemisphere<T>(
        &self,
        place: impl Fn(u32, [f64; 2]) -> [DVec3; 2],
        number: u64,
        count: u32,
        trace: impl Fn(&Ray, &dyn Fn(u64) -> f64) -> T,
    ) -> Vec<T> {
        let sequence = SobolSequence::new(self.seed, number);
        let look = |index: u32| {
            let [point, normal] = place(index, sequence.point(index, 0));
            let towards = cosine_hemisphere(sequence.point(index, 1), normal);
            let ray = Ray { origin: point + normal * self.clearance, direction: towards };
            trace(&ray, &|which| sequence.number(index, 2 + which))
        };
        (0..count).map(look).collect()
    }

    /// The first hit of a ray that light does not go straight through.
    pub(super) fn trace(&self, ray: &Ray) -> RayTarget {
        let (world, prepared) = (self.world, self.world.appearance.prepared);
        let mut from = 0.0;
        for _ in 0..MOST_PASSABLE {
            let struck = world.first_triangle(ray, from);
            let t_max = struck.map_or(f64::INFINITY, |(hit, _)| hit.t);
            if world.appearance.intersect_lights(ray, from, t_max, 0).is_some() {
                return RayTarget::Lamp;
            }
            let Some((hit, triangle)) = struck else { return RayTarget::Nothing };
            let bsdf = world.appearance.bsdf(prepared.object_of[triangle as usize], prepared.material_number(triangle));
            if !bsdf.is_passable() {
                let [a, b, c] = prepared.corners(triangle);
                let outside = (b - a).cross(c - a).dot(ray.direction) < 0.0;
                let transmittance = if from > 0.0 { self.along(ray, hit.t * SHORT) } else { 1.0 };
                let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
                let through_opening = self.openings.are_crossed(ray, hit.t);
                return RayTarget::Side { triangle, outside, weights, t: hit.t, transmittance, through_opening };
            }
            from = hit.t;
        }
        RayTarget::Nothing
    }
}

impl RadiosityPatch {
    /// Weights of the corners of the triangle, as the scene orders them, in the order of the patch.
    pub(super) fn weights(&self, [a, b, c]: [f64; 3]) -> [f64; 3] {
        if self.outside { [a, b, c] } else { [a, c, b] }
    }
}
