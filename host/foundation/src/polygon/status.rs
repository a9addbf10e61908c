//! The edges that the sweep line meets, from low to high.
//!
//! A list linked both ways, with an index over it for searching: sorted blocks of at most [`BLOCK`] slots.

use glam::DVec2;

use super::chain::ReflexChain;
use crate::numeric::predicates::turn;

/// Most slots in a block.
const BLOCK: usize = 64;

/// The slot below the lowest and above the highest edge; it bears no edge.
pub(super) const OUTSIDE: u32 = 0;

/// An edge under the sweep line, and the interval above it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    /// A point of the line of the edge, met first.
    pub left: DVec2,
    /// The end of the edge, met last.
    pub right: DVec2,
    /// The edge: the rank of the corner where it begins.
    pub edge: u32,
    /// The slot below.
    pub below: u32,
    /// The slot above.
    pub above: u32,
    block: u32,
    /// The left boundary of the interval above, if that is inside of the polygon.
    pub chain: Option<ReflexChain>,
}

impl Slot {
    pub fn new(left: DVec2, right: DVec2, edge: u32, chain: Option<ReflexChain>) -> Slot {
        Slot { left, right, edge, below: OUTSIDE, above: OUTSIDE, block: 0, chain }
    }

    /// Bears another edge at the same place.
    pub fn take(&mut self, other: Slot) {
        (self.left, self.right, self.edge, self.chain) = (other.left, other.right, other.edge, other.chain);
    }

    /// Positive if `point` lies above the edge, zero on it.
    #[inline(always)]
    pub fn side(&self, point: DVec2) -> f64 {
        turn(self.left, self.right, point)
    }
}

#[derive(Clone, Copy)]
struct Block {
    len: usize,
    slots: [u32; BLOCK],
}

const EMPTY: Block = Block { len: 0, slots: [OUTSIDE; BLOCK] };

/// The edges under the sweep line.
pub(super) struct Status {
    slots: Vec<Slot>,
    free: Vec<u32>,
    blocks: Vec<Block>,
    free_blocks: Vec<u32>,
    /// The blocks in use, from low to high.
    order: Vec<u32>,
}

impl std::ops::Index<u32> for Status {
    type Output = Slot;

    #[inline(always)]
    fn index(&self, slot: u32) -> &Slot {
        &self.slots[slot as usize]
    }
}

impl std::ops::IndexMut<u32> for Status {
    #[inline(always)]
    fn index_mut(&mut self, slot: u32) -> &mut Slot {
        &mut self.slots[slot as usize]
    }
}

impl Status {
    pub fn new() -> Status {
        let outside = Slot::new(DVec2::ZERO, DVec2::ZERO, 0, None);
        Status {
            slots: vec![outside],
            free: Vec::new(),
            blocks: Vec::new(),
            free_blocks: Vec::new(),
            order: Vec::new(),
        }
    }

    /// The highest edge that lies below `point`.
    pub fn below(&self, point: DVec2) -> u32 {
        let is_below = |&slot: &u32| self[slot].side(point) > 0.0;
        let blocks = self.order.partition_point(|&block| is_below(&self.blocks[block as usize].slots[0]));
        let Some(last) = blocks.checked_sub(1) else { return OUTSIDE };
        let block = &self.blocks[self.order[last] as usize];
        let slots = 1 + block.slots[1..block.len].partition_point(is_below);
        block.slots[slots - 1]
    }

    /// Adds an edge above the slot `below`.
    pub fn insert(&mut self, below: u32, slot: Slot) -> u32 {
        let (mut block, mut position) = self.position_above(below);
        if self.blocks[block as usize].len == BLOCK {
            let upper = self.split(block);
            if position > BLOCK / 2 {
                (block, position) = (upper, position - BLOCK / 2);
            }
        }
        let above = self[below].above;
        let slot = Slot { below, above, block, ..slot };
        let index = match self.free.pop() {
            Some(index) => {
                self[index] = slot;
                index
            }
            None => {
                self.slots.push(slot);
                (self.slots.len() - 1) as u32
            }
        };
        self[below].above = index;
        self[above].below = index;
        let block = &mut self.blocks[block as usize];
        block.slots.copy_within(position..block.len, position + 1);
        block.slots[position] = index;
        block.len += 1;
        index
    }

    /// Takes an edge out.
    pub fn remove(&mut self, slot: u32) {
        let Slot { below, above, block: index, .. } = self[slot];
        self[below].above = above;
        self[above].below = below;
        let block = &mut self.blocks[index as usize];
        let position = block.position(slot);
        block.slots.copy_within(position + 1..block.len, position);
        block.len -= 1;
        if block.len == 0 {
            self.order.remove(index_of(&self.order, index));
            self.free_blocks.push(index);
        }
        self.free.push(slot);
    }

    /// The block and the place in it for an edge above `below`.
    fn position_above(&mut self, below: u32) -> (u32, usize) {
        if below != OUTSIDE {
            let block = self[below].block;
            return (block, self.blocks[block as usize].position(below) + 1);
        }
        if self.order.is_empty() {
            let block = self.new_block();
            self.order.push(block);
        }
        (self.order[0], 0)
    }

    /// Moves the upper half of a full block to a new one above it.
    fn split(&mut self, index: u32) -> u32 {
        let upper = self.new_block();
        self.order.insert(index_of(&self.order, index) + 1, upper);
        let mut block = EMPTY;
        let full = &mut self.blocks[index as usize];
        block.slots[..BLOCK / 2].copy_from_slice(&full.slots[BLOCK / 2..]);
        (full.len, block.len) = (BLOCK / 2, BLOCK / 2);
        for &slot in &block.slots[..BLOCK / 2] {
            self[slot].block = upper;
        }
        self.blocks[upper as usize] = block;
        upper
    }

    fn new_block(&mut self) -> u32 {
        self.free_blocks.pop().unwrap_or_else(|| {
            self.blocks.push(EMPTY);
            (self.blocks.len() - 1) as u32
        })
    }
}

impl Block {
    fn position(&self, slot: u32) -> usize {
        index_of(&self.slots[..self.len], slot)
    }
}

/// Where a list holds `value`. Every slot is listed in its block and every block in the order.
fn index_of(list: &[u32], value: u32) -> usize {
    list.iter().position(|&other| other == value).unwrap_or(list.len())
}
