//! Rays through instances.

#[cfg(target_arch = "x86_64")]
use super::super::lanes::{Avx, AvxLanes};
use super::super::lanes::{LANES, Lanes, ScalarLanes};
use super::super::prepared_ray::PreparedRay;
use super::super::visit::{LeafVisitor, visit_leaves};
use super::super::{Hit, Octree, Ray};
use super::aggregates::Aggregates;
use super::blocks::SphereTest;
use super::cell_walk::{CellVisitor, visit_cells};
use super::cells::Cells;
use super::descent::Descent;
use super::made::{NothingMade, PrototypeMaker, RayInterval};
use super::octree::{Content, InstanceOctree, KnownInstances};
use super::parts::PartsOnDemand;
use super::path::{InstanceHit, InstancePath, PlacedSurface};
use super::placement::Instance;
use super::stored::{Extents, StoredInstances};
use std::ops::Range;

/// An octree of instances, and who makes those of its prototypes that are made on demand.
#[derive(Clone, Copy)]
pub struct InstanceWalk<'w> {
    octree: &'w InstanceOctree,
    maker: &'w dyn PrototypeMaker,
}

impl InstanceOctree {
    /// This, with who makes those of its prototypes that are made on demand, if there are any.
    pub fn made_by<'w>(&'w self, maker: Option<&'w dyn PrototypeMaker>) -> InstanceWalk<'w> {
        InstanceWalk { octree: self, maker: maker.unwrap_or(&NothingMade) }
    }

    /// [`InstanceWalk::closest`], where all prototypes are stored.
    pub fn closest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<InstanceHit> {
        self.made_by(None).closest(ray, t_min, t_max)
    }

    /// [`InstanceWalk::occluded`], where all prototypes are stored.
    pub fn occluded(&self, ray: &Ray, t_min: f64, t_max: f64) -> bool {
        self.made_by(None).occluded(ray, t_min, t_max)
    }

    /// [`InstanceWalk::each_hit`], where all prototypes are stored.
    pub fn each_hit(&self, ray: &Ray, t_min: f64, t_max: f64, enough: impl FnMut(InstanceHit) -> bool) -> bool {
        self.made_by(None).each_hit(ray, t_min, t_max, enough)
    }

    /// [`InstanceWalk::placed`], where all prototypes are stored.
    pub fn placed(&self, path: &InstancePath) -> PlacedSurface {
        self.made_by(None).placed(path)
    }
}

impl<'w> InstanceWalk<'w> {
    /// Finds the nearest hit with `t_min < t < t_max`, both exclusive, as [`Octree::closest`] does.
    ///
    /// Of several hits with the same `t`, one counts, always the same.
    pub fn closest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<InstanceHit> {
        let mut query = Nearest { limits: [t_min, t_max], best: None };
        self.ask(ray, None, &mut query);
        query.best
    }

    /// Says whether anything is hit with `t_min < t < t_max`.
    pub fn occluded(&self, ray: &Ray, t_min: f64, t_max: f64) -> bool {
        self.ask(ray, None, &mut Any { limits: [t_min, t_max] })
    }

    /// Gives all hits with `t_min < t < t_max`, in no order, until one is enough; says whether one was.
    pub fn each_hit(&self, ray: &Ray, t_min: f64, t_max: f64, enough: impl FnMut(InstanceHit) -> bool) -> bool {
        self.ask(ray, None, &mut Each { limits: [t_min, t_max], enough })
    }

    /// How the surface at the end of a path of this octree is placed.
    pub fn placed(&self, path: &InstancePath) -> PlacedSurface {
        self.placed_within(path.numbers(), PlacedSurface::UNPLACED)
    }

    /// How the surface at the end of a path is placed by what is placed itself.
    fn placed_within(&self, numbers: &[u64], outer: PlacedSurface) -> PlacedSurface {
        let Some((number, inner)) = numbers.split_first() else { return outer };
        let Some(instance) = self.instance(*number) else { return outer };
        let mut placed = outer.then(&instance);
        match &self.octree.prototypes[usize::from(instance.prototype)].content {
            Content::Surface { .. } => {}
            Content::Instances(octree) => placed = InstanceWalk { octree, ..*self }.placed_within(inner, placed),
            Content::Made { model } => self.maker.give(*model, &placed.clone(), None, &mut |octree| {
                placed = InstanceWalk { octree, maker: self.maker }.placed_within(inner, placed);
            }),
        }
        placed
    }

