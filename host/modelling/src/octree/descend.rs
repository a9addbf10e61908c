//! Rays down the index, nearest child first.

#[cfg(target_arch = "x86_64")]
use super::lanes::{Avx, AvxLanes};
use super::lanes::{LANES, Lanes, ScalarLanes, prefetch};
use super::packet::Packet;
use super::prepared_ray::PreparedRay;
use super::visit::{LeafVisitor, visit_leaves};
use super::walk::Search;
use super::{Hit, Octree, Ray, WalkCount};
use glam::DVec3;
use std::ops::Range;

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

/// Shows packets to a search.
struct PacketVisitor<'v, 'a, F> {
    search: &'v mut Search<'a>,
    is_last: F,
}

impl<'a, F: FnMut(&mut Search<'a>, &Packet) -> bool> LeafVisitor for PacketVisitor<'_, 'a, F> {
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.search.limit
    }

    #[inline(always)]
    fn count(&mut self) {
        self.search.count.cells += 1;
    }

    #[inline(always)]
    fn visit(&mut self, places: Range<usize>) -> bool {
        let packets = &self.search.octree.index.packets[places];
        packets.iter().for_each(prefetch);
        packets.iter().any(|packet| (self.is_last)(self.search, packet))
    }
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
    fn visit<L: Lanes>(&mut self, proof: L::Proof, is_last: impl FnMut(&mut Self, &Packet) -> bool) -> bool {
        let (index, ray) = (&self.octree.index, &self.ray.single);
        visit_leaves::<L>(proof, &index.nodes, ray, &mut PacketVisitor { search: self, is_last })
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
