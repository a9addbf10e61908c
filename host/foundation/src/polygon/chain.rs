//! The part of the polygon that the sweep has passed but not yet covered with triangles.

use glam::DVec2;

use crate::numeric::predicates::turn;

/// No link.
const NONE: u32 = u32::MAX;

/// A reflex chain, the left boundary of an interval inside of the polygon: corners from the left end of its lower edge
/// to that of its upper edge. On both sides of its rightmost corner it turns away from the interval, so that each new
/// corner sees every corner that it cuts off.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReflexChain {
    /// The link at the lower edge.
    low: u32,
    /// The link at the upper edge.
    high: u32,
    /// The link that was added last.
    rightmost: u32,
}

/// A corner of a chain.
#[derive(Clone, Copy)]
pub(super) struct ChainLink {
    point: DVec2,
    corner: u32,
    low: u32,
    high: u32,
}

/// All chains, and the triangles that were cut off them.
pub(super) struct ReflexChains {
    links: Vec<ChainLink>,
    pub triangles: Vec<[u32; 3]>,
}

/// A corner that the sweep has come to: its index and its position.
pub(super) type SweepCorner = (u32, DVec2);

impl ReflexChains {
    /// Without chains, with room for the triangles of a polygon of so many corners.
    pub fn with_capacity(corners: usize) -> ReflexChains {
        ReflexChains { links: Vec::with_capacity(corners + corners / 2), triangles: Vec::with_capacity(corners) }
    }

    /// A chain of one corner.
    pub fn start(&mut self, corner: SweepCorner) -> ReflexChain {
        let link = self.link(corner, NONE, NONE);
        ReflexChain { low: link, high: link, rightmost: link }
    }

    /// A corner at the right end of the lower edge.
    #[inline]
    pub fn extend_low(&mut self, chain: ReflexChain, corner: SweepCorner) -> ReflexChain {
        let mut end = chain.low;
        while end != chain.high {
            let next = self[end].high;
            if turn(self[end].point, corner.1, self[next].point) <= 0.0 {
                break;
            }
            self.cut(end, corner.0, next);
            end = next;
        }
        let link = self.link(corner, NONE, end);
        self[end].low = link;
        ReflexChain { low: link, high: chain.high, rightmost: link }
    }

    /// A corner at the right end of the upper edge.
    #[inline]
    pub fn extend_high(&mut self, chain: ReflexChain, corner: SweepCorner) -> ReflexChain {
        let mut end = chain.high;
        while end != chain.low {
            let next = self[end].low;
            if turn(self[next].point, corner.1, self[end].point) <= 0.0 {
                break;
            }
            self.cut(next, corner.0, end);
            end = next;
        }
        let link = self.link(corner, end, NONE);
        self[end].high = link;
        ReflexChain { low: chain.low, high: link, rightmost: link }
    }

    /// A corner where both edges end: the chain is used up.
    pub fn close(&mut self, chain: ReflexChain, corner: SweepCorner) {
        let mut end = chain.low;
        while end != chain.high {
            let next = self[end].high;
            self.cut(end, corner.0, next);
            end = next;
        }
    }

    /// A corner between the edges: a lower and an upper chain, which end at it.
    pub fn split(&mut self, chain: ReflexChain, corner: SweepCorner) -> (ReflexChain, ReflexChain) {
        let middle = chain.rightmost;
        let ChainLink { point, corner: name, high, .. } = self[middle];
        let upper = if middle == chain.high {
            self.start((name, point))
        } else {
            let copy = self.link((name, point), NONE, high);
            self[high].low = copy;
            ReflexChain { low: copy, high: chain.high, rightmost: copy }
        };
        let lower = ReflexChain { high: middle, ..chain };
        (self.extend_high(lower, corner), self.extend_low(upper, corner))
    }

    /// One chain of two that meet in their last corner.
    pub fn join(&mut self, lower: ReflexChain, upper: ReflexChain) -> ReflexChain {
        let (meeting, next) = (lower.high, self[upper.low].high);
        self[meeting].high = next;
        self[next].low = meeting;
        ReflexChain { low: lower.low, high: upper.high, rightmost: meeting }
    }

    #[inline(always)]
    fn cut(&mut self, low: u32, corner: u32, high: u32) {
        let triangle = [self[low].corner, corner, self[high].corner];
        self.triangles.push(triangle);
    }

    #[inline(always)]
    fn link(&mut self, (corner, point): SweepCorner, low: u32, high: u32) -> u32 {
        self.links.push(ChainLink { point, corner, low, high });
        (self.links.len() - 1) as u32
    }
}

impl std::ops::Index<u32> for ReflexChains {
    type Output = ChainLink;

    #[inline(always)]
    fn index(&self, link: u32) -> &ChainLink {
        &self.links[link as usize]
    }
}

impl std::ops::IndexMut<u32> for ReflexChains {
    #[inline(always)]
    fn index_mut(&mut self, link: u32) -> &mut ChainLink {
        &mut self.links[link as usize]
    }
}
