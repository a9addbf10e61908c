//! Triangles of the limit surface within a tolerance: small only where it is curved, without cracks.
//!
//! Around each vertex lies a patch between the limit points of its faces. What a step makes of these faces depends on
//! them alone, so that a patch is divided without its neighbours. The sides of patches are shared: when one of two
//! neighbours divides the side between them, the other one keeps to the new points.

use std::cell::OnceCell;
use std::collections::HashMap;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, TAU};
use std::rc::Rc;

use glam::{DVec2, DVec3};

use super::creases::Creases;
use super::error::SubdivisionError;
use super::limit::{Limit, Limits, SharpRim, distinct};
use super::polyhedron::{NONE, Polyhedron};
use crate::mesh::Mesh;

/// The most patches, for tolerances that rounding never meets.
const MOST_PATCHES: usize = 1 << 21;

/// The limit surface of a polyhedron without finite sharpness, within `tolerance`.
pub(super) fn mesh(polyhedron: &Polyhedron, tolerance: f64) -> Result<Mesh, SubdivisionError> {
    let creases = Creases::of(polyhedron);
    let limits = Limits::of(&creases);
    let mut surface = Surface { tolerance, vertices: vec![Limit::default(); limits.count], sides: Vec::new() };
    for (limit, &name) in limits.of_corners.iter().zip(&limits.names).rev().filter(|(_, name)| **name != NONE) {
        surface.vertices[name as usize] = *limit;
    }
    let mut leaves = Vec::new();
    for patch in surface.patches(&creases, &limits) {
        surface.divide(patch, &mut leaves)?;
    }
    surface.settle(&mut leaves)?;
    Ok(surface.triangles(&leaves))
}

/// A face of the polyhedron, or of what steps made of it.
struct Face {
    corners: Vec<DVec3>,
    rim: Rc<SharpRim>,
    refined: OnceCell<Rc<Face>>,
}

impl Face {
    fn new(corners: Vec<DVec3>, rim: SharpRim) -> Rc<Face> {
        Rc::new(Face { corners, rim: Rc::new(rim), refined: OnceCell::new() })
    }

    /// The face within it after a step.
    fn refined(&self) -> &Rc<Face> {
        let step = || Face { corners: self.rim.step(&self.corners), rim: self.rim.clone(), refined: OnceCell::new() };
        self.refined.get_or_init(|| Rc::new(step()))
    }
}

/// A face as one of those around a vertex, and which of its corners is that vertex.
#[derive(Clone)]
struct FanCorner {
    face: Rc<Face>,
    corner: usize,
}

impl FanCorner {
    fn new(face: &Rc<Face>, corner: usize) -> FanCorner {
        FanCorner { face: face.clone(), corner }
    }

    /// The number of the corner so many corners behind.
    fn at(&self, shift: usize) -> usize {
        (self.corner + shift) % self.face.corners.len()
    }

    /// The number of the corner before.
    fn last(&self) -> usize {
        self.at(self.face.corners.len() - 1)
    }

    fn here(&self) -> DVec3 {
        self.face.corners[self.corner]
    }

    /// A face has one limit in all patches that are divided.
    fn limit(&self) -> Limit {
        self.face.rim.limit(&self.face.corners).unwrap_or_default()
    }
}

/// The part of the surface between the limit points of the faces around a vertex.
struct Patch {
    /// The faces, counter-clockwise; empty for a flat patch, which is not divided.
    fan: Vec<FanCorner>,
    /// Whether the faces go all around the vertex; else the last side lies on a crease or a border.
    is_closed: bool,
    /// The limit points: vertices of the surface, the normals there on this side of a crease, and the parameters.
    points: Vec<Point>,
    /// The sides from each limit point to the next.
    sides: Vec<u32>,
    /// The one of the first patches that it is a part of.
    whole: u32,
}

/// A point of a patch: the vertex, the normal on this side of a crease, and its place in a regular polygon.
type Point = (u32, DVec3, DVec2);

/// The corners of the regular polygon that is the domain of a patch with so many; the unit square for four.
fn domain(count: usize) -> impl Iterator<Item = DVec2> {
    let angle = move |k: usize| (k as f64 - 0.5) * TAU / count as f64 - FRAC_PI_2;
    let on_circle = move |k: usize| DVec2::from_angle(angle(k)) * FRAC_1_SQRT_2 + 0.5;
    let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    (0..count).map(move |k| if count == 4 { square[k] } else { on_circle(k) })
}

