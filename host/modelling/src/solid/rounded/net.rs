//! The polyhedron whose limit surface has rounded edges: every face beside such an edge is divided along it.

use std::collections::HashMap;

use glam::DVec3;

use super::error::RoundingError;
use super::faces::{HalfEdge, PolygonFace, PolygonFaces};
use crate::polygon::{TriangulationKind, triangulate_in_space};
use crate::subdivision::Polyhedron;

/// Corners of faces whose sides turn by less than this sine are straight.
const STRAIGHT: f64 = 1e-9;

/// Makes the polyhedron.
pub struct RoundingNet<'a> {
    faces: &'a PolygonFaces,
    points: Vec<DVec3>,
    /// For each edge how far from it the rounding begins; none where it stays sharp.
    setbacks: &'a [Option<f64>],
    radius: f64,
    /// Points on edges near their ends: by edge and vertex.
    on_edges: HashMap<(usize, u32), u32>,
    /// Points on rounded edges, in their direction: a strip that is one face long would not be divided.
    cuts: HashMap<usize, [u32; 2]>,
    polygons: Vec<Vec<u32>>,
    /// The vertices of the polyhedron, by those of the solid.
    named: HashMap<u32, u32>,
}

/// What is known of a corner of a face.
struct Corner {
    vertex: u32,
    /// The corner of what is left of the face.
    inner: u32,
    /// Whether a piece of its own lies between two strips.
    has_piece: bool,
}

impl<'a> RoundingNet<'a> {
    /// The polyhedron, its sharp edges sharp for ever.
    pub fn polyhedron(
        faces: &'a PolygonFaces,
        points: &[DVec3],
        setbacks: &'a [Option<f64>],
        radius: f64,
    ) -> Result<Polyhedron, RoundingError> {
        let mut net = RoundingNet {
            faces,
            points: points.to_vec(),
            setbacks,
            radius,
            on_edges: HashMap::new(),
            cuts: HashMap::new(),
            polygons: Vec::new(),
            named: HashMap::new(),
        };
        net.put_points_on_edges()?;
        for face in &faces.faces {
            net.divide(face)?;
        }
        let used = net.without_unused();
        let mut polyhedron = Polyhedron::new(used, &net.polygons)?;
        polyhedron.sharpen_edges(&net.sharp_edges(), f64::INFINITY)?;
        Ok(polyhedron)
    }

    fn at(&self, vertex: u32) -> DVec3 {
        self.points[vertex as usize]
    }

    fn along(&self, side: &HalfEdge) -> DVec3 {
        (self.at(side.ends[1]) - self.at(side.ends[0])).normalize_or_zero()
    }

    fn too_wide(&self, side: &HalfEdge) -> RoundingError {
        RoundingError::TooWide { from: self.at(side.ends[0]), to: self.at(side.ends[1]), radius: self.radius }
    }

    /// How far along the two sides of a corner the strips of the other side reach, and the sine of its angle; twice the
    /// setback, so that the rounding ends in the middle of the strip.
    fn reaches(&self, face: &PolygonFace, before: &HalfEdge, behind: &HalfEdge) -> ([f64; 2], f64) {
        let sine = face.normal.dot(self.along(behind).cross(-self.along(before)));
        let reach = |side: &HalfEdge| 2.0 * self.setbacks[side.edge].unwrap_or(0.0) / sine;
        // Along the side behind, the strip of the side before, and the other way round.
        ([reach(before), reach(behind)], sine)
    }

