//! What the triangles of all operands do to each other: points, and the lines that carry them.
//!
//! A carrier is an edge of the input, or the line in which two faces cross. Whatever lies on it is kept once, in order,
//! for all faces that share it; so no two faces ever disagree about their border.

use super::buried::BuriedTriangles;
use super::contact::{CommonPoint, Contact, ConvexFace, EdgeKey, Feature, PointKey, crossing};
use super::expression::Expression;
use super::faces::{CandidateFaces, contacts, touching};
use super::operand::Operands;
use super::partial_evaluation::PartialEvaluation;
use super::relevance::relevant;
use crate::numeric::implicit::{ImplicitPoint, PointDefinition, coincide, compare, turn};
use crate::solid::union_find::UnionFind;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};
use std::cmp::Ordering;
use std::collections::hash_map::Entry;

/// A line that carries points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Line {
    Edge(EdgeKey),
    /// Where two faces cross, the lower first.
    Faces([u32; 2]),
}

#[derive(Clone, Debug)]
struct Carrier {
    line: Line,
    /// In the order of [`along`].
    points: Vec<u32>,
}

/// A piece of a carrier that lies in a face, inside it or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    carrier: u32,
    ends: [u32; 2],
}

/// The arrangement in a face that something touches: what lies in it.
#[derive(Clone, Debug, Default)]
pub struct FaceArrangement {
    /// Points inside it.
    pub inner: Vec<u32>,
    /// Lines across it.
    pub segments: Vec<Segment>,
    /// Points at its corners, as many as it has sides.
    pub corners: [u32; 4],
    is_touched: bool,
    /// The operand whose faces touch it, or [`SEVERAL`].
    partner: Option<u32>,
}

/// More than one operand.
const SEVERAL: u32 = u32::MAX;

/// Work done by an operation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Pairs of triangles whose boxes touch.
    pub pairs: u64,
    /// Pairs that have a point in common.
    pub contacts: u64,
    /// Points made.
    pub points: u64,
    /// Triangles that were divided.
    pub divided: u64,
    /// Triangles that they were divided into.
    pub facets: u64,
    /// Connected parts of the surface that were classified.
    pub parts: u64,
    /// Rays that were sent to classify them.
    pub rays: u64,
    /// If rounding made the result cross itself: the attempt that freed it of self-intersections, the first as 1.
    pub repair_attempt: u64,
}

/// The points, carriers and face arrangements of the faces near other operands.
pub struct Arrangement {
    /// Faces that may touch others. Their names are their indices here.
    pub faces: Vec<ConvexFace>,
    /// The lower triangle, counted over all operands, of each face.
    pub triangles: Vec<u32>,
    /// The face arrangement of each face.
    pub face_arrangements: Vec<FaceArrangement>,
    /// The points; several may be one, see [`Arrangement::point`].
    pub points: Vec<ImplicitPoint>,
    /// Vertices by point, where the point is one.
    pub vertices: Vec<Option<u32>>,
    /// Whether something of another operand passes through the point.
    pub on_other: Vec<bool>,
    /// Coplanar groups: faces that overlap in one plane, joined.
    pub coplanar_groups: UnionFind,
    /// For each triangle, counted over all operands, whether it may matter.
    pub is_relevant: Vec<bool>,
    /// Work done.
    pub counts: Counts,
    same: UnionFind,
    of_key: FxHashMap<PointKey, u32>,
    carriers: Vec<Carrier>,
    of_edge: FxHashMap<EdgeKey, u32>,
    of_faces: FxHashMap<[u32; 2], u32>,
    positions: FxHashMap<u32, DVec3>,
    ambiguous: FxHashSet<u32>,
}

/// Order along any line: lexicographic.
fn along(a: &ImplicitPoint, b: &ImplicitPoint) -> Ordering {
    compare(0, a, b).then_with(|| compare(1, a, b)).then_with(|| compare(2, a, b))
}

