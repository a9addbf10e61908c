//! Rays through the octree: down the index, or from cell to cell.

use super::build::eighths;
use super::clip::FAT;
use super::code::{LocationalCode, MAX_DEPTH};
use super::frame::Frame;
use super::index::WIDTH;
use super::packet::{LANES, Packet};
use super::{Hit, Location, Octree, Ray, Walk, WalkCount};
use crate::numeric::triangle::Shear;

/// Entries of the stack that need no allocation.
const STACK: usize = 40;

/// Voxels along the cube.
const VOXELS: i64 = 1 << MAX_DEPTH;

/// One ray on its way: what it has met so far.
struct Search<'a> {
    octree: &'a Octree,
    shear: Shear,
    frame: Frame,
    t_min: f64,
    t_max: f64,
    any: bool,
    best: Option<Hit>,
    limit: f32,
    count: WalkCount,
}

/// Finds the nearest hit, or for `any` some hit, with `t_min < t < t_max`.
pub fn search(octree: &Octree, ray: &Ray, t_min: f64, t_max: f64, any: bool) -> (Option<Hit>, WalkCount) {
    let nothing = (None, WalkCount::default());
    if octree.leaves.codes.is_empty() {
        return nothing;
    }
    let Some(shear) = Shear::new(ray, octree.cube.side.recip()) else { return nothing };
    let Some(frame) = Frame::new(ray, &shear, &octree.cube, t_min, t_max) else { return nothing };
    let limit = frame.limit_of(frame.length);
    let mut search = Search { octree, shear, frame, t_min, t_max, any, best: None, limit, count: WalkCount::default() };
    match octree.walk {
        Walk::Index => search.descend(),
        // A ray from so far away that its points are less certain than a cell is fat may be in the cell beside the one
        // that it is taken for.
        Walk::LeadingDirection if 4.0 * search.frame.double_tolerance <= FAT => search.step_from_cell_to_cell(),
        Walk::LeadingDirection => search.look_from_above(),
    }
    (search.best, search.count)
}

impl Search<'_> {
    /// Tests some packets; returns whether the search is over.
    #[inline]
    fn any_packet(&mut self, start: u32, count: u32) -> bool {
        let packets = &self.octree.index.packets[start as usize..(start + count) as usize];
        packets.iter().any(|packet| self.test(packet))
    }

    /// Tests the triangles of a terminal node; returns whether the search is over.
    fn any_of_leaf(&mut self, leaf: usize) -> bool {
        let triangles = self.octree.leaves.of(leaf);
        self.count.triangles += triangles.len() as u64;
        triangles.iter().any(|&triangle| self.decide(triangle) && self.any)
    }

    /// Tests a packet; returns whether the search is over.
    #[inline]
    fn test(&mut self, packet: &Packet) -> bool {
        self.count.triangles += LANES as u64;
        let mut lanes = packet.candidates(&self.frame, self.limit);
        while lanes != 0 {
            let triangle = packet.triangles[lanes.trailing_zeros() as usize];
            lanes &= lanes - 1;
            if self.decide(triangle) && self.any {
                return true;
            }
        }
        false
    }

    /// Decides in double precision whether a triangle is hit nearer than any before.
    #[inline]
    fn decide(&mut self, triangle: u32) -> bool {
        let octree = self.octree;
        let corners = octree.triangles[triangle as usize].map(|i| octree.vertices[i as usize]);
        let Some(crossing) = self.shear.crossing(corners) else { return false };
        let t = crossing.t;
        let nearer = match self.best {
            Some(best) => t < best.t || (t == best.t && triangle < best.triangle),
            None => t < self.t_max,
        };
        if !(nearer && t > self.t_min) {
            return false;
        }
        self.best = Some(Hit { t, triangle, u: crossing.u, v: crossing.v });
        self.limit = self.frame.limit(t);
        true
    }

    /// Goes down the index, nearest child first.
    fn descend(&mut self) {
        let octree = self.octree;
        let mut stack = Stack::new();
        let (mut start, mut packets) = (0_u32, 0_u32);
        loop {
            self.count.cells += 1;
            if packets == 0 {
                let node = &octree.index.nodes[start as usize];
                let (mut lanes, near) = node.meets(&self.frame, self.limit);
                if lanes != 0 {
                    let mut nearest = lanes.trailing_zeros() as usize;
                    lanes &= lanes - 1;
                    let mark = stack.top;
                    while lanes != 0 {
                        let lane = lanes.trailing_zeros() as usize;
                        lanes &= lanes - 1;
                        let farther =
                            if near[lane] < near[nearest] { std::mem::replace(&mut nearest, lane) } else { lane };
                        let entry =
                            Entry { start: node.start[farther], packets: node.packets[farther], near: near[farther] };
                        stack.insert(mark, entry);
                    }
                    (start, packets) = (node.start[nearest], node.packets[nearest]);
                    continue;
                }
            } else if self.any_packet(start, packets) {
                return;
            }
            loop {
                let Some(entry) = stack.pop() else { return };
                if entry.near <= self.limit {
                    (start, packets) = (entry.start, entry.packets);
                    break;
                }
            }
        }
    }
}

