//! Rays down the index, nearest child first.

#[cfg(target_arch = "x86_64")]
use super::lanes::{Avx, AvxLanes};
use super::lanes::{LANES, Lanes, ScalarLanes, prefetch};
use super::packet::Packet;
use super::prepared_ray::PreparedRay;
use super::walk::Search;
use super::wide_bvh::Child;
use super::{Hit, Octree, Ray, WalkCount};
use glam::DVec3;

/// Entries of the stack that need no allocation.
const STACK: usize = 32;

/// A child that is still to be visited: where the ray enters it, as bits, above its reference. So the nearer is the
/// lesser, since no length is negative.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry(u64);

impl Entry {
    #[inline(always)]
    fn new(near: f32, child: Child) -> Self {
        Self(u64::from(near.to_bits()) << 32 | u64::from(child.0))
    }

    #[inline(always)]
    fn near(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child(self.0 as u32)
    }
}

/// A stack that allocates only where trees are uncommonly deep.
struct Stack {
    fixed: [Entry; STACK],
    top: usize,
    spill: Vec<Entry>,
}

impl Stack {
    #[inline(always)]
    fn new() -> Self {
        Self { fixed: [Entry(0); STACK], top: 0, spill: Vec::new() }
    }

    /// Inserts above `mark` so that the nearest comes on top.
    #[inline(always)]
    fn insert(&mut self, mark: usize, entry: Entry) {
        if self.top >= STACK {
            self.spill.push(entry);
            return;
        }
        let mut at = self.top;
        while at > mark && self.fixed[at - 1] < entry {
            self.fixed[at] = self.fixed[at - 1];
            at -= 1;
        }
        self.fixed[at] = entry;
        self.top += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<Entry> {
        if let Some(entry) = self.spill.pop() {
            return Some(entry);
        }
        self.top = self.top.checked_sub(1)?;
        Some(self.fixed[self.top])
    }
}

/// Finds the nearest hit with `t_min < t < t_max`, and counts the work, if there was any.
#[inline]
pub fn nearest(octree: &Octree, ray: &Ray, t_min: f64, t_max: f64, count: &mut WalkCount) -> Option<Hit> {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,fma")]
        fn nearest_wide(
            avx: Avx,
            octree: &Octree,
            ray: &Ray,
            t_min: f64,
            t_max: f64,
            count: &mut WalkCount,
        ) -> Option<Hit> {
            nearest_by::<AvxLanes>(avx, octree, ray, [t_min, t_max], count)
        }
        if let Some(avx) = Avx::detected() {
            // SAFETY: `avx` proves that the processor has AVX2 and FMA, all that this function asks for.
            return unsafe { nearest_wide(avx, octree, ray, t_min, t_max, count) };
        }
    }
    nearest_by::<ScalarLanes>((), octree, ray, [t_min, t_max], count)
}

/// Says whether anything is hit with `t_min < t < t_max`.
#[inline]
pub fn is_any(octree: &Octree, ray: &Ray, t_min: f64, t_max: f64) -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,fma")]
        fn is_any_wide(avx: Avx, octree: &Octree, ray: &Ray, t_min: f64, t_max: f64) -> bool {
            is_any_by::<AvxLanes>(avx, octree, ray, [t_min, t_max])
        }
        if let Some(avx) = Avx::detected() {
            // SAFETY: `avx` proves that the processor has AVX2 and FMA, all that this function asks for.
            return unsafe { is_any_wide(avx, octree, ray, t_min, t_max) };
        }
    }
    is_any_by::<ScalarLanes>((), octree, ray, [t_min, t_max])
}

/// The nearest triangle that a ray hits, as [`nearest`] finds it, with given instructions.
#[inline(always)]
pub fn nearest_by<L: Lanes>(
    proof: L::Proof,
    octree: &Octree,
    ray: &Ray,
    limits: [f64; 2],
    count: &mut WalkCount,
) -> Option<Hit> {
    let line = PreparedRay::new(ray, &octree.cube, limits[0], limits[1])?;
    let mut search = Search::new(octree, &line, limits[0], limits[1], false);
    search.descend::<L, false>(proof);
    let (hit, work) = search.found();
    *count = work;
    hit
}