impl Arrangement {
    /// Finds all contacts between different operands, and within each that is not simple.
    ///
    /// Those that cannot matter to an expression are left out.
    pub fn new(operands: &Operands, expression: &Expression) -> Arrangement {
        let evaluation = PartialEvaluation::outside(expression, operands.meshes().len());
        let buried = BuriedTriangles::of(operands, &evaluation);
        let mut pairs = operands.pairs(|operand| buried.visible(operands, operand));
        let count = pairs.len() as u64;
        if !operands.are_simple {
            (0..operands.meshes().len() as u32).for_each(|operand| pairs.extend(operands.overlaps(operand)));
        }
        let mut faces = CandidateFaces::default();
        faces.add(operands, pairs.as_flattened());
        let mut contacts = contacts(&faces, &pairs);
        let is_relevant = relevant(operands, &evaluation, &buried, &touching(operands, &faces, &contacts));
        // Names are given to what is left only: a vertex of a face that was left out is no vertex of the others.
        let matters: Vec<bool> = faces
            .triangles
            .iter()
            .map(|&triangle| operands.halves(triangle).any(|half| is_relevant[half as usize]))
            .collect();
        contacts.retain(|(pair, _)| pair.iter().all(|&face| matters[face as usize]));
        faces.name(&mut contacts);
        let divided = faces.faces.len();
        if !operands.are_simple {
            let around = faces.around(operands, contacts.iter().flat_map(|(_, contact)| &contact.points));
            faces.add(operands, &around);
            (divided..faces.faces.len()).for_each(|face| _ = faces.name_face(face));
        }
        let all = faces.faces.len();
        // Mostly each contact has an end of its own, and each face a corner.
        let room = contacts.len() + divided;
        let mut arrangement = Arrangement {
            face_arrangements: vec![FaceArrangement::default(); all],
            points: Vec::with_capacity(room),
            vertices: Vec::with_capacity(room),
            on_other: Vec::with_capacity(room),
            coplanar_groups: UnionFind::new(all),
            is_relevant,
            counts: Counts { pairs: count, contacts: contacts.len() as u64, ..Counts::default() },
            same: UnionFind::new(0),
            of_key: FxHashMap::with_capacity_and_hasher(room, Default::default()),
            carriers: Vec::with_capacity(room),
            of_edge: FxHashMap::with_capacity_and_hasher(contacts.len(), Default::default()),
            of_faces: FxHashMap::with_capacity_and_hasher(contacts.len(), Default::default()),
            positions: faces.positions,
            ambiguous: faces.ambiguous,
            faces: faces.faces,
            triangles: faces.triangles,
        };
        for (pair, contact) in &contacts {
            arrangement.take(operands, *pair, contact);
        }
        arrangement.face_arrangements[divided..].iter_mut().for_each(|content| content.is_touched = true);
        arrangement.cross();
        arrangement.sort_points();
        arrangement.corners();
        arrangement.counts.points = arrangement.points.len() as u64;
        arrangement
    }

    /// The one number of a point.
    pub fn point(&self, point: u32) -> u32 {
        self.same.root(point)
    }

    /// Faces that something touches.
    pub fn touched(&self) -> impl Iterator<Item = u32> {
        (0..self.faces.len() as u32).filter(|&face| self.face_arrangements[face as usize].is_touched)
    }

    /// Points inside the edge of a face from corner `k` to the next, in that order.
    pub fn on_edge(&self, face: u32, k: u8) -> Vec<u32> {
        let face = &self.faces[face as usize];
        let edge = face.edge(k);
        let Some(&carrier) = self.of_edge.get(&edge) else { return Vec::new() };
        let mut points = self.distinct(carrier);
        let [first, last] = [0, 1].map(|i| self.of_key.get(&PointKey::Vertex(edge[i])).map(|&p| self.point(p)));
        points.retain(|&p| Some(p) != first && Some(p) != last);
        let [from, to] = face.ends(k.into()).map(|end| end.to_array());
        if from > to {
            points.reverse();
        }
        points
    }

