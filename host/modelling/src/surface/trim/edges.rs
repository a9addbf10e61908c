//! The edges of trimmed surfaces: which are the same, and the vertices that they share.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::super::{Surface, TessellationError, Tolerance};
use super::{TrimEdge, TrimmedSurface};
use crate::curve::Curve;
use crate::mesh::bits;

/// The most halvings of a piece of an edge.
const MAX_HALVINGS: usize = 24;
/// The most segments of an edge.
const MAX_SEGMENTS: usize = 1 << 16;
/// The part of the tolerances that the outline may use up: what lies beside it must keep them too.
const OUTLINE_PART: f64 = 0.7;

/// An edge in space.
struct Edge {
    /// The face, loop and place of each use, and whether it runs against the first.
    uses: Vec<([usize; 3], bool)>,
    /// The fractions of its vertices, from 0 to 1, by the first use.
    fractions: Vec<f64>,
    /// The number of its first vertex; the others follow.
    first: usize,
}

/// All edges of all faces, with a vertex for each of their fractions.
pub(super) struct Edges {
    edges: Vec<Edge>,
    /// The edge of each use.
    of: HashMap<[usize; 3], (usize, bool)>,
    /// The vertices that are the same point, as a forest.
    parents: Vec<usize>,
    positions: Vec<DVec3>,
}

impl Edges {
    pub fn of<S: Surface>(faces: &[TrimmedSurface<S>], tolerance: Tolerance) -> Result<Edges, TessellationError> {
        let mut all = Edges { edges: Vec::new(), of: HashMap::new(), parents: Vec::new(), positions: Vec::new() };
        let mut by_name: HashMap<usize, usize> = HashMap::new();
        let mut by_points: HashMap<[[u64; 3]; 5], usize> = HashMap::new();
        for (face, trimmed) in faces.iter().enumerate() {
            for (ring, edges) in trimmed.loops.iter().enumerate() {
                for (place, edge) in edges.iter().enumerate() {
                    let points = five(&trimmed.surface, edge);
                    if points.iter().any(|point| !point.is_finite()) {
                        return Err(TessellationError::NotFinite { surface: face });
                    }
                    let key = points.map(bits);
                    let mut turned = key;
                    turned.reverse();
                    let is_point = key.iter().all(|point| *point == key[0]);
                    let named = edge.shared.and_then(|name| by_name.get(&name));
                    let known = named.or_else(|| by_points.get(&key).or_else(|| by_points.get(&turned)));
                    let number = known.copied().filter(|_| !is_point).unwrap_or(all.edges.len());
                    if number == all.edges.len() {
                        all.edges.push(Edge { uses: Vec::new(), fractions: Vec::new(), first: 0 });
                        by_points.insert(key, number);
                    }
                    by_name.extend(edge.shared.map(|name| (name, number)));
                    let is_turned = all.edges[number].uses.first().is_some_and(|(first, _)| {
                        let other = five(&faces[first[0]].surface, &faces[first[0]].loops[first[1]][first[2]]);
                        let gap = |k: usize, l: usize| points[k].distance(other[l]);
                        (0..5).map(|k| gap(k, 4 - k)).sum::<f64>() < (0..5).map(|k| gap(k, k)).sum::<f64>()
                    });
                    all.edges[number].uses.push(([face, ring, place], is_turned));
                    all.of.insert([face, ring, place], (number, is_turned));
                }
            }
        }
        for number in 0..all.edges.len() {
            all.divide(number, faces, tolerance)?;
        }
        all.join_ends(faces);
        Ok(all)
    }

    /// Divides an edge until its segments follow it on all its faces.
    fn divide<S: Surface>(
        &mut self,
        number: usize,
        faces: &[TrimmedSurface<S>],
        tolerance: Tolerance,
    ) -> Result<(), TessellationError> {
        let edge = &self.edges[number];
        let uses: Vec<(&S, &TrimEdge, bool)> =
            edge.uses.iter().map(|&([f, r, p], turned)| (&faces[f].surface, &faces[f].loops[r][p], turned)).collect();
        let mut fractions = vec![0.0];
        for pair in start(uses[0].1).windows(2) {
            let mut stack = vec![(pair[0], pair[1], 0)];
            while let Some((from, to, halvings)) = stack.pop() {
                let follows = |(surface, edge, turned): &(&S, &TrimEdge, bool)| {
                    let at = |fraction: f64| edge.uv(if *turned { 1.0 - fraction } else { fraction });
                    segment_follows(*surface, at, [from, to], tolerance)
                };
                if halvings == MAX_HALVINGS || uses.iter().all(follows) {
                    fractions.push(to);
                    continue;
                }
                let middle = 0.5 * (from + to);
                stack.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
                if fractions.len() > MAX_SEGMENTS {
                    let segments = fractions.len();
                    return Err(TessellationError::TooFine { surface: edge.uses[0].0[0], segments });
                }
            }
        }
        let (surface, curve, _) = uses[0];
        let positions: Vec<DVec3> = fractions.iter().map(|&f| surface.point(inside(surface, curve.uv(f)))).collect();
        let first = self.positions.len();
        self.parents.extend(first..first + positions.len());
        // An edge that is a point, as at a pole, is one vertex.
        if positions.iter().all(|position| *position == positions[0]) {
            self.parents[first..].fill(first);
        }
        self.positions.extend(positions);
        let edge = &mut self.edges[number];
        (edge.first, edge.fractions) = (first, fractions);
        Ok(())
    }

