//! Rays through instances.

#[cfg(target_arch = "x86_64")]
use super::super::lanes::{Avx, AvxLanes};
use super::super::lanes::{Lanes, ScalarLanes};
use super::super::prepared_ray::PreparedRay;
use super::super::visit::{LeafVisitor, visit_leaves};
use super::super::{Hit, Octree, Ray};
use super::build::{Content, InstanceOctree};
use super::path::{InstanceHit, InstancePath};
use super::placement::InstanceBound;
use std::ops::Range;

/// Rounding of a sphere, as a part of its radius and of how far it is: far more than there is.
const ROUNDING: f64 = 1e-9;

impl InstanceOctree {
    /// Finds the nearest hit with `t_min < t < t_max`, both exclusive, as [`Octree::closest`] does.
    ///
    /// Of several hits with the same `t`, one counts, always the same.
    pub fn closest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<InstanceHit> {
        let mut query = Nearest { limits: [t_min, t_max], best: None };
        self.ask(ray, InstancePath::default(), &mut query);
        query.best
    }

    /// Says whether anything is hit with `t_min < t < t_max`.
    pub fn occluded(&self, ray: &Ray, t_min: f64, t_max: f64) -> bool {
        self.ask(ray, InstancePath::default(), &mut Any { limits: [t_min, t_max] })
    }

    /// Gives all hits with `t_min < t < t_max`, in no order, until one is enough; says whether one was.
    pub fn each_hit(&self, ray: &Ray, t_min: f64, t_max: f64, enough: impl FnMut(InstanceHit) -> bool) -> bool {
        self.ask(ray, InstancePath::default(), &mut Each { limits: [t_min, t_max], enough })
    }

    /// Asks all surfaces along a ray, the nearer ones first, until the answer is known; says whether it is.
    fn ask(&self, ray: &Ray, path: InstancePath, query: &mut impl Query) -> bool {
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx2,fma")]
            fn ask_wide(
                avx: Avx,
                octree: &InstanceOctree,
                ray: &Ray,
                path: InstancePath,
                query: &mut impl Query,
            ) -> bool {
                octree.ask_by::<AvxLanes>(avx, ray, path, query)
            }
            if let Some(avx) = Avx::detected() {
                // SAFETY: `avx` proves that the processor has AVX2 and FMA, all that this function asks for.
                return unsafe { ask_wide(avx, self, ray, path, query) };
            }
        }
        self.ask_by::<ScalarLanes>((), ray, path, query)
    }

    #[inline(always)]
    fn ask_by<L: Lanes>(&self, proof: L::Proof, ray: &Ray, path: InstancePath, query: &mut impl Query) -> bool {
        let [t_min, t_max] = query.limits();
        let Some(prepared) = PreparedRay::new(ray, &self.cube, t_min, t_max) else { return false };
        let limit = prepared.single.limit_of(prepared.chord.length());
        let mut visitor = Visitor { octree: self, ray, prepared: &prepared, path, query, limit };
        visit_leaves::<L>(proof, &self.nodes, &prepared.single, &mut visitor)
    }
}

/// What is asked of the surfaces along a ray.
trait Query {
    /// The lengths between which hits count.
    fn limits(&self) -> [f64; 2];
    /// Asks a surface; returns whether the answer is known.
    ///
    /// - `first`: the number of its first triangle in hits.
    fn ask(&mut self, surface: &Octree, first: u32, ray: &Ray, path: InstancePath) -> bool;
}

struct Nearest {
    limits: [f64; 2],
    best: Option<InstanceHit>,
}

impl Query for Nearest {
    fn limits(&self) -> [f64; 2] {
        self.limits
    }

    fn ask(&mut self, surface: &Octree, first: u32, ray: &Ray, path: InstancePath) -> bool {
        if let Some(hit) = surface.closest(ray, self.limits[0], self.limits[1]) {
            self.limits[1] = hit.t;
            self.best = Some(InstanceHit { hit: numbered(hit, first), path });
        }
        false
    }
}

/// A hit whose triangle is counted from a number on.
fn numbered(hit: Hit, first: u32) -> Hit {
    Hit { triangle: hit.triangle + first, ..hit }
}

struct Any {
    limits: [f64; 2],
}

impl Query for Any {
    fn limits(&self) -> [f64; 2] {
        self.limits
    }

    fn ask(&mut self, surface: &Octree, _: u32, ray: &Ray, _: InstancePath) -> bool {
        surface.occluded(ray, self.limits[0], self.limits[1])
    }
}

struct Each<F> {
    limits: [f64; 2],
    enough: F,
}

impl<F: FnMut(InstanceHit) -> bool> Query for Each<F> {
    fn limits(&self) -> [f64; 2] {
        self.limits
    }

    fn ask(&mut self, surface: &Octree, first: u32, ray: &Ray, path: InstancePath) -> bool {
        let enough = |hit: Hit| (self.enough)(InstanceHit { hit: numbered(hit, first), path });
        surface.each_hit(ray, self.limits[0], self.limits[1], enough)
    }
}

/// Takes a ray into the coordinates of prototypes.
struct Visitor<'v, Q> {
    octree: &'v InstanceOctree,
    ray: &'v Ray,
    prepared: &'v PreparedRay,
    path: InstancePath,
    query: &'v mut Q,
    limit: f32,
}

impl<Q: Query> Visitor<'_, Q> {
    /// Whether the ray comes to the sphere about the origin of an instance that all of it is within; in doubt it does.
    #[inline(always)]
    fn may_hit(&self, number: usize) -> bool {
        let InstanceBound { prototype, origin, longer } = self.octree.placements.bound(&self.octree.positions, number);
        let to = origin - self.ray.origin;
        let radius = self.octree.prototypes[usize::from(prototype)].radius * longer * (1.0 + ROUNDING)
            + to.abs().max_element() * ROUNDING;
        let square = self.ray.direction.length_squared();
        if !square.is_normal() {
            return true;
        }
        let t = to.dot(self.ray.direction) / square;
        let beside = to - self.ray.direction * t;
        let [t_min, t_max] = self.query.limits();
        let half = radius / square.sqrt();
        // Written so that what is not a number may hit.
        let misses = beside.length_squared() > radius * radius || t + half < t_min || t - half > t_max;
        !misses
    }
}

impl<Q: Query> LeafVisitor for Visitor<'_, Q> {
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.limit
    }

    #[inline(always)]
    fn count(&mut self) {}

    #[inline(always)]
    fn visit(&mut self, places: Range<usize>) -> bool {
        for number in places {
            if !self.may_hit(number) {
                continue;
            }
            let instance = self.octree.instance(number);
            let inverse = instance.placement.inverse();
            let origin = inverse.transform_point3(self.ray.origin);
            let ray = Ray { origin, direction: inverse.transform_vector3(self.ray.direction) };
            let path = self.path.and(number as u32);
            let is_known = match &self.octree.prototypes[usize::from(instance.prototype)].content {
                Content::Surface { octree, first } => self.query.ask(octree, *first, &ray, path),
                Content::Instances(inner) => inner.ask(&ray, path, self.query),
            };
            if is_known {
                return true;
            }
            let length = self.prepared.single.limit(self.query.limits()[1]);
            self.limit = self.limit.min(length);
        }
        false
    }
}