/// Whether a ray hits any triangle, as [`is_any`] tells, with given instructions.
#[inline(always)]
pub fn is_any_by<L: Lanes>(proof: L::Proof, octree: &Octree, ray: &Ray, limits: [f64; 2]) -> bool {
    let line = PreparedRay::new(ray, &octree.cube, limits[0], limits[1]);
    line.is_some_and(|line| Search::new(octree, &line, limits[0], limits[1], true).descend::<L, true>(proof))
}

/// Gives all hits with `t_min < t < t_max`, in no order, until one is enough; says whether one was.
#[inline]
pub fn each(octree: &Octree, ray: &Ray, t_min: f64, t_max: f64, enough: impl FnMut(Hit) -> bool) -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,fma")]
        fn each_wide(avx: Avx, octree: &Octree, ray: &Ray, limits: [f64; 2], enough: impl FnMut(Hit) -> bool) -> bool {
            each_by::<AvxLanes>(avx, octree, ray, limits, enough)
        }
        if let Some(avx) = Avx::detected() {
            // SAFETY: `avx` proves that the processor has AVX2 and FMA, all that this function asks for.
            return unsafe { each_wide(avx, octree, ray, [t_min, t_max], enough) };
        }
    }
    each_by::<ScalarLanes>((), octree, ray, [t_min, t_max], enough)
}

#[inline(always)]
fn each_by<L: Lanes>(
    proof: L::Proof,
    octree: &Octree,
    ray: &Ray,
    limits: [f64; 2],
    mut enough: impl FnMut(Hit) -> bool,
) -> bool {
    let Some(line) = PreparedRay::new(ray, &octree.cube, limits[0], limits[1]) else { return false };
    let mut search = Search::new(octree, &line, limits[0], limits[1], true);
    search.visit::<L>(proof, |search, packet| search.any_of_packet::<L>(proof, packet, &mut enough))
}

/// Gives all hits among the triangles of some packets with `t_min < t < t_max`, in no order, until one is enough; says
/// whether one was.
#[inline]
pub fn each_in(
    octree: &Octree,
    packets: &[Packet],
    ray: &Ray,
    [t_min, t_max]: [f64; 2],
    enough: impl FnMut(Hit) -> bool,
) -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,fma")]
        fn each_in_wide(
            avx: Avx,
            octree: &Octree,
            packets: &[Packet],
            ray: &Ray,
            limits: [f64; 2],
            enough: impl FnMut(Hit) -> bool,
        ) -> bool {
            each_in_by::<AvxLanes>(avx, octree, packets, ray, limits, enough)
        }
        if let Some(avx) = Avx::detected() {
            // SAFETY: `avx` proves that the processor has AVX2 and FMA, all that this function asks for.
            return unsafe { each_in_wide(avx, octree, packets, ray, [t_min, t_max], enough) };
        }
    }
    each_in_by::<ScalarLanes>((), octree, packets, ray, [t_min, t_max], enough)
}

/// Says whether a triangle of some packets is hit with `t_min < t < t_max`.
#[inline]
pub fn is_any_in(octree: &Octree, packets: &[Packet], ray: &Ray, t_min: f64, t_max: f64) -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,fma")]
        fn is_any_in_wide(avx: Avx, octree: &Octree, packets: &[Packet], ray: &Ray, limits: [f64; 2]) -> bool {
            is_any_in_by::<AvxLanes>(avx, octree, packets, ray, limits)
        }
        if let Some(avx) = Avx::detected() {
            // SAFETY: `avx` proves that the processor has AVX2 and FMA, all that this function asks for.
            return unsafe { is_any_in_wide(avx, octree, packets, ray, [t_min, t_max]) };
        }
    }
    is_any_in_by::<ScalarLanes>((), octree, packets, ray, [t_min, t_max])
}

#[inline(always)]
fn each_in_by<L: Lanes>(
    proof: L::Proof,
    octree: &Octree,
    packets: &[Packet],
    ray: &Ray,
    limits: [f64; 2],
    mut enough: impl FnMut(Hit) -> bool,
) -> bool {
    let Some(line) = PreparedRay::new(ray, &octree.cube, limits[0], limits[1]) else { return false };
    let search = Search::new(octree, &line, limits[0], limits[1], true);
    packets.iter().any(|packet| search.any_of_packet::<L>(proof, packet, &mut enough))
}

