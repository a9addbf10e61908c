//! Triangles and edges cut to what a view shows, and projected to the vector screen.
//!
//! Each point that a boundary cuts out of an edge is made once, however many triangles and edges meet there, so cut
//! neighbours stay neighbours.
//!
//! # Model
//! The *depth key* grows towards the eye and changes evenly along straight lines on the screen: 1/w in perspective, and
//! without, minus the depth. It does not use front and back boundary: those of a client may be 1e-15 and 1e15.

use super::{
    Facets,
    facets::{BlockView, Edge},
};
use glam::{DVec2, DVec3, DVec4};
use std::collections::HashMap;

/// The nearest that is shown, of the largest w.
const NEAREST: f64 = 1e-9;
/// Boundaries that can cut: near, left, right, bottom, top, front, back.
const BOUNDARIES: usize = 7;
/// The bits of those of them before an object: near and front.
const OPENING: u8 = 0b10_0001;

/// A point on the vector screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenPoint {
    /// x and y; the screen is -1..=1.
    pub position: DVec2,
    /// The depth key.
    pub depth_key: f64,
}

/// A triangle piece, on the screen.
#[derive(Clone, Copy, Debug)]
pub struct TrianglePiece {
    /// Its corners.
    pub spots: [u32; 3],
    /// The triangle of which it is a piece.
    pub triangle: u32,
}

/// What is left of a projected edge.
#[derive(Clone, Copy, Debug)]
pub struct ProjectedEdge {
    /// Its ends.
    pub spots: [u32; 2],
    /// Both ends in the coordinates of the rendering node, homogeneous, and their w in clip space.
    pub ends: [(DVec4, f64); 2],
    /// The number of the edge.
    pub edge: usize,
}

/// What a view shows of facets.
#[derive(Clone, Debug, Default)]
pub struct Projected {
    /// Points; the first are those of the facets, as far as they are shown.
    pub points: Vec<ScreenPoint>,
    /// Triangles.
    pub pieces: Vec<TrianglePiece>,
    /// Edges.
    pub lines: Vec<ProjectedEdge>,
    /// Whether something was cut off that is near, so that a solid may show its inside.
    pub opened: bool,
}

/// A point that can be cut.
#[derive(Clone, Copy)]
struct Raw {
    clip: DVec4,
    eye: DVec3,
    local: DVec4,
    view: u32,
}

struct Cutter {
    raw: Vec<Raw>,
    cuts: HashMap<(usize, [u32; 2]), u32>,
    near: f64,
}

/// Cuts and projects.
///
/// - `edges`: of which something may be drawn.
pub fn project(facets: &Facets, edges: &[Edge]) -> Projected {
    let raw: Vec<Raw> =
        facets.points.iter().map(|p| Raw { clip: p.clip, eye: p.eye, local: p.local, view: p.view }).collect();
    let near = raw.iter().map(|p| p.clip.w).fold(0.0, f64::max) * NEAREST;
    let mut cutter = Cutter { raw, cuts: HashMap::new(), near };
    let mut projected = Projected::default();
    let mut polygon = Vec::new();
    for (triangle, facet) in (0..).zip(&facets.triangles) {
        let view = &facets.views[facets.faces[facet.face as usize].view as usize];
        polygon.clear();
        polygon.extend(facet.corners.map(|corner| facets.corners[corner as usize].point));
        projected.opened |= cutter.cut_polygon(&mut polygon, view);
        for k in 2..polygon.len() {
            projected.pieces.push(TrianglePiece { spots: [polygon[0], polygon[k - 1], polygon[k]], triangle });
        }
    }
    for (edge, facet) in edges.iter().enumerate() {
        let view = facet.faces[0].map_or(0, |face| facets.faces[face as usize].view);
        if let Some(spots) = cutter.cut_line(facet.ends, &facets.views[view as usize]) {
            let ends = spots.map(|spot| {
                let raw = &cutter.raw[spot as usize];
                (raw.local, raw.clip.w)
            });
            projected.lines.push(ProjectedEdge { spots, ends, edge });
        }
    }
    projected.points = cutter.raw.iter().map(|raw| screen_point(raw, &facets.views[raw.view as usize])).collect();
    projected
}

impl Cutter {
    /// Positive inside of a boundary.
    fn inside(&self, boundary: usize, point: u32) -> f64 {
        let p = self.raw[point as usize].clip;
        match boundary {
            0 => p.w - self.near,
            1 => p.w + p.x,
            2 => p.w - p.x,
            3 => p.w + p.y,
            4 => p.w - p.y,
            5 => p.z,
            _ => p.w - p.z,
        }
    }

