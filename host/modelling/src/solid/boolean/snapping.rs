//! Snap rounding: makes one of what lies within a few units in the last place of each other.
//!
//! Corners that are near become one; an edge that passes near a corner goes through it; a face that does, has it as a
//! corner of its triangles; two edges that pass near each other get a common corner. So two sheets that nearly coincide
//! end up with the same triangles, which cancel. The surface stays closed through all of it: what happens to an edge
//! happens to it in all its triangles.
//!
//! # Source
//! Hobby 1999 for the plane, where one such pass suffices.
//!
//! # Cost
//! n log n in the triangles that are snapped and the pairs of them that are near each other.

use super::result::{CornerTables, Outcome};
use super::triangulation::IncrementalTriangulation;
use crate::mesh::Mesh;
use crate::numeric::bounds::Bounds;
use crate::numeric::implicit::{ImplicitPoint, PointDefinition};
use crate::octree::TriangleBvh;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// An edge by its vertices, the lower first.
type Edge = [u32; 2];

/// The triangles among which what is near is snapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Those that overlap others.
    Overlapping,
    /// Those that overlap others, and those near them.
    Near,
}

/// Snaps what is near among triangles that overlap.
///
/// - `pairs`: the triangles.
/// - `roundings`: what is near, in units in the last place of the largest coordinate there.
pub fn snapped(mut outcome: Outcome, pairs: &[[u32; 2]], roundings: f64, scope: Scope) -> Outcome {
    let reach = SnapDistance(roundings * f64::EPSILON);
    let mut involved = pairs.as_flattened().to_vec();
    involved.sort_unstable();
    involved.dedup();
    if scope == Scope::Near {
        involved = with_near(&outcome.mesh, involved, reach);
    }
    let one = clustered(&outcome.mesh, &involved, reach);
    for triangle in &mut outcome.mesh.triangles {
        *triangle = triangle.map(|vertex| one[vertex as usize]);
    }
    let mut near = Incidences::new(&outcome.mesh, &involved);
    near.collect(&mut outcome.mesh, &involved, reach);
    rebuilt(outcome, near, &involved)
}

/// How far from a place what is near may be.
#[derive(Clone, Copy)]
struct SnapDistance(f64);

impl SnapDistance {
    fn at(self, p: DVec3) -> f64 {
        self.0 * p.abs().max_element()
    }

    /// The box of some points and of all that is near.
    fn around(self, points: &[DVec3]) -> [DVec3; 2] {
        let margin = DVec3::splat(points.iter().map(|p| self.at(*p)).fold(0.0, f64::max));
        let bounds = Bounds::of(points.iter().copied());
        [bounds.min - margin, bounds.max + margin]
    }
}

fn sorted(a: u32, b: u32) -> Edge {
    if a < b { [a, b] } else { [b, a] }
}

fn sides(t: [u32; 3]) -> [Edge; 3] {
    [sorted(t[0], t[1]), sorted(t[1], t[2]), sorted(t[2], t[0])]
}

fn is_collapsed(t: [u32; 3]) -> bool {
    t[0] == t[1] || t[1] == t[2] || t[2] == t[0]
}

/// Boxes by location.
fn sorted_boxes(boxes: impl Iterator<Item = [DVec3; 2]>) -> TriangleBvh {
    let corners: Vec<DVec3> = boxes.flatten().collect();
    let boxes: Vec<[u32; 3]> = (0..corners.len() as u32 / 2).map(|k| [2 * k, 2 * k + 1, 2 * k + 1]).collect();
    TriangleBvh::new(&corners, &boxes)
}

