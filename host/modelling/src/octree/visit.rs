//! The way of a ray down an index, nearest child first.

use super::lanes::{LANES, Lanes};
use super::prepared_ray::SinglePrecisionRay;
use super::wide_bvh::{BvhNode, Child};
use std::ops::Range;

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

/// Who looks at the leaves of an index along a ray.
pub trait LeafVisitor {
    /// No length beyond this counts any more.
    fn limit(&self) -> f32;
    /// Counts a node or a leaf.
    fn count(&mut self);
    /// Hears of places that are likely to be looked at soon.
    #[inline(always)]
    fn expect(&self, _: Range<usize>) {}
    /// Looks at the things in some places; returns whether the search is over.
    fn visit(&mut self, places: Range<usize>) -> bool;
}

/// Visits the leaves along a ray, the nearer ones first, until the search is over; says whether it is.
///
/// - `nodes`: of the index, the top first; there may be none.
#[inline(always)]
pub fn visit_leaves<L: Lanes>(
    proof: L::Proof,
    nodes: &[BvhNode],
    ray: &SinglePrecisionRay,
    visitor: &mut impl LeafVisitor,
) -> bool {
    if nodes.is_empty() {
        return false;
    }
    let mut stack = Stack::new();
    let mut child = Child(0);
    loop {
        visitor.count();
        match child.place() {
            Err(place) => {
                let node = &nodes[place];
                let (mut lanes, near) = node.meets::<L>(proof, ray, visitor.limit());
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
                    if let Ok(places) = node.children[first].place() {
                        visitor.expect(places);
                    }
                    while lanes != 0 {
                        let lane = lanes.trailing_zeros() as usize & (LANES - 1);
                        lanes &= lanes - 1;
                        let entry = Entry::new(near[lane], node.children[lane]);
                        if let Ok(places) = node.children[lane].place() {
                            visitor.expect(places);
                        }
                        stack.insert(mark, nearest.max(entry));
                        nearest = nearest.min(entry);
                    }
                    child = nearest.child();
                    continue;
                }
            }
            Ok(places) => {
                if visitor.visit(places) {
                    return true;
                }
            }
        }
        loop {
            let Some(entry) = stack.pop() else { return false };
            if entry.near() <= visitor.limit() {
                child = entry.child();
                break;
            }
        }
    }
}