/// What is still to be visited.
#[derive(Clone, Copy, Default)]
struct Entry {
    start: u32,
    packets: u32,
    near: f32,
}

/// A stack that allocates only where trees are uncommonly deep.
struct Stack {
    fixed: [Entry; STACK],
    top: usize,
    spill: Vec<Entry>,
}

impl Stack {
    #[inline]
    fn new() -> Self {
        Self { fixed: [Entry::default(); STACK], top: 0, spill: Vec::new() }
    }

    /// Inserts above `mark` so that the nearest comes on top.
    #[inline]
    fn insert(&mut self, mark: usize, entry: Entry) {
        if self.top >= STACK - WIDTH || !self.spill.is_empty() {
            self.spill.push(entry);
            return;
        }
        let mut at = self.top;
        while at > mark && self.fixed[at - 1].near < entry.near {
            self.fixed[at] = self.fixed[at - 1];
            at -= 1;
        }
        self.fixed[at] = entry;
        self.top += 1;
    }

    #[inline]
    fn pop(&mut self) -> Option<Entry> {
        if let Some(entry) = self.spill.pop() {
            return Some(entry);
        }
        self.top = self.top.checked_sub(1)?;
        Some(self.fixed[self.top])
    }
}

impl Search<'_> {
    /// Steps from cell to cell as the paper does: locate by binary search, leave through the side across the leading
    /// direction; only if the exit point lies outside that side try the second direction, then the third.
    ///
    /// Positions are computed from the entry point, never from the last cell, so no error builds up. Each step
    /// changes the voxel along the axis that it crosses and moves the others at most forward: it ends.
    fn step_from_cell_to_cell(&mut self) {
        let octree = self.octree;
        let frame = self.frame.clone();
        let voxels = VOXELS as f64;
        let entry = frame.entry.map(|x| x * voxels);
        let forward = frame.down.map(|down| 1 - 2 * down as i64);
        let leading = frame.axes[2];
        let others = [frame.axes[0], frame.axes[1]];
        let mut voxel = entry.map(|x| (x.floor() as i64).clamp(0, VOXELS - 1));
        loop {
            self.count.cells += 1;
            let code = LocationalCode::containing(voxel.map(|x| x as u32), MAX_DEPTH);
            let (cell, leaf) = match octree.locate_leaf(code) {
                Ok(leaf) => (octree.leaves.codes[leaf], Some(leaf)),
                Err(Location::Empty { code, .. }) => (code, None),
                Err(_) => return,
            };
            if leaf.is_some_and(|leaf| self.any_of_leaf(leaf)) {
                return;
            }
            let low = cell.corner().map(i64::from);
            let side = i64::from(cell.side());
            // The plane through which each axis would leave the cell.
            let plane = [0, 1, 2].map(|axis| low[axis] + if forward[axis] > 0 { side } else { 0 });
            let at = |axis: usize, s: f64| entry[axis] + frame.slopes[axis] * s;
            let inside = |axis: usize, x: f64| x >= low[axis] as f64 && x <= (low[axis] + side) as f64;

            // Along the leading axis the slope is 1 or -1: no multiplication gives the length, two the exit point.
            let mut crossed = leading;
            let mut s = (plane[leading] as f64 - entry[leading]).abs();
            let mut point = [0.0; 3];
            for axis in others {
                point[axis] = at(axis, s);
            }
            if let Some(second) = others.into_iter().find(|&axis| !inside(axis, point[axis])) {
                crossed = second;
                s = (plane[second] as f64 - entry[second]) * self.inverse(second);
                let third = if second == others[0] { others[1] } else { others[0] };
                point[third] = at(third, s);
                if !inside(third, point[third]) {
                    crossed = third;
                    s = (plane[third] as f64 - entry[third]) * self.inverse(third);
                    point[second] = at(second, s);
                }
                point[leading] = at(leading, s);
            }
            if s / voxels > f64::from(self.limit) {
                return;
            }
            for axis in 0..3 {
                let (first, last) = (low[axis], low[axis] + side - 1);
                voxel[axis] = if axis != crossed {
                    let (from, to) = if forward[axis] > 0 { (voxel[axis], last) } else { (first, voxel[axis]) };
                    (point[axis].floor() as i64).clamp(from, to)
                } else if forward[axis] > 0 {
                    last + 1
                } else {
                    first - 1
                };
            }
            if !(0..VOXELS).contains(&voxel[crossed]) {
                return;
            }
        }
    }

    /// Opens all cubes that the ray may meet, from the modelling cube down.
    fn look_from_above(&mut self) {
        let leaves = &self.octree.leaves;
        let mut cubes = vec![(LocationalCode::ROOT, 0..leaves.codes.len())];
        while let Some((cube, nodes)) = cubes.pop() {
            if nodes.is_empty() || !self.frame.may_meet(cube) {
                continue;
            }
            self.count.cells += 1;
            if leaves.codes[nodes.start] != cube {
                cubes.extend(eighths(cube).map(|eighth| (eighth, leaves.within(eighth, nodes.clone()))));
            } else if self.any_of_leaf(nodes.start) {
                return;
            }
        }
    }

    /// One over the slope of an axis that the ray crosses.
    fn inverse(&self, axis: usize) -> f64 {
        self.frame.slopes[axis].recip()
    }
}
