//! Rays through the octree: down the index, or from cell to cell.

use super::build::octants;
use super::clip::FAT;
use super::code::{LocationalCode, MAX_DEPTH};
use super::prepared_ray::PreparedRay;
use super::{Hit, Location, Octree, WalkCount};
use glam::DVec3;

/// Voxels along the cube.
const VOXELS: i64 = 1 << MAX_DEPTH;

/// One ray as it is traced: what it has hit so far.
pub struct Search<'a> {
    pub(super) octree: &'a Octree,
    /// Apart, so that what changes can stay in the registers of the processor.
    pub(super) ray: &'a PreparedRay,
    pub(super) t_min: f64,
    pub(super) t_max: f64,
    /// Whether any hit will do.
    any: bool,
    best: Option<Hit>,
    /// No length beyond this counts any more.
    pub(super) limit: f32,
    pub(super) count: WalkCount,
}

impl<'a> Search<'a> {
    /// Prepares a search for a hit with `t_min < t < t_max`, for which the line was made.
    #[inline(always)]
    pub fn new(octree: &'a Octree, line: &'a PreparedRay, t_min: f64, t_max: f64, any: bool) -> Self {
        let limit = line.single.limit_of(line.chord.length());
        Self { octree, ray: line, t_min, t_max, any, best: None, limit, count: WalkCount::default() }
    }

    /// The hit that was found.
    #[inline(always)]
    pub fn found(&self) -> (Option<Hit>, WalkCount) {
        (self.best, self.count)
    }

    /// Visits the cells along the ray.
    pub fn walk(&mut self) {
        if self.octree.triangles.is_empty() {
            return;
        }
        // A ray from so far away that its points are less certain than a cell is fat may be in the cell beside the one
        // that it is taken for.
        if 4.0 * self.ray.chord.double_tolerance() <= FAT {
            self.step_from_cell_to_cell(|search, leaf, _| search.any_of_leaf(leaf));
        } else {
            self.look_from_above();
        }
    }

    /// Visits the cells along the ray, in terminal nodes as it is told.
    ///
    /// - `visit`: the terminal node, and from where to where the ray is in it, sides of the modelling cube along the
    ///   longest axis; returns whether the search is over.
    pub(super) fn walk_with(&mut self, visit: impl FnMut(&mut Self, usize, [f64; 2]) -> bool) {
        if 4.0 * self.ray.chord.double_tolerance() <= FAT { self.step_from_cell_to_cell(visit) } else { self.walk() }
    }
}

impl Search<'_> {
    /// Tests the triangles of a terminal node; returns whether the search is over.
    pub(super) fn any_of_leaf(&mut self, leaf: usize) -> bool {
        let triangles = self.octree.leaves().of(leaf);
        self.count.triangles += triangles.len() as u64;
        triangles.iter().any(|&triangle| self.decide(triangle, self.octree.corners(triangle)) && self.any)
    }

    /// The hit of a triangle with given corners, decided in double precision.
    #[inline(always)]
    pub(super) fn intersection(&self, triangle: u32, corners: [DVec3; 3]) -> Option<Hit> {
        let crossing = self.ray.shear.intersection(corners)?;
        let is_within = crossing.t > self.t_min && crossing.t < self.t_max;
        is_within.then_some(Hit { t: crossing.t, triangle, u: crossing.u, v: crossing.v })
    }

    /// Decides in double precision whether a triangle with given corners is hit nearer than any before.
    #[inline(always)]
    pub(super) fn decide(&mut self, triangle: u32, corners: [DVec3; 3]) -> bool {
        self.intersection(triangle, corners).is_some_and(|hit| self.offer(hit))
    }

    /// Takes a hit if it is nearer than any before; returns whether it is.
    #[inline(always)]
    pub(super) fn offer(&mut self, hit: Hit) -> bool {
        let t = hit.t;
        let nearer = match self.best {
            Some(best) => t < best.t || (t == best.t && hit.triangle < best.triangle),
            None => t < self.t_max,
        };
        if !(nearer && t > self.t_min) {
            return false;
        }
        self.best = Some(hit);
        self.limit = self.ray.single.limit(t);
        true
    }
}

impl Search<'_> {
    /// Steps from cell to cell as the paper does: locate by binary search, leave through the side across the leading
    /// direction; only if the exit point lies outside that side try the second direction, then the third.
    ///
    /// Positions are computed from the entry point, never from the last cell, so no error builds up. Each step
    /// changes the voxel along the axis that it crosses and moves the others at most forward: it ends.
    fn step_from_cell_to_cell(&mut self, mut visit: impl FnMut(&mut Self, usize, [f64; 2]) -> bool) {
        let octree = self.octree;
        let leaves = octree.leaves();
        let slopes = self.ray.shear.slopes().to_array();
        let voxels = VOXELS as f64;
        let [x, y, z, _] = self.ray.chord.entry(&self.ray.shear).to_array();
        let entry = [x, y, z].map(|x| x * voxels);
        let forward = self.ray.single.down.map(|down| 1 - 2 * i64::from(down));
        let [second, third, leading] = self.ray.shear.axes();
        let others = [second, third];
        let mut voxel = entry.map(|x| (x.floor() as i64).clamp(0, VOXELS - 1));
        let mut enter = 0.0;
        loop {
            self.count.cells += 1;
            let code = LocationalCode::containing(voxel.map(|x| x as u32), MAX_DEPTH);
            let (cell, leaf) = match octree.locate_leaf(code) {
                Ok(leaf) => (leaves.codes[leaf], Some(leaf)),
                Err(Location::Empty { code, .. }) => (code, None),
                Err(_) => return,
            };
            let low = cell.corner().map(i64::from);
            let side = i64::from(cell.side());
            // The plane through which each axis would leave the cell.
            let plane = [0, 1, 2].map(|axis| low[axis] + if forward[axis] > 0 { side } else { 0 });
            let at = |axis: usize, s: f64| entry[axis] + slopes[axis] * s;
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
                s = (plane[second] as f64 - entry[second]) * slopes[second].recip();
                let third = if second == others[0] { others[1] } else { others[0] };
                point[third] = at(third, s);
                if !inside(third, point[third]) {
                    crossed = third;
                    s = (plane[third] as f64 - entry[third]) * slopes[third].recip();
                    point[second] = at(second, s);
                }
                point[leading] = at(leading, s);
            }
            let exit = s / voxels;
            if leaf.is_some_and(|leaf| visit(self, leaf, [enter, exit])) || exit > f64::from(self.limit) {
                return;
            }
            enter = exit;
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

    /// Opens all cubes that the ray may hit, from the modelling cube down.
    fn look_from_above(&mut self) {
        let leaves = self.octree.leaves();
        let mut cubes = vec![(LocationalCode::ROOT, 0..leaves.codes.len())];
        while let Some((cube, nodes)) = cubes.pop() {
            if nodes.is_empty() || !self.ray.chord.may_meet(&self.ray.shear, cube) {
                continue;
            }
            self.count.cells += 1;
            if leaves.codes[nodes.start] != cube {
                cubes.extend(octants(cube).map(|octant| (octant, leaves.within(octant, nodes.clone()))));
            } else if self.any_of_leaf(nodes.start) {
                return;
            }
        }
    }
}
