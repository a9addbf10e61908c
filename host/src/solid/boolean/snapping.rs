//! Drawing together what lies within a few roundings of each other.
//!
//! Corners that are near become one; an edge that passes near a corner goes through it; a face that does, has it as a
//! corner of its triangles; two edges that pass near each other get a common corner. So two sheets that nearly coincide
//! end up with the same triangles, which cancel. The surface stays closed through all of it: what happens to an edge happens
//! to it in all its triangles.
//!
//! # Source
//! Hobby 1999 for the plane, where one such pass suffices.

use super::result::{Outcome, Tables};
use super::triangulation::Triangulation;
use crate::mesh::Mesh;
use crate::numeric::implicit::{Definition, Point};
use crate::octree::Sorted;
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

/// An edge by its vertices, the lower first.
type Edge = [u32; 2];

/// What lies near edges and in faces: vertices with their place along the edge from its lower vertex on.
#[derive(Default)]
struct Near {
    edges: FxHashMap<Edge, Vec<(f64, u32)>>,
    faces: FxHashMap<u32, Vec<u32>>,
    /// The other ends of the pieces of edges at each vertex.
    next: FxHashMap<u32, Vec<u32>>,
}

/// Draws together what is near among triangles that overlap.
///
/// - `pairs`: the triangles.
/// - `roundings`: what is near, in units in the last place of the largest coordinate.
pub fn snapped(mut outcome: Outcome, pairs: &[[u32; 2]], roundings: f64) -> Outcome {
    let mut involved = pairs.as_flattened().to_vec();
    involved.sort_unstable();
    involved.dedup();
    let reach = |p: DVec3| roundings * f64::EPSILON * p.abs().max_element();
    let close = near_triangles(&outcome.mesh, &involved, reach);
    let common = common_corners(&outcome.mesh, &close, reach);
    let first_common = outcome.mesh.vertices.len() as u32;
    outcome.mesh.vertices.extend(common.iter().map(|(place, _)| *place));
    let mut vertices: Vec<u32> = involved.iter().flat_map(|&t| outcome.mesh.triangles[t as usize]).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices.extend(first_common..outcome.mesh.vertices.len() as u32);
    let one = clustered(&outcome.mesh, &vertices, reach);
    for triangle in &mut outcome.mesh.triangles {
        *triangle = triangle.map(|vertex| one[vertex as usize]);
    }
    let mut near = Near::default();
    for (number, (_, edges)) in (first_common..).zip(&common) {
        for edge in edges {
            near.pass(&outcome.mesh.vertices, edge.map(|v| one[v as usize]), one[number as usize]);
        }
    }
    near.collect(&outcome.mesh, &close, reach);
    near.follow(&outcome.mesh, &involved);
    rebuilt(outcome, &near)
}

fn sorted(a: u32, b: u32) -> Edge {
    if a < b { [a, b] } else { [b, a] }
}

fn sides(t: [u32; 3]) -> [Edge; 3] {
    [sorted(t[0], t[1]), sorted(t[1], t[2]), sorted(t[2], t[0])]
}

/// Pairs of triangles whose boxes are near, both ways.
fn near_triangles(mesh: &Mesh, involved: &[u32], reach: impl Fn(DVec3) -> f64) -> Vec<[u32; 2]> {
    let boxes: Vec<DVec3> = involved
        .iter()
        .flat_map(|&t| {
            let corners = mesh.corners(t as usize);
            let margin = DVec3::splat(corners.into_iter().map(&reach).fold(0.0, f64::max));
            let (low, high) = (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]));
            [low - margin, high + margin]
        })
        .collect();
    let triangles: Vec<[u32; 3]> = (0..involved.len() as u32).map(|k| [2 * k, 2 * k + 1, 2 * k + 1]).collect();
    let set = Sorted::new(&boxes, &triangles);
    let pairs = set.pairs(&set).into_iter().filter(|[a, b]| a != b);
    let mut pairs: Vec<[u32; 2]> = pairs.map(|pair| pair.map(|k| involved[k as usize])).collect();
    pairs.sort_unstable();
    pairs
}

