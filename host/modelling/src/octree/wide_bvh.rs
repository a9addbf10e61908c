//! The index: a wide BVH over the triangles in the order of their codes, for rays that start at the top.

use std::ops::Range;

use glam::DVec3;
use rayon::current_num_threads;
use rayon::prelude::*;
use wide::f32x4;

use super::build::OctreeBuilder;
use super::items::{self, Item};
use super::lanes::{Eight, LANES, Lanes};
use super::packet::Packet;
use super::partition::{ItemGroup, shares};
use super::prepared_ray::SinglePrecisionRay;
use crate::memory::prefer_large_pages;
use crate::numeric::bounds::Bounds;

/// So many cells or fewer are divided by their items.
const FEW_CELLS: usize = 64;

/// Items of so many triangles or fewer are not divided.
const LEAF: usize = 12;

/// Set where a child is a leaf.
const IS_LEAF: u32 = 1 << 31;

/// Behind that, the number of things less one; then the place.
const PLACE_BITS: u32 = 28;

/// A child of a box: a node, or a leaf of a few successive things, by its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Child(pub u32);

impl Child {
    /// A leaf: one to eight things in successive places below 2^28.
    pub fn leaf(places: Range<usize>) -> Self {
        Self(IS_LEAF | (places.len() as u32 - 1) << PLACE_BITS | places.start as u32)
    }

    /// The places of a leaf, or else that of a node.
    #[inline(always)]
    pub fn place(self) -> Result<Range<usize>, usize> {
        if self.0 & IS_LEAF == 0 {
            return Err(self.0 as usize);
        }
        let first = (self.0 & ((1 << PLACE_BITS) - 1)) as usize;
        Ok(first..first + ((self.0 & !IS_LEAF) >> PLACE_BITS) as usize + 1)
    }

    /// This reference when so many nodes and things come before; what is the top, or nothing, stays.
    pub fn moved(self, nodes: usize, things: usize) -> Self {
        match self.0 {
            0 => self,
            bits if bits & IS_LEAF != 0 => Self(bits + things as u32),
            bits => Self(bits + nodes as u32),
        }
    }
}

/// Up to eight boxes, each of a node or of a leaf.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct BvhNode {
    /// By axis, then low and high.
    bounds: [[Eight; 2]; 3],
    /// The child in each box.
    pub children: [Child; LANES],
}

impl BvhNode {
    /// No box.
    pub const EMPTY: Self = Self {
        bounds: [[Eight([f32::INFINITY; LANES]), Eight([f32::NEG_INFINITY; LANES])]; 3],
        children: [Child(0); LANES],
    };

    /// Puts a box in a lane.
    pub fn set(&mut self, lane: usize, around: &Item, child: Child) {
        let (low, high) = (around.low.to_array(), around.high.to_array());
        for axis in 0..3 {
            self.bounds[axis][0].0[lane] = low[axis];
            self.bounds[axis][1].0[lane] = high[axis];
        }
        self.children[lane] = child;
    }

    /// The boxes, in local coordinates, and the child in each.
    pub fn boxes(&self) -> impl Iterator<Item = (Bounds, Child)> {
        let corner = |side: usize, lane: usize| {
            DVec3::from_array([0, 1, 2].map(|axis| f64::from(self.bounds[axis][side].0[lane])))
        };
        (0..LANES)
            .map(move |lane| (Bounds { min: corner(0, lane), max: corner(1, lane) }, self.children[lane]))
            .filter(|(bounds, _)| !bounds.is_empty())
    }

    /// The children that the ray may hit up to a limit, one bit each, and where it enters them.
    #[inline(always)]
    pub fn meets<L: Lanes>(&self, proof: L::Proof, frame: &SinglePrecisionRay, limit: f32) -> (u32, L) {
        let [x, y, z] = &self.bounds;
        let near_z = near::<L>(proof, z, 2, frame).most(L::splat(proof, 0.0));
        let enter = near::<L>(proof, x, 0, frame).most(near(proof, y, 1, frame)).most(near_z);
        let far_z = far::<L>(proof, z, 2, frame).least(L::splat(proof, limit));
        let exit = far::<L>(proof, x, 0, frame).least(far(proof, y, 1, frame)).least(far_z);
        (enter.is_at_most(exit), enter)
    }
}

/// Lengths to the near sides of boxes.
#[inline(always)]
fn near<L: Lanes>(proof: L::Proof, sides: &[Eight; 2], axis: usize, frame: &SinglePrecisionRay) -> L {
    let side = L::load(proof, &sides[usize::from(frame.down[axis])]);
    side.times_plus(L::splat(proof, frame.inverse[axis]), L::splat(proof, frame.near[axis]))
}

/// Lengths to the far sides of boxes.
#[inline(always)]
fn far<L: Lanes>(proof: L::Proof, sides: &[Eight; 2], axis: usize, frame: &SinglePrecisionRay) -> L {
    let side = L::load(proof, &sides[usize::from(!frame.down[axis])]);
    side.times_plus(L::splat(proof, frame.inverse[axis]), L::splat(proof, frame.far[axis]))
}

/// The index over items: nodes and packets.
#[derive(Clone, Debug, Default)]
pub struct WideBvh {
    /// The first is the top. None for no items.
    pub nodes: Vec<BvhNode>,
    /// Triangles in the order of the leaves of the tree.
    pub packets: Vec<Packet>,
}