    /// Where strips of neighbouring edges end on an edge, it gets a point: the mean of what its two faces ask for.
    fn put_points_on_edges(&mut self) -> Result<(), RoundingError> {
        let mut asked: HashMap<(usize, u32), Vec<f64>> = HashMap::new();
        for face in &self.faces.faces {
            for run in &face.loops {
                for (k, behind) in run.iter().enumerate() {
                    let before = &run[(k + run.len() - 1) % run.len()];
                    let ([behind_reach, before_reach], sine) = self.reaches(face, before, behind);
                    let is_rounded = [before, behind].map(|side| self.setbacks[side.edge].is_some());
                    if is_rounded == [false; 2] {
                        continue;
                    }
                    if sine < STRAIGHT {
                        if is_rounded == [true; 2] && sine < -STRAIGHT {
                            continue;
                        }
                        return Err(RoundingError::Hollow { at: self.at(behind.ends[0]) });
                    }
                    if is_rounded[0] {
                        asked.entry((behind.edge, behind.ends[0])).or_default().push(behind_reach);
                    }
                    if is_rounded[1] {
                        asked.entry((before.edge, behind.ends[0])).or_default().push(before_reach);
                    }
                }
            }
        }
        for (edge, found) in self.faces.edges.iter().enumerate() {
            let length = self.at(found.ends[0]).distance(self.at(found.ends[1]));
            let mean = |vertex: u32| {
                let all = asked.get(&(edge, vertex))?;
                Some(all.iter().sum::<f64>() / all.len() as f64)
            };
            let reaches = found.ends.map(mean);
            if reaches.iter().flatten().sum::<f64>() >= length * (1.0 - STRAIGHT) {
                return Err(self.too_wide(&HalfEdge { edge, ends: found.ends }));
            }
            for (k, reach) in reaches.into_iter().enumerate() {
                let Some(reach) = reach else { continue };
                let (from, to) = (found.ends[k], found.ends[1 - k]);
                self.points.push(self.at(from) + (self.at(to) - self.at(from)) * (reach / length));
                self.on_edges.insert((edge, from), self.points.len() as u32 - 1);
            }
            if self.setbacks[edge].is_some() {
                let ends = found.ends.map(|end| self.on_edges.get(&(edge, end)).copied().unwrap_or(end));
                let cuts = self.thirds(ends);
                self.cuts.insert(edge, cuts);
            }
        }
        Ok(())
    }

    /// Adds two points between two others.
    fn thirds(&mut self, [from, to]: [u32; 2]) -> [u32; 2] {
        [1.0 / 3.0, 2.0 / 3.0].map(|part| {
            self.points.push(self.at(from).lerp(self.at(to), part));
            self.points.len() as u32 - 1
        })
    }

    /// Divides a face into strips along rounded edges, pieces between two strips, and the rest.
    fn divide(&mut self, face: &PolygonFace) -> Result<(), RoundingError> {
        let mut rest = Vec::new();
        for run in &face.loops {
            let count = run.len();
            let corners = (0..count).map(|k| self.corner(face, &run[(k + count - 1) % count], &run[k]));
            let corners: Vec<Corner> = corners.collect();
            let mut inner = Vec::new();
            for (k, side) in run.iter().enumerate() {
                let (from, to) = (&corners[k], &corners[(k + 1) % count]);
                let on_edge = side.ends.map(|end| self.on_edges.get(&(side.edge, end)).copied());
                inner.push(from.inner);
                if (self.at(to.inner) - self.at(from.inner)).dot(self.along(side)) <= STRAIGHT * self.radius {
                    return Err(self.too_wide(side));
                }
                if self.setbacks[side.edge].is_none() {
                    let between = [(from, on_edge[0]), (to, on_edge[1])];
                    inner.extend(between.iter().filter_map(|(c, on)| on.filter(|on| *on != c.inner)));
                    continue;
                }
                let begin = [Some(from.vertex).filter(|_| !from.has_piece), on_edge[0]];
                let end = [on_edge[1], Some(to.vertex).filter(|_| !to.has_piece)];
                let is_forward = self.faces.edges[side.edge].ends == side.ends;
                let [one, two] = self.cuts[&side.edge];
                let [one, two] = if is_forward { [one, two] } else { [two, one] };
                let [first, second] = self.thirds([from.inner, to.inner]);
                self.polygons.push(begin.into_iter().flatten().chain([one, first, from.inner]).collect());
                self.polygons.push(vec![one, two, second, first]);
                self.polygons
                    .push([two].into_iter().chain(end.into_iter().flatten()).chain([to.inner, second]).collect());
                inner.extend([first, second]);
            }
            for (k, corner) in corners.iter().enumerate().filter(|(_, corner)| corner.has_piece) {
                let before = self.on_edges.get(&(run[(k + count - 1) % count].edge, corner.vertex)).copied();
                let behind = self.on_edges.get(&(run[k].edge, corner.vertex)).copied();
                let piece = [Some(corner.vertex), behind, Some(corner.inner), before];
                self.polygons.push(piece.into_iter().flatten().collect());
            }
            rest.push(inner);
        }
        self.add_rest(face, rest)
    }