/// How far a point is from a segment, and where along it the nearest point is, 0..=1.
fn from_segment(p: DVec3, [a, b]: [DVec3; 2]) -> (f64, f64) {
    let d = b - a;
    let t = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
    ((p - a - d * t).length(), t)
}

/// Corners for edges that pass near each other between their ends, with those edges.
fn common_corners(mesh: &Mesh, close: &[[u32; 2]], reach: impl Fn(DVec3) -> f64) -> Vec<(DVec3, [Edge; 2])> {
    let mut seen: FxHashSet<[Edge; 2]> = FxHashSet::default();
    let mut found = Vec::new();
    for [one, two] in close.iter().filter(|[a, b]| a < b) {
        for e in sides(mesh.triangles[*one as usize]) {
            for f in sides(mesh.triangles[*two as usize]) {
                if e.iter().any(|v| f.contains(v)) || !seen.insert(if e < f { [e, f] } else { [f, e] }) {
                    continue;
                }
                let [[a, b], [p, q]] = [e, f].map(|edge| edge.map(|v| mesh.vertices[v as usize]));
                let (d, g) = (b - a, q - p);
                let normal = d.cross(g);
                let size = normal.length_squared();
                if size == 0.0 {
                    continue;
                }
                let (s, t) = ((p - a).cross(g).dot(normal) / size, (p - a).cross(d).dot(normal) / size);
                if !(s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) {
                    continue;
                }
                let (x, y) = (a + d * s, p + g * t);
                let near = reach(x);
                let is_apart = x.distance(y) > near;
                if !is_apart && [a, b, p, q].iter().all(|end| end.distance(x) > near && end.distance(y) > near) {
                    found.push(((x + y) / 2.0, [e, f]));
                }
            }
        }
    }
    found
}

/// For each vertex the one that it becomes: the first of those given that is near.
fn clustered(mesh: &Mesh, vertices: &[u32], reach: impl Fn(DVec3) -> f64) -> Vec<u32> {
    let mut one: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let largest = vertices.iter().map(|&v| reach(mesh.vertices[v as usize])).fold(0.0, f64::max);
    if largest == 0.0 {
        return one;
    }
    let cell = |p: DVec3| (p / largest).floor().to_array().map(|x| x as i64);
    let mut kept: FxHashMap<[i64; 3], Vec<u32>> = FxHashMap::default();
    for &vertex in vertices {
        let at = mesh.vertices[vertex as usize];
        let [x, y, z] = cell(at);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let near = |other: &&u32| mesh.vertices[**other as usize].distance(at) <= reach(at);
        match around.flat_map(|key| kept.get(&key).into_iter().flatten()).find(near) {
            Some(&other) => one[vertex as usize] = other,
            None => kept.entry([x, y, z]).or_default().push(vertex),
        }
    }
    one
}

impl Near {
    /// Makes an edge pass through a vertex.
    fn pass(&mut self, vertices: &[DVec3], [a, b]: Edge, vertex: u32) {
        if a == b || vertex == a || vertex == b {
            return;
        }
        let edge = sorted(a, b);
        let points = self.edges.entry(edge).or_default();
        if points.iter().all(|(_, v)| *v != vertex) {
            points.push((from_segment(vertices[vertex as usize], edge.map(|v| vertices[v as usize])).1, vertex));
        }
    }