    /// Asks all surfaces along a ray, about the nearer ones first, until the answer is known; says whether it is.
    fn ask(&self, ray: &Ray, outer: Option<&Descent<'_>>, query: &mut impl Query) -> bool {
        let walk = *self;
        match &self.octree.known {
            KnownInstances::Stored(stored) => {
                ask_stored(stored, &self.octree.extents, ray, &Placed { walk, stored, base: 0, outer }, query)
            }
            KnownInstances::Parts(parts) => {
                ask_stored(&parts.above, &parts.extents, ray, &Parts { walk, parts, outer }, query)
            }
            KnownInstances::Cells(cells) => self.ask_cells(cells, ray, outer, query),
        }
    }

    /// Asks a prototype.
    ///
    /// - `ray`: in its coordinates.
    #[inline(always)]
    fn ask_prototype(&self, prototype: usize, ray: &Ray, descent: &Descent<'_>, query: &mut impl Query) -> bool {
        match &self.octree.prototypes[prototype].content {
            Content::Surface { octree, first } => query.ask(octree, *first, ray, descent),
            Content::Instances(octree) => InstanceWalk { octree, ..*self }.ask(ray, Some(descent), query),
            Content::Made { model } => self.ask_made(*model, prototype, ray, descent, query),
        }
    }

    /// Asks a prototype that is made on demand, unless the ray passes by its box.
    fn ask_made(&self, model: u32, prototype: usize, ray: &Ray, descent: &Descent<'_>, query: &mut impl Query) -> bool {
        if ray.within(&self.octree.prototypes[prototype].bounds(), query.limits()).is_none() {
            return false;
        }
        let mut is_known = false;
        let along = RayInterval { ray, between: query.limits() };
        self.maker.give(model, &descent.placed(), Some(along), &mut |octree| {
            is_known = InstanceWalk { octree, maker: self.maker }.ask(ray, Some(descent), query);
        });
        is_known
    }

    /// Asks what is placed in the cells along a ray.
    fn ask_cells(&self, cells: &Cells, ray: &Ray, outer: Option<&Descent<'_>>, query: &mut impl Query) -> bool {
        let mut below = CellPrototypes { walk: *self, outer, query };
        visit_cells(cells, &self.seen(cells), &self.octree.extents.spheres, ray, &mut below)
    }

    /// How instances in cells are seen.
    fn seen(&self, cells: &Cells) -> Aggregates<'w> {
        match cells.aggregates.map(|number| self.maker.aggregate_views(number)) {
            Some(views) if !views.is_empty() => cells.seen_by(views),
            _ => Aggregates::NONE,
        }
    }

    /// An instance as it is seen; none if there is none, or something else stands in for it.
    fn instance(&self, number: u64) -> Option<Instance> {
        match &self.octree.known {
            KnownInstances::Cells(cells) => cells.instance_seen(number, &self.seen(cells)),
            KnownInstances::Stored(_) | KnownInstances::Parts(_) => self.octree.instance(number),
        }
    }
}

/// What is placed in cells.
struct CellPrototypes<'p, Q> {
    walk: InstanceWalk<'p>,
    outer: Option<&'p Descent<'p>>,
    query: &'p mut Q,
}

impl<Q: Query> CellVisitor for CellPrototypes<'_, Q> {
    #[inline(always)]
    fn limits(&self) -> [f64; 2] {
        self.query.limits()
    }

    #[inline(always)]
    fn visit(&mut self, number: u64, instance: &Instance, ray: &Ray) -> bool {
        let CellPrototypes { walk, outer, .. } = *self;
        let descent = Descent { octree: walk.octree, number, met: Some(instance), outer };
        walk.ask_prototype(usize::from(instance.prototype), ray, &descent, self.query)
    }
}

/// What is behind the leaves of an index.
trait Below {
    /// Asks what is at a place; returns whether the answer is known.
    fn ask(&self, block: usize, lane: usize, ray: &Ray, query: &mut impl Query) -> bool;
}

/// Prototypes that are placed.
struct Placed<'p> {
    walk: InstanceWalk<'p>,
    stored: &'p StoredInstances,
    /// What the numbers of instances begin with.
    base: u64,
    outer: Option<&'p Descent<'p>>,
}

impl Below for Placed<'_> {
    #[inline(always)]
    fn ask(&self, block: usize, lane: usize, ray: &Ray, query: &mut impl Query) -> bool {
        let StoredInstances { placements, positions, .. } = self.stored;
        let Some(prototype) = placements.prototype(block, lane).map(usize::from) else { return false };
        let ray = placements.own_ray(positions, block, lane, self.walk.octree.extents.spheres[prototype].center, ray);
        let number = self.base | (block * LANES + lane) as u64;
        let descent = Descent { octree: self.walk.octree, number, met: None, outer: self.outer };
        self.walk.ask_prototype(prototype, &ray, &descent, query)
    }
}

/// Parts of instances.
struct Parts<'p> {
    walk: InstanceWalk<'p>,
    parts: &'p PartsOnDemand,
    outer: Option<&'p Descent<'p>>,
}