/// The mean of the parameters of some points.
fn mean(points: &[Point]) -> DVec2 {
    points.iter().map(|point| point.2).sum::<DVec2>() / points.len() as f64
}

/// A side of one or two patches.
struct Side {
    ends: [u32; 2],
    is_crease: bool,
    /// The point that divides it, and its halves.
    halves: Option<(u32, [u32; 2])>,
}

/// What a step makes of a patch.
struct Division {
    refined: Vec<Rc<Face>>,
    edges: Vec<Rc<Face>>,
    vertex: Rc<Face>,
    /// Limits of the faces for edges.
    middles: Vec<Limit>,
    center: Limit,
}

struct Surface {
    tolerance: f64,
    vertices: Vec<Limit>,
    sides: Vec<Side>,
}

impl Surface {
    /// The patches of all vertices, and flat ones where faces do not shrink to a point.
    fn patches(&mut self, creases: &Creases<'_>, limits: &Limits) -> Vec<Patch> {
        let mesh = creases.mesh;
        let faces: Vec<Rc<Face>> = (0..mesh.face_count())
            .map(|face| Face::new(mesh.face_points(face).collect(), SharpRim::of(creases, face)))
            .collect();
        let face_of = mesh.face_of();
        let mut known = HashMap::new();
        let mut patches = Vec::new();
        let mut add = |run: Vec<(u32, u32)>, fan: Vec<FanCorner>, is_closed| {
            let normal = |owner: u32| limits.of_corners[owner as usize].normal;
            let points = run.iter().zip(domain(run.len())).map(|(&(name, owner), uv)| (name, normal(owner), uv));
            let points: Vec<Point> = points.collect();
            let following = points.iter().skip(1).chain(&points[..1]);
            let sides = points.iter().zip(following).map(|(a, b)| self.side([a.0, b.0], &mut known)).collect();
            let whole = patches.len() as u32;
            patches.push(Patch { fan, is_closed, points, sides, whole });
        };
        creases.each_inner_face(|run, owners| {
            let run = distinct(run, owners, &limits.names);
            if run.len() > 2 {
                add(run, Vec::new(), true);
            }
        });
        for (run, is_closed) in creases.sectors() {
            let short = distinct(run, run, &limits.names);
            if short.len() < 3 {
                continue;
            }
            let place = |&corner: &u32| {
                let face = face_of[corner as usize];
                FanCorner::new(&faces[face as usize], (corner - mesh.starts[face as usize]) as usize)
            };
            let fan: Vec<FanCorner> = run.iter().map(place).collect();
            let has_limits = fan.iter().all(|place| place.face.rim.limit(&place.face.corners).is_some());
            let run: Vec<(u32, u32)> = run.iter().map(|&corner| (limits.names[corner as usize], corner)).collect();
            // At the end of a crease the first and the last face shrink to one point.
            if has_limits && (is_closed || run[0].0 != run[run.len() - 1].0) {
                add(run, fan, is_closed);
            } else {
                add(short, Vec::new(), true);
            }
        }
        for patch in patches.iter().filter(|patch| !patch.is_closed) {
            self.sides[patch.sides[patch.sides.len() - 1] as usize].is_crease = true;
        }
        patches
    }

    /// The side between two vertices of the first patches.
    fn side(&mut self, ends: [u32; 2], known: &mut HashMap<[u32; 2], u32>) -> u32 {
        let [a, b] = ends;
        *known.entry([a.min(b), a.max(b)]).or_insert_with(|| self.new_side(ends, false))
    }

    fn new_side(&mut self, ends: [u32; 2], is_crease: bool) -> u32 {
        self.sides.push(Side { ends, is_crease, halves: None });
        (self.sides.len() - 1) as u32
    }

    /// Divides a patch as long as it is not flat.
    fn divide(&mut self, patch: Patch, leaves: &mut Vec<Patch>) -> Result<(), SubdivisionError> {
        let mut waiting = vec![patch];
        while let Some(patch) = waiting.pop() {
            if leaves.len() + waiting.len() > MOST_PATCHES {
                return Err(SubdivisionError::TooLarge { corners: 4 * MOST_PATCHES });
            }
            if patch.fan.is_empty() {
                leaves.push(patch);
                continue;
            }
            if self.error(&patch) > self.tolerance {
                self.split(&patch, &Division::of(&patch), &mut waiting);
            } else {
                leaves.push(patch);
            }
        }
        Ok(())
    }