impl WideBvh {
    /// Builds it; the result does not depend on the number of threads.
    pub fn new(division: &OctreeBuilder<'_>) -> Self {
        let local = items::local(division);
        let (items, mut cells) = items::items(division, &local);
        let mut index = Self::default();
        if items.is_empty() {
            return index;
        }
        let builder =
            Builder { vertices: division.vertices, triangles: division.triangles, local: &local, items: &items };
        let mut groups = Vec::new();
        let part = ItemGroup::of(&cells);
        divide_cells(&mut cells, &part, LEAF, &mut index.nodes, &mut groups);
        let build = |cells: &[Item], index: &mut Self| builder.of_group(cells, index);
        if current_num_threads() == 1 {
            index.reserve(items.len() / 24, items.len() / 4);
            for CellGroup { cells, place } in groups {
                let child = build(cells, &mut index);
                index.attach(child, place);
            }
        } else {
            let made: Vec<Self> = groups
                .par_iter()
                .map(|CellGroup { cells, .. }| {
                    let mut made = Self::default();
                    build(cells, &mut made);
                    made
                })
                .collect();
            let sum = |of: fn(&Self) -> usize| made.iter().map(of).sum();
            index.reserve(sum(|made| made.nodes.len()), sum(|made| made.packets.len()));
            for (made, CellGroup { place, .. }) in made.iter().zip(groups) {
                let child = index.append(made);
                index.attach(child, place);
            }
        }
        index
    }

    /// Puts a child in its place.
    fn attach(&mut self, child: Child, place: Option<NodeLane>) {
        if let Some(place) = place {
            place.attach(&mut self.nodes, child);
        }
    }

    /// Gets memory for so many more.
    fn reserve(&mut self, nodes: usize, packets: usize) {
        self.nodes.reserve(nodes);
        self.packets.reserve(packets);
        prefer_large_pages(self.nodes.spare_capacity_mut());
        prefer_large_pages(self.packets.spare_capacity_mut());
    }

    /// Adds what another one holds; returns its top.
    fn append(&mut self, other: &Self) -> Child {
        let (nodes, packets) = (self.nodes.len(), self.packets.len());
        self.packets.extend_from_slice(&other.packets);
        self.nodes.extend(other.nodes.iter().cloned().map(|mut node| {
            node.children = node.children.map(|child| child.moved(nodes, packets));
            node
        }));
        Child(nodes as u32)
    }
}

/// A few cells that wait for their nodes.
pub struct CellGroup<'a> {
    /// The cells.
    pub cells: &'a mut [Item],
    /// What they are below; nothing if they are all there are.
    pub place: Option<NodeLane>,
}

/// A lane of a node.
#[derive(Clone, Copy)]
pub struct NodeLane {
    node: usize,
    lane: usize,
}

impl NodeLane {
    /// Puts a child there.
    pub fn attach(self, nodes: &mut [BvhNode], child: Child) {
        nodes[self.node].children[self.lane] = child;
    }
}

/// Adds the nodes above many cells, and collects groups of few.
///
/// - `leaf`: how many of the things in cells are a leaf.
pub fn divide_cells<'a>(
    cells: &'a mut [Item],
    all: &ItemGroup,
    leaf: usize,
    nodes: &mut Vec<BvhNode>,
    groups: &mut Vec<CellGroup<'a>>,
) {
    if all.items <= FEW_CELLS {
        groups.push(CellGroup { cells, place: None });
        return;
    }
    let node = nodes.len();
    nodes.push(BvhNode::EMPTY);
    for (lane, (share, part)) in shares(cells, all, leaf).into_iter().enumerate() {
        if part.items <= FEW_CELLS {
            nodes[node].set(lane, &part.around, Child(0));
            groups.push(CellGroup { cells: share, place: Some(NodeLane { node, lane }) });
        } else {
            let child = Child(nodes.len() as u32);
            nodes[node].set(lane, &part.around, child);
            divide_cells(share, &part, leaf, nodes, groups);
        }
    }
}

/// Builder of the nodes, with the items of which they are made.
struct Builder<'a> {
    vertices: &'a [DVec3],
    triangles: &'a [[u32; 3]],
    local: &'a [f32x4],
    items: &'a [Item],
}

impl Builder<'_> {
    /// Adds the nodes of the items of some cells.
    fn of_group(&self, cells: &[Item], index: &mut WideBvh) -> Child {
        let mut items = Vec::with_capacity(cells.iter().map(Item::weight).sum());
        for cell in cells {
            let first = cell.number() as usize;
            items.extend_from_slice(&self.items[first..first + cell.weight()]);
        }
        let part = ItemGroup::of(&items);
        self.node(&mut items, &part, index)
    }

    fn node(&self, items: &mut [Item], part: &ItemGroup, index: &mut WideBvh) -> Child {
        let node = index.nodes.len();
        index.nodes.push(BvhNode::EMPTY);
        for (lane, (share, part)) in shares(items, part, LEAF).into_iter().enumerate() {
            let child = if part.items > LEAF { self.node(share, &part, index) } else { self.packets(share, index) };
            index.nodes[node].set(lane, &part.around, child);
        }
        Child(node as u32)
    }

    fn packets(&self, items: &[Item], index: &mut WideBvh) -> Child {
        let place = |vertex: u32| {
            let [x, y, z, _] = self.local[vertex as usize].to_array();
            [x, y, z]
        };
        let packet = |items: &[Item]| Packet::new(items.iter().map(Item::number), self.vertices, self.triangles, place);
        let first = index.packets.len();
        index.packets.extend(items.chunks(LANES).map(packet));
        Child::leaf(first..index.packets.len())
    }
}