    /// The points of a segment, from end to end.
    pub fn pieces(&self, segment: &Segment) -> Vec<u32> {
        let [p, q] = segment.ends.map(|end| self.point(end));
        let at = |p: u32| &self.points[p as usize];
        let is_forward = along(at(p), at(q)) == Ordering::Less;
        let [low, high] = if is_forward { [p, q] } else { [q, p] };
        let mut pieces = vec![low];
        let between = |&x: &u32| {
            x != low && x != high && along(at(low), at(x)) == Ordering::Less && along(at(x), at(high)) == Ordering::Less
        };
        pieces.extend(self.distinct(segment.carrier).into_iter().filter(between));
        pieces.push(high);
        pieces
    }

    fn distinct(&self, carrier: u32) -> Vec<u32> {
        let mut points: Vec<u32> = self.carriers[carrier as usize].points.iter().map(|&p| self.point(p)).collect();
        points.dedup();
        points
    }

    fn id(&mut self, key: PointKey) -> u32 {
        if let Some(&id) = self.of_key.get(&key) {
            return id;
        }
        let definition = self.definition(key);
        let id = self.points.len() as u32;
        self.points.push(ImplicitPoint::new(definition));
        self.vertices.push(if let PointKey::Vertex(vertex) = key { Some(vertex) } else { None });
        self.on_other.push(matches!(key, PointKey::Vertex(vertex) if self.ambiguous.contains(&vertex)));
        self.same.grow();
        self.of_key.insert(key, id);
        id
    }

    fn ends(&self, edge: EdgeKey) -> [DVec3; 2] {
        edge.map(|vertex| self.positions[&vertex])
    }

    fn definition(&self, key: PointKey) -> PointDefinition {
        let plane = |face: u32| self.faces[face as usize].plane();
        match key {
            PointKey::Vertex(vertex) => PointDefinition::Given(self.positions[&vertex]),
            PointKey::Pierced(edge, face) => PointDefinition::LineAndPlane(self.ends(edge), plane(face)),
            PointKey::Faces(faces) => PointDefinition::Planes(faces.map(plane)),
            PointKey::Edges(one, two) => PointDefinition::crossing(self.ends(one), self.ends(two)),
        }
    }

    fn carrier(&mut self, line: Line) -> u32 {
        let next = self.carriers.len() as u32;
        let entry = match line {
            Line::Edge(edge) => self.of_edge.entry(edge),
            Line::Faces(faces) => {
                return match self.of_faces.entry(faces) {
                    Entry::Occupied(known) => *known.get(),
                    Entry::Vacant(new) => {
                        self.carriers.push(Carrier { line, points: Vec::new() });
                        *new.insert(next)
                    }
                };
            }
        };
        match entry {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(new) => {
                self.carriers.push(Carrier { line, points: Vec::new() });
                *new.insert(next)
            }
        }
    }

    fn add(&mut self, carrier: u32, point: u32) {
        let points = &mut self.carriers[carrier as usize].points;
        if !points.contains(&point) {
            points.push(point);
        }
    }