    /// Finds which corners are near which triangles.
    fn collect(&mut self, mesh: &Mesh, close: &[[u32; 2]], reach: impl Fn(DVec3) -> f64) {
        for &[face, other] in close {
            let t = mesh.triangles[face as usize];
            let corners = mesh.corners(face as usize);
            if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
                continue;
            }
            for vertex in mesh.triangles[other as usize] {
                if t.contains(&vertex) {
                    continue;
                }
                let p = mesh.vertices[vertex as usize];
                let near = reach(p);
                let is_near = |edge: &Edge| from_segment(p, edge.map(|v| mesh.vertices[v as usize])).0 <= near;
                let mut edges = sides(t).into_iter().filter(is_near).peekable();
                if edges.peek().is_some() {
                    edges.for_each(|edge| self.pass(&mesh.vertices, edge, vertex));
                    continue;
                }
                let [a, b, c] = corners;
                let normal = (b - a).cross(c - a);
                let height = (p - a).dot(normal) / normal.length();
                let inside = barycentric(corners, p).iter().all(|w| *w > 0.0);
                if height.abs() <= near && inside {
                    let inner = self.faces.entry(face).or_default();
                    if !inner.contains(&vertex) {
                        inner.push(vertex);
                    }
                }
            }
        }
        // A triangle that is hardly more than its longest side.
        let mut involved: Vec<u32> = close.iter().map(|pair| pair[0]).collect();
        involved.dedup();
        for face in involved {
            let t = mesh.triangles[face as usize];
            for k in 0..3 {
                let (edge, vertex) = (sorted(t[k], t[(k + 1) % 3]), t[(k + 2) % 3]);
                let p = mesh.vertices[vertex as usize];
                if edge[0] != edge[1] && from_segment(p, edge.map(|v| mesh.vertices[v as usize])).0 <= reach(p) {
                    self.pass(&mesh.vertices, edge, vertex);
                }
            }
        }
        for points in self.edges.values_mut() {
            points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
    }

    /// Notes the pieces of all edges of some triangles: where they run in other faces, those are divided along them.
    fn follow(&mut self, mesh: &Mesh, triangles: &[u32]) {
        for &triangle in triangles {
            for [a, b] in sides(mesh.triangles[triangle as usize]) {
                let ends = self.along(a, b).into_iter().map(|(_, v)| v).chain([b]);
                let mut last = a;
                for end in ends {
                    for (from, to) in [(last, end), (end, last)] {
                        let all = self.next.entry(from).or_default();
                        if from != to && !all.contains(&to) {
                            all.push(to);
                        }
                    }
                    last = end;
                }
            }
        }
    }

    /// What an edge passes through, from one end to the other.
    fn along(&self, from: u32, to: u32) -> Vec<(f64, u32)> {
        let mut points = self.edges.get(&sorted(from, to)).cloned().unwrap_or_default();
        if from > to {
            points.reverse();
            points.iter_mut().for_each(|point| point.0 = 1.0 - point.0);
        }
        points
    }
}

fn barycentric([a, b, c]: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let part = |q: DVec3, r: DVec3| (q - p).cross(r - p).dot(normal) / normal.length_squared();
    [part(b, c), part(c, a), part(a, b)]
}

/// The surface with all edges and faces through what is near them, less triangles that cancel.
fn rebuilt(outcome: Outcome, near: &Near) -> Outcome {
    let old = &outcome.mesh;
    let tables = Tables::of(&[old]);
    let mut made: Vec<([u32; 3], u32, bool)> = Vec::with_capacity(old.triangles.len());
    for (&t, index) in old.triangles.iter().zip(0..) {
        if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
            continue;
        }
        let chains = [0, 1, 2].map(|k| near.along(t[k], t[(k + 1) % 3]));
        let inner = near.faces.get(&index).map_or(&[][..], Vec::as_slice);
        if inner.is_empty() && chains.iter().all(Vec::is_empty) {
            made.push((t, index, true));
        } else {
            let parts = divided(old, index, &chains, inner, &near.next);
            made.extend(parts.into_iter().map(|corners| (corners, index, false)));
        }
    }
    let is_kept = uncancelled(&made);
    let mut new = Outcome { counts: outcome.counts, ..Outcome::default() };
    new.mesh.vertices.clone_from(&old.vertices);
    for ((corners, index, is_whole), _) in made.into_iter().zip(is_kept).filter(|(_, kept)| *kept) {
        new.mesh.triangles.push(corners);
        new.sources.push(outcome.sources[index as usize]);
        if is_whole {
            tables.take(&mut new.mesh, old, index as usize);
        } else {
            tables.interpolate(&mut new.mesh, old, 0, index as usize, [index as usize; 3]);
        }
    }
    new.clean();
    new
}

