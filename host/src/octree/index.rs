//! The index: wide nodes over the sorted terminal nodes, for rays that start at the top.

use rayon::join;
use wide::f32x4;

use super::build::Leaves;
use super::clip::Bounds;
use super::code::LocationalCode;
use super::frame::Frame;

/// Children of a node.
pub const WIDTH: usize = 4;

/// More leaves than this are split between threads.
const PARALLEL_LEAVES: usize = 4096;

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

/// A node of the binary tree that the bits of the codes make; `right` is 0 for a leaf.
#[derive(Clone, Copy)]
struct Fork {
    bounds: Bounds,
    right: usize,
    leaf: usize,
}

/// Derives the nodes from terminal nodes; the first is the top. None for none.
///
/// - `packet_starts`: where the packets of each leaf begin, and at last where they end.
pub fn nodes(leaves: &Leaves, packet_starts: &[u32]) -> Vec<Node> {
    let count = leaves.codes.len();
    if count == 0 {
        return Vec::new();
    }
    let blank = Fork { bounds: Bounds::EMPTY, right: 0, leaf: 0 };
    let mut forks = vec![blank; 2 * count - 1];
    grow(leaves, 0, count, 0, &mut forks);
    let mut nodes = Vec::with_capacity(count / 2 + 1);
    gather(&forks, packet_starts, 0, &mut nodes);
    nodes
}

/// Fills the tree over leaves `from..to`: the fork, all of its left part, all of its right part.
///
/// Splits where the first bit changes that not all codes share: across the middle of a cell.
fn grow(leaves: &Leaves, from: usize, to: usize, place: usize, forks: &mut [Fork]) {
    let [fork, parts @ ..] = forks else { return };
    if to - from == 1 {
        *fork = Fork { bounds: leaves.bounds[from], right: 0, leaf: from };
        return;
    }
    let middle = split(&leaves.codes[from..to]) + from;
    let left_size = 2 * (middle - from) - 1;
    let right = place + 1 + left_size;
    let (left_part, right_part) = parts.split_at_mut(left_size);
    let mut grow_left = || {
        grow(leaves, from, middle, place + 1, left_part);
        left_part[0].bounds
    };
    let mut grow_right = || {
        grow(leaves, middle, to, right, right_part);
        right_part[0].bounds
    };
    let (a, b) = if to - from > PARALLEL_LEAVES { join(grow_left, grow_right) } else { (grow_left(), grow_right()) };
    *fork = Fork { bounds: a.union(&b), right, leaf: 0 };
}

fn split(codes: &[LocationalCode]) -> usize {
    let (first, last) = (codes[0].bits(), codes[codes.len() - 1].bits());
    let mask = 1 << (63 - (first ^ last).leading_zeros().min(63));
    codes.partition_point(|code| code.bits() & mask == first & mask).clamp(1, codes.len() - 1)
}

/// Gathers a fork and what lies below it into nodes, opening the largest child until the node is full.
fn gather(forks: &[Fork], packet_starts: &[u32], top: usize, nodes: &mut Vec<Node>) -> u32 {
    let mut children = vec![top];
    while children.len() < WIDTH {
        let inner = children.iter().enumerate().filter(|(_, fork)| forks[**fork].right != 0);
        let largest = inner.max_by(|a, b| {
            let area = |fork: usize| forks[fork].bounds.half_area();
            area(*a.1).total_cmp(&area(*b.1)).then(b.0.cmp(&a.0))
        });
        let Some((slot, &fork)) = largest else { break };
        children[slot] = fork + 1;
        children.push(forks[fork].right);
    }
    let place = nodes.len();
    let mut bounds = [[[0.0; WIDTH]; 2]; 3];
    for lane in 0..WIDTH {
        let of = children.get(lane).map_or(Bounds::EMPTY, |&fork| forks[fork].bounds);
        for axis in 0..3 {
            bounds[axis][0][lane] = of.low[axis];
            bounds[axis][1][lane] = of.high[axis];
        }
    }
    let bounds = bounds.map(|axis| axis.map(f32x4::new));
    nodes.push(Node { bounds, start: [0; WIDTH], packets: [0; WIDTH] });
    for (lane, fork) in children.into_iter().enumerate() {
        if forks[fork].right == 0 {
            let leaf = forks[fork].leaf;
            nodes[place].start[lane] = packet_starts[leaf];
            nodes[place].packets[lane] = packet_starts[leaf + 1] - packet_starts[leaf];
        } else {
            nodes[place].start[lane] = gather(forks, packet_starts, fork, nodes);
        }
    }
    place as u32
}
