//! The part of the polygon that the sweep has passed but not yet covered with triangles.

use glam::DVec2;

use crate::numeric::predicates::turn;

/// No link.
const NONE: u32 = u32::MAX;

/// The left boundary of an interval inside of the polygon: corners from the left end of its lower edge to that of its
/// upper edge. On both sides of its rightmost corner it turns away from the interval, so that each new corner sees
/// every corner that it cuts off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chain {
    /// The link at the lower edge.
    low: u32,
    /// The link at the upper edge.
    high: u32,
    /// The link that was added last.
    rightmost: u32,
}

/// A corner of a chain.
#[derive(Clone, Copy)]
pub(super) struct Link {
    point: DVec2,
    corner: u32,
    low: u32,
    high: u32,
}

/// All chains, and the triangles that were cut off them.
pub(super) struct Chains {
    links: Vec<Link>,
    pub triangles: Vec<[u32; 3]>,
}

/// A corner that the sweep has come to: its index and its position.
pub(super) type Corner = (u32, DVec2);

impl Chains {
    /// Without chains, with room for the triangles of a polygon of so many corners.
    pub fn with_capacity(corners: usize) -> Chains {
        Chains { links: Vec::with_capacity(corners + corners / 2), triangles: Vec::with_capacity(corners) }
    }

    /// A chain of one corner.
    pub fn start(&mut self, corner: Corner) -> Chain {
        let link = self.link(corner, NONE, NONE);
        Chain { low: link, high: link, rightmost: link }
    }

    /// A corner at the right end of the lower edge.
    #[inline]
    pub fn extend_low(&mut self, chain: Chain, corner: Corner) -> Chain {
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
        Chain { low: link, high: chain.high, rightmost: link }
    }

    /// A corner at the right end of the upper edge.
    #[inline]
    pub fn extend_high(&mut self, chain: Chain, corner: Corner) -> Chain {
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
        Chain { low: chain.low, high: link, rightmost: link }
    }

    /// A corner where both edges end: the chain is used up.
    pub fn close(&mut self, chain: Chain, corner: Corner) {
        let mut end = chain.low;
        while end != chain.high {
            let next = self[end].high;
            self.cut(end, corner.0, next);
            end = next;
        }
    }

    /// A corner between the edges: a lower and an upper chain, which end at it.
    pub fn split(&mut self, chain: Chain, corner: Corner) -> (Chain, Chain) {
        let middle = chain.rightmost;
        let Link { point, corner: name, high, .. } = self[middle];
        let upper = if middle == chain.high {
            self.start((name, point))
        } else {
            let copy = self.link((name, point), NONE, high);
            self[high].low = copy;
            Chain { low: copy, high: chain.high, rightmost: copy }
        };
        let lower = Chain { high: middle, ..chain };
        (self.extend_high(lower, corner), self.extend_low(upper, corner))
    }

    /// One chain of two that meet in their last corner.
    pub fn join(&mut self, lower: Chain, upper: Chain) -> Chain {
        let (meeting, next) = (lower.high, self[upper.low].high);
        self[meeting].high = next;
        self[next].low = meeting;
        Chain { low: lower.low, high: upper.high, rightmost: meeting }
    }

    #[inline(always)]
    fn cut(&mut self, low: u32, corner: u32, high: u32) {
        let triangle = [self[low].corner, corner, self[high].corner];
        self.triangles.push(triangle);
    }

    #[inline(always)]
    fn link(&mut self, (corner, point): Corner, low: u32, high: u32) -> u32 {
        self.links.push(Link { point, corner, low, high });
        (self.links.len() - 1) as u32
    }
}

impl std::ops::Index<u32> for Chains {
    type Output = Link;

    #[inline(always)]
    fn index(&self, link: u32) -> &Link {
        &self.links[link as usize]
    }
}

impl std::ops::IndexMut<u32> for Chains {
    #[inline(always)]
    fn index_mut(&mut self, link: u32) -> &mut Link {
        &mut self.links[link as usize]
    }
}