    /// How far the triangles of a patch are from the surface: on its sides, and in its middle.
    fn error(&self, patch: &Patch) -> f64 {
        let count = patch.points.len();
        let point = |k: usize| self.vertices[patch.points[k % count].0 as usize].point;
        let (middles, center) = middles(patch);
        let chord = |(k, middle): (usize, &DVec3)| {
            let distance = distance(*middle, [point(k), point(k + 1), point(k + 1)]);
            if distance <= self.tolerance || self.sides[patch.sides[k] as usize].is_crease {
                return distance;
            }
            // Along the surface, a side that both neighbours have may lie anywhere.
            let off = *middle - point(k).midpoint(point(k + 1));
            let normals = [k, k + 1].map(|k| patch.points[k % count].1.normalize_or_zero());
            normals.into_iter().map(|n| if n == DVec3::ZERO { distance } else { off.dot(n).abs() }).fold(0.0, f64::max)
        };
        let sides = middles.iter().enumerate().map(chord).fold(0.0, f64::max);
        let from_fan = |first: usize| {
            let triangles = (1..count - 1).map(|k| [first, first + k, first + k + 1].map(point));
            triangles.map(|triangle| distance(center, triangle)).fold(f64::INFINITY, f64::min)
        };
        let closing = if patch.is_closed { 0.0 } else { distance(center, [point(count - 1), point(0), point(0)]) };
        // Of four points the better diagonal is taken.
        let middle = if count == 4 { from_fan(0).min(from_fan(1)) } else { from_fan(0) };
        sides.max(closing) + middle
    }

    /// Divides the side `side` in `limit`, unless it is already divided.
    fn halve(&mut self, side: u32, limit: Limit) -> (u32, [u32; 2]) {
        let Side { ends, is_crease, halves } = self.sides[side as usize];
        if let Some(halves) = halves {
            return halves;
        }
        if ends[0] == ends[1] {
            return (ends[0], [side, side]);
        }
        let middle = self.vertices.len() as u32;
        self.vertices.push(limit);
        let halves =
            (middle, [self.new_side([ends[0], middle], is_crease), self.new_side([middle, ends[1]], is_crease)]);
        self.sides[side as usize].halves = Some(halves);
        halves
    }

    /// The half of a divided side at one of its ends.
    fn half(&self, side: u32, halves: [u32; 2], end: u32) -> u32 {
        if self.sides[side as usize].ends[0] == end { halves[0] } else { halves[1] }
    }

    /// One patch for each limit point of a patch.
    fn split(&mut self, patch: &Patch, division: &Division, parts: &mut Vec<Patch>) {
        let count = patch.points.len();
        let edges = division.edges.len();
        let mut middles = Vec::with_capacity(edges);
        for (k, middle) in division.middles.iter().enumerate() {
            self.sides[patch.sides[k] as usize].is_crease |= division.edges[k].rim.creases.contains(&true);
            middles.push(self.halve(patch.sides[k], *middle));
        }
        let outer = (!patch.is_closed).then(|| self.halve(patch.sides[count - 1], division.center));
        let center = outer.map_or(self.vertices.len() as u32, |(center, _)| center);
        if outer.is_none() {
            self.vertices.push(division.center);
        }
        let halfway = |k: usize| (patch.points[k].2 + patch.points[(k + 1) % count].2) * 0.5;
        // At an open fan the last side has its middle where the others have their common one.
        let in_the_middle = if patch.is_closed { mean(&patch.points) } else { halfway(count - 1) };
        let inner: Vec<u32> = middles.iter().map(|middle| self.new_side([middle.0, center], false)).collect();
        for k in 0..count {
            let end = patch.points[k].0;
            let own = (FanCorner::new(&division.refined[k], patch.fan[k].corner), patch.points[k], 0);
            let vertex = (FanCorner::new(&division.vertex, k), (center, division.center.normal, in_the_middle), 0);
            let side_part = |this: &Surface, edge: usize| this.half(patch.sides[edge], middles[edge].1, end);
            // Face, its limit point, and the side from there to the next.
            let behind = (k < edges).then(|| {
                let place = FanCorner::new(&division.edges[k], 0);
                (place, (middles[k].0, division.middles[k].normal, halfway(k)), inner[k])
            });
            let before = (k > 0 || patch.is_closed).then(|| {
                let edge = (k + count - 1) % count;
                let face = &division.edges[edge];
                let place = FanCorner::new(face, face.corners.len() - 1);
                (place, (middles[edge].0, division.middles[edge].normal, halfway(edge)), side_part(self, edge))
            });
            let run = match (behind, before, outer) {
                (Some(behind), Some(before), _) => {
                    let last = inner[(k + count - 1) % count];
                    vec![(own.0, own.1, side_part(self, k)), behind, (vertex.0, vertex.1, last), before]
                }
                (Some(behind), None, Some((_, halves))) => {
                    let closing = self.half(patch.sides[count - 1], halves, end);
                    vec![(own.0, own.1, side_part(self, k)), behind, (vertex.0, vertex.1, closing)]
                }
                (None, Some(before), Some((_, halves))) => {
                    let closing = self.half(patch.sides[count - 1], halves, end);
                    vec![(vertex.0, vertex.1, inner[edges - 1]), before, (own.0, own.1, closing)]
                }
                _ => continue,
            };
            let is_closed = run.len() == 4;
            let mut part =
                Patch { fan: Vec::new(), is_closed, points: Vec::new(), sides: Vec::new(), whole: patch.whole };
            for (place, point, side) in run {
                part.fan.push(place);
                part.points.push(point);
                part.sides.push(side);
            }
            parts.push(part);
        }
    }

