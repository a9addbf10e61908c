//! Rays through instances.

#[cfg(target_arch = "x86_64")]
use super::super::lanes::{Avx, AvxLanes};
use super::super::lanes::{LANES, Lanes, ScalarLanes};
use super::super::prepared_ray::PreparedRay;
use super::super::visit::{LeafVisitor, visit_leaves};
use super::super::{Hit, Octree, Ray};
use super::blocks::SphereTest;
use super::build::{Content, InstanceOctree};
use super::path::{InstanceHit, InstancePath};
use std::ops::Range;

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
        let test = SphereTest::new(ray, &self.positions);
        let from = test.as_ref().map_or(0.0, |test| test.from(t_min));
        let mut visitor =
            Visitor::<L, _> { proof, octree: self, ray, prepared: &prepared, test, from, path, query, limit };
        visit_leaves::<L>(proof, &self.nodes, &prepared.single, &mut visitor)
    }
}

/// What is asked of the surfaces along a ray.
trait Query {
    /// Whether an answer brings the limits closer, so that the order counts.
    const NARROWS: bool;
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
    const NARROWS: bool = true;

    fn limits(&self) -> [f64; 2] {
        self.limits
    }

    #[inline(always)]
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
    const NARROWS: bool = false;

    fn limits(&self) -> [f64; 2] {
        self.limits
    }

    #[inline(always)]
    fn ask(&mut self, surface: &Octree, _: u32, ray: &Ray, _: InstancePath) -> bool {
        surface.occluded(ray, self.limits[0], self.limits[1])
    }
}

struct Each<F> {
    limits: [f64; 2],
    enough: F,
}

impl<F: FnMut(InstanceHit) -> bool> Query for Each<F> {
    const NARROWS: bool = false;

    fn limits(&self) -> [f64; 2] {
        self.limits
    }

    #[inline(always)]
    fn ask(&mut self, surface: &Octree, first: u32, ray: &Ray, path: InstancePath) -> bool {
        let enough = |hit: Hit| (self.enough)(InstanceHit { hit: numbered(hit, first), path });
        surface.each_hit(ray, self.limits[0], self.limits[1], enough)
    }
}

/// Takes a ray into the coordinates of prototypes.
struct Visitor<'v, L: Lanes, Q> {
    proof: L::Proof,
    octree: &'v InstanceOctree,
    ray: &'v Ray,
    prepared: &'v PreparedRay,
    /// None where spheres about instances cannot be compared with the ray.
    test: Option<SphereTest>,
    /// The length of the ray from which on hits count.
    from: f32,
    path: InstancePath,
    query: &'v mut Q,
    limit: f32,
}

impl<L: Lanes, Q: Query> Visitor<'_, L, Q> {
    /// The length of the ray up to which hits count.
    #[inline(always)]
    fn to(&self) -> f32 {
        self.test.as_ref().map_or(0.0, |test| test.to(self.query.limits()[1]))
    }

    /// Asks what is placed at a place; returns whether the answer is known.
    #[inline(always)]
    fn ask(&mut self, block: usize, lane: usize) -> bool {
        let InstanceOctree { placements, positions, prototypes, spheres, .. } = self.octree;
        let Some(prototype) = placements.prototype(block, lane).map(usize::from) else { return false };
        let ray = placements.own_ray(positions, block, lane, spheres[prototype].center, self.ray);
        let path = self.path.and((block * LANES + lane) as u32);
        match &prototypes[prototype].content {
            Content::Surface { octree, first } => self.query.ask(octree, *first, &ray, path),
            Content::Instances(inner) => inner.ask(&ray, path, self.query),
        }
    }
}

impl<L: Lanes, Q: Query> LeafVisitor for Visitor<'_, L, Q> {
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.limit
    }

    #[inline(always)]
    fn count(&mut self) {}

    #[inline(always)]
    fn visit(&mut self, blocks: Range<usize>) -> bool {
        let InstanceOctree { placements, positions, spheres, .. } = self.octree;
        for block in blocks {
            let mut to = self.to();
            let (mut lanes, enter) =
                placements.meets::<L>(self.proof, positions, block, spheres, self.test.as_ref(), [self.from, to]);
            // The nearer ones first, so that those behind a hit are not asked.
            while lanes != 0 {
                let mut lane = lanes.trailing_zeros() as usize & (LANES - 1);
                let mut others = if Q::NARROWS { lanes & (lanes - 1) } else { 0 };
                while others != 0 {
                    let other = others.trailing_zeros() as usize & (LANES - 1);
                    others &= others - 1;
                    lane = if enter.0[other] < enter.0[lane] { other } else { lane };
                }
                lanes &= !(1 << lane);
                if Q::NARROWS && enter.0[lane] > to {
                    continue;
                }
                if self.ask(block, lane) {
                    return true;
                }
                if Q::NARROWS {
                    to = self.to();
                }
            }
            if Q::NARROWS {
                self.limit = self.limit.min(self.prepared.single.limit(self.query.limits()[1]));
            }
        }
        false
    }
}
