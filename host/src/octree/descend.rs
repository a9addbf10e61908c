//! Rays down the index, nearest child first.

use super::index::{Child, Slabs};
use super::lanes::{LANES, Lanes, Plain};
use super::packet::{Packet, Sight};
use super::walk::Search;

/// Entries of the stack that need no allocation.
const STACK: usize = 64;

/// What is still to be visited: where the ray enters it, as bits, above what it is. So the nearer is the lesser, since no
/// length is negative.
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

impl Search<'_> {
    /// Goes down the index with the widest instructions of the processor.
    #[inline]
    pub(super) fn go_down(&mut self) {
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx2,fma")]
            fn descend_wide(search: &mut Search<'_>) {
                search.descend::<super::lanes::Wide>();
            }
            if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
                // SAFETY: the processor has AVX2 and FMA, all that this function asks for.
                unsafe { descend_wide(self) };
                return;
            }
        }
        self.descend::<Plain>();
    }

    #[inline(always)]
    fn descend<L: Lanes>(&mut self) {
        let index = &self.octree.index;
        let (slabs, sight) = (Slabs::<L>::new(&self.frame), Sight::<L>::new(&self.frame));
        let mut stack = Stack::new();
        let mut child = Child(0);
        loop {
            self.count.cells += 1;
            match child.place() {
                Err(place) => {
                    let node = &index.nodes[place];
                    let (mut lanes, near) = node.meets(&slabs, self.limit);
                    if lanes != 0 {
                        let near = near.store().0;
                        let mark = stack.top;
                        let mut nearest = Entry(u64::MAX);
                        loop {
                            let lane = lanes.trailing_zeros() as usize & (LANES - 1);
                            let entry = Entry::new(near[lane], node.children[lane]);
                            if nearest != Entry(u64::MAX) {
                                stack.insert(mark, nearest.max(entry));
                            }
                            nearest = nearest.min(entry);
                            lanes &= lanes - 1;
                            if lanes == 0 {
                                break;
                            }
                        }
                        child = nearest.child();
                        continue;
                    }
                }
                Ok(place) => {
                    if self.test(&index.packets[place], &sight) {
                        return;
                    }
                }
            }
            loop {
                let Some(entry) = stack.pop() else { return };
                if entry.near() <= self.limit {
                    child = entry.child();
                    break;
                }
            }
        }
    }

    /// Tests a packet; returns whether the search is over.
    #[inline(always)]
    fn test<L: Lanes>(&mut self, packet: &Packet, sight: &Sight<L>) -> bool {
        self.count.triangles += LANES as u64;
        let mut lanes = packet.candidates(sight, self.limit);
        while lanes != 0 {
            let triangle = packet.triangles[lanes.trailing_zeros() as usize & (LANES - 1)];
            lanes &= lanes - 1;
            if self.decide(triangle) && self.any {
                return true;
            }
        }
        false
    }
}