    /// Divides also those patches whose sides at creases, or all sides at open fans, were divided from beyond: only
    /// they know the normals there.
    fn settle(&mut self, leaves: &mut Vec<Patch>) -> Result<(), SubdivisionError> {
        loop {
            let is_divided = |side: &u32| self.sides[*side as usize].halves.is_some();
            let is_unsettled = |patch: &mut Patch| {
                let is_concerned = |side: &&u32| !patch.is_closed || self.sides[**side as usize].is_crease;
                !patch.fan.is_empty() && patch.sides.iter().filter(is_concerned).any(is_divided)
            };
            let unsettled: Vec<Patch> = leaves.extract_if(.., is_unsettled).collect();
            if unsettled.is_empty() {
                return Ok(());
            }
            for patch in unsettled {
                let mut parts = Vec::new();
                self.split(&patch, &Division::of(&patch), &mut parts);
                for part in parts {
                    self.divide(part, leaves)?;
                }
            }
        }
    }

    fn triangles(mut self, leaves: &[Patch]) -> Mesh {
        let mut mesh = Mesh::default();
        let mut outline = Vec::new();
        for patch in leaves {
            outline.clear();
            for (k, (&point, &side)) in patch.points.iter().zip(&patch.sides).enumerate() {
                outline.push(point);
                self.push_between(side, point, patch.points[(k + 1) % patch.points.len()].2, &mut outline);
            }
            outline.dedup_by_key(|point| point.0);
            while outline.len() > 1 && outline[0].0 == outline[outline.len() - 1].0 {
                outline.pop();
            }
            if !patch.fan.is_empty() && outline.len() > 3 {
                self.lead(patch, &mut outline);
            }
            for pair in outline.get(1..).unwrap_or_default().windows(2) {
                let triangle = [outline[0], pair[0], pair[1]];
                mesh.triangles.push(triangle.map(|point| point.0));
                mesh.corner_normals.push(triangle.map(|point| point.1));
                mesh.corner_parameters.push(triangle.map(|point| point.2));
                mesh.surfaces.push(patch.whole);
            }
        }
        mesh.vertices = self.vertices.iter().map(|limit| limit.point).collect();
        mesh
    }

    /// Adds the points that divide a side, beginning at `from`, without its ends.
    ///
    /// - `to`: the parameters at its other end.
    fn push_between(&self, side: u32, from: Point, to: DVec2, outline: &mut Vec<Point>) {
        let Side { ends, is_crease, halves: Some((middle, [first, second])) } = self.sides[side as usize] else {
            return;
        };
        let [near, far] = if ends[0] == from.0 { [first, second] } else { [second, first] };
        let uv = (from.2 + to) * 0.5;
        self.push_between(near, from, uv, outline);
        // Beyond a crease the normal is another one.
        let normal = if is_crease { from.1 } else { self.vertices[middle as usize].normal };
        outline.push((middle, normal, uv));
        self.push_between(far, (middle, normal, uv), to, outline);
    }

    /// Makes an outline ready for triangles from its first point: the better diagonal of four points, else a new point
    /// in the middle of the patch.
    fn lead(&mut self, patch: &Patch, outline: &mut Vec<Point>) {
        let (_, center) = middles(patch);
        let at = |k: usize| self.vertices[outline[k].0 as usize].point;
        if outline.len() == 4 {
            let far = |k: usize| (center - (at(k) + at(k + 2)) * 0.5).length_squared();
            if far(1) < far(0) {
                outline.rotate_left(1);
            }
        } else if patch.is_closed {
            let center = Division::of(patch).center;
            let first = outline[0];
            outline.insert(0, (self.vertices.len() as u32, center.normal, mean(&patch.points)));
            outline.push(first);
            self.vertices.push(center);
        }
    }
}