/// Some triangles, and those near them.
fn with_near(mesh: &Mesh, triangles: Vec<u32>, reach: SnapDistance) -> Vec<u32> {
    let all = TriangleBvh::new(&mesh.vertices, &mesh.triangles);
    let mut found = triangles.clone();
    for triangle in triangles {
        let [min, max] = reach.around(&mesh.corners(triangle as usize));
        all.touching(Bounds { min, max }, |other| found.push(other));
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// How far a point is from a segment, and where along it the nearest point is, 0..=1.
fn from_segment(p: DVec3, [a, b]: [DVec3; 2]) -> (f64, f64) {
    let d = b - a;
    let t = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
    ((p - a - d * t).length(), t)
}

/// For each vertex the one that it becomes: the lowest of those of the triangles that is near.
fn clustered(mesh: &Mesh, involved: &[u32], reach: SnapDistance) -> Vec<u32> {
    let mut one: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut vertices: Vec<u32> = involved.iter().flat_map(|&t| mesh.triangles[t as usize]).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let place = |k: u32| mesh.vertices[vertices[k as usize] as usize];
    let near = sorted_boxes(vertices.iter().map(|&v| reach.around(&[mesh.vertices[v as usize]])));
    let mut pairs = near.pairs_within(|a, b| place(a).distance(place(b)) <= reach.at(place(a)));
    pairs.sort_unstable();
    for pair in pairs {
        let [a, b] = pair.map(|k| vertices[k as usize]);
        if one[b as usize] == b {
            one[b as usize] = one[a as usize];
        }
    }
    one
}

/// What lies near edges and in faces.
struct Incidences {
    edges: Vec<Edge>,
    number: FxHashMap<Edge, u32>,
    /// For each edge: vertices with their place along it from its lower vertex on, in order.
    on_edges: Vec<Vec<(f64, u32)>>,
    /// For each triangle that is involved: vertices inside it.
    in_faces: Vec<Vec<u32>>,
    /// The other ends of edges at each vertex: those of others run through a face, which is divided along them.
    next: FxHashMap<u32, Vec<u32>>,
}

impl Incidences {
    fn new(mesh: &Mesh, involved: &[u32]) -> Incidences {
        let triangles = involved.iter().map(|&t| mesh.triangles[t as usize]);
        let mut edges: Vec<Edge> = triangles.flat_map(sides).filter(|[a, b]| a != b).collect();
        edges.sort_unstable();
        edges.dedup();
        let number = edges.iter().copied().zip(0..).collect();
        let on_edges = vec![Vec::new(); edges.len()];
        Incidences { edges, number, on_edges, in_faces: vec![Vec::new(); involved.len()], next: FxHashMap::default() }
    }

    /// Makes an edge pass through a vertex; whether it did not before.
    fn pass(&mut self, vertices: &[DVec3], edge: u32, vertex: u32) -> bool {
        let ends = self.edges[edge as usize];
        let points = &mut self.on_edges[edge as usize];
        if ends.contains(&vertex) || points.iter().any(|(_, v)| *v == vertex) {
            return false;
        }
        let t = from_segment(vertices[vertex as usize], ends.map(|v| vertices[v as usize])).1;
        let place = points.partition_point(|(at, v)| (*at, *v) < (t, vertex));
        points.insert(place, (t, vertex));
        true
    }

    fn is_on(&self, edge: u32, vertex: u32) -> bool {
        self.edges[edge as usize].contains(&vertex) || self.on_edges[edge as usize].iter().any(|(_, v)| *v == vertex)
    }

    /// What an edge passes through, from one end to the other.
    fn along(&self, from: u32, to: u32) -> Vec<(f64, u32)> {
        let Some(edge) = self.number.get(&sorted(from, to)) else { return Vec::new() };
        let mut points = self.on_edges[*edge as usize].clone();
        if from > to {
            points.reverse();
            points.iter_mut().for_each(|point| point.0 = 1.0 - point.0);
        }
        points
    }

    /// Finds what is near.
    fn collect(&mut self, mesh: &mut Mesh, involved: &[u32], reach: SnapDistance) {
        let mut vertices: Vec<u32> = self.edges.as_flattened().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        let of_edges =
            sorted_boxes(self.edges.iter().map(|edge| reach.around(&edge.map(|v| mesh.vertices[v as usize]))));
        self.pass_near(mesh, &vertices, &of_edges, reach);
        let new = self.meet(mesh, &of_edges, reach);
        self.pass_near(mesh, &new, &of_edges, reach);
        self.agree(mesh);
        vertices.extend(new);
        let faces: Vec<[u32; 3]> = involved.iter().map(|&t| mesh.triangles[t as usize]).collect();
        let of_faces = sorted_boxes(faces.iter().map(|t| reach.around(&t.map(|v| mesh.vertices[v as usize]))));
        let of_vertices = sorted_boxes(vertices.iter().map(|&v| [mesh.vertices[v as usize]; 2]));
        let inside = of_vertices.pairs_if(&of_faces.all(), |vertex, face| {
            let (vertex, t) = (vertices[vertex as usize], faces[face as usize]);
            if is_collapsed(t) || sides(t).iter().any(|edge| self.is_on(self.number[edge], vertex)) {
                return false;
            }
            let p = mesh.vertices[vertex as usize];
            let [a, b, c] = t.map(|v| mesh.vertices[v as usize]);
            let normal = (b - a).cross(c - a);
            let height = (p - a).dot(normal) / normal.length();
            height.abs() <= reach.at(p) && barycentric([a, b, c], p).iter().all(|w| *w > 0.0)
        });
        for [vertex, face] in inside {
            self.in_faces[face as usize].push(vertices[vertex as usize]);
        }
        for inner in &mut self.in_faces {
            inner.sort_unstable();
        }
        for edge in 0..self.edges.len() {
            let [from, to] = self.edges[edge];
            let mut last = from;
            for end in self.on_edges[edge].clone().into_iter().map(|(_, v)| v).chain([to]) {
                self.note(last, end);
                last = end;
            }
        }
    }

    /// Notes that there is an edge between two vertices.
    fn note(&mut self, a: u32, b: u32) {
        for (from, to) in [(a, b), (b, a)] {
            let all = self.next.entry(from).or_default();
            if !all.contains(&to) {
                all.push(to);
            }
        }
    }

    /// Makes edges pass through vertices that are near.
    fn pass_near(&mut self, mesh: &Mesh, vertices: &[u32], of_edges: &TriangleBvh, reach: SnapDistance) {
        let of_vertices = sorted_boxes(vertices.iter().map(|&v| [mesh.vertices[v as usize]; 2]));
        let pairs = of_vertices.pairs_if(&of_edges.all(), |vertex, edge| {
            let (vertex, edge) = (vertices[vertex as usize], self.edges[edge as usize]);
            let p = mesh.vertices[vertex as usize];
            !edge.contains(&vertex) && from_segment(p, edge.map(|v| mesh.vertices[v as usize])).0 <= reach.at(p)
        });
        for [vertex, edge] in pairs {
            self.pass(&mesh.vertices, edge, vertices[vertex as usize]);
        }
    }

    /// Gives edges that pass near each other, and have no vertex in common, one; returns those that are new.
    fn meet(&mut self, mesh: &mut Mesh, of_edges: &TriangleBvh, reach: SnapDistance) -> Vec<u32> {
        let first = mesh.vertices.len() as u32;
        let mut pairs = of_edges.pairs_within(|one, two| self.near_crossing(mesh, [one, two], reach).is_some());
        pairs.sort_unstable();
        for [one, two] in pairs {
            // An earlier pair may have given them one.
            let Some(place) = self.near_crossing(mesh, [one, two], reach) else { continue };
            let known = [one, two].into_iter().flat_map(|edge| &self.on_edges[edge as usize]).map(|(_, v)| *v);
            let near = |v: &u32| mesh.vertices[*v as usize].distance(place) <= reach.at(place);
            let vertex = known.into_iter().find(near).unwrap_or(mesh.vertices.len() as u32);
            if vertex as usize == mesh.vertices.len() {
                mesh.vertices.push(place);
            }
            self.pass(&mesh.vertices, one, vertex);
            self.pass(&mesh.vertices, two, vertex);
        }
        (first..mesh.vertices.len() as u32).collect()
    }

    /// Where two edges pass near each other away from their ends, if they have no vertex in common.
    fn near_crossing(&self, mesh: &Mesh, [one, two]: [u32; 2], reach: SnapDistance) -> Option<DVec3> {
        let [[a, b], [p, q]] = [one, two].map(|edge| self.edges[edge as usize].map(|v| mesh.vertices[v as usize]));
        let (d, g) = (b - a, q - p);
        let normal = d.cross(g);
        let size = normal.length_squared();
        let (s, t) = ((p - a).cross(g).dot(normal) / size, (p - a).cross(d).dot(normal) / size);
        if !(s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) {
            return None;
        }
        let (x, y) = (a + d * s, p + g * t);
        let near = reach.at(x);
        if x.distance(y) > near || [a, b, p, q].iter().any(|end| end.distance(x) <= near || end.distance(y) <= near) {
            return None;
        }
        let has_common = |edge: u32, other: u32| {
            let points = self.on_edges[edge as usize].iter().map(|(_, v)| *v).chain(self.edges[edge as usize]);
            points.into_iter().any(|v| self.is_on(other, v))
        };
        (!has_common(one, two)).then_some((x + y) / 2.0)
    }

    /// Makes the long side of a triangle that is hardly more than it pass through what the others do, and these through
    /// what it does, so that nothing of it is left.
    fn agree(&mut self, mesh: &Mesh) {
        const MOST: usize = 16;
        for _ in 0..MOST {
            let mut is_end = vec![false; mesh.vertices.len()];
            for (edge, points) in self.edges.iter().zip(&self.on_edges).filter(|(_, points)| !points.is_empty()) {
                edge.iter().for_each(|v| is_end[*v as usize] = true);
                points.iter().for_each(|(_, v)| is_end[*v as usize] = true);
            }
            let mut has_changed = false;
            let may_be_long = |t: &&[u32; 3]| !is_collapsed(**t) && t.iter().all(|v| is_end[*v as usize]);
            for t in mesh.triangles.iter().filter(may_be_long) {
                for k in 0..3 {
                    let [a, b, c] = [0, 1, 2].map(|i| t[(k + i) % 3]);
                    let chain = self.along(a, c);
                    let Some(middle) = chain.iter().position(|(_, v)| *v == b) else { continue };
                    let long = self.edge(a, c);
                    for (points, side) in [(&chain[..middle], [a, b]), (&chain[middle + 1..], [b, c])] {
                        let side = self.edge(side[0], side[1]);
                        for (_, vertex) in points {
                            has_changed |= self.pass(&mesh.vertices, side, *vertex);
                        }
                        for (_, vertex) in self.on_edges[side as usize].clone() {
                            has_changed |= self.pass(&mesh.vertices, long, vertex);
                        }
                    }
                }
            }
            if !has_changed {
                return;
            }
        }
    }

    /// The number of an edge, also of one that nothing was near to.
    fn edge(&mut self, a: u32, b: u32) -> u32 {
        let edge = sorted(a, b);
        *self.number.entry(edge).or_insert_with(|| {
            self.edges.push(edge);
            self.on_edges.push(Vec::new());
            self.edges.len() as u32 - 1
        })
    }
}

fn barycentric([a, b, c]: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let part = |q: DVec3, r: DVec3| (q - p).cross(r - p).dot(normal) / normal.length_squared();
    [part(b, c), part(c, a), part(a, b)]
}

/// The surface with all edges and faces through what is near them, less triangles that cancel.
fn rebuilt(outcome: Outcome, mut near: Incidences, involved: &[u32]) -> Outcome {
    let old = &outcome.mesh;
    let tables = CornerTables::of(&[old]);
    let mut place = vec![u32::MAX; old.triangles.len()];
    involved.iter().zip(0..).for_each(|(&triangle, at)| place[triangle as usize] = at);
    let mut made: Vec<([u32; 3], u32, bool)> = Vec::with_capacity(old.triangles.len());
    for (&t, index) in old.triangles.iter().zip(0..) {
        if is_collapsed(t) {
            continue;
        }
        let chains = [0, 1, 2].map(|k| near.along(t[k], t[(k + 1) % 3]));
        if (0..3).any(|k| chains[k].iter().any(|(_, v)| *v == t[(k + 2) % 3])) {
            continue; // nothing of it is left
        }
        let inner = near.in_faces.get(place[index as usize] as usize).cloned().unwrap_or_default();
        if inner.is_empty() && chains.iter().all(Vec::is_empty) {
            made.push((t, index, true));
        } else {
            let parts = divided(old, index, &chains, &inner, &near.next);
            // Faces near this one are to be divided in the same way.
            for part in &parts {
                sides(*part).into_iter().for_each(|[a, b]| near.note(a, b));
            }
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
    let point = |x: f64, y: f64| ImplicitPoint::new(PointDefinition::Given(DVec3::new(x, y, 0.0)));
    let place = |k: usize, s: f64| match k {
        0 => point(s, 0.0),
        1 => point(STEPS - s, s),
        _ => point(0.0, STEPS - s),
    };
    let on_sides: Vec<Vec<ImplicitPoint>> = chains
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
    let inside: Vec<ImplicitPoint> = inner
        .iter()
        .map(|&v| {
            let [_, x, y] = barycentric(corners, mesh.vertices[v as usize]).map(|w| (w * STEPS).round().max(1.0));
            let surplus = (x + y - (STEPS - 1.0)).max(0.0);
            if x > y { point(x - surplus, y) } else { point(x, y - surplus) }
        })
        .collect();
    let frame = [point(0.0, 0.0), point(STEPS, 0.0), point(0.0, STEPS)];
    let mut names = t.to_vec();
    let mut triangulation = IncrementalTriangulation::new(2, &frame.each_ref());
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