/// Whether each triangle is left when those with the same corners cancel, one way against the other.
fn uncancelled(made: &[([u32; 3], u32, bool)]) -> Vec<bool> {
    let mut of_corners: FxHashMap<[u32; 3], Vec<(usize, bool)>> = FxHashMap::default();
    let mut kept = vec![true; made.len()];
    for (index, (corners, ..)) in made.iter().enumerate() {
        let mut key = *corners;
        key.sort_unstable();
        let lowest = corners.iter().position(|c| *c == key[0]).unwrap_or(0);
        let is_even = corners[(lowest + 1) % 3] == key[1];
        let all = of_corners.entry(key).or_default();
        match all.iter().position(|(_, even)| *even != is_even) {
            Some(place) => {
                kept[all.swap_remove(place).0] = false;
                kept[index] = false;
            }
            None => all.push((index, is_even)),
        }
    }
    kept
}

/// Steps into which sides are thought to be divided.
const STEPS: f64 = (1_u64 << 40) as f64;

/// The parts of a triangle whose sides pass through points, and that has points inside it.
///
/// They are found where sides are straight, which they are but for roundings.
fn divided(
    mesh: &Mesh,
    triangle: u32,
    chains: &[Vec<(f64, u32)>; 3],
    inner: &[u32],
    next: &FxHashMap<u32, Vec<u32>>,
) -> Vec<[u32; 3]> {
    let t = mesh.triangles[triangle as usize];
    let corners = mesh.corners(triangle as usize);
    let point = |x: f64, y: f64| Point::new(Definition::Given(DVec3::new(x, y, 0.0)));
    let place = |k: usize, s: f64| match k {
        0 => point(s, 0.0),
        1 => point(STEPS - s, s),
        _ => point(0.0, STEPS - s),
    };
    let on_sides: Vec<Vec<Point>> = chains
        .iter()
        .enumerate()
        .map(|(k, chain)| {
            let mut last = 0.0_f64;
            let left = |n: usize| (chain.len() - n) as f64;
            let steps = chain.iter().enumerate().map(|(n, (at, _))| {
                last = (at * STEPS).round().min(STEPS - left(n)).max(last + 1.0);
                place(k, last)
            });
            steps.collect()
        })
        .collect();
    let inside: Vec<Point> = inner
        .iter()
        .map(|&v| {
            let [_, x, y] = barycentric(corners, mesh.vertices[v as usize]).map(|w| (w * STEPS).round().max(1.0));
            let surplus = (x + y - (STEPS - 1.0)).max(0.0);
            if x > y { point(x - surplus, y) } else { point(x, y - surplus) }
        })
        .collect();
    let frame = [point(0.0, 0.0), point(STEPS, 0.0), point(0.0, STEPS)];
    let mut names = t.to_vec();
    let mut triangulation = Triangulation::new(2, &frame.each_ref());
    for k in 0..3_u8 {
        triangulation.insert_on_side(k, &on_sides[k as usize]);
        names.extend(chains[k as usize].iter().map(|(_, v)| v));
    }
    for (point, &vertex) in inside.iter().zip(inner) {
        if triangulation.insert(point) as usize == names.len() {
            names.push(vertex);
        }
    }
    // Edges of other triangles from point to point.
    let number: FxHashMap<u32, u32> = names.iter().copied().zip(0..).collect();
    for (name, from) in names.iter().zip(0..) {
        for to in next.get(name).into_iter().flatten().filter_map(|to| number.get(to)).filter(|to| **to > from) {
            triangulation.fix(from, *to);
        }
    }
    let parts = triangulation.triangles.iter().map(|corners| corners.map(|c| names[c as usize]));
    parts.filter(|[a, b, c]| a != b && b != c && c != a).collect()
}