    /// Notes what two faces have in common.
    fn take(&mut self, operands: &Operands, [a, b]: [u32; 2], contact: &Contact) {
        let ids: Vec<u32> = contact.points.iter().map(|point| self.id(point.key)).collect();
        for (which, (face, other)) in [(a, b), (b, a)].into_iter().enumerate() {
            // Lines of one operand that does not cross itself cross no others of it.
            let partner =
                if operands.are_simple { operands.of_triangle(self.triangles[other as usize]) } else { SEVERAL };
            let content = &mut self.face_arrangements[face as usize];
            content.is_touched = true;
            content.partner = match content.partner {
                Some(known) if known != partner => Some(SEVERAL),
                _ => Some(partner),
            };
            for (point, &id) in contact.points.iter().zip(&ids) {
                self.on_other[id as usize] = true;
                match point.features[which] {
                    Feature::Corner(_) => {}
                    Feature::Edge(k) => {
                        let carrier = self.carrier(Line::Edge(self.faces[face as usize].edge(k)));
                        self.add(carrier, id);
                    }
                    Feature::Inside => {
                        let inner = &mut self.face_arrangements[face as usize].inner;
                        if !inner.contains(&id) {
                            inner.push(id);
                        }
                    }
                }
            }
        }
        if contact.coplanar {
            self.edges_in_plane([a, b], contact, &ids);
            if ids.len() > 2 {
                self.coplanar_groups.join(a, b);
            }
        } else if let ([p, q], [one, two]) = (&contact.points[..], &ids[..]) {
            self.segment([a, b], [p, q], [*one, *two]);
        }
    }

    /// The line in which two faces cross: an edge of one of them, if it runs along one.
    fn segment(&mut self, faces: [u32; 2], points: [&CommonPoint; 2], ends: [u32; 2]) {
        let edge = |which: usize| {
            let face = &self.faces[faces[which] as usize];
            face.numbers().find(|&k| points.iter().all(|p| face.is_on(p.features[which], k)))
        };
        let edges = [edge(0), edge(1)];
        for which in 0..2 {
            let line = match (edges[which], edges[1 - which]) {
                // On an own edge, where its points are already.
                (Some(_), _) => continue,
                (None, Some(k)) => Line::Edge(self.faces[faces[1 - which] as usize].edge(k)),
                (None, None) => Line::Faces(if faces[0] < faces[1] { faces } else { [faces[1], faces[0]] }),
            };
            let carrier = self.carrier(line);
            if let Line::Faces(_) = line {
                ends.into_iter().for_each(|end| self.add(carrier, end));
            }
            self.push_segment(faces[which], Segment { carrier, ends });
        }
    }

    fn push_segment(&mut self, face: u32, segment: Segment) {
        let segments = &mut self.face_arrangements[face as usize].segments;
        let swapped = Segment { ends: [segment.ends[1], segment.ends[0]], ..segment };
        if !segments.contains(&segment) && !segments.contains(&swapped) {
            segments.push(segment);
        }
    }

    /// The edges of two faces in one plane, as far as each lies in the other.
    fn edges_in_plane(&mut self, faces: [u32; 2], contact: &Contact, ids: &[u32]) {
        for which in 0..2 {
            let other = faces[1 - which];
            let [face, beyond] = [faces[which], other].map(|face| self.faces[face as usize]);
            for k in face.numbers() {
                let is_on = |i: &usize| face.is_on(contact.points[*i].features[which], k);
                let on: Vec<usize> = (0..ids.len()).filter(is_on).collect();
                let at = |i: usize| &self.points[ids[i] as usize];
                let least = on.iter().copied().min_by(|&i, &j| along(at(i), at(j)));
                let most = on.iter().copied().max_by(|&i, &j| along(at(i), at(j)));
                let (Some(least), Some(most)) = (least, most) else { continue };
                let ends = [least, most].map(|i| contact.points[i].features[1 - which]);
                let along_own = beyond.numbers().any(|j| ends.iter().all(|feature| beyond.is_on(*feature, j)));
                if least != most && !along_own {
                    let carrier = self.carrier(Line::Edge(face.edge(k)));
                    self.push_segment(other, Segment { carrier, ends: [ids[least], ids[most]] });
                }
            }
        }
    }

    /// Where lines of several operands cross in a face: two operands whose own faces do not cross make none.
    fn cross(&mut self) {
        for face in 0..self.faces.len() {
            if self.face_arrangements[face].partner == Some(SEVERAL) {
                self.cross_in(face as u32);
            }
        }
    }