    /// The last vertex of each edge is the first of the next in its loop.
    fn join_ends<S: Surface>(&mut self, faces: &[TrimmedSurface<S>]) {
        for (face, trimmed) in faces.iter().enumerate() {
            for (ring, edges) in trimmed.loops.iter().enumerate() {
                for place in 0..edges.len() {
                    let last = *self.vertices([face, ring, place]).last().unwrap_or(&0);
                    let next = self.vertices([face, ring, (place + 1) % edges.len()])[0];
                    self.join(last, next);
                }
            }
        }
    }

    /// The vertices of a use of an edge, in its direction.
    fn vertices(&self, place: [usize; 3]) -> Vec<usize> {
        let (number, turned) = self.of[&place];
        let edge = &self.edges[number];
        let vertices = edge.first..edge.first + edge.fractions.len();
        if turned { vertices.rev().collect() } else { vertices.collect() }
    }

    /// The corners of a loop in order, each with the vertex that it belongs to.
    pub fn corners<S: Surface>(&self, face: usize, ring: usize, trimmed: &TrimmedSurface<S>) -> Vec<(DVec2, usize)> {
        let mut corners = Vec::new();
        for (place, curve) in trimmed.loops[ring].iter().enumerate() {
            let (number, turned) = self.of[&[face, ring, place]];
            let fractions = &self.edges[number].fractions;
            let vertices = self.vertices([face, ring, place]);
            let fraction = |k: usize| if turned { 1.0 - fractions[fractions.len() - 1 - k] } else { fractions[k] };
            let corner = |k: usize| (inside(&trimmed.surface, curve.uv(fraction(k))), vertices[k]);
            corners.extend((0..fractions.len() - 1).map(corner));
        }
        corners
    }

    /// Makes two vertices one.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b)] = a.min(b);
    }

    /// The vertex that stands for all that are the same as `vertex`.
    pub fn root(&self, mut vertex: usize) -> usize {
        while self.parents[vertex] != vertex {
            vertex = self.parents[vertex];
        }
        vertex
    }

    /// The place of a vertex.
    pub fn position(&self, vertex: usize) -> DVec3 {
        self.positions[vertex]
    }
}

/// The parameters, taken into the domain where rounding left it.
fn inside<S: Surface>(surface: &S, uv: DVec2) -> DVec2 {
    let [low, high] = surface.domain();
    uv.clamp(low, high)
}

fn five<S: Surface>(surface: &S, edge: &TrimEdge) -> [DVec3; 5] {
    [0.0, 0.25, 0.5, 0.75, 1.0].map(|fraction| surface.point(inside(surface, edge.uv(fraction))))
}

/// The fractions at which the division of an edge begins: the joints of its curve, and points between them where it may
/// bend, so that even a loop of one piece is a polygon.
fn start(edge: &TrimEdge) -> Vec<f64> {
    let basis = edge.curve.basis();
    let (breaks, [low, high]) = (basis.breaks(), edge.curve.domain());
    let steps = match (basis.degree(), breaks.len()) {
        (1, _) => 1,
        (_, 2) => 4,
        _ => 2,
    };
    let mut fractions = vec![0.0];
    for pair in breaks.windows(2) {
        let step = |k: usize| pair[0] + (pair[1] - pair[0]) * k as f64 / steps as f64;
        fractions.extend(
            (1..=steps).map(|k| if k == steps && pair[1] == high { 1.0 } else { (step(k) - low) / (high - low) }),
        );
    }
    fractions
}

/// Whether the segment between two fractions of a curve in the parameters stays near its curve in space and normals.
fn segment_follows<S: Surface>(
    surface: &S,
    at: impl Fn(f64) -> DVec2,
    [from, to]: [f64; 2],
    tolerance: Tolerance,
) -> bool {
    const STEPS: usize = 16;
    let samples: Vec<(DVec3, DVec3)> = (0..=STEPS)
        .map(|k| inside(surface, at(from + (to - from) * k as f64 / STEPS as f64)))
        .map(|uv| (surface.point(uv), surface.normal(uv)))
        .collect();
    let ((a, first), (b, last)) = (samples[0], samples[STEPS]);
    let along = (b - a).normalize_or_zero();
    samples.iter().all(|&(point, normal)| {
        let offset = point - a;
        let is_near = (offset - along * offset.dot(along)).length() <= OUTLINE_PART * tolerance.chord;
        let turn = first.angle_between(normal).max(last.angle_between(normal)).to_degrees();
        // A normal that is not known turns by nothing.
        is_near && (turn <= OUTLINE_PART * tolerance.angle || turn.is_nan())
    })
}