#[inline(always)]
fn is_any_in_by<L: Lanes>(proof: L::Proof, octree: &Octree, packets: &[Packet], ray: &Ray, limits: [f64; 2]) -> bool {
    let Some(line) = PreparedRay::new(ray, &octree.cube, limits[0], limits[1]) else { return false };
    let mut search = Search::new(octree, &line, limits[0], limits[1], true);
    let within = line.single.within(search.t_min, search.t_max);
    packets.iter().any(|packet| search.test::<L, true>(proof, packet, within))
}

impl Search<'_> {
    /// Goes down the index; returns whether it ended at a hit that is enough.
    #[inline(always)]
    fn descend<L: Lanes, const ANY: bool>(&mut self, proof: L::Proof) -> bool {
        let within = if ANY { self.ray.single.within(self.t_min, self.t_max) } else { [0.0; 2] };
        self.visit::<L>(proof, |search, packet| search.test::<L, ANY>(proof, packet, within))
    }

    /// Visits the packets along the ray, the nearer ones first, until one of them is the last.
    #[inline(always)]
    fn visit<L: Lanes>(&mut self, proof: L::Proof, mut is_last: impl FnMut(&mut Self, &Packet) -> bool) -> bool {
        let index = &self.octree.index;
        if index.nodes.is_empty() {
            return false;
        }
        let mut stack = Stack::new();
        let mut child = Child(0);
        loop {
            self.count.cells += 1;
            match child.place() {
                Err(place) => {
                    let node = &index.nodes[place];
                    let (mut lanes, near) = node.meets::<L>(proof, &self.ray.single, self.limit);
                    if lanes != 0 {
                        let first = lanes.trailing_zeros() as usize & (LANES - 1);
                        lanes &= lanes - 1;
                        if lanes == 0 {
                            child = node.children[first];
                            continue;
                        }
                        let near = near.store().0;
                        let mut nearest = Entry::new(near[first], node.children[first]);
                        let mark = stack.top;
                        while lanes != 0 {
                            let lane = lanes.trailing_zeros() as usize & (LANES - 1);
                            lanes &= lanes - 1;
                            let entry = Entry::new(near[lane], node.children[lane]);
                            stack.insert(mark, nearest.max(entry));
                            nearest = nearest.min(entry);
                        }
                        child = nearest.child();
                        continue;
                    }
                }
                Ok(places) => {
                    let packets = &index.packets[places];
                    packets.iter().for_each(prefetch);
                    for packet in packets {
                        if is_last(self, packet) {
                            return true;
                        }
                    }
                }
            }
            loop {
                let Some(entry) = stack.pop() else { return false };
                if entry.near() <= self.limit {
                    child = entry.child();
                    break;
                }
            }
        }
    }

    /// The corners of a triangle, world units.
    #[inline(always)]
    fn corners(&self, packet: &Packet, lane: usize) -> [DVec3; 3] {
        packet.corners(lane).unwrap_or_else(|| self.octree.corners(packet.triangles[lane]))
    }

    /// Gives the hits of a packet until one is enough.
    #[inline(always)]
    fn any_of_packet<L: Lanes>(&self, proof: L::Proof, packet: &Packet, enough: &mut impl FnMut(Hit) -> bool) -> bool {
        let (mut lanes, _) = packet.candidates::<L, false>(proof, &self.ray.single, self.limit, [0.0; 2]);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & (LANES - 1);
            lanes &= lanes - 1;
            if self.intersection(packet.triangles[lane], self.corners(packet, lane)).is_some_and(&mut *enough) {
                return true;
            }
        }
        false
    }

    /// Tests a packet; returns whether the search is over.
    #[inline(always)]
    fn test<L: Lanes, const ANY: bool>(&mut self, proof: L::Proof, packet: &Packet, within: [f32; 2]) -> bool {
        self.count.triangles += LANES as u64;
        let (mut lanes, certain) = packet.candidates::<L, ANY>(proof, &self.ray.single, self.limit, within);
        if ANY && certain != 0 {
            return true;
        }
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & (LANES - 1);
            lanes &= lanes - 1;
            if self.decide(packet.triangles[lane], self.corners(packet, lane)) && ANY {
                return true;
            }
        }
        false
    }
}