    fn cross_in(&mut self, face: u32) {
        let axis = self.faces[face as usize].axis;
        let segments = self.face_arrangements[face as usize].segments.clone();
        let boxes: Vec<_> = segments
            .iter()
            .map(|s| self.points[s.ends[0] as usize].bounds().union(self.points[s.ends[1] as usize].bounds()))
            .collect();
        let mut order: Vec<usize> = (0..segments.len()).collect();
        let across = (axis + 1) % 3;
        order.sort_by(|&i, &j| boxes[i].min[across].total_cmp(&boxes[j].min[across]));
        for (place, &i) in order.iter().enumerate() {
            let near = order[place + 1..].iter().take_while(|&&j| boxes[j].min[across] <= boxes[i].max[across]);
            for &j in near {
                if segments[i].carrier != segments[j].carrier && boxes[i].touches(boxes[j]) {
                    self.cross_segments(face, &segments[i], &segments[j]);
                }
            }
        }
        // Points of one operand on lines of another.
        let inner = self.face_arrangements[face as usize].inner.clone();
        for point in inner {
            let at = self.points[point as usize].bounds();
            for (segment, near) in segments.iter().zip(&boxes) {
                if at.touches(*near) && !segment.ends.contains(&point) {
                    self.put_on(axis, point, segment);
                }
            }
        }
    }

    /// Adds a point to the carrier of a segment of the same plane, if it lies inside the segment.
    fn put_on(&mut self, axis: usize, point: u32, segment: &Segment) {
        if self.turn(axis, segment, point) == 0.0 {
            self.put_between(point, segment);
        }
    }

    /// The turn from a segment to a point, seen along an axis, by [`turn`]; 0 for a point that is known to be an end of
    /// it.
    fn turn(&self, axis: usize, segment: &Segment, point: u32) -> f64 {
        let [from, to, same] = [segment.ends[0], segment.ends[1], point].map(|p| self.same.root(p));
        if same == from || same == to {
            return 0.0;
        }
        let [p, q, x] = [segment.ends[0], segment.ends[1], point].map(|p| &self.points[p as usize]);
        turn(axis, p, q, x)
    }

    /// Adds a point on the line of a segment to its carrier, if it lies inside the segment.
    fn put_between(&mut self, point: u32, segment: &Segment) {
        let [from, to, same] = [segment.ends[0], segment.ends[1], point].map(|p| self.same.root(p));
        if same == from || same == to {
            return;
        }
        let [p, q, x] = [segment.ends[0], segment.ends[1], point].map(|p| &self.points[p as usize]);
        match [along(p, x), along(x, q)] {
            [Ordering::Equal, _] => self.join([segment.ends[0], point]),
            [_, Ordering::Equal] => self.join([segment.ends[1], point]),
            [one, two] if one == two => self.add(segment.carrier, point),
            _ => {}
        }
    }

    fn cross_segments(&mut self, face: u32, one: &Segment, two: &Segment) {
        let axis = self.faces[face as usize].axis;
        let turns_of = |segment: &Segment, ends: [u32; 2]| ends.map(|end| self.turn(axis, segment, end));
        let turns = turns_of(one, two.ends);
        // Most lie beside each other.
        if turns[0] * turns[1] > 0.0 {
            return;
        }
        let turns = [turns, turns_of(two, one.ends)];
        for (turns, segment, ends) in [(turns[0], one, two.ends), (turns[1], two, one.ends)] {
            for (turn, end) in turns.into_iter().zip(ends) {
                if turn == 0.0 {
                    self.put_between(end, segment);
                }
            }
        }
        if turns.iter().all(|[from, to]| from * to < 0.0) {
            self.crossing(face, [one.carrier, two.carrier]);
        }
    }