/// The limit points that divide the sides of a patch between its faces, and the one in its middle.
fn middles(patch: &Patch) -> (Vec<DVec3>, DVec3) {
    if !patch.is_closed || patch.fan.iter().any(|place| !place.face.rim.is_smooth()) {
        let division = Division::of(patch);
        return (division.middles.iter().map(|limit| limit.point).collect(), division.center.point);
    }
    // Centroids, for which no faces need be made.
    let count = patch.fan.len();
    let corner = |k: usize, shift: usize| {
        let place = &patch.fan[k % count];
        place.face.refined().corners[place.at(shift)]
    };
    let before = |k: usize| corner(k, patch.fan[k].face.corners.len() - 1);
    let middle = |k: usize| (corner(k, 0) + before(k) + corner(k + 1, 1) + corner(k + 1, 0)) * 0.25;
    let center = (0..count).map(|k| corner(k, 0)).sum::<DVec3>() / count as f64;
    ((0..count).map(middle).collect(), center)
}

impl Division {
    fn of(patch: &Patch) -> Division {
        let count = patch.fan.len();
        let refined: Vec<Rc<Face>> = patch.fan.iter().map(|place| place.face.refined().clone()).collect();
        let places: Vec<FanCorner> =
            refined.iter().zip(&patch.fan).map(|(face, place)| FanCorner::new(face, place.corner)).collect();
        let edges = if patch.is_closed { count } else { count - 1 };
        let edges: Vec<Rc<Face>> = (0..edges).map(|k| edge_face(&places[k], &places[(k + 1) % count])).collect();
        let corners: Vec<DVec3> = places.iter().map(FanCorner::here).collect();
        let rim = if patch.is_closed {
            SharpRim::default()
        } else {
            SharpRim { creases: (0..count).map(|k| k + 1 == count).collect(), pinned: vec![false; count] }
        };
        let vertex = Face::new(corners, rim);
        let limit = |face: &Rc<Face>| FanCorner::new(face, 0).limit();
        let middles = edges.iter().map(limit).collect();
        Division { center: limit(&vertex), refined, edges, vertex, middles }
    }
}

/// The face that a step makes of the edge between two faces around a vertex, from its corner within the first one. Its
/// last corner lies within the second.
fn edge_face(first: &FanCorner, second: &FanCorner) -> Rc<Face> {
    let (end, end_beyond) = (first.last(), second.at(1));
    let rims = [&first.face.rim, &second.face.rim];
    let is_held = rims[0].pinned.get(end).copied().unwrap_or(false);
    let [a, b, c, d] = [first.here(), first.face.corners[end], second.face.corners[end_beyond], second.here()];
    if is_held {
        return Face::new(vec![a, b, d], SharpRim { creases: vec![false; 3], pinned: vec![false, true, false] });
    }
    // The edge ends at a crease if both faces have a side on it.
    let before_end = first.at(first.face.corners.len() - 2);
    let is_crease = |rim: &SharpRim, side: usize| rim.creases.get(side).copied().unwrap_or(false);
    if is_crease(rims[0], before_end) && is_crease(rims[1], end_beyond) {
        return Face::new(
            vec![a, b, c, d],
            SharpRim { creases: vec![false, true, false, false], pinned: vec![false; 4] },
        );
    }
    Face::new(vec![a, b, c, d], SharpRim::default())
}

/// The distance of a point from a triangle, which may have shrunk to a side.
fn distance(point: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let is_above = |(from, to): (DVec3, DVec3)| normal.cross(to - from).dot(point - from) >= 0.0;
    if normal != DVec3::ZERO && [(a, b), (b, c), (c, a)].into_iter().all(is_above) {
        return normal.normalize_or_zero().dot(point - a).abs();
    }
    let from_side = |(from, to): (DVec3, DVec3)| {
        let along = to - from;
        let t = (point - from).dot(along) / along.length_squared();
        // No number for a side without length, which has its beginning only.
        (point - from - along * if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) }).length()
    };
    [(a, b), (b, c), (c, a)].into_iter().map(from_side).fold(f64::INFINITY, f64::min)
}