    /// A bit for each boundary that a point is outside of.
    fn outside(&self, point: u32, view: &BlockView) -> u8 {
        let p = self.raw[point as usize].clip;
        // The near one counts w = 0 as outside, also where everything is at the eye.
        let mut bits = u8::from(p.w <= 0.0 || p.w < self.near);
        bits |= u8::from(p.x < -p.w) << 1 | u8::from(p.x > p.w) << 2;
        bits |= u8::from(p.y < -p.w) << 3 | u8::from(p.y > p.w) << 4;
        if view.depth_clipping {
            bits |= u8::from(p.z < 0.0) << 5 | u8::from(p.z > p.w) << 6;
        }
        bits
    }

    /// Cuts a polygon to what is shown. Returns whether something near was cut off.
    fn cut_polygon(&mut self, polygon: &mut Vec<u32>, view: &BlockView) -> bool {
        let codes = polygon.iter().map(|point| self.outside(*point, view));
        let (mut any, mut all) = (0, u8::MAX);
        codes.for_each(|code| (any, all) = (any | code, all & code));
        if any == 0 {
            return false;
        }
        let opened = any & OPENING != 0;
        if all != 0 {
            polygon.clear();
            return opened;
        }
        for boundary in (0..BOUNDARIES).filter(|boundary| any >> boundary & 1 == 1) {
            let before = std::mem::take(polygon);
            for (k, &to) in before.iter().enumerate() {
                let from = before[(k + before.len() - 1) % before.len()];
                let (a, b) = (self.inside(boundary, from), self.inside(boundary, to));
                if (a < 0.0) != (b < 0.0) {
                    polygon.push(self.cut(boundary, from, to));
                }
                if b >= 0.0 {
                    polygon.push(to);
                }
            }
            polygon.dedup();
            if polygon.len() > 1 && polygon.first() == polygon.last() {
                polygon.pop();
            }
        }
        if polygon.len() < 3 {
            polygon.clear();
        }
        opened
    }

    /// What is shown of an edge.
    fn cut_line(&mut self, mut ends: [u32; 2], view: &BlockView) -> Option<[u32; 2]> {
        let codes = ends.map(|end| self.outside(end, view));
        if codes[0] & codes[1] != 0 {
            return None;
        }
        for boundary in (0..BOUNDARIES).filter(|boundary| (codes[0] | codes[1]) >> boundary & 1 == 1) {
            let [a, b] = ends.map(|end| self.inside(boundary, end) < 0.0);
            match (a, b) {
                (true, true) => return None,
                (true, false) => ends[0] = self.cut(boundary, ends[0], ends[1]),
                (false, true) => ends[1] = self.cut(boundary, ends[0], ends[1]),
                (false, false) => {}
            }
        }
        (ends[0] != ends[1] && ends.iter().all(|end| self.outside(*end, view) & 1 == 0)).then_some(ends)
    }

    /// The point where a boundary cuts an edge.
    fn cut(&mut self, boundary: usize, from: u32, to: u32) -> u32 {
        let key = [from.min(to), from.max(to)];
        if let Some(known) = self.cuts.get(&(boundary, key)) {
            return *known;
        }
        let [a, b] = key.map(|point| self.inside(boundary, point));
        let [p, q] = key.map(|point| self.raw[point as usize]);
        let t = a / (a - b);
        let mut clip = p.clip + (q.clip - p.clip) * t;
        // Onto the boundary itself, which a rounding may miss.
        match boundary {
            1 => clip.x = -clip.w,
            2 => clip.x = clip.w,
            3 => clip.y = -clip.w,
            4 => clip.y = clip.w,
            _ => {}
        }
        let (eye, local) = (p.eye + (q.eye - p.eye) * t, p.local + (q.local - p.local) * t);
        self.raw.push(Raw { clip, eye, local, view: p.view });
        let number = self.raw.len() as u32 - 1;
        self.cuts.insert((boundary, key), number);
        number
    }
}

/// A point on the screen; some position for one that is not shown.
fn screen_point(raw: &Raw, view: &BlockView) -> ScreenPoint {
    if raw.clip.w <= 0.0 {
        return ScreenPoint { position: DVec2::ZERO, depth_key: 0.0 };
    }
    let across = |[low, high]: [f64; 2], c: f64| low + (c / raw.clip.w + 1.0) * (high - low) / 2.0;
    let nearness = if view.matrix.row(3).truncate() == DVec3::ZERO {
        -view.matrix.row(2).truncate().dot(raw.eye)
    } else {
        1.0 / raw.clip.w
    };
    ScreenPoint {
        position: DVec2::new(across(view.horizontal, raw.clip.x), across(view.vertical, raw.clip.y)),
        depth_key: nearness,
    }
}
