//! The index: wide nodes over the sorted terminal nodes, for rays that start at the top.

use glam::DVec3;
use rayon::join;
use wide::f32x4;

use super::clip::Bounds;
use super::frame::Frame;
use super::items::Item;
use super::packet::{LANES, Packet};
use super::partition::divide;

/// Children of a node.
pub const WIDTH: usize = 4;

/// More items than this are split between threads.
const PARALLEL_ITEMS: usize = 4096;

/// What single-precision division of lengths may lose, relative.
const LENGTH_ERROR: f32 = 1.0 + 4.0 * f32::EPSILON;

/// Up to four boxes, each of a node or of the packets of a terminal node.
#[derive(Clone, Debug)]
pub struct Node {
    /// By axis, then low and high.
    bounds: [[f32x4; 2]; 3],
    /// Where each child begins, among the nodes or among the packets.
    pub start: [u32; WIDTH],
    /// Number of packets; 0 for a node.
    pub packets: [u32; WIDTH],
}

impl Node {
    fn new(boxes: [Bounds; WIDTH]) -> Self {
        let lanes = |number: &dyn Fn(&Bounds) -> f32| f32x4::new(std::array::from_fn(|lane| number(&boxes[lane])));
        let bounds = std::array::from_fn(|axis| [lanes(&|b| b.low[axis]), lanes(&|b| b.high[axis])]);
        Self { bounds, start: [0; WIDTH], packets: [0; WIDTH] }
    }

    /// The children that the ray may meet up to a limit, one bit each, and where it enters them.
    #[inline]
    pub fn meets(&self, frame: &Frame, limit: f32) -> (u32, [f32; WIDTH]) {
        let side = |axis: usize, side: usize, origin: &[f32x4; 3]| {
            (self.bounds[axis][side] - origin[axis]) * frame.inverse[axis]
        };
        let [x, y, z] = frame.down;
        let near = side(0, x, &frame.near_origin)
            .fast_max(side(1, y, &frame.near_origin))
            .fast_max(side(2, z, &frame.near_origin).fast_max(f32x4::splat(frame.start)));
        let far = side(0, 1 - x, &frame.far_origin).fast_min(side(1, 1 - y, &frame.far_origin)).fast_min(side(
            2,
            1 - z,
            &frame.far_origin,
        ));
        let far = (far * f32x4::splat(LENGTH_ERROR)).fast_min(f32x4::splat(limit));
        (near.simd_le(far).to_bitmask(), near.to_array())
    }
}

/// Part of the binary tree that the nodes are gathered from.
struct Branch {
    bounds: Bounds,
    /// Number of items.
    items: usize,
    /// The two parts; none where the items fit into one packet.
    parts: Option<Box<[Branch; 2]>>,
}

/// The index over items: nodes and packets.
#[derive(Clone, Debug, Default)]
pub struct Index {
    /// The first is the top. None for no items.
    pub nodes: Vec<Node>,
    /// Triangles in the order of the leaves of the tree.
    pub packets: Vec<Packet>,
}

impl Index {
    /// Builds it; `corners` gives the local coordinates of a triangle.
    pub fn new(mut items: Vec<Item>, corners: impl Fn(u32) -> [DVec3; 3]) -> Self {
        let mut index = Self::default();
        if items.is_empty() {
            return index;
        }
        let tree = grow(&mut items);
        index.gather(&tree, &items, &corners);
        index
    }

    /// Gathers a branch into nodes, opening the largest part until the node is full; returns the first node.
    fn gather(&mut self, branch: &Branch, items: &[Item], corners: &impl Fn(u32) -> [DVec3; 3]) -> u32 {
        // Each part with the place of its first item.
        let mut parts = vec![(branch, 0)];
        while parts.len() < WIDTH {
            let open = parts.iter().enumerate().filter(|(_, (part, _))| part.parts.is_some());
            let Some((slot, _)) = open.max_by(|(i, (a, _)), (j, (b, _))| {
                a.bounds.half_area().total_cmp(&b.bounds.half_area()).then(j.cmp(i))
            }) else {
                break;
            };
            let (part, first) = parts[slot];
            if let Some([left, right]) = part.parts.as_deref() {
                parts[slot] = (left, first);
                parts.insert(slot + 1, (right, first + left.items));
            }
        }
        let place = self.nodes.len();
        let bounds = std::array::from_fn(|lane| parts.get(lane).map_or(Bounds::EMPTY, |(part, _)| part.bounds));
        self.nodes.push(Node::new(bounds));
        for (lane, (part, first)) in parts.into_iter().enumerate() {
            let items = &items[first..first + part.items];
            let (start, packets) = match part.parts {
                Some(_) => (self.gather(part, items, corners), 0),
                None => self.pack(items, corners),
            };
            self.nodes[place].start[lane] = start;
            self.nodes[place].packets[lane] = packets;
        }
        place as u32
    }

    /// Packs items; returns the first packet and how many there are.
    fn pack(&mut self, items: &[Item], corners: &impl Fn(u32) -> [DVec3; 3]) -> (u32, u32) {
        let start = self.packets.len() as u32;
        for chunk in items.chunks(LANES) {
            self.packets.push(Packet::new(chunk.iter().map(|item| item.triangle), corners));
        }
        (start, self.packets.len() as u32 - start)
    }
}

/// Sorts items into a tree.
fn grow(items: &mut [Item]) -> Branch {
    let count = items.len();
    let bounds = items.iter().fold(Bounds::EMPTY, |all, item| all.union(&item.bounds));
    if count <= LANES {
        return Branch { bounds, items: count, parts: None };
    }
    let middle = divide(items);
    let (left, right) = items.split_at_mut(middle);
    let (left, right) =
        if count > PARALLEL_ITEMS { join(|| grow(left), || grow(right)) } else { (grow(left), grow(right)) };
    Branch { bounds, items: count, parts: Some(Box::new([left, right])) }
}
