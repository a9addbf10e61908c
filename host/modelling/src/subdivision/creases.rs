//! The creases, borders and corners of a polyhedron as one step of the sharp rules meets them.

use glam::DVec3;

use super::polyhedron::{NONE, Polyhedron};
use super::rings::by_face;
use super::weights::{Pinning, held, pinning, step};

/// What a polyhedron looks like to one step of the sharp rules.
pub(super) struct Creases<'a> {
    pub mesh: &'a Polyhedron,
    /// For each corner the one before it in its face.
    last: Vec<u32>,
    /// The corners between two neighbouring creases (or borders) at a vertex, counter-clockwise, one sector after the
    /// other; where a vertex has no crease, all corners around it.
    sectors: Vec<Sector>,
    ring: Vec<u32>,
    /// For each vertex how much it is pinned: 1 where the surface has a corner.
    pub vertex_pinning: Vec<f64>,
    /// The corners of faces that alone fill the angle of a crease: the face is cut there along the crease.
    pub cut: Vec<bool>,
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
            .map(|vertex| mesh.vertex_sharpness.get(vertex).map_or(0.0, |sharpness| pinning(*sharpness)))
            .collect();
        let mut creases = Creases {
            mesh,
            last: mesh.last(),
            sectors: Vec::new(),
            ring: Vec::new(),
            vertex_pinning: vertex_hold,
            cut: Vec::new(),
        };
        creases.find_sectors();
        creases.pin_corners();
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

    /// Where three creases meet, and where a border has one face only, the surface has a corner. Where one face fills
    /// the angle of a crease, it is cut, unless the other side has one face, too.
    fn pin_corners(&mut self) {
        // How much the three sharpest edges at each vertex pin, the third first.
        let mut sharpest = vec![[0.0_f64; 3]; self.mesh.points.len()];
        for side in 0..self.mesh.corners.len() as u32 {
            let hold = pinning(self.mesh.sharpness(side));
            // An edge of two faces is seen from both, at either end once.
            let ends = [side, self.mesh.next[side as usize]].map(|h| self.mesh.corners[h as usize] as usize);
            let seen = if self.mesh.twins[side as usize] == NONE { 2 } else { 1 };
            for &end in &ends[..seen] {
                sharpest[end][0] = hold.max(sharpest[end][0]);
                sharpest[end].sort_unstable_by(f64::total_cmp);
            }
        }
        for (hold, sharpest) in self.vertex_pinning.iter_mut().zip(&sharpest) {
            *hold = hold.max(sharpest[0]);
        }
        self.cut = vec![false; self.mesh.corners.len()];
        for sector in self.sectors.iter().filter(|sector| !sector.is_closed && sector.end - sector.begin == 1) {
            let corner = self.ring[sector.begin];
            let hold = &mut self.vertex_pinning[self.mesh.corners[corner as usize] as usize];
            let [before, behind] = [self.last[corner as usize], corner].map(|side| self.mesh.twins[side as usize]);
            if before == NONE || behind == NONE || self.mesh.next[behind as usize] == before {
                *hold = 1.0;
            } else {
                self.cut[corner as usize] = true;
            }
        }
        for (cut, &vertex) in self.cut.iter_mut().zip(&self.mesh.corners) {
            *cut &= self.vertex_pinning[vertex as usize] < 1.0;
        }
    }

    /// The pinning of a corner of a face.
    fn pinning_of(&self, corner: u32) -> Pinning {
        let next = self.mesh.next[corner as usize];
        let last = self.last[corner as usize];
        let before_last = self.last[last as usize];
        let hold = |corner: u32| self.vertex_pinning[self.mesh.corners[corner as usize] as usize];
        let sides = [before_last, last, corner, next].map(|side| self.mesh.sharpness(side));
        Pinning::by(sides, [last, corner, next].map(hold))
    }

    /// The new positions of all corners.
    pub fn moved(&self) -> Vec<DVec3> {
        by_face(self.mesh, &|face, new: &mut [DVec3]| {
            let first = self.mesh.starts[face];
            let sides = first..first + new.len() as u32;
            let corners: Vec<DVec3> = self.mesh.face_points(face).collect();
            step(&corners, new);
            for (k, side) in sides.enumerate() {
                new[k] = held(&corners, k, self.pinning_of(side), new[k]);
            }
        })
    }

    /// Joins the corners that coincide after this step: across creases, and around pinned vertices.
    pub fn join(&self, joined: &mut CornerSets) {
        for side in 0..self.mesh.corners.len() as u32 {
            let twin = self.mesh.twins[side as usize];
            if twin != NONE && self.is_crease(side) {
                let other = self.mesh.next[twin as usize];
                if !self.cut[side as usize] && !self.cut[other as usize] {
                    joined.join(side, other);
                }
            }
        }
        for sector in &self.sectors {
            let corners = &self.ring[sector.begin..sector.end];
            if self.vertex_pinning[self.mesh.corners[corners[0] as usize] as usize] == 1.0 {
                corners.windows(2).for_each(|pair| joined.join(pair[0], pair[1]));
            }
        }
    }

    /// The faces of the next step as runs of old corners: one within each face, one for each edge, one for each vertex.
    /// With them the old corners to whose faces they belong: others only where a face is cut.
    pub fn each_face(&self, mut with: impl FnMut(&[u32], &[u32])) {
        self.each_inner_face(&mut with);
        self.sectors().for_each(|(run, _)| with(run, run));
    }

    /// The corners of each face for a vertex, counter-clockwise, and whether they go all around it.
    pub fn sectors(&self) -> impl Iterator<Item = (&[u32], bool)> {
        self.sectors.iter().map(|sector| (&self.ring[sector.begin..sector.end], sector.is_closed))
    }

    /// The faces of the next step but for those of vertices.
    pub fn each_inner_face(&self, mut with: impl FnMut(&[u32], &[u32])) {
        let sides: Vec<u32> = (0..self.mesh.corners.len() as u32).collect();
        let (mut run, mut owners) = (Vec::new(), Vec::new());
        for face in self.mesh.starts.windows(2) {
            run.clear();
            owners.clear();
            for &corner in &sides[face[0] as usize..face[1] as usize] {
                self.push_corner(corner, &mut run);
                owners.resize(run.len(), corner);
            }
            with(&run, &owners);
        }
        for &side in &sides {
            let twin = self.mesh.twins[side as usize];
            if twin != NONE && side < twin && !self.is_crease(side) {
                let [after_side, after_twin] = [side, twin].map(|h| self.mesh.next[h as usize]);
                let corners = [after_side, side, after_twin, twin];
                with(&corners, &corners);
            }
        }
    }

    /// The corners that become the ends of a crease; where its own are cut, those beyond.
    pub fn ends(&self, side: u32) -> [u32; 2] {
        let (next, twin) = (self.mesh.next[side as usize], self.mesh.twins[side as usize]);
        let beyond = |corner: u32, other: u32| if self.cut[corner as usize] { other } else { corner };
        match twin {
            NONE => [side, next],
            _ => [beyond(side, self.mesh.next[twin as usize]), beyond(next, twin)],
        }
    }

    /// A corner as a run of corners; where it is cut, those of the faces beyond the crease stand for it.
    fn push_corner(&self, corner: u32, run: &mut Vec<u32>) {
        if self.cut[corner as usize] {
            let [before, behind] = [self.last[corner as usize], corner].map(|side| self.mesh.twins[side as usize]);
            run.extend([before, self.mesh.next[behind as usize]]);
        } else {
            run.push(corner);
        }
    }

    /// The child creases: their ends as old corners, and their sharpness.
    pub fn child_creases(&self) -> Vec<([u32; 2], f64)> {
        let mut heirs = Vec::new();
        for side in 0..self.mesh.corners.len() as u32 {
            if self.mesh.twins[side as usize] != NONE && self.is_crease(side) {
                heirs.push((self.ends(side), self.mesh.sharpness(side)));
            }
        }
        for sector in self.sectors.iter().filter(|sector| !sector.is_closed) {
            let (first, end) = (self.ring[sector.begin], self.ring[sector.end - 1]);
            let sharpness = self.mesh.sharpness(first).min(self.mesh.sharpness(self.last[end as usize]));
            heirs.push(([first, end], sharpness));
        }
        heirs
    }
}

/// Sets of corners that become one vertex.
pub(super) struct CornerSets {
    lower: Vec<u32>,
}

impl CornerSets {
    pub fn new(count: usize) -> CornerSets {
        CornerSets { lower: (0..count as u32).collect() }
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

    /// For each corner the number of its set, and how many sets there are. Corners that are `left_out`, which stand
    /// alone, have none.
    pub fn names(mut self, left_out: &[bool]) -> (Vec<u32>, usize) {
        let mut count = 0;
        let mut names = vec![NONE; self.lower.len()];
        for corner in (0..names.len() as u32).filter(|&corner| !left_out[corner as usize]) {
            let lowest = self.lowest(corner);
            names[corner as usize] = if lowest == corner { count } else { names[lowest as usize] };
            count += u32::from(lowest == corner);
        }
        (names, count as usize)
    }
}