impl Below for Parts<'_> {
    fn ask(&self, block: usize, lane: usize, ray: &Ray, query: &mut impl Query) -> bool {
        let Parts { walk, parts, outer } = *self;
        let Some(part) = parts.above.placements.prototype(block, lane) else { return false };
        // The sphere about a part is often far larger than its box.
        if ray.within(&parts.extents.boxes[usize::from(part)], query.limits()).is_none() {
            return false;
        }
        let stored = parts.part(&walk.octree.extents, usize::from(part));
        let base = ((block * LANES + lane) as u64) << 32;
        ask_stored(stored, &walk.octree.extents, ray, &Placed { walk, stored, base, outer }, query)
    }
}

/// Asks what is placed along a ray.
fn ask_stored(
    stored: &StoredInstances,
    extents: &Extents,
    ray: &Ray,
    below: &impl Below,
    query: &mut impl Query,
) -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,fma")]
        fn ask_wide(
            avx: Avx,
            stored: &StoredInstances,
            extents: &Extents,
            ray: &Ray,
            below: &impl Below,
            query: &mut impl Query,
        ) -> bool {
            ask_by::<AvxLanes>(avx, stored, extents, ray, below, query)
        }
        if let Some(avx) = Avx::detected() {
            // SAFETY: `avx` proves that the processor has AVX2 and FMA, all that this function asks for.
            return unsafe { ask_wide(avx, stored, extents, ray, below, query) };
        }
    }
    ask_by::<ScalarLanes>((), stored, extents, ray, below, query)
}

#[inline(always)]
fn ask_by<L: Lanes>(
    proof: L::Proof,
    stored: &StoredInstances,
    extents: &Extents,
    ray: &Ray,
    below: &impl Below,
    query: &mut impl Query,
) -> bool {
    let [t_min, t_max] = query.limits();
    let Some(prepared) = PreparedRay::new(ray, &stored.cube, t_min, t_max) else { return false };
    let limit = prepared.single.limit_of(prepared.chord.length());
    let test = SphereTest::new(ray, &stored.positions);
    let from = test.as_ref().map_or(0.0, |test| test.from(t_min));
    let mut visitor =
        Visitor::<L, _, _> { proof, stored, extents, ray, prepared: &prepared, test, from, below, query, limit };
    visit_leaves::<L>(proof, &stored.nodes, &prepared.single, &mut visitor)
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
    fn ask(&mut self, surface: &Octree, first: u32, ray: &Ray, descent: &Descent<'_>) -> bool;
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
    fn ask(&mut self, surface: &Octree, first: u32, ray: &Ray, descent: &Descent<'_>) -> bool {
        if let Some(hit) = surface.closest(ray, self.limits[0], self.limits[1]) {
            self.limits[1] = hit.t;
            self.best = Some(InstanceHit { hit: numbered(hit, first), path: descent.path() });
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
    fn ask(&mut self, surface: &Octree, _: u32, ray: &Ray, _: &Descent<'_>) -> bool {
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
    fn ask(&mut self, surface: &Octree, first: u32, ray: &Ray, descent: &Descent<'_>) -> bool {
        let enough = |hit: Hit| (self.enough)(InstanceHit { hit: numbered(hit, first), path: descent.path() });
        surface.each_hit(ray, self.limits[0], self.limits[1], enough)
    }
}

/// Takes a ray to what is behind leaves.
struct Visitor<'v, L: Lanes, B, Q> {
    proof: L::Proof,
    stored: &'v StoredInstances,
    extents: &'v Extents,
    ray: &'v Ray,
    prepared: &'v PreparedRay,
    /// None where spheres about instances cannot be compared with the ray.
    test: Option<SphereTest>,
    /// The length of the ray from which on hits count.
    from: f32,
    below: &'v B,
    query: &'v mut Q,
    limit: f32,
}

impl<L: Lanes, B: Below, Q: Query> Visitor<'_, L, B, Q> {
    /// The length of the ray up to which hits count.
    #[inline(always)]
    fn to(&self) -> f32 {
        self.test.as_ref().map_or(0.0, |test| test.to(self.query.limits()[1]))
    }
}

impl<L: Lanes, B: Below, Q: Query> LeafVisitor for Visitor<'_, L, B, Q> {
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.limit
    }

    #[inline(always)]
    fn count(&mut self) {}

    #[inline(always)]
    fn expect(&self, blocks: Range<usize>) {
        self.stored.placements.prefetch(blocks.start);
    }

    #[inline(always)]
    fn visit(&mut self, blocks: Range<usize>) -> bool {
        let StoredInstances { placements, positions, .. } = self.stored;
        let spheres = &self.extents.spheres;
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
                if self.below.ask(block, lane, self.ray, self.query) {
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