    /// The point where two carriers cross in a face.
    fn crossing(&mut self, face: u32, carriers: [u32; 2]) {
        let beyond = |faces: [u32; 2]| if faces[0] == face { faces[1] } else { faces[0] };
        let lines = carriers.map(|carrier| self.carriers[carrier as usize].line);
        let key = match lines {
            [Line::Edge(one), Line::Edge(two)] => crossing(one, two),
            [Line::Edge(edge), Line::Faces(faces)] | [Line::Faces(faces), Line::Edge(edge)] => {
                PointKey::Pierced(edge, beyond(faces))
            }
            [Line::Faces(one), Line::Faces(two)] => {
                let mut faces = [face, beyond(one), beyond(two)];
                faces.sort_unstable();
                PointKey::Faces(faces)
            }
        };
        let mut carriers = carriers.to_vec();
        if let PointKey::Faces([a, b, c]) = key {
            carriers.extend([[a, b], [b, c], [a, c]].iter().filter_map(|faces| self.of_faces.get(faces)));
        }
        let point = self.id(key);
        for carrier in carriers {
            self.add(carrier, point);
        }
    }

    /// Orders the points of every carrier, and joins those that are one.
    fn sort_points(&mut self) {
        let points = &self.points;
        self.carriers.par_iter_mut().with_min_len(64).for_each(|carrier| {
            carrier.points.sort_by(|&a, &b| along(&points[a as usize], &points[b as usize]));
        });
        let neighbours =
            |carrier: &Carrier| carrier.points.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>();
        let pairs: Vec<[u32; 2]> = self.carriers.iter().flat_map(neighbours).collect();
        pairs.into_iter().for_each(|pair| self.unite(pair));
        let several = |content: &&FaceArrangement| content.partner == Some(SEVERAL);
        let pairs: Vec<Vec<[u32; 2]>> =
            self.face_arrangements.par_iter().filter(several).map(|c| self.near_pairs(c)).collect();
        pairs.into_iter().flatten().for_each(|pair| self.unite(pair));
    }

    /// Makes one of two points if they coincide.
    fn unite(&mut self, pair: [u32; 2]) {
        let [a, b] = pair.map(|p| self.same.root(p));
        if a != b && coincide(&self.points[pair[0] as usize], &self.points[pair[1] as usize]) {
            self.join(pair);
        }
    }

    /// Makes one of two points that coincide.
    fn join(&mut self, pair: [u32; 2]) {
        let [a, b] = pair.map(|p| self.same.root(p));
        if a != b {
            self.same.join(a, b);
            let [root, other] = [a.min(b) as usize, a.max(b) as usize];
            self.vertices[root] = self.vertices[root].or(self.vertices[other]);
            self.on_other[root] = true;
        }
    }

    /// Points in a face that may be one: those of edges that run along each other are on no carrier in common.
    fn near_pairs(&self, content: &FaceArrangement) -> Vec<[u32; 2]> {
        let ends = content.segments.iter().flat_map(|s| s.ends);
        let mut points: Vec<u32> = content.inner.iter().copied().chain(ends).collect();
        points.sort_unstable();
        points.dedup();
        let bounds = |p: u32| self.points[p as usize].bounds();
        points.sort_by(|&a, &b| bounds(a).min.x.total_cmp(&bounds(b).min.x));
        let mut pairs = Vec::new();
        for (place, &a) in points.iter().enumerate() {
            let near = points[place + 1..].iter().take_while(|&&b| bounds(b).min.x <= bounds(a).max.x);
            pairs.extend(near.filter(|&&b| bounds(a).touches(bounds(b))).map(|&b| [a, b]));
        }
        pairs
    }

    fn corners(&mut self) {
        for face in 0..self.faces.len() {
            if self.face_arrangements[face].is_touched {
                let shape = self.faces[face];
                for (k, &vertex) in shape.vertices().iter().enumerate() {
                    let corner = self.id(PointKey::Vertex(vertex));
                    self.face_arrangements[face].corners[k] = self.point(corner);
                }
            }
        }
    }
}