    fn corner(&mut self, face: &PolygonFace, before: &HalfEdge, behind: &HalfEdge) -> Corner {
        let vertex = behind.ends[0];
        let is_rounded = [before, behind].map(|side| self.setbacks[side.edge].is_some());
        let on = |side: &HalfEdge| self.on_edges.get(&(side.edge, vertex)).copied().unwrap_or(vertex);
        let inner = match is_rounded {
            [false, false] => vertex,
            [true, false] => on(behind),
            [false, true] => on(before),
            [true, true] => {
                let ([behind_reach, before_reach], _) = self.reaches(face, before, behind);
                let offset = self.along(behind) * behind_reach - self.along(before) * before_reach;
                self.points.push(self.at(vertex) + offset);
                self.points.len() as u32 - 1
            }
        };
        let ([reach, _], _) = self.reaches(face, before, behind);
        Corner { vertex, inner, has_piece: is_rounded == [true, true] && reach > 0.0 }
    }

    /// Adds what is left of a face: whole if it is convex, otherwise in triangles.
    fn add_rest(&mut self, face: &PolygonFace, rest: Vec<Vec<u32>>) -> Result<(), RoundingError> {
        let turn = |run: &[u32], k: usize| {
            let [a, b, c] = [0, 1, 2].map(|step| self.at(run[(k + step) % run.len()]));
            let (one, two) = ((b - a).normalize_or_zero(), (c - b).normalize_or_zero());
            face.normal.dot(one.cross(two)).atan2(one.dot(two))
        };
        if let [run] = &rest[..] {
            let turns: Vec<f64> = (0..run.len()).map(|k| turn(run, k)).collect();
            let is_once_around = turns.iter().sum::<f64>() < 3.0 * std::f64::consts::PI;
            if turns.iter().all(|turn| *turn > -STRAIGHT) && is_once_around {
                self.polygons.push(run.clone());
                return Ok(());
            }
        }
        let contours: Vec<Vec<DVec3>> = rest.iter().map(|run| run.iter().map(|v| self.at(*v)).collect()).collect();
        let names: Vec<u32> = rest.concat();
        let triangles = triangulate_in_space(&contours, TriangulationKind::Delaunay)?.triangles;
        // Points that lie straight between others are no corners of triangles, but of faces.
        let next: HashMap<u32, u32> =
            rest.iter().flat_map(|run| (0..run.len()).map(|k| (run[k], run[(k + 1) % run.len()]))).collect();
        let is_corner: std::collections::HashSet<u32> =
            triangles.as_flattened().iter().map(|k| names[*k as usize]).collect();
        for triangle in triangles {
            let corners = triangle.map(|k| names[k as usize]);
            let mut polygon = Vec::new();
            for k in 0..3 {
                polygon.push(corners[k]);
                let mut between = Vec::new();
                let mut here = next.get(&corners[k]).copied();
                while let Some(point) = here.filter(|point| !is_corner.contains(point) && between.len() < next.len()) {
                    between.push(point);
                    here = next.get(&point).copied();
                }
                if here == Some(corners[(k + 1) % 3]) {
                    polygon.extend(between);
                }
            }
            self.polygons.push(polygon);
        }
        Ok(())
    }

    /// Leaves out the points that no polygon has.
    fn without_unused(&mut self) -> Vec<DVec3> {
        let mut names: HashMap<u32, u32> = HashMap::new();
        let mut used = Vec::new();
        for vertex in self.polygons.iter_mut().flatten() {
            *vertex = *names.entry(*vertex).or_insert_with(|| {
                used.push(self.points[*vertex as usize]);
                used.len() as u32 - 1
            });
        }
        self.on_edges.values_mut().for_each(|point| *point = names.get(point).copied().unwrap_or(u32::MAX));
        self.named = names;
        used
    }

    /// The pieces of edges that stay sharp.
    fn sharp_edges(&self) -> Vec<[u32; 2]> {
        let mut sharp = Vec::new();
        for (edge, found) in self.faces.edges.iter().enumerate().filter(|(edge, _)| self.setbacks[*edge].is_none()) {
            let [from, to] = found.ends;
            let on = |end: u32| self.on_edges.get(&(edge, end)).copied();
            let named = |vertex: u32| self.named.get(&vertex).copied();
            let run: Vec<u32> = [named(from), on(from), on(to), named(to)].into_iter().flatten().collect();
            sharp.extend(run.windows(2).map(|pair| [pair[0], pair[1]]));
        }
        sharp
    }
}
