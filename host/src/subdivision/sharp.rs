//! One step of a polyhedron with creases, sharp vertices or borders.

use std::collections::HashMap;

use glam::DVec3;

use super::error::SubdivisionError;
use super::polyhedron::{NONE, Polyhedron};
use super::rings::by_face;
use super::weights::{Held, held, step};

/// What a polyhedron looks like to one step of the sharp rules.
pub(super) struct Creases<'a> {
    pub mesh: &'a Polyhedron,
    /// For each corner the one before it in its face.
    pub last: Vec<u32>,
    /// The corners between two neighbouring creases (or borders) at a vertex, counter-clockwise, one sector after the
    /// other; where a vertex has no crease, all corners around it.
    sectors: Vec<Sector>,
    ring: Vec<u32>,
    /// For each vertex how much it is held: 1 where the surface has a corner.
    pub vertex_hold: Vec<f64>,
}

struct Sector {
    begin: usize,
    end: usize,
    /// Whether it goes all around a vertex without a crease.
    is_closed: bool,
}

impl<'a> Creases<'a> {
    pub fn of(mesh: &'a Polyhedron) -> Creases<'a> {
        let vertex_hold = (0..mesh.points.len())
            .map(|vertex| mesh.vertex_sharpness.get(vertex).map_or(0.0, |sharpness| sharpness.min(1.0)))
            .collect();
        let mut creases = Creases { mesh, last: mesh.last(), sectors: Vec::new(), ring: Vec::new(), vertex_hold };
        creases.find_sectors();
        creases.hold_corners();
        creases
    }

    /// Whether a side is a crease in this step, or a border.
    pub fn is_crease(&self, side: u32) -> bool {
        self.mesh.sharpness(side) >= 1.0
    }

    fn find_sectors(&mut self) {
        let count = self.mesh.corners.len() as u32;
        let mut seen = vec![false; count as usize];
        // First those that begin at a crease, then the rings.
        for is_closed in [false, true] {
            for first in 0..count {
                if seen[first as usize] || !is_closed && !self.is_crease(first) {
                    continue;
                }
                let begin = self.ring.len();
                let mut corner = first;
                loop {
                    self.ring.push(corner);
                    seen[corner as usize] = true;
                    let side = self.last[corner as usize];
                    if !is_closed && self.is_crease(side) {
                        break;
                    }
                    corner = self.mesh.twins[side as usize];
                    if corner == first {
                        break;
                    }
                }
                self.sectors.push(Sector { begin, end: self.ring.len(), is_closed });
            }
        }
    }

    /// Where three creases meet, and where one face fills the angle of two, the surface has a corner.
    fn hold_corners(&mut self) {
        let mut meeting = vec![0_u8; self.mesh.points.len()];
        for side in 0..self.mesh.corners.len() as u32 {
            // An edge of two faces is seen from both, at either end once.
            let ends = [side, self.mesh.next[side as usize]].map(|h| self.mesh.corners[h as usize] as usize);
            let seen = if self.mesh.twins[side as usize] == NONE { 2 } else { 1 };
            if self.is_crease(side) {
                ends[..seen].iter().for_each(|&end| meeting[end] = meeting[end].saturating_add(1));
            }
        }
        let counted = self.vertex_hold.iter_mut().zip(&meeting);
        counted.filter(|(_, count)| **count > 2).for_each(|(hold, _)| *hold = 1.0);
        for sector in self.sectors.iter().filter(|sector| !sector.is_closed && sector.end - sector.begin == 1) {
            let vertex = self.mesh.corners[self.ring[sector.begin] as usize];
            self.vertex_hold[vertex as usize] = 1.0;
        }
    }

    /// How a corner of a face is held.
    pub fn held(&self, corner: u32) -> Held {
        let next = self.mesh.next[corner as usize];
        let last = self.last[corner as usize];
        let before_last = self.last[last as usize];
        // Along a side, its end at `corner` is held by `other`, the other side of the face there. Along a crease only
        // the vertex holds, so that the faces at both sides agree.
        let hold = |side: u32, corner: u32, other: u32| {
            let vertex = self.vertex_hold[self.mesh.corners[corner as usize] as usize];
            if self.is_crease(side) { vertex } else { vertex.max(self.mesh.sharpness(other).min(1.0)) }
        };
        Held {
            here_forward: hold(corner, corner, last),
            there_forward: hold(corner, next, next),
            here_backward: hold(last, corner, corner),
            there_backward: hold(last, last, before_last),
        }
    }

    /// The new positions of all corners, from positions that may differ between the corners of a vertex.
    pub fn moved(&self, position: &(impl Fn(u32) -> DVec3 + Sync)) -> Vec<DVec3> {
        by_face(self.mesh, &|face, new: &mut [DVec3]| {
            let first = self.mesh.starts[face];
            let sides = first..first + new.len() as u32;
            let corners: Vec<DVec3> = sides.clone().map(position).collect();
            step(&corners, new);
            for (k, side) in sides.enumerate() {
                new[k] = held(&corners, k, self.held(side), new[k]);
            }
        })
    }

    /// Joins the corners that coincide after this step: across creases, and around held vertices.
    pub fn join(&self, joined: &mut Joined) {
        for side in 0..self.mesh.corners.len() as u32 {
            let twin = self.mesh.twins[side as usize];
            if twin != NONE && self.is_crease(side) {
                joined.join(side, self.mesh.next[twin as usize]);
            }
        }
        for sector in &self.sectors {
            let corners = &self.ring[sector.begin..sector.end];
            if self.vertex_hold[self.mesh.corners[corners[0] as usize] as usize] == 1.0 {
                corners.windows(2).for_each(|pair| joined.join(pair[0], pair[1]));
            }
        }
    }

    /// The faces of the next step as runs of old corners: one within each face, one for each edge, one for each vertex.
    pub fn each_face(&self, mut with: impl FnMut(&[u32])) {
        let sides: Vec<u32> = (0..self.mesh.corners.len() as u32).collect();
        for face in self.mesh.starts.windows(2) {
            with(&sides[face[0] as usize..face[1] as usize]);
        }
        for &side in &sides {
            let twin = self.mesh.twins[side as usize];
            if twin != NONE && side < twin && !self.is_crease(side) {
                let [after_side, after_twin] = [side, twin].map(|h| self.mesh.next[h as usize]);
                with(&[after_side, side, after_twin, twin]);
            }
        }
        for sector in &self.sectors {
            with(&self.ring[sector.begin..sector.end]);
        }
    }

    /// The creases of the next step: their ends as old corners, and what is left of their sharpness.
    fn heirs(&self) -> Vec<([u32; 2], f64)> {
        let mut heirs = Vec::new();
        for side in 0..self.mesh.corners.len() as u32 {
            if self.mesh.twins[side as usize] != NONE && self.is_crease(side) {
                heirs.push(([side, self.mesh.next[side as usize]], self.mesh.sharpness(side) - 1.0));
            }
        }
        for sector in self.sectors.iter().filter(|sector| !sector.is_closed) {
            let (first, end) = (self.ring[sector.begin], self.ring[sector.end - 1]);
            let left = self.mesh.sharpness(first).min(self.mesh.sharpness(self.last[end as usize])) - 1.0;
            heirs.push(([first, end], left));
        }
        heirs
    }
}

/// Cuts corners and grinds edges, except where they are sharp.
///
/// # Errors
/// Corners meet that should not: only where faces of the polyhedron touch each other twice.
pub(super) fn refined(mesh: &Polyhedron) -> Result<Polyhedron, SubdivisionError> {
    let creases = Creases::of(mesh);
    let mut joined = Joined::new(mesh.corners.len());
    creases.join(&mut joined);
    let (names, count) = joined.names();
    let mut points = vec![DVec3::ZERO; count];
    // The lowest of joined corners gives the position.
    let moved = creases.moved(&|corner| mesh.points[mesh.corners[corner as usize] as usize]);
    for (corner, position) in moved.into_iter().enumerate().rev() {
        points[names[corner] as usize] = position;
    }
    let mut corners = Vec::with_capacity(4 * mesh.corners.len());
    let mut starts = vec![0];
    creases.each_face(|face| push_face(face, &names, &mut corners, &mut starts));
    let mut refined = Polyhedron::linked(points, corners, starts)?;
    inherit(&creases, &names, &mut refined);
    Ok(refined)
}

/// Adds a face of joined corners, unless fewer than three are left.
fn push_face(face: &[u32], names: &[u32], corners: &mut Vec<u32>, starts: &mut Vec<u32>) {
    let begin = corners.len();
    for &corner in face {
        let name = names[corner as usize];
        if corners.len() == begin || corners[corners.len() - 1] != name {
            corners.push(name);
        }
    }
    while corners.len() > begin + 1 && corners[begin] == corners[corners.len() - 1] {
        corners.pop();
    }
    if corners.len() < begin + 3 {
        corners.truncate(begin);
    } else {
        starts.push(corners.len() as u32);
    }
}

/// Hands what is left of the sharpness on.
fn inherit(creases: &Creases<'_>, names: &[u32], refined: &mut Polyhedron) {
    let mesh = creases.mesh;
    if mesh.vertex_sharpness.iter().any(|&sharpness| sharpness > 1.0) {
        refined.vertex_sharpness = vec![0.0; refined.points.len()];
        for (corner, &vertex) in mesh.corners.iter().enumerate() {
            let left = (mesh.vertex_sharpness[vertex as usize] - 1.0).max(0.0);
            refined.vertex_sharpness[names[corner] as usize] = left;
        }
    }
    let mut sharp: HashMap<[u32; 2], f64> = HashMap::new();
    for (ends, left) in creases.heirs() {
        let [a, b] = ends.map(|corner| names[corner as usize]);
        if left > 0.0 && a != b {
            sharp.insert([a.min(b), a.max(b)], left);
        }
    }
    if sharp.is_empty() {
        return;
    }
    let mut is_end = vec![false; refined.points.len()];
    sharp.keys().flatten().for_each(|&vertex| is_end[vertex as usize] = true);
    let sharpness = |h: usize| {
        let [a, b] = [refined.corners[h], refined.corners[refined.next[h] as usize]];
        if !(is_end[a as usize] && is_end[b as usize]) {
            return 0.0;
        }
        sharp.get(&[a.min(b), a.max(b)]).copied().unwrap_or(0.0)
    };
    refined.edge_sharpness = (0..refined.corners.len()).map(sharpness).collect();
}

/// Sets of corners that become one vertex.
pub(super) struct Joined {
    lower: Vec<u32>,
}

impl Joined {
    pub fn new(count: usize) -> Joined {
        Joined { lower: (0..count as u32).collect() }
    }

    /// The lowest corner of a set.
    pub fn lowest(&mut self, mut corner: u32) -> u32 {
        while self.lower[corner as usize] != corner {
            let lower = self.lower[corner as usize];
            self.lower[corner as usize] = self.lower[lower as usize];
            corner = lower;
        }
        corner
    }

    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.lowest(a), self.lowest(b));
        self.lower[a.max(b) as usize] = a.min(b);
    }

    /// For each corner the number of its set, and how many sets there are.
    pub fn names(mut self) -> (Vec<u32>, usize) {
        let mut count = 0;
        let mut names = vec![0; self.lower.len()];
        for corner in 0..names.len() as u32 {
            let lowest = self.lowest(corner);
            names[corner as usize] = if lowest == corner { count } else { names[lowest as usize] };
            count += u32::from(lowest == corner);
        }
        (names, count as usize)
    }
}
